#include "dialogs/figure_dialog.h"

#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

#include "dialogs/closing_buttons.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/named.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kPreviewWidth = 400, kPreviewHeight = 460; // logical pixels

QString tipOf(const char* key) { return QObject::tr(settingOf(settingsOf<FigureSettings>(), key).help); }

QString wordsOf(const char* key) { return QObject::tr(settingOf(settingsOf<FigureSettings>(), key).words); }

QDoubleSpinBox* numberOf(const char* key, const QString& id, double step, QWidget* parent) {
    const Setting& setting = settingOf(settingsOf<FigureSettings>(), key);
    auto* const box = named(new QDoubleSpinBox(parent), id, tipOf(key));
    return withLook(box, {setting.range.lo, setting.range.hi, 1, step, QString::fromStdString(setting.unitText())});
}

} // namespace

FigureDialog::FigureDialog(const FigureOptions& offered, QWidget* parent)
    : QDialog(parent), m_offered(offered.settings),
      m_aspect(offered.settings.heightMm.value_or(0.75 * offered.settings.widthMm) / offered.settings.widthMm),
      m_path(named(new QLineEdit(offered.path, this), "figurePath",
                   tr("A name that ends in .pdf or .svg; without one of them it gets .pdf"))),
      m_title(named(new QLineEdit(this), "figureTitle", tipOf("title"))),
      m_preset(named(new QComboBox(this), "figurePreset", tr("Widths that journals ask for"))),
      m_width(numberOf("width_mm", "figureWidth", 1, this)), m_height(numberOf("height_mm", "figureHeight", 1, this)),
      m_font(numberOf("font_pt", "figureFont", 0.5, this)), m_dpi(named(new QSpinBox(this), "figureDpi", tipOf("dpi"))),
      m_preview(named(new QLabel(this), "figurePreview")), m_about(named(new QLabel(this), "figureAbout")) {
    setObjectName("figureDialog");
    setWindowTitle(tr("Save figure for print"));
    m_path->setMinimumWidth(260);
    m_title->setPlaceholderText(tr("The name of the volume"));
    const std::pair<QString, double> presets[] = {{tr("One column"), 85},
                                                  {tr("One and a half columns"), 114},
                                                  {tr("Two columns"), 174},
                                                  {tr("Width of A4"), 210}};
    for (const auto& [text, width] : presets) m_preset->addItem(tr("%1 (%2 mm)").arg(text).arg(width), width);
    m_preset->addItem(tr("Another width"), 0.0);
    const NumberRange dpi = settingOf(settingsOf<FigureSettings>(), "dpi").range;
    m_dpi->setRange(static_cast<int>(dpi.lo), static_cast<int>(dpi.hi));
    m_dpi->setSingleStep(50);
    m_dpi->setSuffix(tr(" dpi"));
    m_dpi->setValue(static_cast<int>(m_offered.dpi));
    m_font->setValue(m_offered.fontPt);
    m_title->setText(QString::fromStdString(m_offered.title));
    m_width->setValue(m_offered.widthMm);
    m_height->setValue(m_aspect * m_offered.widthMm);

    auto* const browse = browseButton(*this);
    connect(browse, &QPushButton::clicked, this, &FigureDialog::browse);
    auto* const form = new QFormLayout;
    form->setVerticalSpacing(9);
    form->addRow(tr("For"), m_preset);
    form->addRow(wordsOf("width_mm"), m_width);
    form->addRow(wordsOf("height_mm"), m_height);
    form->addRow(wordsOf("dpi"), m_dpi);
    form->addRow(wordsOf("font_pt"), m_font);
    form->addRow(tr("Parts"), makeParts());
    form->addRow(wordsOf("title"), m_title);
    addRow(*form, tr("&File"), m_path, rowOf({{m_path, 1}, browse}));

    m_preview->setFixedSize(kPreviewWidth, kPreviewHeight);
    m_preview->setAlignment(Qt::AlignCenter);
    m_preview->setWordWrap(true);
    m_preview->setTextFormat(Qt::PlainText);
    m_preview->setAccessibleName(tr("Preview"));
    m_preview->setText(tr("Drawing…"));
    makeFaint(*m_about);
    m_about->setAlignment(Qt::AlignCenter);
    auto* const buttons = closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel);
    m_save = buttons->button(QDialogButtonBox::Save);
    auto* const all = inset(new QVBoxLayout(this), {18, 16, 18, 12});
    add(*all, {rowOf({{columnOf({form, Cell::rest()}), 1}, Cell::gap(16), columnOf({m_preview, m_about})}), buttons});

    connect(m_preset, &QComboBox::activated, this, &FigureDialog::setWidthOfPreset);
    connect(m_width, &QDoubleSpinBox::valueChanged, this, &FigureDialog::followWidth);
    connect(m_height, &QDoubleSpinBox::valueChanged, this, [this](double height) {
        m_aspect = height / m_width->value();
        Q_EMIT changed();
    });
    for (QDoubleSpinBox* const box : {m_font})
        connect(box, &QDoubleSpinBox::valueChanged, this, &FigureDialog::changed);
    connect(m_dpi, &QSpinBox::valueChanged, this, &FigureDialog::changed);
    connect(m_title, &QLineEdit::textChanged, this, &FigureDialog::changed);
    connect(m_path, &QLineEdit::textChanged, this,
            [this](const QString& path) { m_save->setDisabled(path.trimmed().isEmpty()); });
    followWidth();
}

