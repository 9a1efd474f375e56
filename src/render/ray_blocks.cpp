#include "render/ray_blocks.h"

#include <algorithm>

#include <glm/common.hpp>

#include "base/parallel.h"
#include "render/cpu/ray_packets.h"

namespace pellucid {

namespace {

constexpr int kNothing = 65535; ///< a range without codes: lowest 65535, highest 0

std::size_t asSize(int n) { return static_cast<std::size_t>(n); }
std::ptrdiff_t asDifference(std::size_t n) { return static_cast<std::ptrdiff_t>(n); }
int lowOf(std::int32_t range) { return range & 0xffff; }
int highOf(std::int32_t range) { return static_cast<int>(static_cast<std::uint32_t>(range) >> 16); }
std::int32_t rangeOf(int low, int high) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(low) | static_cast<std::uint32_t>(high) << 16);
}

/// What elements that lie `steps` off know of the next opaque block, in lines of `count`: at least that far.
void hear(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::uint8_t steps) {
    for (std::size_t i = 0; i < count; ++i) to[i] = std::min(to[i], std::max(from[i], steps));
}

/// hear() from both sides, up to the farthest that counts; elements are neighbours `stride` apart among `count`.
void hearAlong(const std::vector<std::uint8_t>& from, std::vector<std::uint8_t>& to, std::size_t stride) {
    to = from;
    for (std::size_t steps = 1; steps < kMostBlockDistance && steps * stride < from.size(); ++steps) {
        const std::size_t off = steps * stride, count = from.size() - off;
        hear(from.data() + off, to.data(), count, static_cast<std::uint8_t>(steps));
        hear(from.data(), to.data() + off, count, static_cast<std::uint8_t>(steps));
    }
}

} // namespace

RayBlocks::RayBlocks(const IntensityGrid& grid) {
    const Int3 n = grid.codes.dims();
    for (int a = 0; a < 3; ++a) m_dims[a] = std::max(1, (n[a] - 1 + kRayBlock - 1) / kRayBlock);
    m_ranges.assign(voxelCount(m_dims), rangeOf(kNothing, 0));
    parallelFor(asSize(m_dims.z), [&](std::size_t layer) {
        const int bz = static_cast<int>(layer);
        std::vector<std::uint16_t> low(asSize(m_dims.x * m_dims.y), kNothing), high(low.size(), 0);
        for (int k = bz * kRayBlock; k <= std::min(n.z - 1, (bz + 1) * kRayBlock); ++k)
            for (int j = 0; j < n.y; ++j) {
                const std::size_t row = grid.codes.index(0, j, k);
                const std::uint8_t* valid = grid.valid.empty() ? nullptr : &grid.valid[row];
                for (int bx = 0; bx < m_dims.x; ++bx) {
                    std::uint16_t l = kNothing, h = 0;
                    for (int i = bx * kRayBlock; i <= std::min(n.x - 1, (bx + 1) * kRayBlock); ++i) {
                        if (valid && !valid[i]) continue;
                        const std::uint16_t code = grid.codes[row + asSize(i)];
                        l = std::min(l, code);
                        h = std::max(h, code);
                    }
                    // A row between two blocks belongs to both.
                    for (int by = (j - 1 + kRayBlock) / kRayBlock - 1; by <= j / kRayBlock; ++by) {
                        if (by < 0 || by >= m_dims.y) continue;
                        const std::size_t b = asSize(bx + m_dims.x * by);
                        low[b] = std::min(low[b], l);
                        high[b] = std::max(high[b], h);
                    }
                }
            }
        for (std::size_t b = 0; b < low.size(); ++b) m_ranges[layer * low.size() + b] = rangeOf(low[b], high[b]);
    });
    if (!grid.valid.empty()) joinAcrossInvalid(grid);
}

