// Films of what the window shows: a turntable, the frames of a series, a way from view to view.
#pragma once

#include <memory>

#include <QObject>
#include <QSize>

#include "jobs/job.h"

namespace pellucid {
struct FilmResult;
struct FilmTask;
} // namespace pellucid

namespace pellucid::gui {

class Services;

class FilmController : public QObject {
    Q_OBJECT
public:
    explicit FilmController(Services& services);
    ~FilmController() override;

    void addActions();

    /// In the background; one after the other.
    void save(const FilmTask& task);
    void cancel() { m_job.cancel(); }
    bool isBusy() const { return m_job.isRunning(); }
    QString busyText() const;
    /// Pixels of the view on the screen, which are offered first.
    void setSeenSize(const QSize& pixels) { m_seen = pixels; }

Q_SIGNALS:
    void busyChanged();
    void progress(double fraction);
    void cancelled();
    void saved(const QString& path);

private:
    void choose();

    Services& m_services;
    QSize m_seen;
    QString m_name; ///< of the file that is being written
    Job<std::shared_ptr<const FilmTask>, std::shared_ptr<const FilmResult>> m_job;
};

} // namespace pellucid::gui
