#include "dialogs/raw_dialog.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <QDoubleValidator>
#include <QFileInfo>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QRegularExpression>
#include <QSpinBox>

#include "dialogs/closing_buttons.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

constexpr int kTypes = static_cast<int>(SampleType::F64) + 1;

QString typeText(SampleType type) {
    const QString shortName = QString::fromLatin1(name(type));
    const QString bits = shortName.mid(1);
    const QString kind = shortName[0] == 'u'   ? QObject::tr("unsigned integer")
                         : shortName[0] == 'i' ? QObject::tr("signed integer")
                                               : QObject::tr("floating point");
    return QStringLiteral("%1 (%2 bit %3)").arg(shortName, bits, kind);
}

} // namespace

RawLayout guessRawLayout(const QString& path, qint64 bytes) {
    RawLayout layout;
    const QString name = QFileInfo(path).completeBaseName().toLower();
    static const QRegularExpression typeInName(
        QStringLiteral("(?:^|[^a-z])(uint|int|u|i|s|float|f)_?(8|16|32|64)(?![0-9])"));
    if (const auto match = typeInName.match(name); match.hasMatch()) {
        const QString kind = match.captured(1), bits = match.captured(2);
        const QString letter = kind.startsWith('u') ? "u" : kind.startsWith('f') ? "f" : "i";
        if (const auto type = findNamed<SampleType>((letter + bits).toStdString())) layout.type = *type;
    } else if (name.contains("float")) {
        layout.type = SampleType::F32;
    } else if (name.contains("short")) {
        layout.type = name.contains("ushort") ? SampleType::U16 : SampleType::I16;
    }
    static const QRegularExpression dimsInName(QStringLiteral("(\\d{1,5})[x_](\\d{1,5})[x_](\\d{1,5})"));
    if (const auto match = dimsInName.match(name); match.hasMatch()) {
        layout.dims = {match.captured(1).toInt(), match.captured(2).toInt(), match.captured(3).toInt()};
        const auto voxels = static_cast<qint64>(voxelCount(layout.dims));
        // The size often settles the type where the name does not say it.
        if (voxels > 0 && bytes == 2 * voxels && bytesPerSample(layout.type) != 2) layout.type = SampleType::U16;
        if (voxels > 0 && bytes == 4 * voxels && bytesPerSample(layout.type) != 4) layout.type = SampleType::F32;
        return layout;
    }
    const double voxels = static_cast<double>(bytes) / static_cast<double>(bytesPerSample(layout.type));
    const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(voxels))));
    layout.dims = {side, side, side};
    return layout;
}

RawDialog::RawDialog(const QStringList& paths, QWidget* parent) : QDialog(parent) {
    setObjectName("rawDialog");
    setWindowTitle(tr("Open raw data"));
    lookAtSizes(paths);
    const RawLayout guess = guessRawLayout(paths.front(), m_bytes);
    for (int i = 0; i < 3; ++i) {
        const QChar axis = "xyz"[i];
        m_dims[i] = named(new QSpinBox(this), QStringLiteral("rawDim") + axis);
        m_dims[i]->setRange(1, 65536);
        m_dims[i]->setValue(guess.dims[i]);
        m_spacing[i] = named(new QDoubleSpinBox(this), QStringLiteral("rawSpacing") + axis);
        m_spacing[i]->setDecimals(6);
        m_spacing[i]->setRange(1e-6, 1e9);
        m_spacing[i]->setValue(1);
        m_dims[i]->setPrefix(QStringLiteral("%1  ").arg(axis));
        m_spacing[i]->setPrefix(m_dims[i]->prefix());
        connect(m_dims[i], &QSpinBox::valueChanged, this, &RawDialog::check);
    }
    m_type = named(new QComboBox(this), "rawType");
    for (int i = 0; i < kTypes; ++i) m_type->addItem(typeText(static_cast<SampleType>(i)), i);
    m_type->setCurrentIndex(static_cast<int>(guess.type));
    m_endian = named(new QComboBox(this), "rawEndian");
    m_endian->addItems({tr("little endian (PC)"), tr("big endian")});
    m_skip = named(new QDoubleSpinBox(this), "rawSkip", tr("Bytes before the first voxel"));
    m_skip->setDecimals(0);
    m_skip->setRange(0, 1e15);
    m_skip->setSuffix(tr(" bytes"));
    m_missing = named(new QLineEdit(this), "rawMissing",
                      tr("This value marks voxels without data, such as 1e35; NaN always does"));
    m_missing->setPlaceholderText(tr("none"));
    auto* number = new QDoubleValidator(m_missing);
    number->setLocale(QLocale::c());
    m_missing->setValidator(number);
    m_verdict = wrappedLabel("rawVerdict", this);
    auto* buttons = closingButtons(*this, QDialogButtonBox::Open | QDialogButtonBox::Cancel);
    m_ok = buttons->button(QDialogButtonBox::Open);

    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(named(new QLabel(headOf(paths), this), "rawWhat"));
    form->addRow(tr("Voxels"), rowOf({m_dims[0], m_dims[1], m_dims[2]}));
    form->addRow(tr("Type"), m_type);
    form->addRow(tr("Byte order"), m_endian);
    form->addRow(tr("Spacing"), rowOf({m_spacing[0], m_spacing[1], m_spacing[2]}));
    form->addRow(tr("Skip"), m_skip);
    form->addRow(tr("Missing value"), m_missing);
    form->addRow(m_verdict);
    form->addRow(buttons);
    connect(m_type, &QComboBox::currentIndexChanged, this, &RawDialog::check);
    connect(m_skip, &QDoubleSpinBox::valueChanged, this, &RawDialog::check);
    check();
}

