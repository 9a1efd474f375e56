// Size, background and place of a picture to be saved.
#pragma once

#include <QDialog>
#include <QSize>

class QCheckBox;
class QComboBox;
class QLineEdit;
class QSpinBox;

namespace pellucid::gui {

struct SaveImageOptions {
    QString path;
    QSize size;
    bool transparent = false;
    bool reference = false; ///< with what stands around the picture
};

class SaveImageDialog : public QDialog {
    Q_OBJECT
public:
    /// `seen`: pixels of the view, the size that is offered first; `reference`: whether a frame of reference is shown.
    SaveImageDialog(const QString& path, const QSize& seen, bool reference, QWidget* parent = nullptr);
    SaveImageOptions options() const;

private:
    QSize m_seen;
    QLineEdit* m_path;
    QComboBox* m_preset;
    QSpinBox *m_width, *m_height;
    QCheckBox *m_transparent, *m_reference;
};

} // namespace pellucid::gui
