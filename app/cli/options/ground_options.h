// --ground, --ground-raw, --ground-scale, --ground-relief, --ground-map: a height field under the volume.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "options/setting_options.h"
#include "session/scene.h"

namespace pellucid::cli {

struct GroundOptions {
    std::optional<std::string> path;
    std::optional<RawLayout> raw;
    SettingOptions<GroundView> given;

    void add(CLI::App& app);
    /// --ground replaces that of the session; the others change it. Throws UsageError where there is none.
    void applyTo(SceneInputs& inputs) const;
};

} // namespace pellucid::cli
