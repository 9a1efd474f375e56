// A volume cut into blocks, one for each rank (docs/method.md, "Blocks of a volume").
#pragma once

#include <functional>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// Blocks between planes of voxels: halves of halves. Whatever the eye, there is an order in which no block hides one
/// that stands before it. Cuts lie at multiples of 8 voxels, so that a volume of few voxels has empty blocks.
class Decomposition {
public:
    /// `work`: how much there is to do in each cell of a coarse grid over the volume, ≥ 0, which cuts share evenly;
    /// null: the same everywhere.
    Decomposition(const Int3& dims, int blocks, const Grid<double>* work = nullptr);

    const Int3& dims() const { return m_dims; }
    const std::vector<VoxelRegion>& blocks() const { return m_blocks; }
    /// The blocks from the eye on: `eye` in voxel coordinates, or where rays are parallel their `direction` in voxels.
    std::vector<int> orderFrom(const Vec3& eye) const;
    std::vector<int> orderAlong(const Vec3& direction) const;

private:
    struct Node {
        int axis = -1, cut = 0; ///< voxels below `cut` are in `low`
        int low = -1, high = -1;
        int block = -1; ///< of a leaf
    };
    int divide(const VoxelRegion& region, int first, int count, const Grid<double>* work);
    int cutOf(const VoxelRegion& region, int axis, double share, const Grid<double>* work) const;
    std::vector<int> order(const std::function<bool(const Node&)>& lowFirst) const;

    Int3 m_dims;
    std::vector<Node> m_nodes;
    std::vector<VoxelRegion> m_blocks;
};

/// No voxel lies in it.
bool isEmpty(const VoxelRegion& region);
/// The region and `layers` of voxels around it, inside a volume.
VoxelRegion widened(const VoxelRegion& region, const Int3& layers, const Int3& dims);

} // namespace pellucid
