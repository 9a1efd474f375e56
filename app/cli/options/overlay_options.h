// --overlay, --overlay-tf and what it looks like: a second volume over the first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "options/setting_options.h"
#include "session/scene.h"

namespace pellucid::cli {

struct OverlayOptions {
    std::optional<std::string> path;
    std::optional<std::string> tf;
    SettingOptions<OverlayView> given;

    void add(CLI::App& app);
    /// --overlay replaces that of the session; the others change it. Throws UsageError where there is none, or where
    /// options do not go together, and as loadTf() does.
    void applyTo(SceneInputs& inputs) const;
    /// --overlay-tf of another program gets the opacities that it has there, of the opened scene. What is to be said of
    /// it.
    std::vector<std::string> convertTf(Scene& scene) const;
};

} // namespace pellucid::cli
