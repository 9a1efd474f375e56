#include "controllers/study_controller.h"

#include <QDesktopServices>
#include <QMessageBox>
#include <QUrl>

#include "base/atomic_file.h"
#include "dialogs/ask_file.h"
#include "dialogs/study_analyze_dialog.h"
#include "dialogs/study_dialog.h"
#include "dialogs/study_files.h"
#include "dialogs/study_run_dialog.h"
#include "dialogs/study_view_dialog.h"
#include "report/study_report.h"
#include "services/services.h"
#include "version.h"

namespace pellucid::gui {
namespace {

// Kept from one start of the program to the next.
constexpr const char *kStudyKey = "studyFile", *kFolderKey = "studyFolder", *kPreparedKey = "studyPrepared";

/// To be typed in the study's folder. Names of participants need no quotes.
std::string commandOf(const StudyAnalysisOptions& options) {
    std::string command = std::string("pellucid-cli study analyze . --out ") + kReportFile;
    for (const std::string& id : options.exclude) command += " --exclude " + id;
    return command + (options.keepAll ? " --keep-all" : "");
}

} // namespace

StudyController::StudyController(Services& services)
    : m_services(services),
      m_preparing(
          [](const Preparation& task, const JobControl& job) {
              return prepareStudy(readStudy(task.study), task.folder, {}, job);
          },
          [this](const Preparation& task, const PreparedStudy& made) {
              const QString folder = QString::fromStdString(task.folder);
              keepPreparedFolder(folder);
              for (const std::string& notice : made.notices) m_services.notices().add({QString::fromStdString(notice)});
              Q_EMIT m_services.message(
                  tr("Prepared %1 pictures in %2").arg(made.study.stimuli.size()).arg(QFileInfo(folder).fileName()));
              Q_EMIT prepared(folder);
          }),
      m_analyzing(
          [](const Analysis& task, const JobControl& job) {
              StudyReport report = makeStudyReport(task.folder.toStdString(), task.options, job);
              report.command = commandOf(task.options);
              report.liesWithStudy = true;
              report.program = std::string("Pellucid ") + kVersion;
              const QString file = QDir(task.folder).filePath(kReportFile);
              writeTextAtomically(file.toStdString(), htmlOf(report));
              return file;
          },
          [this](const Analysis&, const QString& file) {
              m_services.saySaved(file);
              if (!QDesktopServices::openUrl(QUrl::fromLocalFile(file)))
                  m_services.notices().add({tr("The report is in %1. No program was found to show it").arg(file)});
              Q_EMIT analyzed(file);
          }) {
    for (JobBase* job : std::initializer_list<JobBase*>{&m_preparing, &m_analyzing}) follow(*job);
    services.showFailuresOf(m_analyzing, tr("Cannot analyze the study"));
    services.showFailuresOf(m_preparing, tr("Cannot prepare the study"));
}

void StudyController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&File/Stud&y"));
    menu.add("studyAddAction", tr("&Add this view to the study…"), {},
             tr("Adds this picture to a study, for people to judge"), [this] { chooseView(); },
             {.enabled = [this] { return m_services.store().hasVolume(); }});
    menu.add("studyEditAction", tr("&Edit study…"), {}, tr("Texts, times, repeats, and the list of stimuli"),
             [this] { edit(); });
    menu.separate();
    menu.add("studyPrepareAction", tr("&Prepare study…"), {},
             tr("Draws all pictures beforehand, and measures what people will be asked about (VWS, visibility, 2DFS)"),
             [this] { choosePrepared(); }, {.enabled = [this] { return !isBusy(); }});
    menu.add("studyRunAction", tr("&Run study…"), {},
             tr("Shows a prepared study to a participant, over the whole screen"), [this] { chooseRun(); },
             {.enabled = [this] { return m_window.isNull(); }});
    menu.add("studyAnalyzeAction", tr("Analy&ze study…"), {},
             tr("One page about what participants answered, and which measure predicts it"),
             [this] { chooseAnalysis(); }, {.enabled = [this] { return !isBusy(); }});
}

QString StudyController::study() const { return QSettings().value(kStudyKey).toString(); }
void StudyController::setStudy(const QString& path) { QSettings().setValue(kStudyKey, path); }
QString StudyController::preparedFolder() const { return QSettings().value(kPreparedKey).toString(); }
void StudyController::keepPreparedFolder(const QString& folder) { QSettings().setValue(kPreparedKey, folder); }

