// Intensity between voxel centres (docs/method.md, "Volume and intensity").
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
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

/// The cell around a place: its lowest corner, and how to get from there to the others.
struct TrilinearCell {
    std::size_t corner = 0;
    std::size_t step[3]; ///< to the next voxel along each axis; 0 where there is one only
    double fraction[3];  ///< of the way to it

    /// `at` is in voxels of a grid of `n`; clamped to the outer centres.
    TrilinearCell(const Int3& n, const Vec3& at) : step{1, static_cast<std::size_t>(n.x), layerSize(n)} {
        for (int a = 0; a < 3; ++a) {
            const double p = std::clamp(at[a], 0.0, static_cast<double>(n[a] - 1));
            const int base = std::min(static_cast<int>(p), std::max(0, n[a] - 2));
            fraction[a] = p - base;
            corner += step[a] * static_cast<std::size_t>(base);
            if (n[a] == 1) step[a] = 0;
        }
    }
};

/// Trilinear between centres, clamped to the edge beyond the outer ones, of a grid of `n` values that `valueAt(index)`
/// tells: NaN where invalid. `at` is in voxels.
template <class ValueAt>
Interpolated interpolateValid(const ValueAt& valueAt, const Int3& n, const Vec3& at) {
    const TrilinearCell cell(n, at);
    Interpolated result;
    for (unsigned c = 0; c < 8; ++c) {
        double w = 1;
        std::size_t i = cell.corner;
        for (unsigned a = 0; a < 3; ++a) {
            const bool upper = (c >> a) & 1u;
            w *= upper ? cell.fraction[a] : 1 - cell.fraction[a];
            if (upper) i += cell.step[a];
        }
        if (w == 0) continue;
        const double value = valueAt(i);
        if (std::isnan(value)) continue;
        result.value += w * value;
        result.validShare += w;
    }
    if (result.validShare > 0) result.value /= result.validShare;
    return result;
}

/// The same where all values are valid.
template <class ValueAt>
double interpolateAll(const ValueAt& valueAt, const TrilinearCell& cell) {
    const auto alongX = [&](std::size_t i) {
        const double low = valueAt(i), high = valueAt(i + cell.step[0]);
        return low + cell.fraction[0] * (high - low);
    };
    const auto alongY = [&](std::size_t i) {
        const double low = alongX(i), high = alongX(i + cell.step[1]);
        return low + cell.fraction[1] * (high - low);
    };
    const double low = alongY(cell.corner), high = alongY(cell.corner + cell.step[2]);
    return low + cell.fraction[2] * (high - low);
}

/// The same of a grid in memory. `valid` may be empty.
template <class T>
Interpolated interpolate(const T* grid, const Int3& n, const std::vector<std::uint8_t>& valid, const Vec3& at) {
    if (!valid.empty())
        return interpolateValid(
            [&](std::size_t i) {
                return valid[i] ? static_cast<double>(grid[i]) : std::numeric_limits<double>::quiet_NaN();
            },
            n, at);
    // Nearly always: no weights to keep.
    return {interpolateAll([&](std::size_t i) { return static_cast<double>(grid[i]); }, TrilinearCell(n, at)), 1.0};
}

template <class T>
Interpolated interpolate(const Grid<T>& grid, const std::vector<std::uint8_t>& valid, const Vec3& at) {
    return interpolate(grid.data(), grid.dims(), valid, at);
}
inline Interpolated interpolate(const CodeGrid& codes, const std::vector<std::uint8_t>& valid, const Vec3& at) {
    return codes.visit([&](const auto* grid) { return interpolate(grid, codes.dims(), valid, at); });
}

} // namespace pellucid
