// How far a long command is, on stderr.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "base/job.h"

namespace pellucid::cli {

/// A bar that is redrawn in place on a terminal; with --progress elsewhere, one line for each tenth.
class Progress {
public:
    enum class Style { None, Bar, Lines };
    explicit Progress(Style style) : m_style(style) {}
    /// A bar where stderr is a terminal, lines where `demanded`, nothing otherwise.
    static Style styleFor(bool demanded);

    /// Starts a phase of the work ("saliency"); its JobControl stops on Ctrl-C. Throws Cancelled where that has come.
    JobControl phase(const std::string& name);
    /// The same where nobody knows how much there is to do: without a bar.
    JobControl openPhase(const std::string& name);
    /// News of a phase whose end cannot be foreseen, in place of its bar.
    void tell(const std::string& news);
    /// Removes the bar. Call it before anything else is written.
    void finish();

private:
    void show(double fraction);

    Style m_style;
    std::mutex m_mutex;
    std::string m_phase;
    int m_shown = -1; ///< per cent of the bar, tenths of the lines
    std::chrono::steady_clock::time_point m_lastDrawn;
};

/// Clears the bar where one is on the screen. Usable from any thread, and without the Progress at hand.
void clearProgressLine();

} // namespace pellucid::cli
