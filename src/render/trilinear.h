// Intensity between voxel centres (docs/method.md, "Volume and intensity").
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "volume/grid.h"
#include "volume/intensity_grid.h"

namespace pellucid {

/// An interpolated intensity. An invalid voxel has opacity 0, which interpolation carries on: the intensity is the mean
/// over the valid corners, and what it absorbs is multiplied by `validShare`.
struct Interpolated {
    double value = 0;
    double validShare = 0; ///< weight of the valid corners, [0,1]
};

/// Trilinear between centres, clamped to the edge beyond the outer ones, of a grid of `n` values. `at` is in voxels.
/// `valid` may be empty.
template <class T>
Interpolated interpolate(const T* grid, const Int3& n, const std::vector<std::uint8_t>& valid, const Vec3& at) {
    int base[3];
    double fraction[3];
    std::size_t step[3] = {1, static_cast<std::size_t>(n.x),
                           static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y)};
    for (int a = 0; a < 3; ++a) {
        const double p = std::clamp(at[a], 0.0, static_cast<double>(n[a] - 1));
        base[a] = std::min(static_cast<int>(p), std::max(0, n[a] - 2));
        fraction[a] = p - base[a];
        if (n[a] == 1) step[a] = 0;
    }
    const std::size_t corner = static_cast<std::size_t>(base[0]) + step[1] * static_cast<std::size_t>(base[1]) +
                               step[2] * static_cast<std::size_t>(base[2]);
    if (valid.empty()) { // nearly always: no weights to keep
        const auto alongX = [&](std::size_t i) {
            const auto low = static_cast<double>(grid[i]), high = static_cast<double>(grid[i + step[0]]);
            return low + fraction[0] * (high - low);
        };
        const auto alongY = [&](std::size_t i) {
            const double low = alongX(i), high = alongX(i + step[1]);
            return low + fraction[1] * (high - low);
        };
        const double low = alongY(corner), high = alongY(corner + step[2]);
        return {low + fraction[2] * (high - low), 1.0};
    }
    Interpolated result;
    for (int c = 0; c < 8; ++c) {
        double w = 1;
        std::size_t i = corner;
        for (int a = 0; a < 3; ++a) {
            const bool upper = (c >> a) & 1;
            w *= upper ? fraction[a] : 1 - fraction[a];
            if (upper) i += step[a];
        }
        if (w == 0 || !valid[i]) continue;
        result.value += w * static_cast<double>(grid[i]);
        result.validShare += w;
    }
    if (result.validShare > 0) result.value /= result.validShare;
    return result;
}

template <class T>
Interpolated interpolate(const Grid<T>& grid, const std::vector<std::uint8_t>& valid, const Vec3& at) {
    return interpolate(grid.data(), grid.dims(), valid, at);
}
inline Interpolated interpolate(const CodeGrid& codes, const std::vector<std::uint8_t>& valid, const Vec3& at) {
    return codes.visit([&](const auto* grid) { return interpolate(grid, codes.dims(), valid, at); });
}

} // namespace pellucid