QWidget* FigureDialog::makeParts() {
    auto* const parts = new QWidget(this);
    auto* const grid = inset(new QGridLayout(parts), {0, 0, 0, 0});
    const FigureParts shown = figurePartsOf(m_offered.parts);
    for (const FigurePartInfo& part : kFigureParts) {
        auto* const box =
            named(new QCheckBox(tr(part.words), parts), QStringLiteral("figurePart_%1").arg(part.name), tr(part.help));
        box->setChecked(shown.*part.shown);
        connect(box, &QCheckBox::toggled, this, &FigureDialog::changed);
        const int n = static_cast<int>(m_parts.size());
        grid->addWidget(box, n / 2, n % 2);
        m_parts.push_back(box);
    }
    return parts;
}

void FigureDialog::setWidthOfPreset() {
    if (const double width = m_preset->currentData().toDouble(); width > 0) m_width->setValue(width);
}

void FigureDialog::followWidth() {
    const QSignalBlocker quiet(m_height);
    m_height->setValue(m_aspect * m_width->value());
    int preset = m_preset->count() - 1;
    for (int i = 0; i + 1 < m_preset->count(); ++i)
        if (std::abs(m_preset->itemData(i).toDouble() - m_width->value()) < 0.05) preset = i;
    m_preset->setCurrentIndex(preset);
    Q_EMIT changed();
}

void FigureDialog::browse() {
    const QString chosen = QFileDialog::getSaveFileName(
        this, windowTitle(), m_path->text(), tr("Figures (*.pdf *.svg)"), nullptr, QFileDialog::DontConfirmOverwrite);
    if (!chosen.isEmpty()) m_path->setText(chosen);
}

int FigureDialog::previewWidth() const { return static_cast<int>(std::lround(kPreviewWidth * devicePixelRatioF())); }

void FigureDialog::showPreview(const QImage& picture, double height) {
    const double ratio = devicePixelRatioF();
    const QSize room = QSize(kPreviewWidth, kPreviewHeight) * ratio;
    QPixmap pixmap = QPixmap::fromImage(picture);
    if (pixmap.width() > room.width() || pixmap.height() > room.height())
        pixmap = pixmap.scaled(room, Qt::KeepAspectRatio, Qt::SmoothTransformation);
    pixmap.setDevicePixelRatio(ratio);
    m_preview->setPixmap(pixmap);
    const FigurePixels pixels = figurePixels(options().settings);
    m_about->setText(tr("%1 × %2 mm, the picture in %3 × %4 pixels")
                         .arg(QString::number(m_width->value(), 'f', 1), QString::number(height, 'f', 1))
                         .arg(pixels.width)
                         .arg(pixels.height));
}

void FigureDialog::showNoPreview(const QString& why) {
    m_preview->setText(why);
    m_about->clear();
}

FigureOptions FigureDialog::options() const {
    FigureOptions options{m_offered, m_path->text().trimmed()};
    FigureSettings& settings = options.settings;
    settings.widthMm = m_width->value();
    settings.heightMm = m_height->value();
    settings.dpi = m_dpi->value();
    settings.fontPt = m_font->value();
    settings.title = m_title->text().trimmed().toStdString();
    FigureParts parts;
    for (std::size_t n = 0; n < m_parts.size(); ++n) parts.*kFigureParts[n].shown = m_parts[n]->isChecked();
    settings.parts = textOf(parts);
    if (!options.path.isEmpty() && !options.path.endsWith(".pdf", Qt::CaseInsensitive) &&
        !options.path.endsWith(".svg", Qt::CaseInsensitive))
        options.path += ".pdf";
    return options;
}

} // namespace pellucid::gui
