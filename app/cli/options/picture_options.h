// --size, --background, --step, --finest-step, --mode, --jitter, --feature and the light: how the picture looks.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "options/light_options.h"
#include "parse.h"
#include "session/scene.h"

namespace pellucid::cli {

struct PictureOptions {
    ImageSize size;
    std::optional<Gradient> background;
    bool transparent = false;
    std::optional<double> step;
    SettingOptions<DisplaySettings> given;
    bool jitter = false;
    LightOptions light;
    std::optional<std::string> feature;

    /// Mode::OfSession: without --mode, which the command has for something else.
    enum class Mode { Option, OfSession };
    void add(CLI::App& app, Mode modeIs = Mode::Option);
    /// The same without --size.
    void addLook(CLI::App& app, Mode modeIs = Mode::Option);
    /// Throws UsageError for options of the light that do not go together.
    void applyTo(SceneInputs& inputs) const;
    /// What needs the transfer function. Throws UsageError where no feature has the name.
    void applyTo(Scene& scene) const;
    /// --step and --jitter. Throws UsageError.
    void applyTo(PictureInput& picture) const;
    PictureInput pictureOf(const Scene& scene) const;
};

} // namespace pellucid::cli
