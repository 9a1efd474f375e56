#include "gl_test.h"

#include <array>

#include "base/parallel.h"
#include "render/gl/engine_budgets.h"
#include "render/gl/gl_engines.h"
#include "render/gl/gl_resources.h"
#include "support/engine_checks.h"
#include "support/field_sums.h"

using namespace pellucid;
using namespace pellucid::testing;
using pellucid::test::sumsOfField;

namespace {

struct Deviation {
    double rms = 0;   ///< of the field, as a share of the expected field's maximum
    double worst = 0; ///< of any voxel
    double share = 0; ///< of any FV_F
};

Deviation deviation(const Volume& volume, const TransferFunction& tf, const Grid<float>& found,
                    const Grid<float>& expected) {
    Deviation d;
    double largest = 0, sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double e = static_cast<double>(found[i]) - static_cast<double>(expected[i]);
        largest = std::max(largest, static_cast<double>(expected[i]));
        d.worst = std::max(d.worst, std::abs(e));
        sum += e * e;
    }
    REQUIRE(largest > 0);
    d.rms = std::sqrt(sum / static_cast<double>(found.size())) / largest;
    const auto a = featureMeasures(sumsOfField(volume, tf.features, found, nullptr));
    const auto b = featureMeasures(sumsOfField(volume, tf.features, expected, nullptr));
    for (std::size_t f = 0; f < a.size(); ++f) d.share = std::max(d.share, std::abs(a[f].visibility - b[f].visibility));
    return d;
}

std::vector<std::pair<std::string, Camera>> everyKindOfView(const Geometry& g) {
    const Vec3 half = 0.5 * (g.boundsMax() - g.boundsMin());
    return {{"along an axis", orthographic(g, {0, 0, -1}, 40)},
            {"at 45 degrees", orthographic(g, {1, 1, 0}, 40)},
            {"along a diagonal", orthographic(g, {1, -1, 1}, 40)},
            {"nearly along an axis", orthographic(g, {0.05, 1, 0.02}, 40)},
            {"from afar", perspective(g, {30, -60, 20})},
            {"from close", perspective(g, {3, -half.y - 1.5, -2})},
            {"from a corner", perspective(g, half + Vec3(0.5, 0.6, 0.4))},
            {"touching", perspective(g, {0, 0, half.z + 0.1})}};
}

} // namespace

TEST_CASE("a homogeneous slab shows alpha (1 - alpha)^k along all six axes", "[gl]") {
    if (!haveGl()) return;
    // docs/method.md, "Visibility": in a homogeneous block seen along an axis v_k = α(1−α)^k for the k-th voxel plane
    // from the eye.
    const Int3 dims(7, 8, 9);
    const auto volume = volumeOf(dims, std::vector<std::uint8_t>(voxelCount(dims), 100));
    const double alpha = 0.2;
    const auto engine = makeGlEngine(volume);
    for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {1, -1}) {
            Vec3 direction(0);
            direction[axis] = sign;
            const auto field =
                engine->field(orthographic(volume->geometry(), direction, 20), constantOpacity(alpha)).values;
            double worst = 0;
            for (int k = 0; k < dims.z; ++k)
                for (int j = 0; j < dims.y; ++j)
                    for (int i = 0; i < dims.x; ++i) {
                        const int along = Int3(i, j, k)[axis];
                        const int behind = sign > 0 ? along : dims[axis] - 1 - along;
                        const double expected = alpha * std::pow(1 - alpha, behind);
                        worst = std::max(worst, std::abs(static_cast<double>(field.at(i, j, k)) - expected));
                    }
            CAPTURE(axis, sign);
            CHECK(worst < 1e-4);
        }
}

