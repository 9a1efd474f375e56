#include "ranks/decomposition.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

namespace pellucid {

namespace {

constexpr int kCutAt = 8; ///< voxels: blocks of the opaque map belong to one rank

} // namespace

bool isEmpty(const VoxelRegion& region) {
    return region.hi.x <= region.lo.x || region.hi.y <= region.lo.y || region.hi.z <= region.lo.z;
}

VoxelRegion widened(const VoxelRegion& region, const Int3& layers, const Int3& dims) {
    if (isEmpty(region)) return region;
    return {glm::max(region.lo - layers, Int3(0)), glm::min(region.hi + layers, dims)};
}

Decomposition::Decomposition(const Int3& dims, int blocks, const Grid<double>* work)
    : m_dims(dims), m_blocks(static_cast<std::size_t>(blocks)) {
    PELLUCID_CHECK(blocks >= 1);
    divide({Int3(0), dims}, 0, blocks, work);
}

int Decomposition::divide(const VoxelRegion& region, int first, int count, const Grid<double>* work) {
    const int node = static_cast<int>(m_nodes.size());
    m_nodes.emplace_back();
    if (count == 1) {
        m_nodes.back().block = first;
        m_blocks[static_cast<std::size_t>(first)] = region;
        return node;
    }
    const Int3 size = region.hi - region.lo;
    int axis = 2; // the longest; of equals the one along which rows of a file stay whole
    for (const int a : {1, 0})
        if (size[a] > size[axis]) axis = a;
    const int below = count / 2, cut = cutOf(region, axis, static_cast<double>(below) / count, work);
    VoxelRegion low = region, high = region;
    low.hi[axis] = high.lo[axis] = cut;
    const int lowNode = divide(low, first, below, work), highNode = divide(high, first + below, count - below, work);
    m_nodes[static_cast<std::size_t>(node)] = {axis, cut, lowNode, highNode, -1};
    return node;
}

/// Where about `share` of the work in a region lies below.
int Decomposition::cutOf(const VoxelRegion& region, int axis, double share, const Grid<double>* work) const {
    const int lo = region.lo[axis], hi = region.hi[axis];
    double at = lo + share * (hi - lo);
    if (work != nullptr) {
        // The work of each layer of cells, as far as it lies in the region; within a cell it is the same everywhere.
        const Int3 cells = work->dims();
        const auto overlap = [&](int a, int cell) {
            const double size = static_cast<double>(m_dims[a]) / cells[a];
            return std::max(0.0, std::min<double>(region.hi[a], (cell + 1) * size) -
                                     std::max<double>(region.lo[a], cell * size)) /
                   size;
        };
        std::vector<double> layers(static_cast<std::size_t>(cells[axis]), 0.0);
        std::array<std::vector<double>, 3> overlaps;
        VoxelRegion part{Int3(0), Int3(0)}; // the cells that the region has a share of
        for (int a = 0; a < 3; ++a) {
            std::vector<double>& along = overlaps[static_cast<std::size_t>(a)];
            for (int cell = 0; cell < cells[a]; ++cell) {
                along.push_back(overlap(a, cell));
                if (along.back() <= 0) continue;
                if (part.hi[a] == 0) part.lo[a] = cell;
                part.hi[a] = cell + 1;
            }
        }
        for (int k = part.lo.z; k < part.hi.z; ++k)
            for (int j = part.lo.y; j < part.hi.y; ++j) {
                const double row = overlaps[1][static_cast<std::size_t>(j)] * overlaps[2][static_cast<std::size_t>(k)];
                for (int i = part.lo.x; i < part.hi.x; ++i)
                    layers[static_cast<std::size_t>(Int3(i, j, k)[axis])] +=
                        row * overlaps[0][static_cast<std::size_t>(i)] * work->at(i, j, k);
            }
        double all = 0, below = 0;
        for (const double layer : layers) all += layer;
        for (std::size_t n = 0; n < layers.size() && all > 0; ++n) {
            if (below + layers[n] >= share * all && layers[n] > 0) {
                const double size = static_cast<double>(m_dims[axis]) / cells[axis],
                             begin = std::max<double>(lo, static_cast<double>(n) * size),
                             end = std::min<double>(hi, static_cast<double>(n + 1) * size);
                at = begin + (share * all - below) / layers[n] * (end - begin);
                break;
            }
            below += layers[n];
        }
    }
    const int cut = static_cast<int>(std::lround(at / kCutAt)) * kCutAt;
    return std::clamp(cut, lo, hi);
}

std::vector<int> Decomposition::order(const std::function<bool(const Node&)>& lowFirst) const {
    std::vector<int> blocks, open{0};
    while (!open.empty()) {
        const Node& node = m_nodes[static_cast<std::size_t>(open.back())];
        open.pop_back();
        if (node.block >= 0) {
            blocks.push_back(node.block);
            continue;
        }
        const bool low = lowFirst(node);
        open.push_back(low ? node.high : node.low);
        open.push_back(low ? node.low : node.high);
    }
    return blocks;
}

std::vector<int> Decomposition::orderFrom(const Vec3& eye) const {
    return order([&](const Node& node) { return eye[node.axis] < node.cut - 0.5; });
}

std::vector<int> Decomposition::orderAlong(const Vec3& direction) const {
    return order([&](const Node& node) { return direction[node.axis] >= 0; });
}

} // namespace pellucid
