#include <catch2/catch.hpp>

#include <limits>

#include <glm/gtc/quaternion.hpp>

#include "base/parallel.h"
#include "render/cpu/cpu_engine.h"
#include "render/ray_box.h"
#include "support/engine_checks.h"
#include "support/field_sums.h"
#include "support/random_cases.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

const auto reference = [](std::shared_ptr<const Volume> v) { return makeReferenceEngine(std::move(v)); };
const auto cpu = [](std::shared_ptr<const Volume> v) { return makeCpuEngine(std::move(v)); };

/// A random transfer function: tents, some nearly transparent, some solid, or boxes with vertical sides.
TransferFunction randomTf(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    TransferFunction tf = tents(2 + static_cast<int>(unit(random) * 4));
    if (unit(random) < 0.4) {
        tf = {};
        for (int i = 0; i < 3; ++i) {
            const double a = (i + 0.2) / 3, b = (i + 0.8) / 3;
            const Rgb c = rgbFromHsv(120.0 * i, 1, 1);
            for (const auto& [x, alpha] : {std::pair{a, 0.0}, {a, 0.5}, {b, 0.5}, {b, 0.0}})
                tf.points.push_back({x, alpha, c, false, {}});
            tf.features.push_back({"box" + std::to_string(i), a, b, c, {}});
        }
    }
    const double most = tf.points.size() == 12 && tf.points[0].x == tf.points[1].x ? 0.3 : 1.0;
    std::vector<double> x;
    for (std::size_t f = 0; f < tf.features.size(); ++f) x.push_back(most * std::pow(unit(random), 2));
    return withFeatureOpacities(tf, x);
}

/// Perspective, orthographic, at 45° between axes, and with the eye close to the box.
Camera randomCamera(std::mt19937& random, const Geometry& g, int kind) {
    std::uniform_real_distribution<double> unit(0, 1);
    const double az = 360 * unit(random), el = 160 * unit(random) - 80;
    if (kind == 0) return cameraFromView(g, az, el, 1, Projection::Perspective);
    if (kind == 1) return cameraFromView(g, az, el, 1, Projection::Orthographic);
    if (kind == 2)
        return cameraFromView(g, 45 * std::round(az / 45), 45 * std::round(el / 45), 1, Projection::Orthographic);
    Camera camera = cameraFromView(g, az, el, 1, Projection::Perspective);
    const RayInterval t = intersectBox({camera.eye, camera.forward()}, g.boundsMin(), g.boundsMax());
    camera.eye += camera.forward() * (t.enter * (0.97 - 0.3 * unit(random)));
    return camera;
}

} // namespace

TEST_CASE("a homogeneous block gives v_k = α(1 − α)^k", "[visibility][reference]") { checkHomogeneousBlock(reference); }
TEST_CASE("a homogeneous block gives v_k = α(1 − α)^k on the cpu engine", "[visibility][cpu]") {
    checkHomogeneousBlock(cpu);
}
TEST_CASE("opacity refers to d0, whatever the spacing", "[visibility][reference]") { checkAnisotropicBlock(reference); }
TEST_CASE("opacity refers to d0, whatever the spacing, on the cpu engine", "[visibility][cpu]") {
    checkAnisotropicBlock(cpu);
}
TEST_CASE("invalid voxels are transparent", "[visibility][reference]") { checkInvalidVoxels(reference); }
TEST_CASE("invalid voxels are transparent on the cpu engine", "[visibility][cpu]") { checkInvalidVoxels(cpu); }

