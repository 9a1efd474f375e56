// --camera, --view, --orthographic: from where.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "session/scene.h"

namespace pellucid::cli {

struct CameraOptions {
    std::optional<std::string> file;
    std::optional<ViewAngles> view;
    std::optional<NamedView> namedView;
    bool orthographic = false;
    bool mayBeBest = false;             ///< of a command that finds the view itself: --view best
    bool best = false;                  ///< that is what is asked for
    std::optional<ViewAngles> fallback; ///< the command's own, where neither options nor session say

    void add(CLI::App& app);
    /// A view alone, under another name.
    void addView(CLI::App& app, const std::string& name, const std::string& help);
    /// Reads the camera's file. Throws UsageError for options that do not go together, Error for the file.
    void applyTo(SceneInputs& inputs) const;

private:
    bool m_added = false;
};

} // namespace pellucid::cli
