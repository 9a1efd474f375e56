// How often intensities meet gradient magnitudes: where materials are, and where they border on each other.
#pragma once

#include <cstdint>
#include <vector>

#include "base/job.h"
#include "volume/volume.h"

namespace pellucid {

/// Counts of voxels per intensity bin and bin of gradient magnitude |∇s|, central differences in world units times d0,
/// so intensity per d0 (docs/method.md, "Light", has the same gradient). The last bin of gradients holds what exceeds
/// mostGradient, too.
struct JointHistogram {
    int bins = 0, gradientBins = 0;
    double mostGradient = 0;           ///< the upper end of the last bin; 0 where nothing changes anywhere
    std::vector<std::uint32_t> counts; ///< [gradientBin · bins + bin]

    std::uint32_t at(int bin, int gradientBin) const {
        return counts[static_cast<std::size_t>(gradientBin) * static_cast<std::size_t>(bins) +
                      static_cast<std::size_t>(bin)];
    }
};

/// Of every voxel that is valid and has six valid neighbours (at the volume's faces one-sided differences); of volumes
/// above 2²⁴ voxels of every n-th plane and line. Throws Cancelled.
JointHistogram makeJointHistogram(const Volume& volume, int bins = 256, int gradientBins = 128,
                                  const JobControl& job = {});

} // namespace pellucid
