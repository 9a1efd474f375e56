// --distance, --angle, --sphere, --box: what is measured beside what a session holds.
#pragma once

#include <vector>

#include <CLI/CLI.hpp>

#include "session/session.h"

namespace pellucid::cli {

struct RulerOptions {
    std::vector<Ruler> given; ///< in the coordinates that are asked for

    void add(CLI::App& app);
    /// Puts them behind the session's own. Throws UsageError where they are too many.
    void applyTo(std::vector<Ruler>& rulers, PatientAxes axes, const Geometry& geometry) const;
};

} // namespace pellucid::cli
