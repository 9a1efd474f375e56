// --shading, --light, --light-preset, … : how the picture is lit.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "options/setting_options.h"
#include "render/render_settings.h"
#include "session/scene.h"

namespace pellucid::cli {

struct LightOptions {
    bool shading = false, noShading = false;
    std::optional<std::string> preset;
    SettingOptions<Light> given;
    std::optional<Vec3> direction;

    void add(CLI::App& app);
    /// The preset first, single numbers over it. Throws UsageError for options that do not go together.
    void applyTo(Light& light) const;

private:
    bool saysHowBright() const;
    void takeParts(const std::string& text, const std::string& option);
};

} // namespace pellucid::cli