TEST_CASE("columns that are homogeneous along the view are exact however they differ", "[gl]") {
    if (!haveGl()) return;
    // Spacing 2 along the view and 1 = d0 across: each voxel is 2 d0 long. In front of voxel k lie k voxels and, up to
    // the point d0/2 in front of its centre, another half d0: T = (1−α)^(2k + ½).
    const Int3 dims(6, 10, 5);
    const Vec3 spacing(1, 2, 1.5);
    std::vector<std::uint8_t> values;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) values.push_back(static_cast<std::uint8_t>((i * 97 + k * 55) % 256));
    const auto volume = volumeOf(dims, values, spacing);
    const TransferFunction tf = tents(3, 0.7);
    const auto field = makeGlEngine(volume)->field(orthographic(volume->geometry(), {0, 1, 0}, 20), tf).values;
    double worst = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double alpha = tf.opacity(volume->intensity(i));
        const auto j = static_cast<double>(i / static_cast<std::size_t>(dims.x) % static_cast<std::size_t>(dims.y));
        worst = std::max(worst, std::abs(static_cast<double>(field[i]) - alpha * std::pow(1 - alpha, 2 * j + 0.5)));
    }
    CHECK(worst < 1e-4);
}

TEST_CASE("gl agrees with the reference within the tolerances, whatever the view", "[gl]") {
    if (!haveGl()) return;
    const std::vector<std::shared_ptr<const Volume>> volumes{
        noise({20, 16, 12}, {1, 1, 1}, 5), noise({16, 20, 9}, {1, 0.7, 2.2}, 6), waves({20, 16, 18}, {1, 1, 1}),
        waves({16, 20, 9}, {1, 0.7, 2.2})};
    std::vector<double> shares;
    for (const auto& volume : volumes) {
        const auto reference = makeReferenceEngine(volume);
        const auto normal = makeGlEngine(volume), high = makeGlEngine(volume, Quality::High);
        for (const auto& [view, camera] : everyKindOfView(volume->geometry()))
            for (const double peak : {0.08, 0.6}) {
                const TransferFunction tf = tents(3, peak);
                CAPTURE(view, peak, volume->dims().x, volume->geometry().spacing.z);
                const auto expected = reference->field(camera, tf).values;
                const Deviation d = deviation(*volume, tf, normal->field(camera, tf).values, expected);
                CHECK(d.rms < 0.015);
                CHECK(d.share < 0.01);
                shares.push_back(d.share);
                const Deviation h = deviation(*volume, tf, high->field(camera, tf).values, expected);
                CHECK(h.rms < 0.008);
                CHECK(h.share < 0.005);
            }
    }
    std::sort(shares.begin(), shares.end());
    CHECK(shares[shares.size() / 2] < 0.003);
}

TEST_CASE("gl measures grids that are turned, mirrored and sheared", "[gl][affine]") {
    if (!haveGl()) return;
    test::checkAffine([](auto volume) { return makeGlEngine(volume); }, 30);
    test::checkAffine([](auto volume) { return makeGlEngine(volume, Quality::High); }, 10, test::kHighTolerances);
}

TEST_CASE("gl measures what clipping leaves", "[gl][clip]") {
    if (!haveGl()) return;
    const auto make = [](auto volume) { return makeGlEngine(volume); };
    test::checkClippedBlock(make);
    test::checkClipping(make, 30);
    test::checkFaintRest(make, 20);
    test::checkClipping([](auto volume) { return makeGlEngine(volume, Quality::High); }, 10, test::kHighTolerances);
}

TEST_CASE("gl measures one anatomy in eight orientations alike", "[gl][affine]") {
    if (!haveGl()) return;
    test::checkOrientations([](auto volume) { return makeGlEngine(volume); }, 0.01);
}

