// What rays may leap over: blocks of the volume in which a transfer function gives no opacity.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "volume/intensity_grid.h"

namespace pellucid {

/// Lowest and highest code per block of kRayBlock³ cells (the voxels at both ends of a cell count). Made once per
/// volume.
class RayBlocks {
public:
    explicit RayBlocks(const IntensityGrid& grid);

    const Int3& dims() const noexcept { return m_dims; } ///< blocks along each axis
    /// shape dims(): lowest code + 65536·(highest code); the lowest above the highest where no voxel is valid.
    const std::vector<std::int32_t>& ranges() const noexcept { return m_ranges; }

    /// shape dims(), and three more bytes: how many blocks off the next one is, over faces, edges and corners, whose
    /// range `isOpaque`; 0 where it is itself, kMostBlockDistance where none is nearer.
    std::vector<std::uint8_t> distances(const std::function<bool(int low, int high)>& isOpaque) const;

private:
    void joinAcrossInvalid(const IntensityGrid& grid);
    Int3 m_dims{0, 0, 0};
    std::vector<std::int32_t> m_ranges;
};

} // namespace pellucid
