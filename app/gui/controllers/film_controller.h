// Films of what the window shows: a turntable, the frames of a series, a way from view to view.
#pragma once

#include <QObject>
#include <QSize>

#include "jobs/background_work.h"

namespace pellucid {
struct FilmResult;
struct FilmTask;
} // namespace pellucid

namespace pellucid::gui {

class Services;

class FilmController : public FileWork<FilmTask, FilmResult> {
    Q_OBJECT
public:
    explicit FilmController(Services& services);
    ~FilmController() override;

    void addActions();

    /// In the background; one after the other.
    void save(const FilmTask& task);
    /// Pixels of the view on the screen, which are offered first.
    void setSeenSize(const QSize& pixels) { m_seen = pixels; }

Q_SIGNALS:
    void saved(const QString& path);

private:
    void choose();

    Services& m_services;
    QSize m_seen;
};

} // namespace pellucid::gui