TEST_CASE("invalid voxels are transparent and shade nothing", "[gl]") {
    if (!haveGl()) return;
    const Int3 dims(10, 9, 8);
    std::mt19937 random(3);
    std::vector<float> values(voxelCount(dims));
    for (auto& v : values) v = static_cast<float>(random() % 1000);
    for (std::size_t i = 0; i < values.size(); i += 5) values[i] = std::nanf("");
    const auto volume = std::make_shared<const Volume>(Geometry{dims, {1, 1.2, 1}, {0, 0, 0}}, Samples(values));
    const TransferFunction tf = tents(3, 0.5);
    const auto reference = makeReferenceEngine(volume);
    const auto engine = makeGlEngine(volume);
    for (const auto& [view, camera] : everyKindOfView(volume->geometry())) {
        CAPTURE(view);
        const auto found = engine->field(camera, tf).values;
        for (std::size_t i = 0; i < found.size(); i += 5) REQUIRE(found[i] == 0.0f);
        CHECK(deviation(*volume, tf, found, reference->field(camera, tf).values).rms < 0.015);
    }
}

TEST_CASE("the disk in front has the greatest feature visibility, from either side", "[gl]") {
    if (!haveGl()) return;
    // Fig. 4.1, 4.5, 4.6: three solid disks one behind the other along x, of three intensities.
    const Int3 dims(24, 20, 20);
    std::vector<std::uint8_t> values(voxelCount(dims), 0);
    const std::array<int, 3> start{3, 10, 17};
    for (std::size_t disk = 0; disk < 3; ++disk)
        for (int k = 0; k < dims.z; ++k)
            for (int j = 0; j < dims.y; ++j)
                if ((j - 9.5) * (j - 9.5) + (k - 9.5) * (k - 9.5) < 64)
                    for (int i = start[disk]; i < start[disk] + 4; ++i)
                        values[static_cast<std::size_t>(i + dims.x * (j + dims.y * k))] =
                            static_cast<std::uint8_t>(255 * (2 * disk + 1) / 6); // the middle of tent `disk`
    const auto volume = volumeOf(dims, values);
    const TransferFunction tf = tents(3, 0.3);
    const auto engine = makeGlEngine(volume);
    for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
        Camera camera = orthographic(volume->geometry(), {1, 0, 0}, 25);
        camera.projection = projection;
        const auto left = featureMeasures(engine->sums(camera, {&tf, 1}, nullptr)[0]);
        CHECK(left[0].visibility > left[1].visibility);
        CHECK(left[1].visibility > left[2].visibility);
        camera.eye.x = 2 * camera.center.x - camera.eye.x;
        const auto right = featureMeasures(engine->sums(camera, {&tf, 1}, nullptr)[0]);
        CHECK(right[2].visibility > right[1].visibility);
        CHECK(right[1].visibility > right[0].visibility);
        for (std::size_t f = 0; f < 3; ++f) CHECK(right[f].visibility == Approx(left[2 - f].visibility).margin(0.01));
    }
}

TEST_CASE("sums of a batch are those of the single fields", "[gl]") {
    if (!haveGl()) return;
    const auto volume = noise({14, 11, 9}, {1, 1.3, 0.8}, 9);
    WeightFields weights(volume->dims(), 1, 1);
    for (std::size_t i = 0; i < volume->size(); ++i)
        weights.set(i, static_cast<float>(i % 7) / 7, static_cast<float>(i % 11) / 11);
    std::vector<TransferFunction> tfs; // nine: one full group of lanes and one alone
    for (int i = 0; i < 9; ++i) tfs.push_back(withFeatureOpacities(tents(3, 0.4), {0.1 * i, 0.3, 0.9 - 0.1 * i}));
    const auto engine = makeGlEngine(volume);
    gl::VisibilityBudget small; // the light of eight candidates does not fit in: fewer at a time
    small.bufferBytes = 100e3;
    const auto smaller = gl::makeGlEngine(volume, Quality::Normal, small);
    for (const auto& [view, camera] : everyKindOfView(volume->geometry())) {
        CAPTURE(view);
        const auto batch = engine->sums(camera, tfs, &weights), few = smaller->sums(camera, tfs, &weights);
        REQUIRE(few.size() == tfs.size());
        for (std::size_t t = 0; t < tfs.size(); ++t)
            CHECK(few[t].allVisibility == Approx(batch[t].allVisibility).epsilon(0.01));
        REQUIRE(batch.size() == tfs.size());
        for (std::size_t t = 0; t < tfs.size(); ++t) {
            const auto single = sumsOfField(*volume, tfs[t].features, engine->field(camera, tfs[t]).values, &weights);
            // Lanes decide together which rays to follow, so a lane may be the more exact for its neighbours.
            CHECK(batch[t].allVisibility == Approx(single.allVisibility).epsilon(0.01));
            for (std::size_t n = 0; n < 2; ++n)
                CHECK(batch[t].allWeighted[n] == Approx(single.allWeighted[n]).epsilon(0.01));
            for (std::size_t f = 0; f < 3; ++f) {
                CHECK(batch[t].visibility[f] == Approx(single.visibility[f]).epsilon(0.015).margin(0.01));
                for (std::size_t n = 0; n < 2; ++n)
                    CHECK(batch[t].weighted[n][f] == Approx(single.weighted[n][f]).epsilon(0.015).margin(0.01));
            }
        }
    }
}

