// What W_F does when the camera crosses from one sweep axis to another.
#pragma once

#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "render/visibility.h"
#include "support/sample_tf.h"
#include "volume/loader.h"
#include "volume/procedural.h"

namespace pellucid::test {

struct OrbitScene {
    std::string name;
    std::shared_ptr<const Volume> volume;
    TransferFunction tf;
    WeightFields weights;
};

/// Every `step`-th voxel along each axis: the same scene in a size that the reference can walk around.
inline Volume thinned(const Volume& volume, const Int3& step, const Vec3& spacing) {
    const Int3 n = volume.dims(), dims = (n + step - 1) / step;
    std::vector<float> samples;
    samples.reserve(voxelCount(dims));
    const Grid<std::uint8_t> grid(n); // for its index()
    for (int k = 0; k < n.z; k += step.z)
        for (int j = 0; j < n.y; j += step.y)
            for (int i = 0; i < n.x; i += step.x)
                samples.push_back(static_cast<float>(volume.value(grid.index(i, j, k))));
    return Volume({dims, spacing, {}}, Samples(std::move(samples))).withRange(volume.range());
}

/// The knee and the disks of the built-in samples, and the tooth where `sharedDir` has it; isotropic, and with slices
/// three times as far apart as voxels.
inline std::vector<OrbitScene> orbitScenes(const std::string& sharedDir) {
    std::vector<OrbitScene> scenes;
    const auto add = [&](const std::string& name, const Volume& volume, int step, const TransferFunction& tf) {
        for (const bool thick : {false, true}) {
            const auto small = std::make_shared<const Volume>(
                thinned(volume, {step, step, thick ? 3 * step : step}, {1, 1, thick ? 3 : 1}));
            scenes.push_back({name + (thick ? " 1:1:3" : ""), small, tf, saliencyFields(*small, tf)});
        }
    };
    const Volume knee = makeSample("knee", 72), disks = makeSample("disks", 36);
    add("knee", knee, 2, kneeTf(knee));
    add("disks", disks, 1, disksTf());
    const std::string tooth = sharedDir + "/data/real/tooth/tooth.mhd";
    if (std::filesystem::exists(tooth)) {
        VolumeSource source;
        source.path = tooth;
        add("tooth", loadVolume(source), 4, tents(3, 0.3));
    }
    return scenes;
}

/// A path of the eye in steps of 1°, across a place where another axis becomes the nearest to the view.
struct Orbit {
    std::string name;
    std::vector<std::pair<double, double>> views; ///< azimuth, elevation
};

/// Azimuth 40° … 50° (x against y) at elevations 0°, 20° and the diagonal's 35.26°; elevations across 45° (or where the
/// grid's spacing puts it) at azimuth 10° (y against z).
inline std::vector<Orbit> orbits(const Geometry& geometry) {
    std::vector<Orbit> all;
    for (const double elevation : {0.0, 20.0, 35.26}) {
        all.push_back({"azimuths at elevation " + std::to_string(elevation), {}});
        for (int azimuth = 40; azimuth <= 50; ++azimuth) all.back().views.emplace_back(azimuth, elevation);
    }
    constexpr double kDegree = 0.017453292519943295, kAzimuth = 10;
    // Along a ray planes are crossed at |d_y|/s_y and |d_z|/s_z per unit of path: equal where tan el = s_z/s_y·cos az.
    const double even = std::atan(geometry.spacing.z / geometry.spacing.y * std::cos(kAzimuth * kDegree)) / kDegree;
    all.push_back({"elevations at azimuth 10", {}});
    for (int n = -5; n <= 5; ++n) all.back().views.emplace_back(kAzimuth, std::round(even) + n);
    return all;
}

/// Largest step of any W_F between neighbouring views, beyond the step that the reference takes there.
struct OrbitJumps {
    double beyondReference = 0, reference = 0, engine = 0;
};

inline std::vector<std::vector<double>> vwsAlong(VisibilityEngine& engine, const OrbitScene& scene, const Orbit& orbit,
                                                 Projection projection) {
    std::vector<std::vector<double>> all;
    for (const auto& [azimuth, elevation] : orbit.views) {
        const Camera camera = cameraFromView(scene.volume->geometry(), azimuth, elevation, 1, projection);
        all.push_back(vwsOf(engine.sums(camera, {&scene.tf, 1}, &scene.weights)[0]));
    }
    return all;
}

inline OrbitJumps jumpsOf(const std::vector<std::vector<double>>& expected,
                          const std::vector<std::vector<double>>& found) {
    OrbitJumps jumps;
    for (std::size_t n = 1; n < expected.size(); ++n)
        for (std::size_t f = 0; f < expected[n].size(); ++f) {
            const double e = expected[n][f] - expected[n - 1][f], g = found[n][f] - found[n - 1][f];
            jumps.reference = std::max(jumps.reference, std::abs(e));
            jumps.engine = std::max(jumps.engine, std::abs(g));
            jumps.beyondReference = std::max(jumps.beyondReference, std::abs(g - e));
        }
    return jumps;
}

inline constexpr double kLargestJump = 0.005;

/// report(scene, orbit, projection, jumps), if given, sees every figure.
template <class MakeEngine>
void checkOrbits(
    const MakeEngine& makeEngine, const std::string& sharedDir,
    const std::function<void(const OrbitScene&, const Orbit&, Projection, const OrbitJumps&)>& report = {}) {
    for (const OrbitScene& scene : orbitScenes(sharedDir)) {
        const auto reference = makeReferenceEngine(scene.volume);
        const std::unique_ptr<VisibilityEngine> engine = makeEngine(scene.volume);
        for (const Orbit& orbit : orbits(scene.volume->geometry()))
            for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
                const OrbitJumps jumps = jumpsOf(vwsAlong(*reference, scene, orbit, projection),
                                                 vwsAlong(*engine, scene, orbit, projection));
                if (report) report(scene, orbit, projection, jumps);
                INFO(scene.name << ", " << orbit.name
                                << (projection == Projection::Perspective ? ", perspective" : ", orthographic")
                                << ": the reference steps by " << jumps.reference << " at most");
                CHECK(jumps.beyondReference <= kLargestJump);
            }
    }
}

} // namespace pellucid::test
