#include "render/ambient_occlusion.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr int kReach = 6; ///< cells

std::size_t asSize(int n) { return static_cast<std::size_t>(n); }

/// Mean optical depth of a path of d0, per cell.
Grid<float> meanDepths(const IntensityGrid& grid, const TransferFunction& tf, const Feature* only) {
    constexpr int kCell = AmbientOcclusion::kCell;
    const TfSampler sampler(tf);
    std::vector<float> depth(asSize(grid.maxCode) + 1, 0.0f);
    constexpr std::size_t kPiece = 4096;
    parallelFor((depth.size() + kPiece - 1) / kPiece, [&](std::size_t piece) {
        for (std::size_t i = piece * kPiece; i < std::min(depth.size(), (piece + 1) * kPiece); ++i) {
            const double s = static_cast<double>(i) / grid.maxCode;
            if (!only || only->contains(s)) depth[i] = static_cast<float>(opticalDepthOfOpacity(sampler.opacity(s)));
        }
    });
    const Int3 n = grid.codes.dims();
    Grid<float> cells((n + (kCell - 1)) / kCell);
    parallelFor(asSize(cells.dims().z), [&](std::size_t layer) {
        const int c = static_cast<int>(layer), k0 = c * kCell, k1 = std::min(n.z, k0 + kCell);
        for (int b = 0; b < cells.dims().y; ++b)
            for (int a = 0; a < cells.dims().x; ++a) {
                float sum = 0;
                int count = 0;
                for (int k = k0; k < k1; ++k)
                    for (int j = b * kCell; j < std::min(n.y, (b + 1) * kCell); ++j)
                        for (int i = a * kCell; i < std::min(n.x, (a + 1) * kCell); ++i, ++count) {
                            const std::size_t v = grid.codes.index(i, j, k);
                            if (grid.valid.empty() || grid.valid[v]) sum += depth[grid.codes[v]];
                        }
                cells.at(a, b, c) = sum / static_cast<float>(count);
            }
    });
    return cells;
}

/// A way from a cell: the cells met, and how long the path in each is, in d0.
struct Direction {
    Int3 step;
    float length;
};

std::vector<Direction> directions(const Geometry& geometry) {
    std::vector<Direction> all;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const int parts = std::abs(x) + std::abs(y) + std::abs(z);
                if (parts != 1 && parts != 3) continue; // faces and corners
                const Vec3 world = geometry.worldFromIndex() * Vec3(x, y, z);
                all.push_back(
                    {{x, y, z}, static_cast<float>(glm::length(world) * AmbientOcclusion::kCell / geometry.d0())});
            }
    return all;
}

} // namespace

AmbientOcclusion makeAmbientOcclusion(const IntensityGrid& grid, const Geometry& geometry, const TransferFunction& tf,
                                      const Feature* only) {
    const Grid<float> depths = meanDepths(grid, tf, only);
    const Int3 n = depths.dims();
    const std::vector<Direction> ways = directions(geometry);
    AmbientOcclusion result{Grid<std::uint8_t>(n)};
    parallelFor(asSize(n.z), [&](std::size_t layer) {
        const int c = static_cast<int>(layer);
        for (int b = 0; b < n.y; ++b)
            for (int a = 0; a < n.x; ++a) {
                float open = 0;
                for (const Direction& way : ways) {
                    float depth = 0;
                    Int3 at(a, b, c);
                    for (int i = 0; i < kReach; ++i) {
                        at += way.step;
                        if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= n.x || at.y >= n.y || at.z >= n.z) break;
                        depth += depths.at(at.x, at.y, at.z) * way.length;
                    }
                    open += std::exp(-depth);
                }
                result.open.at(a, b, c) =
                    static_cast<std::uint8_t>(255 * open / static_cast<float>(ways.size()) + 0.5f);
            }
    });
    return result;
}

} // namespace pellucid