TEST_CASE("the cpu engine agrees with the reference", "[visibility][cpu]") {
    std::vector<double> fv, vws;
    for (int n = 0; n < 24; ++n) {
        std::mt19937 random(100 + static_cast<unsigned>(n));
        std::uniform_real_distribution<double> unit(0, 1);
        const auto length = [&] { return 20 + static_cast<int>(unit(random) * 16); };
        const Int3 dims{length(), length(), length()};
        const Vec3 spacing{0.6 + unit(random), 0.6 + unit(random), 0.6 + unit(random)};
        const auto volume = roughVolume(random, dims, spacing);
        const TransferFunction tf = randomTf(random);
        const Camera camera = randomCamera(random, volume->geometry(), n % 4);
        const WeightFields weights = saliencyFields(*volume, tf);
        const auto oracle = makeReferenceEngine(volume);
        INFO("case " << n);
        const Disagreement d = compare(*oracle, *makeCpuEngine(volume), camera, tf, weights);
        CHECK(d.visibilityRms < 0.015);
        CHECK(d.visibility < 0.01);
        CHECK(d.vws < 0.01);
        const Disagreement high = compare(*oracle, *makeCpuEngine(volume, Quality::High), camera, tf, weights);
        CHECK(high.visibilityRms < 0.008);
        CHECK(high.visibility < 0.005);
        CHECK(high.vws < 0.005);
        fv.push_back(d.visibility);
        vws.push_back(d.vws);
    }
    std::nth_element(fv.begin(), fv.begin() + 12, fv.end());
    std::nth_element(vws.begin(), vws.begin() + 12, vws.end());
    CHECK(fv[12] < 0.003);
    CHECK(vws[12] < 0.003);
}

TEST_CASE("many candidates in one call give what each gives alone", "[visibility][cpu]") {
    std::mt19937 random(5);
    const auto volume = roughVolume(random, {20, 18, 22}, {1, 1.3, 0.8});
    const Camera camera = cameraFromView(volume->geometry(), 130, 35, 1, Projection::Perspective);
    const TransferFunction base = tents(3);
    const WeightFields weights = saliencyFields(*volume, base);
    std::vector<TransferFunction> tfs;
    for (int i = 0; i < 11; ++i) tfs.push_back(withFeatureOpacities(base, {0.05 * i, 0.5, 1 - 0.08 * i}));
    const auto engine = makeCpuEngine(volume);
    const auto together = engine->sums(camera, tfs, &weights);
    REQUIRE(together.size() == 11);
    for (std::size_t i = 0; i < tfs.size(); ++i) {
        const FeatureSums alone = engine->sums(camera, {&tfs[i], 1}, &weights)[0];
        const FeatureSums field = sumsOfField(*volume, base.features, engine->field(camera, tfs[i]).values, &weights);
        for (std::size_t f = 0; f < 3; ++f) {
            CHECK(together[i].visibility[f] == Approx(alone.visibility[f]).epsilon(1e-5).margin(1e-9));
            CHECK(together[i].weighted[1][f] == Approx(alone.weighted[1][f]).epsilon(1e-5).margin(1e-9));
            CHECK(field.weighted[0][f] == Approx(alone.weighted[0][f]).epsilon(1e-5).margin(1e-9));
        }
        CHECK(together[i].allVisibility == Approx(alone.allVisibility).epsilon(1e-5));
    }
}

TEST_CASE("the cpu engine gives the same bits for any number of threads", "[visibility][cpu]") {
    std::mt19937 random(6);
    const auto volume = roughVolume(random, {40, 60, 50}, Vec3(1));
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const std::vector<TransferFunction> tfs(8, tf);
    for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, projection);
        std::vector<FeatureSums> results;
        for (const int threads : {1, 2, 3, 8}) {
            setThreadCount(threads);
            results.push_back(makeCpuEngine(volume)->sums(camera, tfs, &weights)[7]);
        }
        setThreadCount(0);
        for (const FeatureSums& r : results) {
            CHECK(r.visibility == results[0].visibility);
            CHECK(r.weighted == results[0].weighted);
            CHECK(r.allVisibility == results[0].allVisibility);
        }
    }
}

TEST_CASE("no voxel is more visible than it is opaque, nor a solid one behind a solid wall at all",
          "[visibility][cpu]") {
    std::mt19937 random(11);
    const auto volume = roughVolume(random, {16, 16, 16}, Vec3(1));
    const TransferFunction tf = tents(3, 0.9);
    for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera camera = cameraFromView(volume->geometry(), 25, 40, 1, projection);
        const Grid<float> v = makeCpuEngine(volume)->field(camera, tf).values;
        for (std::size_t i = 0; i < v.size(); ++i) {
            CHECK(v[i] >= 0);
            CHECK(v[i] <= tf.opacity(volume->intensity(i)) + 1e-4); // codes of 16 bits
        }
    }
    const auto wall = volumeFrom(geometryOf({12, 12, 12}), [](int, int j, int) { return j < 3 ? 1.0 : 0.5; });
    TransferFunction solid = homogeneous(0.5);
    solid.points.back().opacity = 1.0;
    const Grid<float> v = makeCpuEngine(wall)->field(lookingAlong(wall->geometry(), {0, 1, 0}), solid).values;
    CHECK(v.at(5, 0, 5) == Approx(1));
    for (int j = 4; j < 12; ++j) CHECK(v.at(5, j, 5) < 1e-6);
}

