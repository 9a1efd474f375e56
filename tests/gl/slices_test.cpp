// The slices engine: docs/method.md, "The slices engine".
#include "gl_test.h"

#include "render/gl/engine_budgets.h"
#include "render/gl/gl_engines.h"
#include "render/gl/gl_resources.h"
#include "render/gl/kept_region.h"
#include "render/gl/layered_view.h"
#include "support/engine_checks.h"
#include "support/field_sums.h"

using namespace pellucid;
using namespace pellucid::testing;
using pellucid::test::kSlicesTolerances;

namespace {

const auto slices = [](std::shared_ptr<const Volume> v) { return makeSlicesEngine(std::move(v)); };

std::vector<Camera> views(const Geometry& g) {
    const Vec3 half = 0.5 * (g.boundsMax() - g.boundsMin());
    return {orthographic(g, {0, 0, -1}, 40), orthographic(g, {1, -1, 1}, 40), perspective(g, {30, -60, 20}),
            perspective(g, half + Vec3(0.5, 0.6, 0.4)), perspective(g, {0, 0, half.z + 0.1})};
}

} // namespace

TEST_CASE("what clipping leaves has the corners that its planes make", "[kept]") {
    const Geometry geometry{{4, 5, 6}, {1, 2, 1}, {0, 0, 0}};
    CHECK(gl::keptCorners(geometry, {}).size() == 8);
    // Half of x, and 2·y' ≤ 3 in the world, where y' = 2j: j ≤ 1.
    const Clipping clipping{{0.5, 0, 0}, {1, 1, 1}, {{{0, 2, 0}, 4}}};
    const auto planes = planesInVoxels(clipping, geometry);
    const auto kept = gl::keptVoxels(geometry, planes);
    REQUIRE(kept);
    CHECK(kept->first == Int3(2, 0, 0)); // x from 0.5·4 − 0.5 on
    CHECK(kept->last == Int3(3, 1, 5));
    for (const Vec3& corner : gl::keptCorners(geometry, planes)) {
        CHECK((std::abs(corner.x - 1.5) < 0.01 || std::abs(corner.x - 3.5) < 0.01));
        CHECK((std::abs(corner.y + 0.5) < 0.01 || std::abs(corner.y - 1) < 0.01));
    }
    CHECK_FALSE(gl::keptVoxels(geometry, planesInVoxels(BoxPart{{}, {1, 1, 1}, {{{1, 0, 0}, -3}}}, geometry)));
}

TEST_CASE("a picture has a pixel per voxel and a layer per d0 where the view is along an axis", "[layered]") {
    const Geometry geometry{{6, 5, 4}, {1, 1, 1}, {3, 2, 1}};
    const auto all = gl::makeLayeredViews(orthographic(geometry, {0, 1, 0}, 10), geometry, Quality::Normal, 2048);
    REQUIRE(all.size() == 1);
    const gl::LayeredView& v = all[0];
    CHECK(v.slabs == 6); // five voxels and half of one in front
    CHECK(v.step == 1);
    // Every voxel centre lies on a pixel, and on a slice.
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 6; ++i) {
                const Vec3 local = v.localFromVoxel * (Vec3(i, j, k) - v.origin);
                const glm::dvec2 pixel = (glm::dvec2(local) - v.firstPixel) * v.pixelsPerD0;
                CHECK(glm::length(pixel - glm::round(pixel)) < 1e-9);
                CHECK(glm::all(glm::greaterThan(pixel, glm::dvec2(0))));
                CHECK(glm::all(glm::lessThan(pixel, glm::dvec2(v.size - 1))));
                const double c = (local.z - v.front) / v.step;
                CHECK(std::abs(c - std::round(c)) < 1e-9);
            }
    // An eye right before the box sees it on several sides of a cube; one behind 20 pixels gets larger ones.
    CHECK(gl::makeLayeredViews(perspective(geometry, {0, -2.6, 0}), geometry, Quality::Normal, 2048).size() > 1);
    const auto coarse = gl::makeLayeredViews(orthographic(geometry, {0, 1, 0}, 10), geometry, Quality::Normal, 9);
    CHECK(coarse[0].size.x <= 9);
    CHECK(coarse[0].pixelsPerD0.x < 1);
}

TEST_CASE("the slices engine keeps what every engine must", "[gl][slices]") {
    if (!haveGl()) return;
    test::checkHomogeneousBlock(slices);
    test::checkAnisotropicBlock(slices);
    test::checkInvalidVoxels(slices);
    test::checkClippedBlock(slices);
}

TEST_CASE("the slices engine agrees with the reference on random cases", "[gl][slices][accuracy]") {
    if (!haveGl()) return;
    std::vector<double> visibility, vws;
    for (std::uint32_t n = 0; n < 40; ++n) {
        const test::RandomCase c = test::randomCase(n);
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const test::Disagreement d =
            test::compare(*makeReferenceEngine(c.volume), *makeSlicesEngine(c.volume), c.camera, c.tf, weights);
        INFO(c.describe());
        CHECK(d.visibilityRms <= kSlicesTolerances.visibilityRms);
        CHECK(d.visibility <= kSlicesTolerances.figure);
        CHECK(d.vws <= kSlicesTolerances.figure);
        visibility.push_back(d.visibility);
        vws.push_back(d.vws);
    }
    CHECK(test::median(visibility) <= kSlicesTolerances.median);
    CHECK(test::median(vws) <= kSlicesTolerances.median);
}