bool StudyController::addView(const QString& study, const AskedFeature& asked) {
    return m_services.attempt(tr("Cannot add the view to the study"), [&] {
        const Study added = addViewToStudy(study.toStdString(), m_services.store().committed().session, asked);
        setStudy(study);
        Q_EMIT m_services.message(
            tr("%1 has %2 stimuli now").arg(QFileInfo(study).fileName()).arg(added.stimuli.size()));
    });
}

void StudyController::prepare(const QString& study, const QString& folder) {
    m_preparing.start({study.toStdString(), folder.toStdString()}, study);
    Q_EMIT busyChanged();
}

void StudyController::analyze(const QString& folder, const StudyAnalysisOptions& options) {
    keepPreparedFolder(folder);
    m_analyzing.start({folder, options}, folder);
    Q_EMIT busyChanged();
}

StudyWindow* StudyController::run(const QString& folder, const QString& participant) {
    const bool opened = m_services.attempt(tr("Cannot run the study"), [&] {
        const std::string id =
            participant.isEmpty() ? newParticipantId(folder.toStdString()) : participant.toStdString();
        m_window = openStudy(folder.toStdString(), id);
        keepPreparedFolder(folder);
        connect(m_window, &QObject::destroyed, &m_services.actions(), &Actions::refresh, Qt::QueuedConnection);
        m_services.actions().refresh();
    });
    return opened ? m_window.data() : nullptr;
}

void StudyController::chooseView() {
    QStringList features;
    for (const Feature& feature : m_services.scene().tf.features) features << QString::fromStdString(feature.name);
    if (features.isEmpty())
        return m_services.showError(tr("Cannot add the view to the study"),
                                    {"the transfer function has no features", "", "add one to ask about"});
    const QString offered =
        study().isEmpty() ? QDir(keptFolder(kFolderKey, QDir::homePath())).filePath("experiment.study.json") : study();
    StudyViewDialog dialog(offered, features, std::max(0, m_services.selectedFeature()), m_services.window());
    while (dialog.exec() == QDialog::Accepted) {
        if (dialog.study().isEmpty()) continue;
        keepFolderOf(kFolderKey, dialog.study());
        if (addView(dialog.study(), dialog.asked())) return;
    }
}

QString StudyController::chooseStudy(const QString& title) {
    const QString offered = QFileInfo::exists(study()) ? study() : keptFolder(kFolderKey, QDir::homePath());
    const QString path = QFileDialog::getOpenFileName(m_services.window(), title, offered, studyFilter());
    if (path.isEmpty()) return path;
    keepFolderOf(kFolderKey, path);
    setStudy(path);
    return path;
}

void StudyController::edit() {
    const QString path = chooseStudy(tr("Edit study"));
    if (path.isEmpty()) return;
    m_services.attempt(tr("Cannot edit the study"), [&] {
        StudyDialog dialog(readStudy(path.toStdString()), m_services.window());
        while (dialog.exec() == QDialog::Accepted)
            if (m_services.attempt(tr("Cannot save the study"), [&] {
                    writeStudy(checked(dialog.study(), path.toStdString()), path.toStdString());
                }))
                return;
    });
}

void StudyController::choosePrepared() {
    const QString path = chooseStudy(tr("Prepare study"));
    if (path.isEmpty()) return;
    const QString folder = QFileDialog::getExistingDirectory(m_services.window(), tr("Folder for the prepared study"),
                                                             QFileInfo(path).absolutePath());
    if (folder.isEmpty()) return;
    const QString file = QString::fromStdString(preparedStudyFile(folder.toStdString()));
    const QString question = tr("There is a prepared study in %1. Replace it?").arg(QFileInfo(folder).fileName());
    if (QFileInfo::exists(file) &&
        QMessageBox::question(m_services.window(), tr("Prepare study"), question) != QMessageBox::Yes)
        return;
    prepare(path, folder);
}

void StudyController::chooseRun() {
    StudyRunDialog dialog(preparedFolder(), m_services.window());
    while (dialog.exec() == QDialog::Accepted)
        if (run(dialog.folder(), dialog.participant()) != nullptr) return;
}

void StudyController::chooseAnalysis() {
    StudyAnalyzeDialog dialog(preparedFolder(), m_services.window());
    if (dialog.exec() == QDialog::Accepted) analyze(dialog.folder(), dialog.options());
}

} // namespace pellucid::gui
