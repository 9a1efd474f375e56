// Which renderer is faster on this machine: measured, once.
#pragma once

#include <optional>

#include "base/job.h"

namespace pellucid {

/// Seconds that the renderers take for the same small picture of a built-in volume.
struct RendererTimes {
    double cpu = 0;
    std::optional<double> gl; ///< empty: there is none, or it cannot draw

    /// Whether gl should draw, where one would `expect` it to or not: a measurement on a busy machine must say clearly,
    /// by half as much again, that the expectation is wrong.
    bool preferGl(bool expect) const { return gl && (expect ? *gl <= 1.5 * cpu : 1.5 * *gl < cpu); }
    bool operator==(const RendererTimes&) const = default;
};

/// Measures: some tenths of a second on a machine that is not busy, the shaders' compilation with it. Throws Cancelled.
RendererTimes timeRenderers(const JobControl& job = {});

} // namespace pellucid
