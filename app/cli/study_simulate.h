// --simulate and what goes with it, of `study run`: participants who are computed.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "base/stopwatch.h"
#include "output.h"
#include "progress.h"
#include "study/simulation.h"

namespace pellucid::cli {

class SimulateOptions {
public:
    void add(CLI::App& app);
    bool isWanted() const { return m_isWanted; }
    /// Throws UsageError where something that belongs to --simulate is given without it.
    void check() const;
    /// Takes part in the study of `folder`.
    Answer run(const std::string& folder, Progress& progress) const;

private:
    bool m_isWanted = false;
    std::string m_needless; ///< an option that is for simulations
    SimulationOptions m_options;
};

} // namespace pellucid::cli
