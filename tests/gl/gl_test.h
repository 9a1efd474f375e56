// What the GL tests share: whether there is a context at all, and small volumes.
#pragma once

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "render/gl/headless_context.h"
#include "saliency/weight_fields.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::testing {

/// False where no context can be made: the reason is printed, and ctest counts the test as skipped. With
/// PELLUCID_REQUIRE_GL=1 the test fails instead.
inline bool haveGl() {
    static const std::string reason = [] {
        try {
            gl::HeadlessContext context;
            return std::string();
        } catch (const Error& error) {
            return std::string(error.what());
        }
    }();
    if (reason.empty()) return true;
    const char* required = std::getenv("PELLUCID_REQUIRE_GL");
    if (required != nullptr && std::string(required) == "1") FAIL("OpenGL is required: " << reason);
    std::cout << "SKIPPED: " << reason << '\n';
    return false;
}

inline std::shared_ptr<const Volume> volumeOf(Int3 dims, std::vector<std::uint8_t> values, Vec3 spacing = {1, 1, 1},
                                              Vec3 origin = {0, 0, 0}) {
    const Volume volume(Geometry{dims, spacing, origin}, Samples(std::move(values)));
    return std::make_shared<const Volume>(volume.withRange({0, 255}));
}

/// Uniform noise: nothing is harder, every voxel is an edge.
inline std::shared_ptr<const Volume> noise(Int3 dims, Vec3 spacing, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> values(voxelCount(dims));
    for (auto& v : values) v = static_cast<std::uint8_t>(random() >> 24);
    return volumeOf(dims, std::move(values), spacing, {3, -2, 1});
}

/// Waves of about twelve world units.
inline std::shared_ptr<const Volume> waves(Int3 dims, Vec3 spacing) {
    std::vector<std::uint8_t> values;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                const Vec3 p = Vec3(i, j, k) * spacing;
                values.push_back(static_cast<std::uint8_t>(127 + 60 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y) +
                                                           60 * std::sin(0.45 * p.z + 0.2 * p.x)));
            }
    return volumeOf(dims, std::move(values), spacing, {3, -2, 1});
}

/// Opacity `alpha` at every intensity, one feature over everything.
inline TransferFunction constantOpacity(double alpha, const Rgb& color = {1, 1, 1}) {
    TransferFunction tf;
    tf.points = {{0.0, alpha, color, false, {}}, {1.0, alpha, color, false, {}}};
    tf.features = {{"all", 0.0, 1.0, color, {}}};
    return tf;
}

inline Camera orthographic(const Geometry& geometry, const Vec3& direction, double height) {
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.center = geometry.boxCenter();
    camera.eye = camera.center - direction * 100.0;
    camera.up = std::abs(direction.z) > 0.9 * std::sqrt(glm::dot(direction, direction)) ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    camera.height = height;
    return camera;
}

inline Camera perspective(const Geometry& geometry, const Vec3& eyeFromCenter) {
    Camera camera;
    camera.center = geometry.boxCenter();
    camera.eye = camera.center + eyeFromCenter;
    camera.up = {0.01, 0.02, 1};
    camera.fovY = 40;
    return camera;
}

inline double worstDifference(const Grid<float>& a, const Grid<float>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    return worst;
}

/// Weights without any pattern that a mistake of one voxel would leave as it is.
inline WeightFields unevenWeights(const Int3& dims) {
    WeightFields weights(dims, 1.0, 2.0);
    for (std::size_t i = 0; i < voxelCount(dims); ++i)
        weights.set(i, static_cast<float>(i * 7919 % 1009) / 1009, static_cast<float>(i * 104729 % 997) / 500);
    return weights;
}

} // namespace pellucid::testing