TEST_CASE("a volume swept in bricks has the same visibility", "[gl][slow]") {
    if (!haveGl()) return;
    const Int3 dims(90, 26, 41);
    std::mt19937 random(8);
    std::vector<float> holes(voxelCount(dims));
    for (auto& v : holes) v = random() % 50 == 0 ? std::nanf("") : static_cast<float>(random() % 1000);
    const auto invalid = std::make_shared<const Volume>(Geometry{dims, {1, 1.3, 0.8}, {0, 0, 0}}, Samples(holes));
    const WeightFields weights = unevenWeights(dims);
    const TransferFunction tf = tents(3, 0.4);
    for (const auto& volume : {noise(dims, {1, 1, 1.6}, 4), invalid}) {
        const auto whole = makeGlEngine(volume);
        // 24 planes of y at a time, 37 of z, 83 of x, and little for everything else.
        gl::VisibilityBudget tiny;
        tiny.volumeBytes = 24 * 90 * 41 * (volume == invalid ? 8.0 : 6.0);
        tiny.voxelsPerStep = 3 * 90 * 41;
        tiny.bufferBytes = 4e6;
        gl::VisibilityBudget both = tiny;
        both.textureSize = 64; // 90 voxels in two bricks
        for (const auto& [budget, name] : {std::pair{tiny, "windows"}, {both, "windows, folded"}}) {
            const auto pieces = gl::makeGlEngine(volume, Quality::Normal, budget);
            for (const auto& [view, camera] : everyKindOfView(volume->geometry())) {
                CAPTURE(view, name);
                CHECK(worstDifference(whole->field(camera, tf).values, pieces->field(camera, tf).values) < 1e-5);
                const FeatureSums a = whole->sums(camera, {&tf, 1}, &weights)[0],
                                  b = pieces->sums(camera, {&tf, 1}, &weights)[0];
                for (std::size_t f = 0; f < 3; ++f) {
                    CHECK(b.visibility[f] == Approx(a.visibility[f]).epsilon(1e-5));
                    for (std::size_t n = 0; n < 2; ++n)
                        CHECK(b.weighted[n][f] == Approx(a.weighted[n][f]).epsilon(1e-5));
                }
            }
        }
    }
}

