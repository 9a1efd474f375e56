#include "dialogs/raw_dialog.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <QDoubleValidator>
#include <QFile>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "dialogs/closing_buttons.h"
#include "dialogs/slice_picture.h"
#include "dialogs/spacing_dialog.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

constexpr int kPictureSize = 220;
constexpr int kRest = 120; ///< milliseconds without a change before a picture is made
constexpr std::size_t kGuesses = 8;
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

RawDialog::RawDialog(const QStringList& paths, QWidget* parent)
    : QDialog(parent), m_path(paths.front()), m_look(
                                                  [](const QString& path, const JobControl& job) {
                                                      return lookAtRaw(path.toStdString(), kGuesses, {job.stop, {}});
                                                  },
                                                  [this](const QString&, RawLook& look) { takeLook(look); }),
      m_pictures(&RawDialog::pictureOf,
                 [this](const VolumeSource&, const QImage& image) {
                     m_picture->setPixmap(
                         image.isNull()
                             ? swatchOf(palette().color(QPalette::AlternateBase), kPictureSize, kPictureSize)
                             : QPixmap::fromImage(image.scaled(kPictureSize, kPictureSize, Qt::KeepAspectRatio,
                                                               Qt::SmoothTransformation)));
                 }),
      m_rest(kRest, [this] {
          VolumeSource source;
          source.path = m_path.toStdString();
          source.raw = layoutOfFile();
          m_pictures.start(source);
      }) {
    setObjectName("rawDialog");
    setWindowTitle(tr("Open raw data"));
    lookAtSizes(paths);
    const RawLayout guess = rawLayoutInName(m_path.toStdString(), static_cast<std::uint64_t>(m_bytes));
    for (int i = 0; i < 3; ++i) {
        const QChar axis = "xyz"[i];
        m_dims[i] = named(new QSpinBox(this), QStringLiteral("rawDim") + axis, tr("Voxels along %1").arg(axis));
        m_dims[i]->setAccessibleName(tr("Voxels along %1").arg(axis));
        m_dims[i]->setRange(1, 65536);
        m_dims[i]->setValue(guess.dims[i]);
        m_dims[i]->setPrefix(QStringLiteral("%1  ").arg(axis));
        connect(m_dims[i], &QSpinBox::valueChanged, this, &RawDialog::check);
        connect(m_dims[i], &QSpinBox::editingFinished, this, [this] { m_isTouched = true; });
    }
    m_type = named(new QComboBox(this), "rawType", tr("How one sample is stored"));
    for (int i = 0; i < kTypes; ++i) m_type->addItem(typeText(static_cast<SampleType>(i)), i);
    m_type->setCurrentIndex(static_cast<int>(guess.type));
    m_endian = named(new QComboBox(this), "rawEndian", tr("Order of the bytes of a sample"));
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
    m_guesses = named(new QComboBox(this), "rawGuesses",
                      tr("Layouts that fit the size of the file, those first in which neighbouring voxels agree best"));
    m_guesses->addItem(tr("looking at the voxels…"));
    m_guesses->setEnabled(false);
    m_picture = named(new QLabel(this), "rawPicture", tr("The slice in the middle, as this layout has it"));
    m_picture->setFixedSize(kPictureSize, kPictureSize);
    m_picture->setAlignment(Qt::AlignCenter);
    m_verdict = wrappedLabel("rawVerdict", this);
    auto* buttons = closingButtons(*this, QDialogButtonBox::Open | QDialogButtonBox::Cancel);
    m_ok = buttons->button(QDialogButtonBox::Open);

    auto* form = new QFormLayout;
    form->setVerticalSpacing(9);
    form->addRow(tr("Likely"), m_guesses);
    form->addRow(tr("Voxels"), rowOf({m_dims[0], m_dims[1], m_dims[2]}));
    form->addRow(tr("Type"), m_type);
    form->addRow(tr("Byte order"), m_endian);
    m_spacing = new SpacingFields(this, tr("not known"));
    m_spacing->addTo(*form);
    form->addRow(tr("Skip"), m_skip);
    form->addRow(tr("Missing value"), m_missing);
    auto* sides = new QHBoxLayout;
    sides->setSpacing(16);
    sides->addLayout(form, 1);
    sides->addWidget(m_picture, 0, Qt::AlignTop);
    auto* rows = inset(new QVBoxLayout(this), {18, 16, 18, 12});
    rows->setSpacing(9);
    rows->addWidget(named(new QLabel(headOf(paths), this), "rawWhat"));
    rows->addLayout(sides);
    rows->addWidget(m_verdict);
    rows->addWidget(buttons);
    connect(m_type, &QComboBox::currentIndexChanged, this, &RawDialog::check);
    connect(m_type, &QComboBox::activated, this, [this] { m_isTouched = true; });
    connect(m_endian, &QComboBox::currentIndexChanged, this, &RawDialog::check);
    connect(m_skip, &QDoubleSpinBox::valueChanged, this, &RawDialog::check);
    connect(m_guesses, &QComboBox::activated, this, [this](int index) {
        if (index >= 0 && index < static_cast<int>(m_layouts.size()))
            setLayoutOfFile(m_layouts[static_cast<std::size_t>(index)]);
    });
    connect(&m_look, &JobBase::failed, this, [this](const Error& error) {
        m_guesses->setItemText(0, tr("none"));
        if (!m_isPacked) return; // the verdict tells what fits
        m_verdict->setText(QString::fromStdString(error.problem()));
    });
    m_look.start(m_path);
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
    QFile first(m_path);
    m_isPacked = first.open(QIODevice::ReadOnly) && first.read(3) == "\x1f\x8b\b";
    if (m_isPacked) m_odd.clear(); // packed sizes differ
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
    layout.type = static_cast<SampleType>(m_type->currentData().toInt());
    layout.bigEndian = m_endian->currentIndex() == 1;
    layout.skipBytes = static_cast<std::uint64_t>(m_skip->value());
    return layout;
}

