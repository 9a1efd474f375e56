// What a figure for print has, how large it is, and how it will look.
#pragma once

#include <vector>

#include <QDialog>

#include "figure/figure_settings.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QSpinBox;

namespace pellucid::gui {

struct FigureOptions {
    FigureSettings settings;
    QString path;
};

class FigureDialog : public QDialog {
    Q_OBJECT
public:
    explicit FigureDialog(const FigureOptions& offered, QWidget* parent = nullptr);
    FigureOptions options() const;

    /// The figure of these options as it looks on paper, `height` millimetres high.
    void showPreview(const QImage& picture, double height);
    /// Why there is none.
    void showNoPreview(const QString& why);
    /// Pixels that a preview should be wide.
    int previewWidth() const;

Q_SIGNALS:
    void changed(); ///< options() may be others, and what is shown is that of the former ones

private:
    QWidget* makeParts();
    void setWidthOfPreset();
    void followWidth();
    void browse();

    FigureSettings m_offered;
    double m_aspect; ///< height of the picture over its width
    QLineEdit *m_path, *m_title;
    QComboBox* m_preset;
    QDoubleSpinBox *m_width, *m_height, *m_font;
    QSpinBox* m_dpi;
    std::vector<QCheckBox*> m_parts; ///< as kFigureParts
    QLabel *m_preview, *m_about;
    QPushButton* m_save = nullptr;
};

} // namespace pellucid::gui
