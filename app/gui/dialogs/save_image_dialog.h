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
    bool annotated = false; ///< with what stands around the picture
};

class SaveImageDialog : public QDialog {
    Q_OBJECT
public:
    /// `seen`: pixels of the view, the size that is offered first; `annotated`: whether annotations are shown.
    SaveImageDialog(const QString& path, const QSize& seen, bool annotated, QWidget* parent = nullptr);
    SaveImageOptions options() const;

private:
    QLineEdit* m_path;
    QComboBox* m_preset;
    QSpinBox *m_width, *m_height;
    QCheckBox *m_transparent, *m_annotated;
};

} // namespace pellucid::gui
