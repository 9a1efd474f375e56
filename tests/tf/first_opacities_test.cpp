// Where features lie, and the opacities that follow.
#include "tf/first_opacities.h"

#include <catch2/catch.hpp>

using namespace pellucid;

namespace {

template <class ValueAt>
VoxelSurvey surveyOf(const Int3& dims, const Vec3& spacing, const ValueAt& valueAt) {
    std::vector<float> values;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) values.push_back(static_cast<float>(valueAt(i, j, k)));
    return surveyVoxels(Volume(Geometry{dims, spacing, {0, 0, 0}}, Samples(values)));
}

} // namespace

TEST_CASE("share, depth and path of a slab", "[first-opacities]") {
    // Three planes of 1 across x in a box of 12 × 10 × 8, spacing 1, 1, 2: d0 is 1.
    const VoxelSurvey survey =
        surveyOf({12, 10, 8}, {1, 1, 2}, [](int i, int, int) { return i >= 4 && i < 7 ? 1.0 : 0.0; });
    const std::vector<FeatureExtent> e = extentsOf(survey, {0, 1}, {{0.5, 1}});
    REQUIRE(e.size() == 1);
    CHECK(e[0].share == Approx(0.25));
    // Lines along x: 10·8 with 3; along y: 3·8 with 10; along z: 3·10 with 16 (d0).
    CHECK(e[0].path == Approx((80.0 * 3 + 24 * 10 + 30 * 16) / (80 + 24 + 30)));
    // The middle plane is 2 deep, but for j = 0, 9, which are 1 from the face (k = 0, 7 are 2 from it); the others 1.
    CHECK(e[0].depth == Approx((2 * 80.0 + 64 * 2 + 16 * 1) / 240));
}

TEST_CASE("what lies deeper is more inside, what is nowhere has no share", "[first-opacities]") {
    const VoxelSurvey survey = surveyOf({21, 21, 21}, {1, 1, 1}, [](int i, int j, int k) {
        const int r = std::max({std::abs(i - 10), std::abs(j - 10), std::abs(k - 10)});
        return r <= 2 ? 3 : r <= 5 ? 2 : r <= 8 ? 1 : 0;
    });
    const std::vector<FeatureExtent> e = extentsOf(survey, {0, 4}, {{0.5, 1.5}, {1.5, 2.5}, {2.5, 3.5}, {3.5, 4}});
    CHECK(e[3].share == 0);
    CHECK(e[2].share == Approx(125.0 / 9261));
    const std::vector<double> inside = insideOf({e[0], e[1], e[2]});
    CHECK(inside[0] == 0);
    CHECK(inside[1] > 0.3);
    CHECK(inside[1] < 0.8);
    CHECK(inside[2] == 1);
    const std::vector<double> covers = coversOf({e[0], e[1], e[2]}, true);
    CHECK(covers[0] < covers[1]);
    CHECK(covers[1] < covers[2]);
    CHECK(insideOf({e[0], e[0]}) == std::vector<double>{0, 0});
}

TEST_CASE("a path of mean length has the alpha that was asked for", "[first-opacities]") {
    FeatureExtent extent;
    extent.path = 20;
    // d0 pieces of alpha α compose to 1 − (1 − α)^path.
    CHECK(1 - std::pow(1 - opacityFor(0.7, extent), 20) == Approx(0.7));
    extent.path = 1;
    CHECK(opacityFor(0.7, extent) == Approx(0.7));
    extent.path = 1e9;
    CHECK(opacityFor(0.7, extent) == 0.001); // never nothing
}

TEST_CASE("where matter is everywhere, the higher and rarer counts", "[first-opacities]") {
    const auto shares = [](const std::vector<double>& of) {
        std::vector<FeatureExtent> e;
        for (const double s : of) e.push_back({s, 1, 1});
        return e;
    };
    const std::vector<double> rising = coversOf(shares({0.6, 0.3, 0.1}), false);
    CHECK(rising[0] < rising[1]);
    CHECK(rising[1] < rising[2]);
    const std::vector<double> even = coversOf(shares({0.4, 0.35, 0.25}), true);
    for (const double c : even) {
        CHECK(c > 0.05);
        CHECK(c < 0.97);
    }
    CHECK(coversOf(shares({1}), false).size() == 1);
}
