#include "runner/study_window.h"

#include <cmath>

#include <QCloseEvent>
#include <QImageReader>
#include <QKeyEvent>
#include <QPushButton>
#include <QScreen>
#include <QStackedLayout>

#include "base/memory.h"
#include "runner/study_pages.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kMsPerSecond = 1000;
constexpr std::uint64_t kBytesPerPixel = 4;

struct VisionAnswer {
    const char *id, *text;
    ColorVision vision;
};
constexpr VisionAnswer kVisions[] = {
    {"visionNormal", QT_TRANSLATE_NOOP("StudyWindow", "I see colours as most people do"), ColorVision::Normal},
    {"visionDeficient", QT_TRANSLATE_NOOP("StudyWindow", "I have a colour vision deficiency"), ColorVision::Deficient},
    {"visionUnsure", QT_TRANSLATE_NOOP("StudyWindow", "I am not sure"), ColorVision::Unsure},
    {"visionNotSaid", QT_TRANSLATE_NOOP("StudyWindow", "I would rather not say"), ColorVision::NotSaid}};

bool isOfTrial(StudyWindow::Page page) {
    using Page = StudyWindow::Page;
    return page == Page::Task || page == Page::Picture || page == Page::Question;
}

QImage readPicture(const std::string& path) {
    QImageReader reader(QString::fromStdString(path));
    const QImage image = reader.read();
    if (image.isNull())
        throw FileError("cannot read the picture (" + reader.errorString().toStdString() + ")", path,
                        "prepare the study again");
    return image.convertToFormat(QImage::Format_RGB32);
}

std::map<std::size_t, QImage> readPictures(const Study& study, const JobControl& job) {
    const std::size_t count = study.stimuli.size();
    requireMemory("showing " + std::to_string(count) + " pictures at once", study.title,
                  kBytesPerPixel * count * static_cast<std::uint64_t>(study.width) *
                      static_cast<std::uint64_t>(study.height));
    std::map<std::size_t, QImage> pictures;
    for (std::size_t i = 0; i < count; ++i) {
        job.throwIfStopped();
        pictures[i] = readPicture(study.stimuli[i].picture);
        job.report(static_cast<double>(i + 1) / static_cast<double>(count));
    }
    return pictures;
}

} // namespace

StudyWindow::StudyWindow(std::unique_ptr<Participation> participation, QWidget* parent)
    : QWidget(parent, Qt::Window), m_participation(std::move(participation)) {
    const Study& study = m_participation->study();
    setObjectName("studyWindow");
    setWindowTitle(QString::fromStdString(study.title));
    setAutoFillBackground(true);
    setFocusPolicy(Qt::StrongFocus);
    m_watch.start();
    m_timer.setSingleShot(true);
    m_timer.setTimerType(Qt::PreciseTimer);
    connect(&m_timer, &QTimer::timeout, this, &StudyWindow::followClock);
    makePages();
    // Each by itself: under a style sheet, the window's own, children do not inherit a palette.
    const QPalette colors = studyPalette(colorFromRgb(study.background));
    setPalette(colors);
    for (QWidget* child : findChildren<QWidget*>()) child->setPalette(colors);

    auto loading = std::make_unique<Job<Study, Pictures>>(readPictures, [this](const Study&, Pictures& pictures) {
        m_pictures = std::move(pictures);
        loaded();
    });
    connect(loading.get(), &JobBase::progress, this, [this](double done) {
        if (!m_isReady) m_start->setText(tr("Loading pictures, %1 %").arg(static_cast<int>(100 * done)));
    });
    connect(loading.get(), &JobBase::failed, this,
            [this](const Error& error) { tellTrouble(tr("The pictures cannot be shown"), error, false); });
    loading->start(study, QString::fromStdString(m_participation->folder()));
    m_loading = std::move(loading);
    turnTo(m_participation->isDone() ? Page::Thanks : m_participation->hasBegun() ? Page::Instructions : Page::Consent);
}

StudyWindow::~StudyWindow() = default;

void StudyWindow::makePages() {
    makePlainPages();
    m_pages[Page::Task] = m_task = new TaskPage(this);
    m_pages[Page::Picture] = m_picture = new PicturePage(this);
    m_pages[Page::Question] = m_question = new QuestionPage(m_participation->study().labels, this);
    for (SeenPage* page : std::initializer_list<SeenPage*>{m_task, m_picture, m_question})
        connect(page, &SeenPage::painted, this, &StudyWindow::pageSeen);
    for (SeenPage* page : std::initializer_list<SeenPage*>{m_task, m_picture}) page->setCursor(Qt::BlankCursor);
    connect(m_question, &QuestionPage::scored, this, [this](int score) { answer(score); });
    connect(m_question, &QuestionPage::skipped, this, [this] { answer({}); });
    m_stack = new QStackedLayout(this);
    for (const auto& [which, page] : m_pages) m_stack->addWidget(page);
}

