#include "dialogs/save_image_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

#include "dialogs/closing_buttons.h"
#include "render/render_settings.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

SaveImageDialog::SaveImageDialog(const QString& path, const QSize& seen, bool annotated, QWidget* parent)
    : QDialog(parent), m_path(named(new QLineEdit(path, this), "imagePath")),
      m_preset(named(new QComboBox(this), "imagePreset")), m_width(named(new QSpinBox(this), "imageWidth")),
      m_height(named(new QSpinBox(this), "imageHeight")),
      m_transparent(named(new QCheckBox(tr("Transparent background (PNG, TIFF, EXR)"), this), "imageTransparent")),
      m_annotated(named(new QCheckBox(tr("With &annotations"), this), "imageReference",
                        tr("What the window shows around the picture: View → Annotations"))) {
    setObjectName("saveImageDialog");
    setWindowTitle(tr("Save image"));
    m_path->setMinimumWidth(340);
    m_annotated->setEnabled(annotated);
    m_annotated->setChecked(annotated);
    for (QSpinBox* box : {m_width, m_height}) {
        box->setRange(1, kMostPixels);
        box->setSuffix(tr(" px"));
    }
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

    auto* browse = new QPushButton(tr("Browse…"), this);
    browse->setAutoDefault(false);
    connect(browse, &QPushButton::clicked, this, [this] {
        const QString chosen = QFileDialog::getSaveFileName(this, tr("Save image"), m_path->text(),
                                                            tr("Images (*.png *.tif *.tiff *.jpg *.exr)"), nullptr,
                                                            QFileDialog::DontConfirmOverwrite);
        if (!chosen.isEmpty()) m_path->setText(chosen);
    });
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(tr("File"), rowOf({{m_path, 1}, browse}));
    form->addRow(tr("Size"), m_preset);
    form->addRow(QString(), rowOf({m_width, new QLabel(QStringLiteral("×"), this), m_height, Cell::rest()}));
    form->addRow(QString(), m_transparent);
    form->addRow(QString(), m_annotated);
    form->addRow(closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel));
}

SaveImageOptions SaveImageDialog::options() const {
    return {m_path->text().trimmed(),
            {m_width->value(), m_height->value()},
            m_transparent->isChecked(),
            m_annotated->isChecked()};
}

} // namespace pellucid::gui
