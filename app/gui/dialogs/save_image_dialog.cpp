#include "dialogs/save_image_dialog.h"

#include "widgets/named.h"
#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

namespace pellucid::gui {

SaveImageDialog::SaveImageDialog(const QString& path, const QSize& seen, bool reference, QWidget* parent)
    : QDialog(parent), m_seen(seen), m_path(new QLineEdit(path, this)), m_preset(new QComboBox(this)),
      m_width(new QSpinBox(this)), m_height(new QSpinBox(this)),
      m_transparent(new QCheckBox(tr("Transparent background (PNG, TIFF, EXR)"), this)),
      m_reference(new QCheckBox(tr("With &frame of reference"), this)) {
    setObjectName("saveImageDialog");
    setWindowTitle(tr("Save image"));
    m_path->setObjectName("imagePath");
    m_path->setMinimumWidth(340);
    m_preset->setObjectName("imagePreset");
    m_width->setObjectName("imageWidth");
    m_height->setObjectName("imageHeight");
    m_transparent->setObjectName("imageTransparent");
    named(m_reference, "imageReference", tr("What the window shows around the picture: View → Frame of reference"));
    m_reference->setEnabled(reference);
    m_reference->setChecked(reference);
    for (QSpinBox* box : {m_width, m_height}) {
        box->setRange(1, 16384);
        box->setSuffix(tr(" px"));
    }
    const auto offer = [&](const QString& text, const QSize& size) {
        m_preset->addItem(QStringLiteral("%1 (%2 × %3)").arg(text).arg(size.width()).arg(size.height()), size);
    };
    offer(tr("As seen"), seen);
    offer(tr("Twice as large"), seen * 2);
    offer(tr("Four times as large"), seen * 4);
    offer(tr("Full HD"), {1920, 1080});
    offer(tr("4K"), {3840, 2160});
    offer(tr("Square"), {1024, 1024});
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
    auto* file = new QHBoxLayout;
    file->addWidget(m_path, 1);
    file->addWidget(browse);
    auto* size = new QHBoxLayout;
    size->addWidget(m_width);
    size->addWidget(new QLabel(QStringLiteral("×"), this));
    size->addWidget(m_height);
    size->addStretch(1);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel, this);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    auto* form = new QFormLayout(this);
    form->setContentsMargins(18, 16, 18, 12);
    form->setVerticalSpacing(9);
    form->addRow(tr("File"), file);
    form->addRow(tr("Size"), m_preset);
    form->addRow(QString(), size);
    form->addRow(QString(), m_transparent);
    form->addRow(QString(), m_reference);
    form->addRow(buttons);
}

SaveImageOptions SaveImageDialog::options() const {
    return {m_path->text().trimmed(),
            {m_width->value(), m_height->value()},
            m_transparent->isChecked(),
            m_reference->isChecked()};
}

} // namespace pellucid::gui