std::optional<GridSpacing> RawDialog::spacing() const {
    const GridSpacing given = m_spacing->value();
    return given == GridSpacing() ? std::nullopt : std::optional(given);
}

std::optional<double> RawDialog::missing() const {
    bool isNumber = false;
    const double value = QLocale::c().toDouble(m_missing->text().trimmed(), &isNumber);
    return isNumber ? std::optional(value) : std::nullopt;
}

/// The middle slice, made coarser where it is large; null where it cannot be read.
QImage RawDialog::pictureOf(const VolumeSource& source, const JobControl& job) {
    VolumeSource slice = source;
    const Int3 dims = source.raw->dims;
    slice.region = VoxelRegion{{0, 0, dims.z / 2}, {dims.x, dims.y, dims.z / 2 + 1}};
    slice.downsample = std::max(1, std::max(dims.x, dims.y) / (2 * kPictureSize));
    try {
        return pictureOfSlice(loadVolume(slice, {job.stop, {}}));
    } catch (const Error&) {
        return {};
    }
}

void RawDialog::setLayoutOfFile(const RawLayout& layout) {
    m_type->setCurrentIndex(static_cast<int>(layout.type));
    m_endian->setCurrentIndex(layout.bigEndian ? 1 : 0);
    m_skip->setValue(static_cast<double>(layout.skipBytes));
    for (int a = 0; a < 3; ++a) m_dims[a]->setValue(layout.dims[a]);
}

void RawDialog::takeLook(const RawLook& look) {
    m_bytes = static_cast<qint64>(look.bytes);
    m_isPacked = false;
    m_guesses->clear();
    m_layouts.clear();
    for (const RawGuess& guess : look.guesses) {
        const Int3 d = guess.layout.dims;
        const bool hasOrder = bytesPerSample(guess.layout.type) > 1;
        m_guesses->addItem(tr("%1 × %2 × %3, %4%5 — %6 % alike")
                               .arg(d.x)
                               .arg(d.y)
                               .arg(d.z)
                               .arg(QString::fromLatin1(name(guess.layout.type)), !hasOrder ? QString()
                                                                                  : guess.layout.bigEndian
                                                                                      ? tr(", big endian")
                                                                                      : tr(", little endian"))
                               .arg(std::lround(100 * std::max(0.0, guess.agreement))));
        m_layouts.push_back(guess.layout);
    }
    m_guesses->setEnabled(!m_layouts.empty());
    if (m_layouts.empty()) m_guesses->addItem(tr("no layout fits: is there a header to skip?"));
    // What the user has set stays.
    if (!m_isTouched && !m_layouts.empty()) setLayoutOfFile(m_layouts.front());
    check();
}

void RawDialog::check() {
    const RawLayout layout = layoutOfFile();
    m_endian->setEnabled(bytesPerSample(layout.type) > 1);
    if (m_isPacked) {
        m_ok->setEnabled(false);
        return m_verdict->setText(tr("The file is packed by gzip: it is being unpacked…"));
    }
    // In floating point: the product of three such sizes does not fit 64 bits.
    const double wanted = static_cast<double>(layout.dims.x) * layout.dims.y * layout.dims.z *
                              static_cast<double>(bytesPerSample(layout.type)) +
                          static_cast<double>(layout.skipBytes);
    const double difference = wanted - static_cast<double>(m_bytes);
    m_ok->setEnabled(difference == 0);
    m_rest.start();
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
