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
    bool layers = false;    ///< what the picture is made of in its place: an .exr file, else a folder
    bool described = true;  ///< the file says what the picture shows, and carries the session
};

class SaveImageDialog : public QDialog {
    Q_OBJECT
public:
    /// `seen`: pixels of the view, the size that is offered first; `annotated`: whether annotations are shown;
    /// `layered`: whether the picture has layers.
    SaveImageDialog(const QString& path, const QSize& seen, bool annotated, bool layered, QWidget* parent = nullptr);
    SaveImageOptions options() const;

private:
    void showContent(); ///< what belongs to the picture or to its layers
    bool wantsLayers() const;

    QLineEdit* m_path;
    QComboBox *m_content, *m_preset;
    QSpinBox *m_width, *m_height;
    QCheckBox *m_transparent, *m_annotated, *m_described;
    bool m_mayAnnotate;
};

} // namespace pellucid::gui
