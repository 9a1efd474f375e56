// Selective saturation and brightness (docs/method.md, "Selective saturation and brightness"; thesis eq. 6.1).
#pragma once

#include <memory>
#include <optional>

#include "base/job.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"
#include "volume/voxel_colors.h"

namespace pellucid {

/// What drives the colour of a voxel. A channel's value is the intensity of its variable through its volume's window,
/// [0,1]; volumes have the grid of the first.
struct HsbInput {
    Int3 dims{0, 0, 0};
    std::shared_ptr<const Volume> saturation; ///< null: saturation 1
    std::shared_ptr<const Volume> brightness; ///< null: brightness 1
    std::shared_ptr<const Volume> hue;        ///< null: hueFrom everywhere
    double a = 1, b = 1;                      ///< saturation = clip(a·S), brightness = 1 − clip(b·Y); ≥ 0
    double hueFrom = 0, hueTo = 240;          ///< degrees, of intensity 0 and 1 of `hue`
};

/// Eq. 6.1, hexcone HSB to sRGB, rounded to 8 bits. An invalid voxel of a variable has the value 0.
/// Throws Cancelled.
VoxelColors hsbColors(const HsbInput& input, const JobControl& job = {});

/// Alpha of eq. 6.1: opacity rises evenly from 0 at intensity 0 to `top` at 1, (0,1]. Its features are the thirds of
/// the window, so that there is something to measure.
TransferFunction opacityRamp(double top);
/// `top` for opacityRamp(), in [0.02,1], by which a ray along the shortest edge of the box meets an optical depth of
/// 1.5 on average.
double rampOpacity(const Volume& volume);

/// A sensible scale for a channel: the 95th percentile of the values above 0 becomes 1. Empty where none is.
std::optional<double> automaticScale(const Volume& channel);

} // namespace pellucid
