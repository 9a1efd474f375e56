// --sigma, --kernel, --w1, --w2, --u1, --u2, --saliency-background: what catches the eye.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "session/scene.h"

namespace pellucid::cli {

struct SaliencyInput {
    std::optional<double> sigma, w1, w2, u1, u2;
    std::optional<SaliencyKernel> kernel;
    std::optional<Rgb> background;

    void add(CLI::App& app);
    /// Throws UsageError unless u1 and u2 sum to 1; one alone determines the other.
    void applyTo(SceneInputs& inputs) const;
};

} // namespace pellucid::cli
