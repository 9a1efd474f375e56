// Which files are the time steps of a series.
#pragma once

#include <QDialog>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "volume/series.h"

class QLabel;
class QLineEdit;
class QPushButton;
class QSpinBox;

namespace pellucid::gui {

/// A folder, a pattern or chosen files; it shows what is found, and which of the frames are wanted.
class SeriesDialog : public QDialog {
    Q_OBJECT
public:
    explicit SeriesDialog(const QString& folder, QWidget* parent = nullptr);
    VolumeSource source() const;

private:
    VolumeSource allFrames() const;
    void look();
    void show(const SeriesListing& listing);
    void setRange(int count);

    QString m_folder;
    QStringList m_files; ///< chosen ones; empty: what the line says
    QLineEdit* m_path;
    QSpinBox *m_first, *m_last, *m_every;
    QLabel* m_found;
    QPushButton* m_ok;
    RestTimer m_pause{200, [this] { look(); }}; ///< milliseconds after the last key
    Job<VolumeSource, SeriesListing> m_listing;
};

} // namespace pellucid::gui
