// --tf: the transfer function.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "session/scene.h"

namespace pellucid::cli {

struct TfOptions {
    std::optional<std::string> spec; ///< a file, auto, tents:N[:PEAK] or ramp:N

    void add(CLI::App& app);
    void applyTo(SceneInputs& inputs) const { inputs.tf = spec; }
};

} // namespace pellucid::cli
