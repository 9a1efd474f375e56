// --clip and --holder: how much of the volume is looked at, in pictures and in figures.
#pragma once

#include <optional>
#include <vector>

#include <CLI/CLI.hpp>

#include "parse.h"
#include "session/scene.h"

namespace pellucid::cli {

struct ClipOptions {
    std::vector<Clip> clips; ///< any: in place of the session's
    std::optional<double> holder;

    void add(CLI::App& app);
    /// Throws UsageError where the intervals of an axis leave nothing, and for too many planes.
    void applyTo(SceneInputs& inputs) const;
    /// Throws UsageError where --holder is given and there is none.
    void check(const Scene& scene) const;
};

} // namespace pellucid::cli