TEST_CASE("volumes of one voxel, one row and one slice are measured as the reference does", "[visibility]") {
    std::mt19937 random(3);
    for (const Int3 dims : {Int3(1), Int3(9, 1, 1), Int3(1, 9, 9), Int3(9, 1, 9), Int3(9, 9, 1)}) {
        const auto volume = roughVolume(random, dims, Vec3(1));
        TransferFunction tf = homogeneous(0.3); // from 0.2 on two features, opaque everywhere
        tf.points[0].opacity = 0.2;
        tf.features = {{"low", 0, 0.5, {1, 0, 0}, {}}, {"high", 0.5, 1, {0, 0, 1}, {}}};
        for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
            const Camera camera = cameraFromView(volume->geometry(), 40, 30, 1, projection);
            const FeatureSums found = makeCpuEngine(volume)->sums(camera, {&tf, 1}, nullptr)[0];
            const FeatureSums expected = makeReferenceEngine(volume)->sums(camera, {&tf, 1}, nullptr)[0];
            INFO(dims.x << " x " << dims.y << " x " << dims.z);
            CHECK(found.allVisibility == Approx(expected.allVisibility).epsilon(0.03));
            const auto a = featureMeasures(found), b = featureMeasures(expected);
            for (std::size_t f = 0; f < 2; ++f) CHECK(a[f].visibility == Approx(b[f].visibility).margin(0.005));
        }
    }
}

TEST_CASE("long thin volumes are measured as the reference does, along them too", "[visibility][cpu]") {
    // More slices than are followed finely; lines enter through the sides, or run through all of them.
    std::mt19937 random(29);
    for (const Int3 dims : {Int3(700, 1, 1), Int3(3, 600, 2), Int3(2, 2, 900)}) {
        const auto volume = roughVolume(random, dims, Vec3(1));
        for (const double peak : {0.02, 0.5}) {
            const TransferFunction tf = tents(3, peak);
            const WeightFields weights = saliencyFields(*volume, tf);
            for (const auto& [azimuth, elevation] : {std::pair{90.0, 0.0}, {80.0, 3.0}, {0.0, 0.0}, {10.0, 80.0}})
                for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
                    const Camera camera = cameraFromView(volume->geometry(), azimuth, elevation, 1, projection);
                    const Grid<float> expected = makeReferenceEngine(volume)->field(camera, tf).values;
                    for (const Quality quality : {Quality::Normal, Quality::High}) {
                        const auto engine = makeCpuEngine(volume, quality);
                        INFO(dims.x << " x " << dims.y << " x " << dims.z << " from " << azimuth << ", " << elevation);
                        const Disagreement d = compareWithField(expected, *engine, camera, tf, weights);
                        const double allowed = quality == Quality::High ? 0.005 : 0.01;
                        CHECK(d.visibility < allowed);
                        CHECK(d.vws < allowed);
                        const std::vector<TransferFunction> two{tf, tf};
                        const FeatureSums batch = engine->sums(camera, two, &weights)[1],
                                          alone = engine->sums(camera, {&tf, 1}, &weights)[0];
                        for (std::size_t f = 0; f < 3; ++f)
                            CHECK(batch.visibility[f] ==
                                  Approx(alone.visibility[f]).epsilon(1e-4).margin(1e-4 * alone.allVisibility));
                    }
                }
        }
    }
}

