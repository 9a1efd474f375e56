#include "study/trial_clock.h"

#include <algorithm>

#include "base/check.h"

namespace pellucid {

TrialClock::TrialClock(double taskMs, double imageMs)
    : m_taskMs(taskMs), m_imageMs(imageMs), m_screen(taskMs > 0 ? Screen::Task : Screen::Picture) {}

void TrialClock::seen(double nowMs) {
    if (m_seen) return;
    m_seen = nowMs;
    if (!m_before) return;
    if (m_screen == Screen::Picture) m_times.taskMs = nowMs - *m_before;
    if (m_screen == Screen::Question) m_times.imageMs = nowMs - *m_before;
}

std::optional<double> TrialClock::remaining(double nowMs) const {
    if (!m_seen || m_screen == Screen::Question) return {};
    return std::max(0.0, *m_seen + duration() - nowMs);
}

bool TrialClock::advance(double nowMs) {
    if (const std::optional<double> left = remaining(nowMs); !left || *left > 0) return false;
    m_screen = m_screen == Screen::Task ? Screen::Picture : Screen::Question;
    m_before = m_seen;
    m_seen.reset();
    return true;
}

void TrialClock::leaveOut(double ms) {
    if (m_seen) *m_seen += ms;
}

TrialTimes TrialClock::answered(double nowMs) const {
    PELLUCID_CHECK(m_screen == Screen::Question && m_seen);
    TrialTimes times = m_times;
    times.responseMs = nowMs - *m_seen;
    return times;
}

} // namespace pellucid
