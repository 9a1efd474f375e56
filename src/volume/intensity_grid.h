// Intensities as 16-bit codes: what the fast engines and the GPU read instead of the samples.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// Intensity s of a voxel is code / maxCode. For integer data whose window spans at most 65 535 values the codes are
/// exact (a whole multiple of value − lo); otherwise they are s rounded to 1/65535.
struct IntensityGrid {
    Grid<std::uint16_t> codes;        ///< shape of the volume; 0 where invalid
    int maxCode = 65535;              ///< in [1, 65535]
    std::vector<std::uint8_t> valid;  ///< one byte per voxel, 1 = valid; empty where every voxel is valid
};

IntensityGrid makeIntensityGrid(const Volume& volume);

} // namespace pellucid