TEST_CASE("the sweeps for every instruction set measure the same", "[visibility][cpu]") {
    std::mt19937 random(17);
    CHECK(sweepKernels().back() == sweepGeneric);
    // Small volumes follow voxels' own lines, large ones do not.
    for (const Int3 dims : {Int3(22, 18, 20), Int3(130, 129, 128)}) {
        const auto rough = roughVolume(random, dims, {1, 1.2, 0.9});
        for (const bool holes : {false, true}) {
            std::vector<float> samples(rough->size());
            for (std::size_t i = 0; i < samples.size(); ++i)
                samples[i] = holes && i % 97 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                  : static_cast<float>(rough->intensity(i));
            const auto volume = std::make_shared<const Volume>(rough->geometry(), Samples(std::move(samples)));
            const TransferFunction tf = tents(3, 0.4);
            const WeightFields weights = saliencyFields(*volume, tf);
            const Camera camera = cameraFromView(volume->geometry(), 40, 25, 1, Projection::Perspective);
            const std::vector<TransferFunction> tfs{tf, withFeatureOpacities(tf, {0.1, 0.9, 0})};
            const auto make = [&](SweepKernel kernel) { return makeCpuEngine(volume, Quality::Normal, kernel); };
            const auto generic = make(sweepGeneric);
            const Grid<float> field = generic->field(camera, tf).values;
            const auto sums = generic->sums(camera, tfs, &weights);
            const SumsJacobian jacobian = generic->jacobian(camera, tf, &weights);
            for (const SweepKernel kernel : sweepKernels()) {
                const auto engine = make(kernel);
                const Grid<float> found = engine->field(camera, tf).values;
                // Of 1e5 rays a few round to the other side of a decision: whether a block is exhausted, or followed.
                double worst = 0, squares = 0;
                for (std::size_t i = 0; i < field.size(); ++i) {
                    const double difference = std::abs(static_cast<double>(found[i]) - static_cast<double>(field[i]));
                    worst = std::max(worst, difference);
                    squares += difference * difference;
                }
                CHECK(worst < 0.02);
                CHECK(std::sqrt(squares / static_cast<double>(field.size())) < 1e-4);
                const auto close = [&](const FeatureSums& a, const FeatureSums& b, double all) {
                    for (std::size_t f = 0; f < 3; ++f) {
                        CHECK(a.visibility[f] == Approx(b.visibility[f]).epsilon(1e-4).margin(1e-4 * all));
                        CHECK(a.weighted[1][f] == Approx(b.weighted[1][f]).epsilon(1e-4).margin(1e-4 * all));
                    }
                };
                const auto foundSums = engine->sums(camera, tfs, &weights);
                for (std::size_t i = 0; i < tfs.size(); ++i) close(foundSums[i], sums[i], sums[i].allVisibility);
                const SumsJacobian foundJacobian = engine->jacobian(camera, tf, &weights);
                for (std::size_t j = 0; j < 3; ++j)
                    close(foundJacobian.byOpacity[j], jacobian.byOpacity[j], jacobian.sums.allVisibility);
            }
        }
    }
}

TEST_CASE("progress grows to 1, however many sweeps there are", "[visibility][cpu]") {
    std::mt19937 random(9);
    const auto volume = roughVolume(random, {20, 20, 20}, Vec3(1));
    Camera camera = cameraFromView(volume->geometry(), 40, 30, 1, Projection::Perspective);
    camera.eye = volume->geometry().boundsMax() + Vec3(1, 1, 1); // so near that several axes share the voxels
    const std::vector<TransferFunction> tfs(17, tents(3));
    const TransferFunction many = tents(20);
    const auto engine = makeCpuEngine(volume);
    setThreadCount(1); // in order
    for (const bool derivatives : {false, true}) {
        std::vector<double> told;
        const JobControl job{{}, [&](double f) { told.push_back(f); }};
        if (derivatives)
            engine->jacobian(camera, many, nullptr, job);
        else
            engine->sums(camera, tfs, nullptr, job);
        REQUIRE(told.size() > 10);
        CHECK(std::is_sorted(told.begin(), told.end()));
        CHECK(told.front() < 0.2);
        CHECK(told.back() == Approx(1));
    }
    setThreadCount(0);
}

TEST_CASE("an engine that was stopped in the middle measures as before", "[visibility]") {
    std::mt19937 random(13);
    const auto volume = roughVolume(random, {30, 24, 28}, Vec3(1));
    const TransferFunction tf = tents(3);
    const Camera camera = cameraFromView(volume->geometry(), 40, 30, 1, Projection::Perspective);
    for (const auto& engine : {makeReferenceEngine(volume, 2), makeCpuEngine(volume)}) {
        const FeatureSums before = engine->sums(camera, {&tf, 1}, nullptr)[0];
        std::stop_source stop;
        CHECK_THROWS_AS(
            engine->sums(camera, {&tf, 1}, nullptr, {stop.get_token(), [&](double) { stop.request_stop(); }}),
            Cancelled);
        CHECK(engine->sums(camera, {&tf, 1}, nullptr)[0].visibility == before.visibility);
    }
}