TEST_CASE("sums on the device are exact and the same in every run", "[gl]") {
    if (!haveGl()) return;
    const auto volume = noise({29, 23, 34}, {1, 1, 1}, 14);
    const WeightFields weights = unevenWeights(volume->dims());
    const auto engine = makeGlEngine(volume), another = makeGlEngine(volume);
    for (const auto& [view, camera] : everyKindOfView(volume->geometry()))
        for (const int features : {1, 3, 30}) {
            CAPTURE(view, features);
            const TransferFunction tf = tents(features, 0.2);
            const FeatureSums sums = engine->sums(camera, {&tf, 1}, &weights)[0];
            const FeatureSums expected = sumsOfField(*volume, tf.features, engine->field(camera, tf).values, &weights);
            for (std::size_t f = 0; f < tf.features.size(); ++f) {
                CHECK(sums.visibility[f] == Approx(expected.visibility[f]).epsilon(1e-5));
                for (std::size_t n = 0; n < 2; ++n)
                    CHECK(sums.weighted[n][f] == Approx(expected.weighted[n][f]).epsilon(1e-5));
            }
            CHECK(sums.allVisibility == Approx(expected.allVisibility).epsilon(1e-5));
            const FeatureSums again = another->sums(camera, {&tf, 1}, &weights)[0];
            CHECK(again.visibility == sums.visibility); // the same bits
            CHECK(again.weighted == sums.weighted);
        }
}

TEST_CASE("weights that change between two calls count", "[gl]") {
    if (!haveGl()) return;
    const auto volume = noise({12, 11, 10}, {1, 1, 1}, 3);
    const Camera camera = perspective(volume->geometry(), {5, -30, 8});
    const TransferFunction tf = tents(3, 0.3);
    const auto engine = makeGlEngine(volume);
    WeightFields weights = unevenWeights(volume->dims());
    const FeatureSums before = engine->sums(camera, {&tf, 1}, &weights)[0];
    for (std::size_t i = 0; i < weights.size(); ++i) weights.set(i, 0.5f * weights.brightness(i), 0.0f);
    const FeatureSums after = engine->sums(camera, {&tf, 1}, &weights)[0];
    CHECK(after.allVisibility == before.allVisibility);
    CHECK(after.allWeighted[0] == Approx(0.5 * before.allWeighted[0]).epsilon(1e-3)); // rounded to 16 bits
    CHECK(after.allWeighted[1] == 0);
    const FeatureSums none = engine->sums(camera, {&tf, 1}, nullptr)[0];
    CHECK(none.allWeighted[0] == 0);
    CHECK(none.allVisibility == before.allVisibility);
}

TEST_CASE("calls in a row make nothing anew on the device", "[gl]") {
    if (!haveGl()) return;
    const struct Restore {
        ~Restore() { gl::limitAllocations(std::numeric_limits<double>::infinity()); }
    } restore;
    const auto volume = noise({18, 17, 16}, {1, 1, 1}, 3);
    const Camera camera = perspective(volume->geometry(), {5, -40, 8});
    const WeightFields weights = unevenWeights(volume->dims());
    std::vector<TransferFunction> tfs, others;
    for (int i = 0; i < 8; ++i) {
        tfs.push_back(tents(3, 0.1 + 0.1 * i));
        others.push_back(tents(3, 0.15 + 0.1 * i));
    }
    const auto engine = makeGlEngine(volume);
    const auto first = engine->sums(camera, tfs, &weights);
    gl::limitAllocations(0); // from here on everything asked for is refused
    CHECK(engine->sums(camera, others, &weights)[7].visibility != first[7].visibility);
    CHECK(engine->sums(camera, tfs, &weights)[7].visibility == first[7].visibility);
    CHECK(engine->sums(camera, {tfs.data(), 1}, &weights)[0].allVisibility ==
          Approx(first[0].allVisibility).epsilon(0.01));
}

