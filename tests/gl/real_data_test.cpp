// The three engines on real volumes: the figures of docs/method.md, "Tolerances", from all sides.
#include <catch2/catch.hpp>

#include <filesystem>

#include "engines/engines.h"
#include "gl_test.h"
#include "render/gl/gl_engines.h"
#include "support/engine_checks.h"
#include "support/orientation_check.h"
#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("reference, cpu and gl agree on the nucleon", "[gl][real]") {
    const std::string path = std::string(PELLUCID_SHARED_DIR) + "/data/real/nucleon/nucleon.mhd";
    if (!std::filesystem::exists(path)) {
        WARN("SKIPPED: there is no " << path);
        return;
    }
    if (!testing::haveGl()) return;
    VolumeSource source;
    source.path = path;
    const auto volume = std::make_shared<const Volume>(loadVolume(source));
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const auto reference = makeReferenceEngine(volume), cpu = makeCpuEngine(volume), gl = makeGlEngine(volume);
    for (const auto& [azimuth, elevation] : {std::pair{30.0, 20.0}, {0.0, 0.0}, {-120.0, -50.0}})
        for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
            const Camera camera = cameraFromView(volume->geometry(), azimuth, elevation, 1, projection);
            for (const auto& [a, b] :
                 {std::pair{reference.get(), cpu.get()}, {reference.get(), gl.get()}, {cpu.get(), gl.get()}}) {
                const Disagreement d = compare(*a, *b, camera, tf, weights);
                INFO(a->name() << " against " << b->name() << " from " << azimuth << ", " << elevation);
                CHECK(d.visibilityRms < 0.015);
                CHECK(d.visibility < 0.003);
                CHECK(d.vws < 0.003);
            }
        }
}

// Files whose axes run in different ways, and the same voxels stored in two other orders: mirrored, and with the axes
// exchanged. All lie at the same place in the world. (The skull's CT tells nothing new, and takes long.)
TEST_CASE("real volumes look and measure the same, however they are stored, on all engines", "[gl][real][affine]") {
    if (!testing::haveGl()) return;
    for (const char* name : {"nifti/ch2.nii.gz", "nrrd/FLAIR.nrrd", "mha/epi_short.mha"}) {
        const std::string path = std::string(PELLUCID_SHARED_DIR) + "/data/real/" + name;
        if (!std::filesystem::exists(path)) {
            WARN("SKIPPED: there is no " << path);
            return;
        }
        VolumeSource source;
        source.path = path;
        source.downsample = std::string(name) == "mha/epi_short.mha" ? 1 : 3; // what storage means does not need all
        const auto volume = std::make_shared<const Volume>(loadVolume(source));
        const Geometry& g = volume->geometry();
        REQUIRE(g.worldAxes == WorldAxes::Patient);
        const TransferFunction tf = withFeatureOpacities(tents(3), {0.1, 0.1, 0.4});
        const Camera camera = cameraFromView(g, 25, 15, 1.2, Projection::Perspective);
        const Mat3& d = g.directions;
        const Vec3& s = g.spacing;
        std::vector<Oriented> stored{{"as it is", volume}};
        for (const auto& [how, grid] : {std::pair{"mirrored", regridded(g, g.dims, Mat3(-d[0], d[1], -d[2]), s)},
                                        {"axes exchanged", regridded(g, {g.dims.z, g.dims.x, g.dims.y},
                                                                     Mat3(d[2], d[0], d[1]), {s.z, s.x, s.y})}})
            stored.push_back({how, std::make_shared<const Volume>(
                                       Volume(grid, sampledOn(grid, *volume, 0)).withRange(volume->range()))});
        std::vector<FeatureMeasures> first;
        Image picture;
        for (const Oriented& o : stored) {
            const WeightFields weights = saliencyFields(*o.volume, tf);
            for (const EngineChoice choice : {EngineChoice::Cpu, EngineChoice::Gl, EngineChoice::Slices}) {
                const auto engine = makeEngine(choice, o.volume);
                const auto now = featureMeasures(engine->sums(camera, {&tf, 1}, &weights)[0]);
                if (first.empty()) first = now;
                for (std::size_t f = 0; f < now.size(); ++f) {
                    INFO(name << ", " << o.name << ", " << engine->name() << ", feature " << f);
                    CHECK(std::abs(now[f].visibility - first[f].visibility) < 0.01);
                    CHECK(std::abs(now[f].vws - first[f].vws) < 0.01);
                }
            }
            RenderSettings settings;
            settings.width = settings.height = 160;
            settings.light.on = true;
            for (const EngineChoice choice : {EngineChoice::Cpu, EngineChoice::Gl}) {
                const Image now = makeRenderer(choice, o.volume)->render(camera, tf, settings);
                if (picture.width == 0) picture = now;
                INFO(name << ", " << o.name << (choice == EngineChoice::Gl ? ", gl" : ", cpu"));
                CHECK(ssim(now, picture) > 0.97);
            }
        }
    }
}

TEST_CASE("however a file stores an anatomy, gl and slices measure and draw the same", "[gl][affine][files]") {
    if (!testing::haveGl()) return;
    const OrientationCase anatomy(36);
    for (const EngineChoice choice : {EngineChoice::Gl, EngineChoice::Slices})
        checkOrientationsMeasure(
            anatomy, [&](auto v) { return makeEngine(choice, std::move(v)); }, 0.01);
    checkOrientationsLook(anatomy, [](auto v) { return makeGlRenderer(std::move(v)); });
}
