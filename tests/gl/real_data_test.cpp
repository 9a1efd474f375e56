// The three engines on real volumes: the figures of docs/method.md, "Tolerances", from all sides.
#include <catch2/catch.hpp>

#include <filesystem>

#include "gl_test.h"
#include "render/gl/gl_engines.h"
#include "support/engine_checks.h"
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