TEST_CASE("a device without memory is used in bricks, or an error says what to do", "[gl]") {
    if (!haveGl()) return;
    const struct Restore {
        ~Restore() { gl::limitAllocations(std::numeric_limits<double>::infinity()); }
    } restore;
    const auto volume = noise({24, 20, 300}, {1, 1, 1}, 3);
    const Camera camera = perspective(volume->geometry(), {15, -13, 600});
    const TransferFunction tf = tents(3, 0.3);
    const auto expected = makeGlEngine(volume)->field(camera, tf).values;
    // The volume takes 288 000 bytes, the light of all planes more: both come in parts then.
    gl::limitAllocations(200e3);
    CHECK(worstDifference(makeGlEngine(volume)->field(camera, tf).values, expected) < 1e-5);

    gl::limitAllocations(100);
    try {
        makeGlEngine(volume)->field(camera, tf);
        FAIL("expected an error");
    } catch (const Error& error) {
        CHECK(error.problem().find("memory") != std::string::npos);
        CHECK(error.where() == "OpenGL");
        CHECK(error.remedy() == Remedy::OtherEngine);
    }
    RenderSettings settings;
    settings.width = settings.height = 20;
    const auto draw = [&] { return makeGlRenderer(volume)->render(camera, tf, settings); };
    CHECK_THROWS_AS(draw(), Error); // and no black image
    gl::limitAllocations(std::numeric_limits<double>::infinity());
    CHECK(draw().width == 20);
}

TEST_CASE("thin volumes have visibility too", "[gl]") {
    if (!haveGl()) return;
    for (const Int3& dims : {Int3(1, 1, 1), Int3(1, 9, 1), Int3(7, 1, 5)}) {
        const auto volume = noise(dims, {1, 1, 1}, 2);
        const auto reference = makeReferenceEngine(volume);
        const auto engine = makeGlEngine(volume);
        for (const auto& [view, camera] : everyKindOfView(volume->geometry())) {
            CAPTURE(view, dims.x, dims.y, dims.z);
            const TransferFunction tf = constantOpacity(0.4);
            CHECK(deviation(*volume, tf, engine->field(camera, tf).values, reference->field(camera, tf).values).rms <
                  0.008);
        }
    }
}

TEST_CASE("a volume longer than any texture is measured and drawn", "[gl]") {
    if (!haveGl()) return;
    std::vector<std::uint8_t> values;
    for (int i = 0; i < 20000 * 3; ++i) values.push_back(static_cast<std::uint8_t>(i * 31 % 251));
    const auto volume = volumeOf({20000, 3, 1}, values); // devices take up to 16384
    const TransferFunction tf = tents(3, 0.4);
    const Camera along = orthographic(volume->geometry(), {1, 0, 0}, 10),
                 across = orthographic(volume->geometry(), {0, 1, 0}, 10);
    const auto gl = makeGlEngine(volume), reference = makeReferenceEngine(volume);
    for (const Camera& camera : {along, across})
        CHECK(worstDifference(gl->field(camera, tf).values, reference->field(camera, tf).values) < 0.01);
    RenderSettings settings;
    settings.width = settings.height = 24;
    settings.background = Rgb{0.1, 0.2, 0.3};
    const Image a = makeGlRenderer(volume)->render(across, tf, settings),
                b = makeCpuRenderer(volume)->render(across, tf, settings);
    double worst = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        worst = std::max(worst, static_cast<double>(std::abs(a.rgba[i] - b.rgba[i])));
    CHECK(worst < 0.03);
}

TEST_CASE("what the device or the caller cannot do is an error", "[gl]") {
    if (!haveGl()) return;
    const auto volume = noise({6, 6, 6}, {1, 1, 1}, 1);
    const auto engine = makeGlEngine(volume);
    Camera inside = perspective(volume->geometry(), {0, -20, 0});
    inside.eye = inside.center + Vec3(0.1, 0, 0);
    CHECK_THROWS_AS(engine->field(inside, tents(3)), Error);

    const Camera camera = perspective(volume->geometry(), {0, -20, 0});
    std::stop_source stop;
    stop.request_stop();
    JobControl job;
    job.stop = stop.get_token();
    CHECK_THROWS_AS(engine->field(camera, tents(3), job), Cancelled);
    CHECK(engine->field(camera, tents(3)).values.size() == volume->size()); // and it works on
}
