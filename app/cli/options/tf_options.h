// --tf: the transfer function; and what is done to it: --colormap, --density, --hide, --only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "session/scene.h"
#include "tf/color_maps.h"
#include "tf/formats/tf_parts.h"

namespace pellucid::cli {

struct TfOptions {
    std::optional<std::string> spec; ///< a file, auto, tents:N[:PEAK], ramp:N or preset:NAME

    std::optional<TfParts> parts; ///< what is taken of `spec`; empty: all

    const ColorMap* colorMap = nullptr;
    ColorMapOptions colorMapOptions;
    double density = 1;
    std::vector<std::string> hide, only; ///< names of features

    void add(CLI::App& app);
    void addSource(CLI::App& app); ///< --tf alone
    /// `spec`, unless only parts of it are wanted: takePartsInto() does that. Throws UsageError for parts of nothing.
    void applyTo(SceneInputs& inputs) const;
    /// The parts, in the place of those of the transfer function that is open. Throws as readTfNamed() does.
    void takePartsInto(Scene& scene, const MemoryUse& then, const JobControl& job) const;
    /// The edits, to the transfer function that is open. Throws UsageError for a name that no feature has.
    void applyTo(Scene& scene) const;
};

} // namespace pellucid::cli
