// How often each intensity occurs.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// Counts per intensity bin over valid voxels: bin ⌊bins·s⌋, the last one closed (docs/method.md, "Entropy
/// refinement"); and which intensities occur at all, finer than any bin.
struct Histogram {
    std::vector<std::uint64_t> counts;
    std::uint64_t total = 0;
    std::vector<std::uint16_t> codes; ///< of IntensityCoder, those that valid voxels have, ascending
    int maxCode = 1;                  ///< intensity is code / maxCode

    /// p of bin i: counts[i] / total; 0 where the volume has no valid voxel.
    double p(std::size_t bin) const {
        return total == 0 ? 0.0 : static_cast<double>(counts[bin]) / static_cast<double>(total);
    }
};

/// The bin of intensity s in [0,1].
int histogramBin(double s, int bins);

Histogram makeHistogram(const Volume& volume, int bins = 256);

} // namespace pellucid
