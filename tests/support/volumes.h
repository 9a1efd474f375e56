// Small analytic volumes and cameras for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include <glm/geometric.hpp>

#include "render/camera.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::test {

inline std::shared_ptr<const Volume> volumeFrom(const Geometry& geometry,
                                                const std::function<double(int, int, int)>& value,
                                                std::optional<ValueRange> range = ValueRange{0, 1}) {
    std::vector<float> samples;
    samples.reserve(voxelCount(geometry.dims));
    for (int k = 0; k < geometry.dims.z; ++k)
        for (int j = 0; j < geometry.dims.y; ++j)
            for (int i = 0; i < geometry.dims.x; ++i) samples.push_back(static_cast<float>(value(i, j, k)));
    Volume volume(geometry, Samples(std::move(samples)));
    return std::make_shared<const Volume>(range ? volume.withRange(*range) : volume);
}

inline Geometry geometryOf(Int3 dims, Vec3 spacing = Vec3(1), Vec3 origin = Vec3(0)) { return {dims, spacing, origin}; }

/// Every voxel of intensity `s`.
inline std::shared_ptr<const Volume> slab(Int3 dims, double s, Vec3 spacing = Vec3(1)) {
    return volumeFrom(geometryOf(dims, spacing), [s](int, int, int) { return s; });
}

/// Blobs of a few voxels with some noise on them: rough, as scans are, not white.
inline std::shared_ptr<const Volume> roughVolume(std::mt19937& random, Int3 dims, Vec3 spacing) {
    std::uniform_real_distribution<double> unit(0, 1);
    struct Wave {
        Vec3 k;
        double phase;
    };
    std::vector<Wave> waves;
    for (int n = 0; n < 5; ++n)
        waves.push_back({Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5) * 1.2, unit(random) * 6.28});
    return volumeFrom(geometryOf(dims, spacing), [&](int i, int j, int k) {
        double s = 0.5 + 0.05 * (unit(random) - 0.5);
        for (const Wave& w : waves) s += 0.13 * std::sin(w.k.x * i + w.k.y * j + w.k.z * k + w.phase);
        return std::clamp(s, 0.0, 1.0);
    });
}

/// A far-off orthographic camera that looks along `direction`.
inline Camera lookingAlong(const Geometry& geometry, const Vec3& direction) {
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.center = geometry.boxCenter();
    camera.eye = camera.center - direction * 1000.0;
    camera.up = std::abs(direction.z) > 0.9 * glm::length(direction) ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    camera.height = 200;
    return camera;
}

/// α everywhere the same, one feature over everything.
inline TransferFunction homogeneous(double alpha) {
    TransferFunction tf;
    tf.points = {{0, alpha, {1, 0, 0}, false, {}}, {1, alpha, {1, 0, 0}, false, {}}};
    tf.features = {{"all", 0, 1, {1, 0, 0}, {}}};
    return tf;
}

} // namespace pellucid::test
