// A colour for every voxel, where colours do not come from the transfer function of the drawn variable.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/grid.h"

namespace pellucid {

/// Straight sRGB, 8 bits a channel, x fastest: red in the lowest byte, then green, blue, and 255. Immutable once
/// shared. Between voxels colours are interpolated trilinearly, channel by channel; opacity is not part of it.
struct VoxelColors {
    Int3 dims{0, 0, 0};
    std::vector<std::uint32_t> rgba;

    static std::uint32_t pack(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
        return r | std::uint32_t{g} << 8 | std::uint32_t{b} << 16 | 0xff000000u;
    }
};

} // namespace pellucid