void StudyWindow::makePlainPages() {
    const Study& study = m_participation->study();
    const auto page = [this](Page which, const char* id, const QString& title) {
        auto* made = new TextPage(id, title, this);
        m_pages[which] = made;
        return made;
    };
    auto* consent = page(Page::Consent, "studyConsent", QString::fromStdString(study.title));
    consent->setText(QString::fromStdString(study.consent));
    consent->addButton("consentAgree", tr("I agree"), [this] { turnTo(Page::Vision); });
    consent->addButton("consentLeave", tr("I do not wish to take part"), [this] { close(); });

    auto* vision = page(Page::Vision, "studyVision", tr("How do you see colours?"));
    vision->setText(tr("Your answer helps us to interpret the others."));
    for (const VisionAnswer& a : kVisions)
        vision->addButton(a.id, tr(a.text), [this, a] {
            m_participation->setColorVision(a.vision);
            turnTo(Page::Instructions);
        });
    vision->stackButtons();

    const bool goesOn = m_participation->hasBegun();
    m_instructions = page(Page::Instructions, "studyInstructions", goesOn ? tr("Welcome back") : tr("What to do"));
    m_instructions->setText(
        (goesOn ? progressText() + "\n\n" : QString()) + QString::fromStdString(study.instructions) + "\n\n" +
        tr("Score with the keys 1 to 5 or the mouse, when the picture has gone. Each question is optional: 0 leaves it "
           "out. Esc interrupts."));
    m_start = m_instructions->addButton("studyStart", tr("Loading pictures…"), [this] { begin(); });
    m_start->setEnabled(false);

    m_pause = page(Page::Pause, "studyPause", tr("A short rest"));
    m_pause->addButton("studyGoOn", tr("Go on"), [this] { begin(); });

    auto* thanks = page(Page::Thanks, "studyThanks", tr("Thank you"));
    thanks->setText(tr("That was all. Your answers are kept under %1.")
                        .arg(QString::fromStdString(m_participation->participant().id)));
    thanks->addButton("studyClose", tr("Close"), [this] { close(); });

    auto* leave = page(Page::Leave, "studyLeave", tr("Leave the study?"));
    leave->setText(tr("Your answers so far are kept. You can go on later as participant %1.")
                       .arg(QString::fromStdString(m_participation->participant().id)));
    leave->addButton("leaveStay", tr("Stay"), [this] { stay(); });
    leave->addButton("leaveLeave", tr("Leave"), [this] { close(); });

    m_trouble = page(Page::Trouble, "studyTrouble", {});
    m_retry = m_trouble->addButton("troubleRetry", tr("Try again"), [this] { keep(); });
    m_trouble->addButton("troubleLeave", tr("Leave"), [this] { close(); });
}

QString StudyWindow::progressText() const {
    return tr("%1 of %2 pictures are done.").arg(m_participation->next()).arg(m_participation->plan().size());
}

double StudyWindow::now() const { return static_cast<double>(m_watch.nsecsElapsed()) / 1e6; }

void StudyWindow::turnTo(Page which) {
    m_page = which;
    QWidget* page = m_pages.at(which);
    m_stack->setCurrentWidget(page);
    if (isOfTrial(which)) {
        setFocus(); // keys are scores
        page->repaint();
    }
    Q_EMIT pageChanged();
}

void StudyWindow::loaded() {
    m_isReady = true;
    // What is drawn for the first time takes longer, by letters and styles that are made then: not in the first trial.
    m_picture->setImage(m_pictures.begin()->second);
    for (const Page page : {Page::Task, Page::Picture, Page::Question}) {
        m_pages.at(page)->resize(size());
        m_pages.at(page)->grab();
    }
    m_start->setText(tr("Start"));
    m_start->setEnabled(true);
    m_start->setFocus();
    Q_EMIT pageChanged();
}

