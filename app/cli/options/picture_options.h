// --size, --background, --step, --shading, --clip, --feature: how the picture looks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "parse.h"
#include "session/scene.h"

namespace pellucid::cli {

struct PictureOptions {
    ImageSize size;
    std::optional<Rgb> background;
    bool transparent = false;
    std::optional<double> step;
    bool shading = false;
    std::vector<Clip> clips; ///< any: in place of the session's
    std::optional<std::string> feature;

    void add(CLI::App& app);
    /// Throws UsageError where the clips leave nothing.
    void applyTo(SceneInputs& inputs) const;
    /// What needs the transfer function. Throws UsageError where no feature has the name.
    void applyTo(Scene& scene) const;
    PictureInput pictureOf(const Scene& scene) const;
};

} // namespace pellucid::cli