void RawDialog::lookAtSizes(const QStringList& paths) {
    std::map<qint64, int> sizes;
    for (const QString& file : paths) ++sizes[QFileInfo(file).size()];
    m_bytes = std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) {
                  return a.second < b.second;
              })->first;
    for (const QString& file : paths)
        if (QFileInfo(file).size() != m_bytes) m_odd << QFileInfo(file).fileName();
}

QString RawDialog::headOf(const QStringList& paths) const {
    const auto name = [](const QString& path) { return QFileInfo(path).fileName().toHtmlEscaped(); };
    if (paths.size() == 1)
        return tr("<b>%1</b><br>%L2 bytes. The file has no header: say how it is laid out.")
            .arg(name(paths.front()))
            .arg(m_bytes);
    return tr("<b>%1 … %2</b><br>%L3 files of %L4 bytes, without headers: say how each of them is laid out.")
        .arg(name(paths.front()), name(paths.back()))
        .arg(paths.size())
        .arg(m_bytes);
}

RawLayout RawDialog::layoutOfFile() const {
    RawLayout layout;
    layout.dims = {m_dims[0]->value(), m_dims[1]->value(), m_dims[2]->value()};
    layout.spacing = {m_spacing[0]->value(), m_spacing[1]->value(), m_spacing[2]->value()};
    layout.type = static_cast<SampleType>(m_type->currentData().toInt());
    layout.bigEndian = m_endian->currentIndex() == 1;
    layout.skipBytes = static_cast<std::uint64_t>(m_skip->value());
    return layout;
}

std::optional<double> RawDialog::missing() const {
    bool isNumber = false;
    const double value = QLocale::c().toDouble(m_missing->text().trimmed(), &isNumber);
    return isNumber ? std::optional(value) : std::nullopt;
}

void RawDialog::check() {
    const RawLayout layout = layoutOfFile();
    // In floating point: the product of three such sizes does not fit 64 bits.
    const double wanted = static_cast<double>(layout.dims.x) * layout.dims.y * layout.dims.z *
                              static_cast<double>(bytesPerSample(layout.type)) +
                          static_cast<double>(layout.skipBytes);
    const double difference = wanted - static_cast<double>(m_bytes);
    m_ok->setEnabled(difference == 0);
    m_endian->setEnabled(bytesPerSample(layout.type) > 1);
    QString text = tr("This fits the file exactly.");
    if (difference == 0 && !m_odd.isEmpty())
        text = tr("This fits the files exactly, but for %1, which will be passed over.")
                   .arg(m_odd.size() > 3 ? tr("%L1 of them").arg(m_odd.size()) : m_odd.join(", "));
    else if (difference > 0)
        text = tr("This needs %L1 bytes more than the file has.").arg(difference, 0, 'f', 0);
    else if (difference < 0)
        text = tr("The file has %L1 bytes more than this needs; skip them if they are a header.")
                   .arg(-difference, 0, 'f', 0);
    m_verdict->setText(text);
}

} // namespace pellucid::gui
