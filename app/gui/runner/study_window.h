// The window that a participant of a study sits in front of (thesis §4.5.2, appendix B).
#pragma once

#include <memory>
#include <optional>

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>

#include "jobs/job.h"
#include "study/participation.h"

class QPushButton;
class QStackedLayout;

namespace pellucid::gui {

class PicturePage;
class QuestionPage;
class TaskPage;
class TextPage;

/// Consent, colour vision, instructions, the trials with their pauses, thanks. All pictures are in memory before the
/// first trial begins. What is shown in a trial, and for how long, a TrialClock says, by a clock that never goes back:
/// a screen counts from when it has been painted. Keys and clicks before the question count for nothing. It closes
/// itself at the end.
class StudyWindow : public QWidget {
    Q_OBJECT
public:
    enum class Page { Consent, Vision, Instructions, Task, Picture, Question, Pause, Thanks, Leave, Trouble };
    Q_ENUM(Page)

    explicit StudyWindow(std::unique_ptr<Participation> participation, QWidget* parent = nullptr);
    ~StudyWindow() override;

    Page page() const { return m_page; }
    const Participation& participation() const { return *m_participation; }
    bool isReady() const { return m_isReady; } ///< all pictures are in memory

Q_SIGNALS:
    void pageChanged();
    void closed();

protected:
    void keyPressEvent(QKeyEvent* event) override;
    void closeEvent(QCloseEvent* event) override;

private:
    using Pictures = std::map<std::size_t, QImage>; ///< by stimulus
    void makePages();
    void makePlainPages();
    void turnTo(Page page);
    void pageSeen(); ///< the present page of a trial has been painted
    void loaded();
    void begin(); ///< goes on with whatever is next
    void beginTrial();
    void followClock();
    void answer(std::optional<int> score);
    void keep();
    void askToLeave();
    void stay();
    void tellTrouble(const QString& title, const Error& error, bool canRetry);
    QString progressText() const;
    double now() const; ///< ms

    std::unique_ptr<Participation> m_participation;
    Pictures m_pictures;
    bool m_isReady = false;
    Page m_page = Page::Consent, m_before = Page::Consent; ///< the latter: where to stay
    double m_leftAt = 0;                                   ///< when it asked whether to leave, ms
    std::optional<std::size_t> m_rested;                   ///< the trial before which the last pause was
    QElapsedTimer m_watch;
    QTimer m_timer;
    std::unique_ptr<TrialClock> m_clock;
    struct Given {
        std::optional<int> score;
        TrialTimes times;
    };
    Given m_given; ///< the answer that is to be kept
    std::map<Page, QWidget*> m_pages;
    QStackedLayout* m_stack = nullptr;
    TextPage *m_instructions = nullptr, *m_pause = nullptr, *m_trouble = nullptr;
    QPushButton *m_start = nullptr, *m_retry = nullptr;
    TaskPage* m_task = nullptr;
    PicturePage* m_picture = nullptr;
    QuestionPage* m_question = nullptr;
    std::unique_ptr<JobBase> m_loading; // last: it ends before the rest goes
};

/// Opens the window over the whole screen; it deletes itself when it is closed. Throws as Participation does.
StudyWindow* openStudy(const std::string& folder, const std::string& participant);

} // namespace pellucid::gui
