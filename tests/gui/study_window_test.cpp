// A study in front of a participant: driven by keys and clicks, interrupted, killed.
#include <csignal>
#include <filesystem>

#include <catch2/catch.hpp>

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QProcess>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTest>

#include "dialogs/study_dialog.h"
#include "dialogs/study_run_dialog.h"
#include "dialogs/study_view_dialog.h"
#include "gui_support.h"
#include "play_study.h"
#include "runner/study_window.h"
#include "study/participation.h"
#include "support/study_cases.h"

using namespace pellucid;
using namespace pellucid::gui;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;
using pellucid::test::writePrepared;
using Page = StudyWindow::Page;

namespace {

constexpr double kTaskSeconds = 0.06, kImageSeconds = 0.12;

Study quickStudy(int training, int count, int repeats = 0) {
    Study study = studyOf(training, count, repeats);
    study.taskSeconds = kTaskSeconds;
    study.imageSeconds = kImageSeconds;
    return study;
}

/// A window in front of a participant, as large as a test needs.
struct Seat {
    explicit Seat(const TempFolder& folder, const std::string& id = "p1")
        : window(std::make_unique<StudyWindow>(std::make_unique<Participation>(folder.path(""), id))) {
        window->resize(800, 600);
        window->show();
        REQUIRE(QTest::qWaitForWindowExposed(window.get(), kPatience));
        REQUIRE(waitFor([&] { return window->isReady(); }));
    }
    void waitForPage(Page page) {
        INFO("page " << static_cast<int>(window->page()));
        REQUIRE(waitFor([&] { return window->page() == page; }));
    }
    void click(const char* id) {
        auto* button = window->findChild<QPushButton*>(id);
        REQUIRE(button != nullptr);
        REQUIRE(waitFor([&] { return button->isVisible() && button->isEnabled(); }));
        QTest::mouseClick(button, Qt::LeftButton);
    }
    void press(Qt::Key key) { QTest::keyClick(window.get(), key); }
    /// From the first page into the first trial.
    void start() {
        click("consentAgree");
        click("visionUnsure");
        click("studyStart");
    }
    std::size_t answered() const { return window->participation().participant().answers.size(); }
    std::unique_ptr<StudyWindow> window;
};

} // namespace

TEST_CASE("a participant is led from consent to thanks", "[study]") {
    const TempFolder folder;
    Study study = quickStudy(1, 3, 1);
    study.pauseEvery = 2;
    writePrepared(study, folder);
    Seat seat(folder);
    CHECK(seat.window->page() == Page::Consent);
    std::vector<Page> pages;
    QObject::connect(seat.window.get(), &StudyWindow::pageChanged, [&] { pages.push_back(seat.window->page()); });
    seat.start();
    for (int trial = 1; trial <= 5; ++trial) {
        seat.waitForPage(Page::Question);
        if (trial == 2)
            seat.click("score5");
        else if (trial == 3)
            seat.press(Qt::Key_0);
        else
            seat.press(static_cast<Qt::Key>(Qt::Key_0 + trial));
        if (trial == 1 || trial == 3) { // after the training, and after two trials
            seat.waitForPage(Page::Pause);
            seat.click("studyGoOn");
        }
    }
    seat.waitForPage(Page::Thanks);
    const std::vector<Page> trial{Page::Task, Page::Picture, Page::Question};
    std::vector<Page> expected{Page::Vision, Page::Instructions};
    for (int i = 1; i <= 5; ++i) {
        expected.insert(expected.end(), trial.begin(), trial.end());
        if (i == 1 || i == 3) expected.push_back(Page::Pause);
    }
    expected.push_back(Page::Thanks);
    CHECK(pages == expected);

    const Participant person = readParticipant(participantFile(folder.path(""), "p1"));
    CHECK(person.colorVision == ColorVision::Unsure);
    REQUIRE(person.answers.size() == 5);
    const std::vector<std::optional<int>> scores{1, 5, std::nullopt, 4, 5};
    for (std::size_t i = 0; i < 5; ++i) {
        const Answer& a = person.answers[i];
        CHECK(a.score == scores[i]);
        // Never shorter than it should be; how much longer, the schedule's own test says with a clock of its own.
        CHECK(a.taskMs >= 1000 * kTaskSeconds);
        CHECK(a.imageMs >= 1000 * kImageSeconds);
        CHECK(a.responseMs >= 0);
    }
    QSignalSpy closed(seat.window.get(), &StudyWindow::closed);
    seat.click("studyClose");
    CHECK(closed.count() == 1);
}

