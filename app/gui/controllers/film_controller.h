// Films of what the window shows: a turntable, the frames of a series, a way from view to view, or from key to key.
#pragma once

#include <deque>
#include <map>
#include <string>

#include <QObject>
#include <QSize>

#include "film/film.h"
#include "jobs/background_work.h"

namespace pellucid::gui {

class Services;

class FilmController : public FileWork<FilmTask, FilmResult> {
    Q_OBJECT
public:
    explicit FilmController(Services& services);
    ~FilmController() override;

    void addActions();

    /// Asks which film, and saves it. Where pictures of it were drawn before it was stopped, it asks whether to draw
    /// the rest.
    void choose(FilmKind offered = FilmKind::Turntable);
    /// In the background; one after the other. Of one that is stopped or fails a notice says how it goes on.
    void save(const FilmTask& task);
    /// Pixels of the view on the screen, which are offered first.
    void setSeenSize(const QSize& pixels) { m_seen = pixels; }

Q_SIGNALS:
    void saved(const QString& path);

private:
    bool mayBegin(FilmTask& task); ///< whether what is at its path may go, or stays a part of it
    void sayUnfinished(const FilmTask& task);

    Services& m_services;
    QSize m_seen;
    std::deque<FilmTask> m_tasks;          ///< under way, the first one now
    std::map<std::string, QString> m_said; ///< notices of films that are not finished, by their paths
};

} // namespace pellucid::gui
