// What the ray of a pixel meets (docs/method.md, "The probe").
#pragma once

#include <vector>

#include "render/view.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// A point of the ray.
struct ProbeSample {
    double t = 0;         ///< world length from where the ray enters
    double intensity = 0; ///< NaN where voxels around are invalid
    double opacity = 0;   ///< accumulated from the eye up to here, [0,1]
};

/// A part of the ray inside one feature, or between features.
struct ProbeRun {
    double begin = 0, end = 0;
    int feature = -1;        ///< index; −1: of no feature
    double opticalDepth = 0; ///< ∫τ over it
    double share = 0;        ///< ∫Tτ over it: its part of the pixel's alpha
};

struct RayProbe {
    bool hit = false;                 ///< the ray meets what is drawn of the box; otherwise there is nothing below
    Vec3 entry{0}, exit{0};           ///< world
    std::vector<ProbeSample> samples; ///< d0/2 apart at most, from entry to exit
    std::vector<ProbeRun> runs;       ///< from entry to exit, without gaps
    std::vector<double> shares;       ///< ∫Tτ of each feature; shares + rest = alpha
    double rest = 0;                  ///< of what is in no feature, what is faint among it
    double alpha = 0;                 ///< 1 − exp(−∫τ)
    Rgb color;                        ///< of the pixel, straight; black where alpha is 0
    int feature = -1;                 ///< the one of the largest share, the first of equal ones; −1: all are 0
    Vec3 position{0};                 ///< world: where that feature, or the rest, adds most; entry where nothing does
    double t = 0;                     ///< likewise, world length from the entry
    double intensity = 0;             ///< likewise; NaN where nothing adds

    Vec3 at(double length) const; ///< the point of the ray at t = length, world
};

/// The ray through (x, y): pixels from the top left corner of a picture of `width` × `height`, centres at +0.5. Of the
/// unlit picture in mode composite; of the voxels of `onlyFeature` alone where that is an index. Double precision.
/// Throws as Camera::validate() and Clipping::validate() do.
RayProbe probe(const Volume& volume, const TransferFunction& tf, const View& view, double x, double y, int width,
               int height, int onlyFeature = -1);

/// The optical depth of each feature in front of one of them: what hides it on this ray. In front of the run in which
/// that feature adds most or, where none adds anything, of the one of the largest optical depth. All are 0 where the
/// ray does not meet it.
std::vector<double> depthInFront(const RayProbe& probe, std::size_t feature);

} // namespace pellucid
