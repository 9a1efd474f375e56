// --intensity, --hue, --region: what a refinement brings out.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "options/volume_options.h"
#include "output.h"
#include "parse.h"
#include "session/refine_priority.h"

namespace pellucid::cli {

/// Pixels of a picture: [x0, x1) × [y0, y1).
struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct PriorityOptions {
    std::optional<double> intensity;
    std::optional<double> hue; ///< degrees
    std::optional<PixelRectangle> region;

    /// --region is that of the data, too, where three intervals are given.
    void add(CLI::App& app, VolumeOptions& volume);
    /// The option that was given; null: none.
    const char* given() const;
    /// What can be told before the volume is read: of several priorities, and of a region beyond a picture of `size`.
    /// Throws UsageError.
    void check(const ImageSize& size) const;
    /// What was given takes the place of what is favoured; a region is of a picture of `size`.
    void applyTo(RefineSettings& settings, const ImageSize& size) const;
    /// What `settings`, to which these have been applied, favour, as `priority` has it: {"kind":"none"}, an
    /// "intensity", with the "hue" that it came of, a "hue", a "region" with its "size" and how many "pixels" show
    /// something.
    Json told(const RefineSettings& settings, const RefinePriority& priority) const;
};

/// "none", "intensity 0.4, hue 120", "1 024 pixels of a region": of PriorityOptions::told().
std::string textOfPriority(const Json& told);

} // namespace pellucid::cli
