// Fields known everywhere, with their exact gradients: ground truth for tests of interpolation, gradients and
// renderers.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "volume/volume.h"

namespace pellucid {

struct ValueAndGradient {
    double value = 0;
    Vec3 gradient{0, 0, 0}; ///< per world unit
};

/// exp(−|p − center|² / (2σ²)), in (0, 1]; lengths in world units.
inline ValueAndGradient gaussianBall(const Vec3& p, const Vec3& center, double sigma) {
    const Vec3 d = p - center;
    const double value = std::exp(-glm::dot(d, d) / (2 * sigma * sigma));
    return {value, -value / (sigma * sigma) * d};
}

/// ½ + ½ sin(k·p), in [0, 1]; k in radians per world unit.
inline ValueAndGradient planeWave(const Vec3& p, const Vec3& k) {
    const double phase = glm::dot(k, p);
    return {0.5 + 0.5 * std::sin(phase), 0.5 * std::cos(phase) * k};
}

/// A float volume of field(p).value at the voxel centres.
template <class Field>
Volume sampleField(const Geometry& geometry, const Field& field) {
    std::vector<float> values;
    values.reserve(voxelCount(geometry.dims));
    for (int k = 0; k < geometry.dims.z; ++k)
        for (int j = 0; j < geometry.dims.y; ++j)
            for (int i = 0; i < geometry.dims.x; ++i)
                values.push_back(static_cast<float>(field(geometry.worldFromVoxel({i, j, k})).value));
    return Volume(geometry, std::move(values));
}

} // namespace pellucid