// From one block into the next the intensity goes over what both have in common, unless all of that is invalid. So
// where voxels are invalid a block's range takes in those of its neighbours, and a way between transparent blocks meets
// nothing opaque here either.
void RayBlocks::joinAcrossInvalid(const IntensityGrid& grid) {
    const Int3 n = grid.codes.dims();
    std::vector<std::uint8_t> touched(m_ranges.size(), 0);
    for (int k = 0; k < n.z; ++k)
        for (int j = 0; j < n.y; ++j)
            for (int i = 0; i < n.x; ++i)
                if (!grid.valid[grid.codes.index(i, j, k)]) {
                    const Int3 b = glm::min(Int3(i, j, k) / kRayBlock, m_dims - 1);
                    touched[voxelIndex(m_dims, b.x, b.y, b.z)] = 1;
                }
    const std::vector<std::int32_t> before = m_ranges;
    const auto at = [&](int x, int y, int z) { return voxelIndex(m_dims, x, y, z); };
    for (int z = 0; z < m_dims.z; ++z)
        for (int y = 0; y < m_dims.y; ++y)
            for (int x = 0; x < m_dims.x; ++x) {
                int low = kNothing, high = 0;
                bool near = false;
                for (int c = std::max(0, z - 1); c <= std::min(m_dims.z - 1, z + 1); ++c)
                    for (int b = std::max(0, y - 1); b <= std::min(m_dims.y - 1, y + 1); ++b)
                        for (int a = std::max(0, x - 1); a <= std::min(m_dims.x - 1, x + 1); ++a) {
                            low = std::min(low, lowOf(before[at(a, b, c)]));
                            high = std::max(high, highOf(before[at(a, b, c)]));
                            near = near || touched[at(a, b, c)];
                        }
                if (near) m_ranges[at(x, y, z)] = rangeOf(low, high);
            }
}

std::vector<std::uint8_t> RayBlocks::distances(const std::function<bool(int, int)>& isOpaque) const {
    constexpr std::size_t kPad = 3;
    const std::size_t size = m_ranges.size(), layer = layerSize(m_dims);
    std::vector<std::uint8_t> distance(size + kPad, 0);
    parallelFor(asSize(m_dims.z), [&](std::size_t z) {
        for (std::size_t i = z * layer; i < (z + 1) * layer; ++i) {
            const int low = lowOf(m_ranges[i]), high = highOf(m_ranges[i]);
            distance[i] = low <= high && isOpaque(low, high) ? 0 : kMostBlockDistance;
        }
    });
    // Over faces, edges and corners the distance is the longest of those along the axes. So one axis after the other:
    // the least, over all blocks of a line, of the larger of what is known there and the way there.
    const std::size_t nx = asSize(m_dims.x), ny = asSize(m_dims.y), nz = asSize(m_dims.z);
    std::vector<std::uint8_t> inLayers(size);
    parallelFor(nz, [&](std::size_t z) {
        constexpr std::size_t kGap = kMostBlockDistance - 1; // between rows, so that a layer is one line along x too
        std::vector<std::uint8_t> rows((nx + kGap) * ny, kMostBlockDistance), alongX, alongXy;
        for (std::size_t y = 0; y < ny; ++y)
            std::copy_n(&distance[z * layer + y * nx], nx, rows.begin() + asDifference(y * (nx + kGap)));
        hearAlong(rows, alongX, 1);
        for (std::size_t y = 0; y < ny; ++y) // what a gap has heard is none of its rows' business
            std::fill_n(alongX.begin() + asDifference(y * (nx + kGap) + nx), kGap, kMostBlockDistance);
        hearAlong(alongX, alongXy, nx + kGap);
        for (std::size_t y = 0; y < ny; ++y)
            std::copy_n(alongXy.begin() + asDifference(y * (nx + kGap)), nx, &inLayers[z * layer + y * nx]);
    });
    parallelFor(nz, [&](std::size_t z) {
        std::uint8_t* const to = &distance[z * layer];
        std::copy_n(&inLayers[z * layer], layer, to);
        for (std::size_t steps = 1; steps < kMostBlockDistance; ++steps) {
            const auto way = static_cast<std::uint8_t>(steps);
            if (z >= steps) hear(&inLayers[(z - steps) * layer], to, layer, way);
            if (z + steps < nz) hear(&inLayers[(z + steps) * layer], to, layer, way);
        }
    });
    return distance;
}

} // namespace pellucid
