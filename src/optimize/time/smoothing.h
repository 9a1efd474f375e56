// The opacities of all frames of a series at once, so that they change as little as their targets allow
// (docs/method.md, "Transfer functions over time").
#pragma once

#include <vector>

#include "optimize/optimizer.h"

namespace pellucid {

/// A frame near the opacities it has.
struct FrameModel {
    std::vector<double> opacity;                 ///< per feature
    std::vector<double> vws;                     ///< W_i there
    std::vector<std::vector<double>> derivative; ///< [i][j]: ∂W_i/∂x_j there
    std::vector<std::vector<double>>
        metric;                        ///< what a jump to this frame is, see TrackOptions::metric; empty: likewise
    std::vector<double> targets;       ///< shares; a feature with target 0 stays
    std::vector<OpacityLimits> limits; ///< one per feature
    double distance = 0;               ///< F that it may have
    /// Made by hand: neither moves nor counts its F, and needs nothing but opacity and, where it is not the first,
    /// metric.
    bool stays = false;
};

/// Opacities per frame and feature that minimise the sum of the jumps from frame to frame, where the root mean square
/// of F is at most that of FrameModel::distance, in the linear model of each frame; where none are, nearly those of the
/// smallest F. No ln τ moves by more than 1. A first frame that does not stay keeps the density that it has, but for
/// what its shares take: else all frames would fade. Throws UsageError where frames differ in their number of features,
/// Cancelled.
std::vector<std::vector<double>> smoothed(const std::vector<FrameModel>& frames, const JobControl& job = {});

} // namespace pellucid
