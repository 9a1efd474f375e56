#include "controllers/film_controller.h"

#include <QDir>
#include <QFileInfo>

#include "dialogs/ask_file.h"
#include "dialogs/error_dialog.h"
#include "dialogs/film_dialog.h"
#include "film/movie_file.h"
#include "render/camera_motion.h"
#include "services/services.h"

namespace pellucid::gui {
namespace {

QString presentView(const Scene& scene) {
    const ViewAngles view = viewAngles(scene.camera, scene.volume->geometry());
    return QStringLiteral("%1,%2,%3")
        .arg(QString::number(view.azimuth, 'f', 1), QString::number(view.elevation, 'f', 1),
             QString::number(view.zoom, 'f', 2));
}

} // namespace

FilmController::FilmController(Services& services)
    : FileWork(&makeFilm,
               [this](const FilmTask& task, const FilmResult& film) {
                   for (const std::string& frame : film.passedOver)
                       m_services.notices().add({tr("Not in the film: %1").arg(QString::fromStdString(frame))});
                   const QString path = QString::fromStdString(task.path);
                   m_services.saySaved(path, tr("%L1 pictures").arg(film.pictures));
                   Q_EMIT saved(path);
               }),
      m_services(services) {
    services.showFailuresOf(job(), tr("Cannot save the film"));
}

FilmController::~FilmController() = default;

void FilmController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File"), [this] { return m_services.store().hasVolume(); });
    menu.add("saveFilmAction", tr("Save &film…"), {},
             tr("The volume turning, the frames of a series, or a way from view to view, as a film (MP4) or pictures"),
             [this] { choose(); });
}

void FilmController::save(const FilmTask& task) {
    if (!m_services.attempt(tr("Cannot save the film"), [&] { checkFilm(task); })) return;
    start(task);
}

void FilmController::choose() {
    const Scene scene = m_services.scene(); // the film is of what is seen now, however long the dialog is open
    const QString folder = keptFolder("filmFolder", QDir::homePath());
    const QString title = QFileInfo(QString::fromStdString(scene.volume->title)).baseName();
    FilmOptions offered;
    offered.views = QStringLiteral("present; ");
    offered.path = QDir(folder).filePath(title + (hasMovieWriter() ? ".mp4" : "_film"));
    FilmDialog dialog(offered, m_seen, scene.series->varies() ? scene.series->size() : 0,
                      scene.session.reference->any(), m_services.window());
    dialog.setPresentView(presentView(scene));
    while (dialog.exec() == QDialog::Accepted) {
        const FilmOptions chosen = dialog.options();
        if (chosen.path.isEmpty()) continue;
        FilmTask task{scene};
        try {
            std::vector<Camera> views;
            if (chosen.settings.kind == FilmKind::Views) views = viewsOfText(chosen.views.toStdString(), scene);
            task.shots = shotsOf(chosen.settings, views, scene);
            task.width = chosen.size.width();
            task.height = chosen.size.height();
            task.framesPerSecond = chosen.settings.framesPerSecond;
            if (chosen.annotated) task.around = *scene.session.reference;
            task.path = chosen.path.toStdString();
            checkFilm(task);
        } catch (const Error& error) { // read before the dialog comes back, which would cover it
            showErrorFirst(m_services.window(), tr("Cannot save the film"), error);
            continue;
        }
        const bool isFolder = filmFileOf(task.path) == FilmFile::Pictures;
        const QString first = isFolder ? QString::fromStdString(pictureFileOf(task.path, 0)) : chosen.path;
        if (!mayReplaceFile(m_services.window(), first, tr("Save film"))) continue;
        keepFolderOf("filmFolder", chosen.path);
        return save(task);
    }
}

} // namespace pellucid::gui
