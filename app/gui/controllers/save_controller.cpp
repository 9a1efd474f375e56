#include "controllers/save_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QSettings>

#include "controllers/field_controller.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "render/annotation_raster.h"
#include "report/report.h"
#include "services/services.h"
#include "session/session_json.h"
#include "tf/formats/tf_json.h"
#include "version.h"

namespace pellucid::gui {
namespace {

QString baseName(const Scene& scene) {
    return QFileInfo(QString::fromStdString(scene.volume->title)).completeBaseName();
}

} // namespace

SaveController::SaveController(Services& services, FieldController& fields)
    : m_services(services), m_fields(fields),
      m_images(
          [](const Picture& picture, const JobControl& job) {
              const auto renderer = makeRenderer(EngineChoice::Auto, picture.input.volume);
              Image image = renderer->render(picture.input.camera, picture.input.tf, picture.input.settings, job);
              job.throwIfStopped();
              if (picture.around.show.any()) drawMarks(image, annotationMarks(picture.around));
              writeImage(image, picture.path.toStdString());
              return picture.path;
          },
          [this](const Picture&, const QString& path) {
              Q_EMIT m_services.message(tr("Saved %1").arg(QFileInfo(path).fileName()));
              Q_EMIT imageSaved(path);
          },
          WhenBusy::Queue),
      m_reports(
          [&workspace = services.workspace()](const ReportTask& task, const JobControl& job) {
              ReportRequest request{.run = task.run, .scene = sceneAtStart(task.run, task.now, job)};
              request.session = sessionAtStart(task.run, task.now.session);
              request.command = std::string("pellucid-cli optimize --session ") + kStartFile;
              request.program = std::string("Pellucid ") + kVersion;
              writeReport(makeReport(request, workspace, job), task.folder.toStdString());
              return task.folder;
          },
          [this](const ReportTask&, const QString& folder) {
              Q_EMIT m_services.message(tr("Saved the report in %1").arg(QFileInfo(folder).fileName()));
              Q_EMIT reportSaved(folder);
          },
          WhenBusy::Queue, &services.compute()) {
    for (JobBase* job : std::initializer_list<JobBase*>{&m_images, &m_reports}) {
        connect(job, &JobBase::busyChanged, this, &SaveController::busyChanged);
        connect(job, &JobBase::progress, this, &SaveController::progress);
        connect(job, &JobBase::cancelled, this, &SaveController::cancelled);
    }
    connect(&m_reports, &JobBase::failed, this,
            [this](const Error& error) { m_services.showError(tr("Cannot save the report"), error); });
    connect(&m_images, &JobBase::failed, this,
            [this](const Error& error) { m_services.showError(tr("Cannot save the image"), error); });
}

void SaveController::addActions() {
    const QString menu = tr("&File");
    const auto open = [this] { return m_services.store().hasVolume(); };
    const auto add = [&](const QString& id, const QString& text, const QString& keys, const QString& tip,
                         bool separator, bool toolBar, std::function<void()> trigger) {
        m_services.actions().add(menu, id, text, keys, tip, std::move(trigger), open,
                                 {.separatorBefore = separator, .inToolBar = toolBar});
    };
    add("saveSessionAction", tr("&Save session"), "Ctrl+S",
        tr("Everything that you have set, with the name of the data, to go on from later"), true, false,
        [this] { chooseSession(false); });
    add("saveSessionAsAction", tr("Save session &as…"), "Ctrl+Shift+S", {}, false, false,
        [this] { chooseSession(true); });
    add("saveTfAction", tr("Sa&ve transfer function"), "Ctrl+T", {}, true, false, [this] { chooseTf(false); });
    add("saveTfAsAction", tr("Save transfer f&unction as…"), "Ctrl+Shift+T", {}, false, false,
        [this] { chooseTf(true); });
    add("saveImageAction", tr("Save &image…"), "Ctrl+E", tr("Save the picture"), true, true, [this] { chooseImage(); });
    m_services.actions().add(
        menu, "saveReportAction", tr("Save &report of the last run…"), {},
        tr("One page about the latest optimization: pictures, bars, curves, settings"),
        [this] {
            if (const Run* run = latestRun()) chooseReport(*run);
        },
        [this] { return latestRun() != nullptr && !m_services.isReadOnly(); });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (!before.session.runs.isSame(after.session.runs)) m_services.actions().refresh();
    });
}

void SaveController::setSessionPath(const QString& path) {
    m_sessionPath = path;
    Q_EMIT sessionPathChanged();
}

bool SaveController::saveSession(const QString& path) {
    if (!m_services.store().hasVolume()) return false;
    try {
        writeSession(m_services.store().committed().session, path.toStdString());
        setSessionPath(path);
        m_services.store().setClean();
        Q_EMIT m_services.message(tr("Saved %1").arg(QFileInfo(path).fileName()));
        Q_EMIT sessionSaved();
        return true;
    } catch (const Error& error) {
        m_services.showError(tr("Cannot save the session"), error);
        return false;
    }
}

bool SaveController::saveTf(const QString& path) {
    if (!m_services.store().hasVolume()) return false;
    try {
        writeTf(*m_services.store().committed().session.tf(), path.toStdString());
        setTfPath(path);
        m_services.store().setTfSaved();
        Q_EMIT m_services.message(tr("Saved %1").arg(QFileInfo(path).fileName()));
        return true;
    } catch (const Error& error) {
        m_services.showError(tr("Cannot save the transfer function"), error);
        return false;
    }
}

