// Which of several volumes is opened: series of DICOM, arrays, images.
#pragma once

#include <QDialog>
#include <QImage>

#include "jobs/job.h"
#include "volume/file_contents.h"

class QListWidget;

namespace pellucid::gui {

class SeriesChoiceDialog : public QDialog {
    Q_OBJECT
public:
    /// `contents`: of `source`, with several arrays. Pictures of them follow as they are read.
    SeriesChoiceDialog(const VolumeSource& source, const FileContents& contents, QWidget* parent = nullptr);
    std::string series() const; ///< the name of the one that is chosen

private:
    struct Asked {
        VolumeSource source;
        int row = 0;
    };
    static QImage pictureOf(const Asked& asked, const JobControl& job);

    std::vector<std::string> m_names;
    QListWidget* m_list;
    Job<Asked, QImage> m_pictures;
};

} // namespace pellucid::gui