TEST_CASE("the slices engine measures affine grids and what clipping leaves", "[gl][slices][affine][clip]") {
    if (!haveGl()) return;
    test::checkAffine(slices, 20, kSlicesTolerances);
    test::checkClipping(slices, 20, kSlicesTolerances);
    test::checkFaintRest(slices, 20, kSlicesTolerances);
    test::checkOrientations(slices, 0.01);
}

TEST_CASE("sums of slices are those of their fields, whatever the memory", "[gl][slices]") {
    if (!haveGl()) return;
    const auto volume = noise({29, 23, 34}, {1, 1.2, 1}, 14);
    const WeightFields weights = unevenWeights(volume->dims());
    gl::SlicesBudget tiny;
    tiny.layerBytes = 1;      // as few layers at a time as there can be
    tiny.bufferBytes = 50000; // some planes of voxels at a time
    const auto whole = makeSlicesEngine(volume), pieces = gl::makeSlicesEngine(volume, Quality::Normal, tiny);
    std::size_t number = 0;
    for (const Camera& camera : views(volume->geometry())) {
        CAPTURE(number++);
        View view(camera);
        view.clipping.planes = {{{1, 2, -1}, 20}};
        const TransferFunction tf = tents(5, 0.2);
        const Grid<float> field = whole->field(view, tf).values;
        CHECK(worstDifference(pieces->field(view, tf).values, field) < 1e-5);
        const FeatureSums sums = whole->sums(view, {&tf, 1}, &weights)[0],
                          again = whole->sums(view, {&tf, 1}, &weights)[0],
                          inPieces = pieces->sums(view, {&tf, 1}, &weights)[0],
                          expected = test::sumsOfField(*volume, tf.features, field, &weights);
        CHECK(again.visibility == sums.visibility); // the same bits
        CHECK(again.weighted == sums.weighted);
        CHECK(sums.allVisibility == Approx(expected.allVisibility).epsilon(1e-5));
        CHECK(inPieces.allVisibility == Approx(expected.allVisibility).epsilon(1e-5));
        for (std::size_t f = 0; f < tf.features.size(); ++f) {
            CHECK(sums.visibility[f] == Approx(expected.visibility[f]).epsilon(1e-5));
            for (std::size_t n = 0; n < 2; ++n) {
                CHECK(sums.weighted[n][f] == Approx(expected.weighted[n][f]).epsilon(1e-5));
                CHECK(inPieces.weighted[n][f] == Approx(expected.weighted[n][f]).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("slices of many transfer functions are those of each alone", "[gl][slices]") {
    if (!haveGl()) return;
    const auto volume = noise({14, 11, 9}, {1, 1.3, 0.8}, 9);
    const Camera camera = perspective(volume->geometry(), {5, -40, 8});
    const WeightFields weights = unevenWeights(volume->dims());
    std::vector<TransferFunction> tfs;
    for (int i = 0; i < 3; ++i) tfs.push_back(withFeatureOpacities(tents(3, 0.4), {0.1 * i, 0.3, 0.9 - 0.1 * i}));
    const auto engine = makeSlicesEngine(volume);
    const auto together = engine->sums(camera, tfs, &weights);
    REQUIRE(together.size() == 3);
    for (std::size_t t = 0; t < tfs.size(); ++t) {
        const FeatureSums alone = engine->sums(camera, {&tfs[t], 1}, &weights)[0];
        CHECK(together[t].visibility == alone.visibility);
        CHECK(together[t].weighted == alone.weighted);
    }
    CHECK(engine->sums(camera, {}, &weights).empty());
    const SumsJacobian jacobian = engine->jacobian(camera, tfs[1], &weights);
    CHECK(jacobian.byOpacity.size() == 3);
    CHECK(jacobian.sums.allVisibility == Approx(together[1].allVisibility).epsilon(0.02));
}

TEST_CASE("the slices engine hears a stop, and says where memory is too small", "[gl][slices]") {
    if (!haveGl()) return;
    const struct Restore {
        ~Restore() { gl::limitAllocations(std::numeric_limits<double>::infinity()); }
    } restore;
    const auto volume = noise({12, 11, 10}, {1, 1, 1}, 1);
    const TransferFunction tf = tents(3);
    const auto engine = makeSlicesEngine(volume);
    const Camera camera = perspective(volume->geometry(), {0, -20, 0});
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(engine->field(camera, tf, {stop.get_token(), {}}), Cancelled);
    CHECK(engine->field(camera, tf).values.size() == volume->size()); // and it works on
    Camera inside = camera;
    inside.eye = inside.center + Vec3(0.1, 0, 0);
    CHECK_THROWS_AS(engine->field(inside, tf), Error);
    gl::limitAllocations(100);
    try {
        makeSlicesEngine(volume)->field(camera, tf);
        FAIL("expected an error");
    } catch (const Error& error) {
        CHECK(error.problem().find("memory") != std::string::npos);
        CHECK(error.remedy() == Remedy::OtherEngine);
    }
}