void SaveController::saveImage(const SaveImageOptions& options) {
    if (!m_services.store().hasVolume()) return;
    Picture picture{
        m_fields.picture(options.size.width(), options.size.height(), options.transparent), {}, options.path};
    if (options.reference)
        picture.around = m_fields.annotation(picture.input, *m_services.scene().session.reference);
    else
        picture.around.show = FrameOfReference::none();
    try {
        picture.input.settings.validate();
        checkImageSuffix(options.path.toStdString());
    } catch (const Error& error) {
        return m_services.showError(tr("Cannot save the image"), error);
    }
    m_busyText = tr("Saving %1…").arg(QFileInfo(options.path).fileName());
    m_images.start(picture, options.path);
    Q_EMIT busyChanged();
}

const Run* SaveController::latestRun() const {
    const std::vector<Run>& runs = *m_services.scene().session.runs;
    const auto latest =
        std::find_if(runs.rbegin(), runs.rend(), [](const Run& run) { return run.hasStart() && !run.history.empty(); });
    return latest == runs.rend() ? nullptr : &*latest;
}

void SaveController::saveReport(const Run& run, const QString& folder) {
    m_busyText = tr("Saving the report…");
    m_reports.start({run, m_services.scene(), folder}, folder);
    Q_EMIT busyChanged();
}

void SaveController::chooseReport(const Run& run) {
    const Run kept = run; // a dialog is open for long
    const QString folder =
        QFileDialog::getExistingDirectory(m_services.window(), tr("Folder for the report"),
                                          QSettings().value("reportFolder", QDir::homePath()).toString());
    if (folder.isEmpty()) return;
    if (QFileInfo::exists(QDir(folder).filePath(kReportFile)) &&
        QMessageBox::question(m_services.window(), tr("Save report"),
                              tr("There is a report in %1. Replace it?").arg(QFileInfo(folder).fileName())) !=
            QMessageBox::Yes)
        return;
    QSettings().setValue("reportFolder", folder);
    saveReport(kept, folder);
}

bool SaveController::chooseSession(bool askForName) {
    if (!m_services.store().hasVolume()) return false;
    QString path = m_sessionPath;
    if (askForName || path.isEmpty()) {
        const QString folder = QSettings().value("sessionFolder").toString();
        const QString offered =
            path.isEmpty() ? QDir(folder).filePath(baseName(m_services.scene()) + ".pellucid.json") : path;
        path = QFileDialog::getSaveFileName(m_services.window(), tr("Save session"), offered,
                                            tr("Sessions (*.pellucid.json)"));
        if (path.isEmpty()) return false;
        if (!path.endsWith(".pellucid.json", Qt::CaseInsensitive)) path += ".pellucid.json";
        QSettings().setValue("sessionFolder", QFileInfo(path).absolutePath());
    }
    return saveSession(path);
}

bool SaveController::chooseTf(bool askForName) {
    if (!m_services.store().hasVolume()) return false;
    QString path = m_tfPath;
    if (askForName || path.isEmpty()) {
        const QString folder = QSettings().value("tfFolder").toString();
        const QString offered =
            path.isEmpty() ? QDir(folder).filePath(baseName(m_services.scene()) + ".tf.json") : path;
        path = QFileDialog::getSaveFileName(m_services.window(), tr("Save transfer function"), offered,
                                            tr("Transfer functions (*.tf.json)"));
        if (path.isEmpty()) return false;
        if (!path.endsWith(".json", Qt::CaseInsensitive)) path += ".tf.json";
        QSettings().setValue("tfFolder", QFileInfo(path).absolutePath());
    }
    return saveTf(path);
}

void SaveController::chooseImage() {
    if (!m_services.store().hasVolume()) return;
    const QString folder = QSettings().value("imageFolder", QDir::homePath()).toString();
    SaveImageDialog dialog(QDir(folder).filePath(baseName(m_services.scene()) + ".png"), m_seen,
                           m_services.scene().session.reference->any() || m_fields.field() != nullptr,
                           m_services.window());
    while (dialog.exec() == QDialog::Accepted) {
        const SaveImageOptions options = dialog.options();
        if (options.path.isEmpty()) continue;
        if (QFileInfo::exists(options.path) &&
            QMessageBox::question(m_services.window(), tr("Save image"),
                                  tr("%1 exists. Replace it?").arg(QFileInfo(options.path).fileName())) !=
                QMessageBox::Yes)
            continue;
        QSettings().setValue("imageFolder", QFileInfo(options.path).absolutePath());
        return saveImage(options);
    }
}

bool SaveController::maybeSave() {
    if (!m_services.store().hasVolume() || m_services.store().isClean()) return true;
    QMessageBox box(QMessageBox::Question, tr("Unsaved changes"), tr("You have unsaved changes."),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, m_services.window());
    box.setObjectName("askSave");
    box.setInformativeText(tr("Do you want to save the session?"));
    box.setDefaultButton(QMessageBox::Save);
    switch (box.exec()) {
    case QMessageBox::Save:
        return chooseSession(false);
    case QMessageBox::Discard:
        return true;
    default:
        return false;
    }
}

} // namespace pellucid::gui