TEST_CASE("keys and clicks count when the question is there, and not before", "[study]") {
    const TempFolder folder;
    writePrepared(quickStudy(0, 2), folder);
    Seat seat(folder);
    for (const Page page : {Page::Consent, Page::Vision, Page::Instructions}) {
        seat.waitForPage(page);
        seat.press(Qt::Key_3);
        seat.click(page == Page::Consent ? "consentAgree" : page == Page::Vision ? "visionNormal" : "studyStart");
    }
    for (const Page page : {Page::Task, Page::Picture}) {
        seat.waitForPage(page);
        seat.press(Qt::Key_3);
        QTest::mouseClick(seat.window.get(), Qt::LeftButton, {}, {400, 300});
        CHECK(seat.answered() == 0);
    }
    seat.waitForPage(Page::Question);
    for (const Qt::Key key : {Qt::Key_6, Qt::Key_9, Qt::Key_A, Qt::Key_Return, Qt::Key_Space}) seat.press(key);
    CHECK(seat.answered() == 0);
    seat.press(Qt::Key_2);
    REQUIRE(seat.answered() == 1);
    CHECK(seat.window->participation().participant().answers[0].score == 2);
}

TEST_CASE("Esc asks first, and a trial that was interrupted begins again", "[study]") {
    const TempFolder folder;
    Study study = quickStudy(0, 3);
    study.imageSeconds = 0.3;
    writePrepared(study, folder);
    {
        Seat seat(folder);
        seat.start();
        seat.waitForPage(Page::Question);
        seat.press(Qt::Key_4);
        seat.waitForPage(Page::Picture);
        seat.press(Qt::Key_Escape);
        CHECK(seat.window->page() == Page::Leave);
        QTest::qWait(400); // longer than the picture: nothing goes on behind the question
        CHECK(seat.window->page() == Page::Leave);
        seat.click("leaveStay");
        CHECK(seat.window->page() == Page::Task);
        seat.waitForPage(Page::Question);
        seat.press(Qt::Key_Escape);
        seat.press(Qt::Key_Escape); // stays
        CHECK(seat.window->page() == Page::Question);
        seat.press(Qt::Key_1);
        CHECK(seat.answered() == 2);
        seat.waitForPage(Page::Task);
        CHECK_FALSE(seat.window->close()); // the window's own cross asks, too
        CHECK(seat.window->page() == Page::Leave);
        seat.click("leaveLeave");
        CHECK_FALSE(seat.window->isVisible());
    }
    Seat seat(folder);
    CHECK(seat.window->page() == Page::Instructions); // consent was given
    seat.click("studyStart");
    seat.waitForPage(Page::Question);
    seat.press(Qt::Key_5);
    seat.waitForPage(Page::Thanks);
    const Participant person = readParticipant(participantFile(folder.path(""), "p1"));
    REQUIRE(person.answers.size() == 3);
    CHECK(person.answers[0].score == 4);
    CHECK(person.answers[1].score == 1);
    CHECK(person.answers[2].score == 5);
    CHECK(person.colorVision == ColorVision::Unsure);
}

TEST_CASE("who does not agree leaves nothing behind", "[study]") {
    const TempFolder folder;
    writePrepared(quickStudy(0, 2), folder);
    Seat seat(folder);
    seat.click("consentLeave");
    CHECK_FALSE(seat.window->isVisible());
    CHECK_FALSE(std::filesystem::exists(participantsFolder(folder.path(""))));
}

TEST_CASE("a program that is killed loses no answer, and goes on where it was", "[study]") {
    const TempFolder folder;
    const Study study = writePrepared(quickStudy(1, 12, 3), folder);
    const std::string file = participantFile(folder.path(""), "p1");
    const auto answers = [&]() -> std::vector<Answer> {
        std::error_code ec;
        return std::filesystem::exists(file, ec) ? readParticipant(file).answers : std::vector<Answer>{};
    };
    std::vector<Answer> kept;
    for (int round = 1; round <= 2; ++round) {
        QProcess process;
        process.start(QCoreApplication::applicationFilePath(),
                      {kPlayStudy, QString::fromStdString(folder.path("")), "p1"});
        REQUIRE(process.waitForStarted(kPatience));
        REQUIRE(waitFor([&] { return answers().size() >= static_cast<std::size_t>(4 * round); }));
        ::kill(static_cast<pid_t>(process.processId()), SIGKILL);
        REQUIRE(process.waitForFinished(kPatience));
        CHECK(process.exitStatus() == QProcess::CrashExit);
        const std::vector<Answer> now = answers();
        REQUIRE(now.size() >= kept.size());
        CHECK(std::equal(kept.begin(), kept.end(), now.begin())); // what was there is there
        kept = now;
    }
    QProcess process;
    process.start(QCoreApplication::applicationFilePath(), {kPlayStudy, QString::fromStdString(folder.path("")), "p1"});
    REQUIRE(process.waitForFinished(kPatience));
    CHECK(process.exitCode() == 0);
    const std::vector<Answer> all = answers();
    const auto plan = planOf(study, "p1");
    REQUIRE(all.size() == plan.size());
    CHECK(std::equal(kept.begin(), kept.end(), all.begin()));
    for (std::size_t i = 0; i < plan.size(); ++i) {
        CHECK(all[i].trial == plan[i].trial);
        CHECK(all[i].stimulus == study.stimuli[plan[i].stimulus].id);
        CHECK(all[i].score == scoreOf(study.stimuli[plan[i].stimulus]));
    }
}