void StudyWindow::begin() {
    const std::size_t next = m_participation->next();
    if (m_participation->isDone()) return turnTo(Page::Thanks);
    const bool justCame = m_page == Page::Instructions;
    if (!justCame && m_rested != next && isPauseBefore(m_participation->study(), m_participation->plan(), next)) {
        m_rested = next;
        const bool afterTraining = m_participation->plan()[next - 1].training;
        m_pause->setTitle(afterTraining ? tr("That was the practice") : tr("A short rest"));
        m_pause->setText(afterTraining ? tr("From now on your answers count. Go on when you are ready.")
                                       : progressText() + "\n\n" + tr("Go on when you are ready."));
        return turnTo(Page::Pause);
    }
    beginTrial();
}

void StudyWindow::beginTrial() {
    const Study& study = m_participation->study();
    const std::size_t trial = m_participation->next();
    const QString question = QString::fromStdString(study.questionOf(m_participation->stimulusOf(trial)));
    m_task->setText(question);
    m_picture->setImage(m_pictures.at(m_participation->plan()[trial].stimulus));
    m_question->setText(question);
    m_clock = std::make_unique<TrialClock>(study.taskSeconds * kMsPerSecond, study.imageSeconds * kMsPerSecond);
    turnTo(m_clock->screen() == TrialClock::Screen::Task ? Page::Task : Page::Picture);
}

void StudyWindow::pageSeen() {
    if (!isOfTrial(m_page) || m_clock == nullptr || m_clock->isSeen() || sender() != m_pages.at(m_page)) return;
    m_clock->seen(now());
    if (const auto left = m_clock->remaining(now())) m_timer.start(static_cast<int>(std::ceil(*left)));
}

void StudyWindow::followClock() {
    if (m_page != Page::Task && m_page != Page::Picture) return; // somebody wants to leave
    if (!m_clock->advance(now())) {
        m_timer.start(static_cast<int>(std::ceil(m_clock->remaining(now()).value_or(0))));
        return;
    }
    turnTo(m_clock->screen() == TrialClock::Screen::Picture ? Page::Picture : Page::Question);
}

void StudyWindow::answer(std::optional<int> score) {
    if (m_page != Page::Question || !m_clock->isSeen()) return;
    m_given = {score, m_clock->answered(now())};
    keep();
}

void StudyWindow::keep() {
    try {
        m_participation->answer(m_given.score, m_given.times);
        begin();
    } catch (const Error& error) {
        tellTrouble(tr("Your answer could not be saved"), error, true);
    }
}

void StudyWindow::askToLeave() {
    if (m_page == Page::Leave) return;
    m_timer.stop();
    m_before = m_page;
    m_leftAt = now();
    turnTo(Page::Leave);
}

void StudyWindow::stay() {
    // A picture that was covered has been seen for another time than it should: its trial begins again.
    if (m_before == Page::Task || m_before == Page::Picture) return beginTrial();
    if (m_before == Page::Question) m_clock->leaveOut(now() - m_leftAt);
    turnTo(m_before);
}

void StudyWindow::tellTrouble(const QString& title, const Error& error, bool canRetry) {
    m_timer.stop();
    m_trouble->setTitle(title);
    m_trouble->setText(QString::fromStdString(error.what()));
    m_retry->setVisible(canRetry);
    turnTo(Page::Trouble);
}

void StudyWindow::keyPressEvent(QKeyEvent* event) {
    if (event->isAutoRepeat()) return;
    if (event->key() == Qt::Key_Escape) {
        if (m_page == Page::Leave)
            stay();
        else
            close();
        return;
    }
    const int score = event->key() - Qt::Key_0;
    if (m_page == Page::Question && score >= kLowestScore && score <= kHighestScore) return answer(score);
    if (m_page == Page::Question && score == 0) return answer({});
    QWidget::keyPressEvent(event);
}

void StudyWindow::closeEvent(QCloseEvent* event) {
    const bool atOnce =
        m_page == Page::Consent || m_page == Page::Thanks || m_page == Page::Leave || m_page == Page::Trouble;
    if (!atOnce) {
        event->ignore();
        return askToLeave();
    }
    QWidget::closeEvent(event);
    Q_EMIT closed();
}

StudyWindow* openStudy(const std::string& folder, const std::string& participant) {
    auto* window = new StudyWindow(std::make_unique<Participation>(folder, participant));
    window->setAttribute(Qt::WA_DeleteOnClose);
    window->setGeometry(window->screen()->geometry()); // where no window manager does
    window->showFullScreen();
    window->raise();
    window->activateWindow();
    return window;
}

} // namespace pellucid::gui
