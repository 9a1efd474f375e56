#include "progress.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <unistd.h>

#include "interrupt.h"

namespace pellucid::cli {

namespace {

std::atomic<bool> g_barVisible{false};

void writeToStderr(const std::string& text) {
    // write(2), not stdio: it is also called while the process is being ended.
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
}

} // namespace

Progress::Style Progress::styleFor(bool demanded) {
    if (isatty(STDERR_FILENO) != 0) return Style::Bar;
    return demanded ? Style::Lines : Style::None;
}

JobControl Progress::phase(const std::string& name) {
    {
        const std::lock_guard lock(m_mutex);
        m_phase = name;
        m_shown = -1;
        m_lastDrawn = {};
    }
    JobControl job;
    job.stop = interruptToken();
    job.throwIfStopped();
    if (m_style != Style::None) {
        job.progress = [this](double fraction) { show(fraction); };
        show(0);
    }
    return job;
}

JobControl Progress::openPhase(const std::string& name) { return {phase(name).stop, {}}; }

void Progress::show(double fraction) {
    const std::unique_lock lock(m_mutex, std::try_to_lock);
    if (!lock || !std::isfinite(fraction)) return; // another thread is drawing: this report is not needed
    const int percent = static_cast<int>(std::floor(100 * std::clamp(fraction, 0.0, 1.0)));
    if (m_style == Style::Lines) {
        const int tenths = percent / 10;
        if (tenths <= m_shown) return;
        m_shown = tenths;
        writeToStderr(m_phase + " " + std::to_string(percent) + " %\n");
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    if (percent == m_shown || (m_shown >= 0 && percent < 100 && now - m_lastDrawn < std::chrono::milliseconds(50)))
        return;
    m_shown = percent;
    m_lastDrawn = now;
    constexpr int kColumns = 30;
    const int filled = kColumns * percent / 100;
    g_barVisible = true;
    writeToStderr("\r\033[K" + m_phase + " [" + std::string(static_cast<std::size_t>(filled), '#') +
                  std::string(static_cast<std::size_t>(kColumns - filled), '.') + "] " + std::to_string(percent) +
                  " %");
}

void Progress::tell(const std::string& news) {
    const std::lock_guard lock(m_mutex);
    if (m_style == Style::Lines) writeToStderr(m_phase + ": " + news + "\n");
    if (m_style != Style::Bar) return;
    g_barVisible = true;
    writeToStderr("\r\033[K" + m_phase + ": " + news);
}

void Progress::finish() { clearProgressLine(); }

void clearProgressLine() {
    if (g_barVisible.exchange(false)) writeToStderr("\r\033[K");
}

} // namespace pellucid::cli