TEST_CASE("an answer that cannot be kept is told, and can be tried again", "[study]") {
    const TempFolder folder;
    writePrepared(quickStudy(0, 2), folder);
    Seat seat(folder);
    seat.start();
    seat.waitForPage(Page::Question);
    folder.write("participants", "a file in the place of the folder");
    seat.press(Qt::Key_3);
    CHECK(seat.window->page() == Page::Trouble);
    CHECK(seat.answered() == 0);
    std::filesystem::remove(folder.path("participants"));
    seat.click("troubleRetry");
    CHECK(seat.answered() == 1);
    CHECK(readParticipant(participantFile(folder.path(""), "p1")).answers[0].score == 3);
    seat.waitForPage(Page::Question);
}

TEST_CASE("a study whose pictures are gone says so", "[study]") {
    const TempFolder folder;
    const Study study = writePrepared(quickStudy(0, 2), folder);
    std::filesystem::remove(study.stimuli[1].picture);
    StudyWindow window(std::make_unique<Participation>(folder.path(""), "p1"));
    window.show();
    REQUIRE(waitFor([&] { return window.page() == Page::Trouble; }));
    bool isNamed = false;
    for (const QLabel* label : window.findChildren<QLabel*>())
        isNamed = isNamed || label->text().contains(QString::fromStdString(study.stimuli[1].picture));
    CHECK(isNamed);
}

TEST_CASE("dialogs of studies give back what was entered", "[study]") {
    const TempFolder folder;
    StudyViewDialog view(QString::fromStdString(folder.path("a")), {"bone", "skin"}, 1);
    CHECK(view.asked().feature == "skin");
    view.findChild<QComboBox*>("studyFeature")->setCurrentIndex(0);
    view.findChild<QLineEdit*>("studyLabel")->setText(" WHITE ");
    view.findChild<QCheckBox*>("studyTraining")->setChecked(true);
    CHECK(view.study().toStdString() == folder.path("a.study.json"));
    CHECK(view.asked().feature == "bone");
    CHECK(view.asked().label == "WHITE");
    CHECK(view.asked().training);

    const Study study = studyOf(1, 3);
    StudyDialog dialog(study);
    CHECK(dialog.study() == study); // looking changes nothing
    dialog.findChild<QDoubleSpinBox*>("study_task_seconds")->setValue(1.5);
    dialog.findChild<QLineEdit*>("study_question")->setText("Where is {feature}?");
    dialog.findChild<QLineEdit*>("studyScore2")->setText("hardly");
    auto* table = dialog.findChild<QTableWidget*>("studyStimuli");
    table->item(1, 2)->setText("BLUE");
    table->selectRow(1);
    dialog.findChild<QPushButton*>("stimulusDown")->click();
    table->selectRow(3);
    dialog.findChild<QPushButton*>("stimulusRemove")->click();
    const Study edited = dialog.study();
    CHECK(edited.taskSeconds == 1.5);
    CHECK(edited.question == "Where is {feature}?");
    CHECK(edited.labels.at(2) == "hardly");
    REQUIRE(edited.stimuli.size() == 3);
    CHECK(edited.stimuli[1].id == "a2");
    CHECK(edited.stimuli[2].id == "a1");
    CHECK(edited.stimuli[2].label == "BLUE");
    dialog.findChild<QLineEdit*>("study_background")->setText("grey");
    CHECK_THROWS_AS(dialog.study(), UsageError);

    StudyRunDialog run(QString::fromStdString(folder.path("")));
    auto* start = run.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
    CHECK_FALSE(start->isEnabled());
    writePrepared(study, folder);
    Participation(folder.path(""), "anna").answer(3, {});
    run.findChild<QLineEdit*>("studyFolder")->setText(QString::fromStdString(folder.path("x")));
    run.findChild<QLineEdit*>("studyFolder")->setText(QString::fromStdString(folder.path("")));
    CHECK(start->isEnabled());
    CHECK(run.participant().isEmpty());
    run.findChild<QComboBox*>("studyParticipant")->setCurrentText("anna");
    CHECK(run.participant() == "anna");
}
