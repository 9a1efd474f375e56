// Studies from the window: views are collected, prepared, and run.
#include "gui_support.h"

#include <QCheckBox>
#include <QDesktopServices>
#include <QDialogButtonBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QTextBrowser>
#include <QToolButton>

#include "dialogs/study_analyze_dialog.h"
#include "session/session_json.h"
#include "study/simulation.h"
#include "support/study_cases.h"

using namespace pellucid;
using namespace pellucid::gui;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;
using pellucid::test::writePrepared;

TEST_CASE("views of the window become a study, which is prepared and run", "[study]") {
    const TempFolder folder;
    OpenWindow open;
    StudyController& studies = open.controllers().studies;
    const QString file = QString::fromStdString(folder.path("mine.study.json"));
    REQUIRE(studies.addView(file, {"f1", "RED", true}));
    Camera turned = open.document().camera();
    turned.eye = turned.center + Vec3(-(turned.eye - turned.center).y, (turned.eye - turned.center).x, 0.1);
    open.document().setCamera(turned);
    open.settle();
    REQUIRE(studies.addView(file, {"f2", "", false}));
    REQUIRE(studies.addView(file, {"f3", "blue", false}));
    CHECK(studies.study() == file);
    Study study = readStudy(file.toStdString());
    REQUIRE(study.stimuli.size() == 3);
    CHECK(study.stimuli[0].training);
    CHECK(study.stimuli[0].word() == "RED");
    CHECK(study.stimuli[1].word() == "f2");
    CHECK(readSession(study.stimuli[0].session).session.camera != readSession(study.stimuli[1].session).session.camera);
    CHECK(*readSession(study.stimuli[1].session).session.camera == turned);
    study.taskSeconds = study.imageSeconds = 0.1;
    study.width = study.height = 64;
    writeStudy(study, file.toStdString());

    const QString prepared = QString::fromStdString(folder.path("prepared"));
    QSignalSpy done(&studies, &StudyController::prepared);
    studies.prepare(file, prepared);
    CHECK(studies.isBusy());
    REQUIRE(waitFor([&] { return done.count() == 1; }));
    const Study ready = readPreparedStudy(prepared.toStdString());
    open.settle();
    // The same figures as the window's bars, of the same view.
    CHECK(*ready.stimuli[1].vws == Approx(open.document().measures()->features[1].vws).margin(1e-6));
    CHECK(*ready.stimuli[2].visibility == Approx(open.document().measures()->features[2].visibility).margin(1e-6));

    QPointer<StudyWindow> window = studies.run(prepared, "");
    REQUIRE(window);
    REQUIRE(QTest::qWaitForWindowExposed(window, kPatience));
    CHECK(window->isFullScreen());
    CHECK(isStudyId(window->participation().participant().id));
    CHECK(studies.preparedFolder() == prepared);
    QTest::mouseClick(window->findChild<QPushButton*>("consentLeave"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return window.isNull(); }));
}

TEST_CASE("preparing in the window can be cancelled", "[study]") {
    const TempFolder folder;
    OpenWindow open;
    StudyController& studies = open.controllers().studies;
    const QString file = QString::fromStdString(folder.path("mine.study.json"));
    for (int i = 0; i < 3; ++i) REQUIRE(studies.addView(file, {"f1", "", false}));
    QSignalSpy cancelled(&studies, &StudyController::cancelled), done(&studies, &StudyController::prepared);
    studies.prepare(file, QString::fromStdString(folder.path("out")));
    QTest::mouseClick(&open.child<QToolButton>("backgroundCancel"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return cancelled.count() == 1 && !studies.isBusy(); }));
    CHECK(done.count() == 0);
    CHECK_FALSE(std::filesystem::exists(folder.path("out/study.json")));
}

TEST_CASE("a study is analysed in the background, and its page is opened", "[study]") {
    const TempFolder folder;
    const QString prepared = QString::fromStdString(folder.path(""));
    writePrepared(studyOf(0, 5), folder);
    OpenWindow open;
    StudyController& studies = open.controllers().studies;
    QSignalSpy done(&studies, &StudyController::analyzed);
    studies.analyze(prepared); // nobody has taken part
    QDialog* error = nullptr;
    REQUIRE(waitFor([&] { return (error = open.window.findChild<QDialog*>("errorDialog")) != nullptr; }));
    CHECK(error->findChild<QLabel*>("errorWhat")->text().contains("nobody has taken part yet", Qt::CaseInsensitive));
    CHECK_FALSE(QFileInfo::exists(QDir(prepared).filePath("report.html")));
    error->close();

    simulateParticipants(folder.path(""), {.participants = 3});
    QTextBrowser reader; // stands in for the desktop's
    QDesktopServices::setUrlHandler("file", &reader, "setSource");
    studies.analyze(prepared);
    CHECK(studies.isBusy());
    REQUIRE(waitFor([&] { return done.count() == 1; }));
    QDesktopServices::unsetUrlHandler("file");
    const QString page = QDir(prepared).filePath("report.html");
    CHECK(done[0][0].toString() == page);
    CHECK(reader.source() == QUrl::fromLocalFile(page));
    CHECK(reader.toPlainText().contains("3 participants gave 15 scores to 5 pictures."));
    CHECK(studies.preparedFolder() == prepared);
    CHECK_FALSE(studies.isBusy());

    StudyAnalyzeDialog dialog(prepared);
    auto* participants = dialog.findChild<QListWidget*>("studyParticipants");
    REQUIRE(participants->count() == 3);
    CHECK(dialog.findChild<QLabel*>("studyAbout")->text().contains("will be replaced"));
    CHECK((dialog.options().exclude.empty() && !dialog.options().keepAll));
    participants->item(1)->setCheckState(Qt::Unchecked);
    dialog.findChild<QCheckBox*>("studyRules")->setChecked(false);
    CHECK(dialog.options().exclude == std::vector<std::string>{"simulated-002"});
    CHECK(dialog.options().keepAll);
    dialog.findChild<QLineEdit*>("studyFolder")->setText(QString::fromStdString(folder.path("nowhere")));
    CHECK(participants->count() == 0);
    CHECK_FALSE(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok)->isEnabled());
}
