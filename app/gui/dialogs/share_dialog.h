// What goes into a web page of the volume, how large it will be, and that whoever gets it has the voxels.
#pragma once

#include <functional>

#include <QDialog>

#include "share/share.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace pellucid::gui {

struct ShareOptions {
    ShareSettings settings;
    QString path;
};

class ShareDialog : public QDialog {
    Q_OBJECT
public:
    /// What a page of these settings would be: estimateShare() of the scene.
    using Estimate = std::function<ShareEstimate(const ShareSettings&)>;

    /// `offered.settings.title` is what the page is called where no title is written.
    ShareDialog(const ShareOptions& offered, Estimate estimate, QWidget* parent = nullptr);
    ShareOptions options() const;

private:
    void fillSizes();
    void browse();
    void follow();

    Estimate m_estimate;
    QLineEdit *m_title, *m_path;
    QComboBox *m_size, *m_bits;
    QCheckBox *m_density, *m_allowed;
    QPushButton* m_save = nullptr;
};

} // namespace pellucid::gui
