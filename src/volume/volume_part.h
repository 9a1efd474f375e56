// The part of a volume that is in this process.
#pragma once

#include "volume/volume.h"

namespace pellucid {

/// All of a volume, or its block and the voxels around that; places are the volume's. Refers to the volume.
struct VolumePart {
    const Volume* volume = nullptr; ///< the voxels that are here; null: none
    Int3 first{0, 0, 0};            ///< where they begin
    VoxelRegion own;                ///< those that this process answers for

    bool owns(const Int3& v) const {
        return v.x >= own.lo.x && v.y >= own.lo.y && v.z >= own.lo.z && v.x < own.hi.x && v.y < own.hi.y &&
               v.z < own.hi.z;
    }
    /// Of a voxel, among those that are here.
    std::size_t indexOf(const Int3& v) const {
        const Int3 at = v - first;
        return voxelIndex(volume->dims(), at.x, at.y, at.z);
    }
    int ownLayers() const { return volume != nullptr ? own.hi.z - own.lo.z : 0; }
    /// Calls body(voxel, index of it, how many) for the rows of own voxels in own layers [begin, end).
    template <class Body>
    void forOwnRows(int begin, int end, const Body& body) const {
        for (int k = own.lo.z + begin; k < own.lo.z + end; ++k)
            for (int j = own.lo.y; j < own.hi.y; ++j) {
                const Int3 row(own.lo.x, j, k);
                body(row, indexOf(row), own.hi.x - own.lo.x);
            }
    }
};

inline VolumePart partHere(const Volume& volume) {
    if (const VoxelsElsewhere* elsewhere = volume.elsewhere())
        return {volume.here().get(), elsewhere->stored().lo, elsewhere->own()};
    return {&volume, Int3(0), {Int3(0), volume.dims()}};
}

} // namespace pellucid