TEST_CASE("volumes with nothing to see have sums of 0", "[visibility]") {
    const auto nothing = volumeFrom(geometryOf({5, 5, 5}), [](int, int, int) { return std::nan(""); }, {});
    const TransferFunction tf = tents(3);
    for (const auto& engine : {makeReferenceEngine(nothing), makeCpuEngine(nothing)}) {
        const FeatureSums sums =
            engine->sums(cameraFromView(nothing->geometry(), 0, 0, 1, Projection::Perspective), {&tf, 1}, nullptr)[0];
        CHECK(sums.allVisibility == 0);
        CHECK(featureMeasures(sums)[0].vws == 0);
    }
}

TEST_CASE("an engine hears a stop and refuses a camera inside the box", "[visibility]") {
    const auto volume = slab({8, 8, 8}, 0.5);
    std::stop_source stop;
    stop.request_stop();
    Camera camera = cameraFromView(volume->geometry(), 0, 0, 1, Projection::Perspective);
    for (const auto& engine : {makeReferenceEngine(volume), makeCpuEngine(volume)})
        CHECK_THROWS_AS(engine->field(camera, tents(3), {stop.get_token(), {}}), Cancelled);
    camera.eye = volume->geometry().boxCenter() + Vec3(0, 1, 0);
    for (const auto& engine : {makeReferenceEngine(volume), makeCpuEngine(volume)})
        CHECK_THROWS_AS(engine->field(camera, tents(3)), Error);
}

TEST_CASE("slices far apart, and eyes far off, are no obstacle to the cpu engine", "[visibility][cpu]") {
    std::mt19937 random(7);
    const auto check = [](const std::shared_ptr<const Volume>& volume, const Camera& camera) {
        const TransferFunction tf = tents(3, 0.3);
        const auto a = makeCpuEngine(volume)->sums(camera, {&tf, 1}, nullptr, {});
        const auto b = makeReferenceEngine(volume)->sums(camera, {&tf, 1}, nullptr, {});
        for (std::size_t f = 0; f < 3; ++f)
            CHECK(a[0].visibility[f] / a[0].allVisibility ==
                  Approx(b[0].visibility[f] / b[0].allVisibility).margin(0.01));
    };
    for (const Vec3 spacing : {Vec3(1, 1, 1000), Vec3(1, 1000, 1), Vec3(1, 1000, 1000)}) {
        const auto volume = roughVolume(random, {8, 8, 8}, spacing);
        for (const auto projection : {Projection::Perspective, Projection::Orthographic})
            check(volume, cameraFromView(volume->geometry(), 40, 40, 1, projection));
    }
    const auto volume = roughVolume(random, {8, 8, 8}, Vec3(1));
    Camera camera = cameraFromView(volume->geometry(), 40, 40, 1, Projection::Perspective);
    for (const double distance : {1e10, 1e30}) {
        camera.eye = camera.center + Vec3(1, -2, 1) * distance;
        check(volume, camera);
    }
}

