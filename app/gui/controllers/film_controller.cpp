#include "controllers/film_controller.h"

#include <QDir>
#include <QFileInfo>
#include <QPushButton>

#include "dialogs/ask_file.h"
#include "dialogs/error_dialog.h"
#include "dialogs/film_dialog.h"
#include "film/movie_file.h"
#include "render/camera_motion.h"
#include "services/services.h"
#include "session/keyframes_file.h"

namespace pellucid::gui {
namespace {

QString presentView(const Scene& scene) {
    const ViewAngles view = viewAngles(scene.camera, scene.volume->geometry());
    return QStringLiteral("%1,%2,%3")
        .arg(QString::number(view.azimuth, 'f', 1), QString::number(view.elevation, 'f', 1),
             QString::number(view.zoom, 'f', 2));
}

FilmTask withResume(FilmTask task) {
    task.resume = true;
    return task;
}

} // namespace

FilmController::FilmController(Services& services)
    : FileWork(&makeFilm,
               [this](const FilmTask& task, const FilmResult& film) {
                   m_tasks.pop_front();
                   for (const std::string& frame : film.passedOver)
                       m_services.notices().add({tr("Not in the film: %1").arg(QString::fromStdString(frame))});
                   const QString path = QString::fromStdString(task.path);
                   m_services.saySaved(path, tr("%L1 pictures").arg(film.pictures));
                   Q_EMIT saved(path);
               }),
      m_services(services) {
    services.showFailuresOf(job(), tr("Cannot save the film"));
    connect(&job(), &JobBase::failed, this, [this] {
        const FilmTask task = m_tasks.front();
        m_tasks.pop_front();
        sayUnfinished(task);
    });
    connect(&job(), &JobBase::cancelled, this, [this] {
        for (const FilmTask& task : std::exchange(m_tasks, {})) sayUnfinished(task);
    });
}

FilmController::~FilmController() = default;

void FilmController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File"), [this] { return m_services.store().hasVolume(); });
    menu.add("saveFilmAction", tr("Save &film…"), {},
             tr("The volume turning, the frames of a series, a way from view to view, or from key to key, as a film\n"
                "(MP4) or pictures"),
             [this] { choose(); });
}

void FilmController::save(const FilmTask& task) {
    if (!m_services.attempt(tr("Cannot save the film"), [&] { checkFilm(task); })) return;
    if (const auto said = m_said.extract(task.path)) m_services.notices().remove(said.mapped());
    m_tasks.push_back(task);
    start(task);
}

void FilmController::sayUnfinished(const FilmTask& task) {
    const auto unfinished = unfinishedFilm(task);
    if (!unfinished || !unfinished->isThisOne || unfinished->pictures == 0) return;
    const QString text = tr("The film %3 is not finished: %L1 of its %L2 pictures are drawn.")
                             .arg(unfinished->pictures)
                             .arg(task.shots.size())
                             .arg(QFileInfo(QString::fromStdString(task.path)).fileName());
    m_said[task.path] = text;
    m_services.notices().add({text, {{tr("Draw the rest"), [this, rest = withResume(task)] { save(rest); }}}});
}

bool FilmController::mayBegin(FilmTask& task) {
    const QString title = tr("Save film"), path = QString::fromStdString(task.path);
    const bool isFolder = filmFileOf(task.path) == FilmFile::Pictures;
    const auto unfinished = unfinishedFilm(task);
    if (!unfinished || unfinished->pictures == 0)
        return mayReplaceFile(m_services.window(),
                              isFolder ? QString::fromStdString(pictureFileOf(task.path, 0)) : path, title);
    if (!isFolder && !mayReplaceFile(m_services.window(), path, title)) return false;
    const QString name = QFileInfo(path).fileName();
    QMessageBox box(QMessageBox::Question, title,
                    unfinished->isThisOne
                        ? tr("%1 was begun before: %L2 of its %L3 pictures are drawn.")
                              .arg(name)
                              .arg(unfinished->pictures)
                              .arg(task.shots.size())
                        : tr("Another film was begun as %1: %L2 of its pictures are there. They would be deleted.")
                              .arg(name)
                              .arg(unfinished->pictures),
                    QMessageBox::Cancel, m_services.window());
    box.setObjectName("unfinishedFilmBox");
    QPushButton* rest = nullptr;
    if (unfinished->isThisOne) {
        rest = box.addButton(tr("Draw the rest"), QMessageBox::AcceptRole);
        box.setDefaultButton(rest);
    } else {
        box.setDefaultButton(QMessageBox::Cancel);
    }
    const QPushButton* const anew =
        box.addButton(unfinished->isThisOne ? tr("Start again") : tr("Replace"), QMessageBox::DestructiveRole);
    box.exec();
    task.resume = rest != nullptr && box.clickedButton() == rest;
    return task.resume || box.clickedButton() == anew;
}

void FilmController::choose(FilmKind kind) {
    const Scene scene = m_services.scene(); // the film is of what is seen now, however long the dialog is open
    const QString folder = keptFolder("filmFolder", QDir::homePath());
    const QString title = QFileInfo(QString::fromStdString(scene.volume->title)).baseName();
    const Keyframes& keys = *scene.session.keyframes;
    std::optional<double> length;
    if (!keys.empty()) length = keys.back().time - keys.front().time;
    FilmOptions offered;
    offered.settings.kind = kind == FilmKind::Keys && keys.empty() ? FilmKind::Turntable : kind;
    offered.views = QStringLiteral("present; ");
    offered.path = QDir(folder).filePath(title + (hasMovieWriter() ? ".mp4" : "_film"));
    FilmDialog dialog(offered, m_seen, scene.series->varies() ? scene.series->size() : 0, length,
                      scene.session.reference->any(), m_services.window());
    dialog.setPresentView(presentView(scene));
    while (dialog.exec() == QDialog::Accepted) {
        const FilmOptions chosen = dialog.options();
        if (chosen.path.isEmpty()) continue;
        FilmTask task{scene};
        try {
            if (chosen.settings.kind == FilmKind::Keys) {
                checkKeyframes(keys, scene);
                task.keys = keys;
                task.shots = shotsOf(keys, chosen.settings.framesPerSecond, scene.volume->geometry());
            } else {
                std::vector<Camera> views;
                if (chosen.settings.kind == FilmKind::Views) views = viewsOfText(chosen.views.toStdString(), scene);
                task.shots = shotsOf(chosen.settings, views, scene);
            }
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
        if (!mayBegin(task)) continue;
        keepFolderOf("filmFolder", chosen.path);
        return save(task);
    }
}

} // namespace pellucid::gui
