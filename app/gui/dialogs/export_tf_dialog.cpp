#include "dialogs/export_tf_dialog.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>

#include "dialogs/closing_buttons.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

namespace {

constexpr auto kFormatKey = "exportedTfFormat";

} // namespace

ExportTfDialog::ExportTfDialog(const QString& path, std::function<QStringList(const TfFormat&)> losses, QWidget* parent)
    : QDialog(parent), m_losses(std::move(losses)),
      m_format(named(new QComboBox(this), "exportTfFormat", tr("The program that is to read it"))),
      m_path(named(new QLineEdit(path, this), "exportTfPath", tr("Where the file goes"))),
      m_lost(named(new QLabel(this), "exportTfLosses")) {
    setObjectName("exportTfDialog");
    setWindowTitle(tr("Export transfer function"));
    m_path->setMinimumWidth(380);
    for (const TfFormat& f : tfFormats().subspan(1)) // the first is our own, which Save writes
        m_format->addItem(QStringLiteral("%1 (*%2)").arg(QString::fromUtf8(f.title), QString::fromUtf8(f.suffix)),
                          QString::fromUtf8(f.name));
    m_lost->setWordWrap(true);
    m_lost->setTextFormat(Qt::PlainText);
    m_lost->setMinimumHeight(6 * m_lost->fontMetrics().lineSpacing());
    m_lost->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    const int kept = m_format->findData(QSettings().value(kFormatKey, "paraview"));
    m_format->setCurrentIndex(std::max(0, kept));
    connect(m_format, &QComboBox::currentIndexChanged, this, &ExportTfDialog::showFormat);

    auto* browse = browseButton(*this);
    connect(browse, &QPushButton::clicked, this, [this] {
        const QString chosen =
            QFileDialog::getSaveFileName(this, tr("Export transfer function"), m_path->text(), m_format->currentText(),
                                         nullptr, QFileDialog::DontConfirmOverwrite);
        if (!chosen.isEmpty()) m_path->setText(chosen);
    });
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(tr("For"), m_format);
    addRow(*form, tr("&File"), m_path, rowOf({{m_path, 1}, browse}));
    form->addRow(tr("What is lost"), m_lost);
    form->addRow(closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel));
    showFormat();
}

const TfFormat& ExportTfDialog::format() const {
    return tfFormatNamed(m_format->currentData().toString().toStdString());
}

void ExportTfDialog::showFormat() {
    QString path = m_path->text();
    if (!m_suffix.isEmpty() && path.endsWith(m_suffix, Qt::CaseInsensitive)) path.chop(m_suffix.size());
    m_suffix = QString::fromUtf8(format().suffix);
    if (!path.endsWith(m_suffix, Qt::CaseInsensitive)) path += m_suffix;
    m_path->setText(path);
    QStringList lines;
    for (const QString& loss : m_losses(format())) lines << QStringLiteral("• ") + loss;
    m_lost->setText(lines.isEmpty() ? tr("Nothing") : lines.join('\n'));
}

ExportTfOptions ExportTfDialog::options() const {
    QSettings().setValue(kFormatKey, m_format->currentData());
    return {&tfFormatNamed(m_format->currentData().toString().toStdString()), m_path->text().trimmed()};
}

} // namespace pellucid::gui