namespace {

/// A random map of the world onto itself: a turn, mirrored or not, then sheared by up to `shear` (tangent).
Mat3 randomMap(Random& random, double shear) {
    const Vec3 axis = glm::normalize(Vec3(random.between(-1, 1), random.between(-1, 1), random.between(0.1, 1)));
    Mat3 map = glm::mat3_cast(glm::angleAxis(random.between(0, 6.3), axis));
    if (random.chance(0.5)) map[random.below(3)] *= -1.0;
    Mat3 sheared(1);
    sheared[1].x = random.between(-shear, shear);
    sheared[2].x = random.between(-shear, shear);
    sheared[2].y = random.between(-shear, shear);
    return map * sheared;
}

/// The same voxels where `map` brings them; the camera goes along.
void moveBy(const Mat3& map, RandomCase& c) {
    Geometry g = c.volume->geometry();
    const Mat3 axes = map * g.worldFromIndex();
    for (int a = 0; a < 3; ++a) {
        g.spacing[a] = glm::length(axes[a]);
        g.directions[a] = axes[a] / g.spacing[a];
    }
    const Vec3 shift(3, -5, 7);
    g.origin = map * g.origin + shift;
    c.volume = std::make_shared<const Volume>(
        Volume(g, c.volume->samples(), c.volume->missing()).withRange(c.volume->range()));
    c.camera.eye = map * c.camera.eye + shift;
    c.camera.center = map * c.camera.center + shift;
    c.camera.up = map * c.camera.up;
}

/// A part of the box, and up to three planes that leave the middle of it.
Clipping randomClipping(Random& random, const Geometry& g) {
    Clipping clipping;
    for (int a = 0; a < 3; ++a)
        if (random.chance(0.4)) {
            clipping.lo[a] = random.between(0, 0.4);
            clipping.hi[a] = random.between(0.6, 1);
        }
    for (int n = random.below(4); n > 0; --n) {
        const Vec3 normal = glm::normalize(Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
        clipping.planes.push_back(
            {normal * 2.0, 2 * (glm::dot(normal, g.boxCenter()) + random.between(-0.1, 0.5) * g.radius())});
    }
    return clipping;
}

} // namespace

TEST_CASE("a turned, mirrored and sheared grid is measured as the reference does", "[visibility][cpu][affine]") {
    for (std::uint32_t n = 0; n < 24; ++n) {
        Random random(n);
        RandomCase c = randomCase(n);
        if (c.tfKind.find("boxes") != std::string::npos) continue; // vertical sides: a sample more or less decides
        moveBy(randomMap(random, 0.35), c);                        // up to 19°
        INFO(c.describe());
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const auto engine = makeCpuEngine(c.volume), oracle = makeReferenceEngine(c.volume, 8);
        const Disagreement d = compare(*oracle, *engine, c.camera, c.tf, weights);
        CAPTURE(n, d.visibilityRms, d.visibility, d.vws);
        CHECK(d.visibilityRms < kNormalTolerances.visibilityRms);
        CHECK(d.visibility < kNormalTolerances.figure);
        CHECK(d.vws < kNormalTolerances.figure);
    }
}

TEST_CASE("a turn or mirroring of the whole world changes no figure", "[visibility][reference][cpu][affine]") {
    for (std::uint32_t n = 0; n < 12; ++n) {
        Random random(n);
        const RandomCase c = randomCase(n, 0.5);
        RandomCase moved = c;
        moveBy(randomMap(random, 0), moved);
        INFO(c.describe());
        for (const bool fast : {false, true}) {
            const auto of = [&](const RandomCase& what) {
                const auto engine = fast ? makeCpuEngine(what.volume) : makeReferenceEngine(what.volume, 2);
                return featureMeasures(engine->sums(what.camera, {&what.tf, 1}, nullptr)[0]);
            };
            const auto before = of(c), after = of(moved);
            for (std::size_t f = 0; f < before.size(); ++f)
                CHECK(after[f].visibility == Approx(before[f].visibility).margin(fast ? 2e-3 : 1e-4));
        }
    }
}

TEST_CASE("what is clipped away is neither seen nor hides, and what is faint hides as far as it is drawn",
          "[visibility][cpu][clip]") {
    for (std::uint32_t n = 0; n < 72; ++n) {
        Random random(n + 100);
        RandomCase c = randomCase(n);
        if (n % 2 == 1) moveBy(randomMap(random, 0.2), c);
        View view(c.camera, randomClipping(random, c.volume->geometry()));
        // In so few voxels boxes leave coarse steps of the reference off by 0.03 of W.
        if (n >= 36) view.clipping.rest = {view.clipping.part(), random.between(0.02, 0.6)};
        if (n >= 36) view.clipping.setPart(randomClipping(random, c.volume->geometry()).part());
        INFO(c.describe() << ", density of the rest " << view.clipping.rest.density);
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const auto engine = makeCpuEngine(c.volume), oracle = makeReferenceEngine(c.volume, n >= 36 ? 48 : 8);
        const Disagreement d = compare(*oracle, *engine, view, c.tf, weights);
        CAPTURE(n, d.visibilityRms, d.visibility, d.vws);
        CHECK(d.visibilityRms < kNormalTolerances.visibilityRms);
        CHECK(d.visibility < kNormalTolerances.figure);
        CHECK(d.vws < kNormalTolerances.figure);
    }
}
