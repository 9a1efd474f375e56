#include "dialogs/save_image_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>

#include "dialogs/closing_buttons.h"
#include "render/render_settings.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

namespace {

constexpr auto kDescribedKey = "describePictures";

} // namespace

SaveImageDialog::SaveImageDialog(const QString& path, const QSize& seen, bool annotated, bool layered, QWidget* parent)
    : QDialog(parent),
      m_path(named(new QLineEdit(path, this), "imagePath",
                   tr("Where the picture goes; the suffix says how it is written: .png, .tif, .exr or .jpg"))),
      m_content(named(new QComboBox(this), "imageContent",
                      tr("The picture as it is seen; or what it is made of, for programs that put pictures together: "
                         "what each feature adds to every pixel, the depth and the normals"))),
      m_preset(named(new QComboBox(this), "imagePreset", tr("Sizes that are often wanted"))),
      m_width(named(new QSpinBox(this), "imageWidth", tr("Width of the picture, pixels"))),
      m_height(named(new QSpinBox(this), "imageHeight", tr("Height of the picture, pixels"))),
      m_transparent(named(new QCheckBox(tr("Transparent background (PNG, TIFF, EXR)"), this), "imageTransparent",
                          tr("Nothing where the volume is not, in the place of the background's colour"))),
      m_annotated(named(new QCheckBox(tr("With &annotations"), this), "imageReference",
                        tr("What the window shows around the picture: View → Annotations"))),
      m_described(
          named(new QCheckBox(tr("Put session and caption into the &file"), this), "imageDescribed",
                tr("The file says what the picture shows, and a PNG file can be opened again as the session: "
                   "settings, transfer function, view, and the names of the data files as seen from the "
                   "picture's folder, which may tell whose data they are. TIFF and JPEG get the caption alone."))),
      m_mayAnnotate(annotated) {
    setObjectName("saveImageDialog");
    setWindowTitle(tr("Save image"));
    m_path->setMinimumWidth(340);
    m_annotated->setEnabled(annotated);
    m_annotated->setChecked(annotated);
    m_described->setChecked(QSettings().value(kDescribedKey, true).toBool());
    connect(m_described, &QCheckBox::clicked, this, [](bool on) { QSettings().setValue(kDescribedKey, on); });
    m_content->addItems({tr("Picture"), tr("Layers: one EXR file"), tr("Layers: a folder of PNG files")});
    m_content->setEnabled(layered);
    connect(m_content, &QComboBox::activated, this, &SaveImageDialog::showContent);
    for (QSpinBox* box : {m_width, m_height}) {
        box->setRange(1, kMostPixels);
        box->setSuffix(tr(" px"));
    }
    m_width->setAccessibleName(tr("Width"));
    m_height->setAccessibleName(tr("Height"));
    const std::pair<QString, QSize> presets[] = {
        {tr("As seen"), seen},         {tr("Twice as large"), seen * 2}, {tr("Four times as large"), seen * 4},
        {tr("Full HD"), {1920, 1080}}, {tr("4K"), {3840, 2160}},         {tr("Square"), {1024, 1024}}};
    for (const auto& [text, size] : presets)
        m_preset->addItem(QStringLiteral("%1 (%2 × %3)").arg(text).arg(size.width()).arg(size.height()), size);
    const auto apply = [this] {
        const QSize size = m_preset->currentData().toSize();
        m_width->setValue(size.width());
        m_height->setValue(size.height());
    };
    connect(m_preset, &QComboBox::activated, this, apply);
    apply();

    auto* browse = browseButton(*this);
    connect(browse, &QPushButton::clicked, this, [this] {
        const QString chosen = QFileDialog::getSaveFileName(this, tr("Save image"), m_path->text(),
                                                            tr("Images (*.png *.tif *.tiff *.jpg *.exr)"), nullptr,
                                                            QFileDialog::DontConfirmOverwrite);
        if (!chosen.isEmpty()) m_path->setText(chosen);
    });
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    addRow(*form, tr("&File"), m_path, rowOf({{m_path, 1}, browse}));
    form->addRow(tr("Con&tent"), m_content);
    form->addRow(tr("Size"), m_preset);
    form->addRow(QString(), rowOf({m_width, new QLabel(QStringLiteral("×"), this), m_height, Cell::rest()}));
    form->addRow(QString(), m_transparent);
    form->addRow(QString(), m_annotated);
    form->addRow(QString(), m_described);
    form->addRow(closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel));
}

bool SaveImageDialog::wantsLayers() const { return m_content->currentIndex() > 0; }

void SaveImageDialog::showContent() {
    m_transparent->setEnabled(!wantsLayers()); // layers are, and have nothing around them
    m_annotated->setEnabled(m_mayAnnotate && !wantsLayers());
    const QStringList endings{QStringLiteral(".png"), QStringLiteral(".exr"), QStringLiteral("_layers")};
    QString path = m_path->text().trimmed();
    for (const QString& other : {QStringLiteral(".png"), QStringLiteral(".exr"), QStringLiteral(".tif"),
                                 QStringLiteral(".tiff"), QStringLiteral(".jpg"), QStringLiteral("_layers")})
        if (path.endsWith(other, Qt::CaseInsensitive)) path.chop(other.size());
    m_path->setText(path + endings.at(m_content->currentIndex()));
}

SaveImageOptions SaveImageDialog::options() const {
    return {m_path->text().trimmed(),
            {m_width->value(), m_height->value()},
            m_transparent->isChecked(),
            m_annotated->isChecked(),
            wantsLayers(),
            m_described->isChecked()};
}

} // namespace pellucid::gui
