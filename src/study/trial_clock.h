// What is on the screen during a trial, and for how long.
#pragma once

#include <optional>

namespace pellucid {

/// How long things took, ms.
struct TrialTimes {
    double taskMs = 0, imageMs = 0; ///< on the screen
    double responseMs = 0;          ///< from the question's coming to the answer
};

/// Task, picture, question: who shows them tells when each could be seen, by a clock that never goes back, and asks
/// when the next is due. Each is due so long after the one before could be seen, so that no delay adds to another.
class TrialClock {
public:
    enum class Screen { Task, Picture, Question };
    /// A task of 0 ms is left out.
    TrialClock(double taskMs, double imageMs);

    Screen screen() const { return m_screen; }
    /// The present screen can be seen since now; further calls count for nothing.
    void seen(double nowMs);
    bool isSeen() const { return m_seen.has_value(); }
    /// Time until the next screen is due, 0 where it is overdue. Empty: the present one has not been seen, or is the
    /// question, which waits.
    std::optional<double> remaining(double nowMs) const;
    /// Goes on to the next screen where it is due, and says whether it did.
    bool advance(double nowMs);
    /// So long of the time since the present screen could be seen does not count: something else covered it.
    void leaveOut(double ms);
    /// Of the trial, answered now: the question has been seen.
    TrialTimes answered(double nowMs) const;

private:
    double duration() const { return m_screen == Screen::Task ? m_taskMs : m_imageMs; }

    double m_taskMs, m_imageMs;
    Screen m_screen;
    std::optional<double> m_seen, m_before; ///< since when the present screen is seen, and the one before was
    TrialTimes m_times;
};

} // namespace pellucid
