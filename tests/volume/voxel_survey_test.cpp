// A sample of a volume, and what its boundaries join.
#include "volume/voxel_survey.h"

#include <limits>
#include <numeric>

#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "volume/analytic.h"

using namespace pellucid;

namespace {

template <class ValueAt>
Volume volumeOf(const Int3& dims, const Vec3& spacing, const ValueAt& valueAt) {
    std::vector<float> values;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) values.push_back(static_cast<float>(valueAt(i, j, k)));
    return Volume(Geometry{dims, spacing, {0, 0, 0}}, Samples(values));
}

} // namespace

TEST_CASE("a small volume is surveyed wholly", "[survey]") {
    const Volume volume = volumeOf({5, 4, 3}, {1, 1, 1}, [](int i, int j, int k) { return i + 10 * j + 100 * k; });
    const VoxelSurvey survey = surveyVoxels(volume);
    REQUIRE(survey.dims == Int3(5, 4, 3));
    for (std::size_t i = 0; i < survey.size(); ++i) {
        CHECK(survey.indices[i] == i);
        CHECK(survey.values[i] == volume.value(i));
    }
    // Of 5·4·3 voxels 3·2·1 are inside.
    std::size_t faces = 0;
    for (std::size_t i = 0; i < survey.size(); ++i) faces += survey.onFace(i);
    CHECK(faces == 60 - 6);
}

TEST_CASE("gradients are per d0 in the world", "[survey]") {
    // 3 per world unit along y, whose spacing is 2; d0 is 0.5.
    const Volume volume = volumeOf({6, 6, 6}, {0.5, 2, 1}, [](int, int j, int) { return 3 * 2 * j; });
    for (const double g : surveyVoxels(volume).gradients) CHECK(g == Approx(3 * 0.5));
}

TEST_CASE("a survey of a large volume is small, has its faces, and is the same with any threads", "[survey]") {
    const Int3 dims(150, 90, 70);
    const Volume volume = volumeOf(dims, {1, 1, 1}, [&](int i, int j, int k) {
        const bool face = i == 0 || j == 0 || k == 0 || i == dims.x - 1 || j == dims.y - 1 || k == dims.z - 1;
        return face ? 7 : 0.001 * i;
    });
    setThreadCount(1);
    const VoxelSurvey one = surveyVoxels(volume);
    setThreadCount(3);
    const VoxelSurvey three = surveyVoxels(volume);
    setThreadCount(0);
    CHECK(one.indices == three.indices);
    CHECK(one.gradients == three.gradients);
    CHECK(one.size() <= VoxelSurvey::kMostCells);
    CHECK(one.size() > VoxelSurvey::kMostCells / 2);
    for (std::size_t i = 0; i < one.size(); ++i) REQUIRE(one.onFace(i) == (one.values[i] == 7));
    for (int a = 0; a < 3; ++a) CHECK(one.pathPerCell[a] * one.dims[a] == Approx(dims[a]));
}

TEST_CASE("invalid voxels are NaN in a survey, and their neighbours' gradients leave them out", "[survey]") {
    const Volume volume = volumeOf({4, 1, 1}, {1, 1, 1}, [](int i, int, int) {
        return i == 1 ? std::numeric_limits<double>::quiet_NaN() : 10.0 * i;
    });
    const VoxelSurvey survey = surveyVoxels(volume);
    CHECK(std::isnan(survey.values[1]));
    CHECK(std::isnan(survey.gradients[1]));
    CHECK(survey.gradients[0] == 0);  // no neighbour but the invalid one
    CHECK(survey.gradients[2] == 10); // one-sided
}

TEST_CASE("paths along the gradient end at the values that a boundary joins", "[survey]") {
    // A ramp from 20 to 80 over four voxels between two flat halves.
    const Volume volume =
        volumeOf({24, 9, 9}, {1, 1, 1}, [](int i, int, int) { return 20 + 60 * std::clamp((i - 10) / 4.0, 0.0, 1.0); });
    const std::vector<BoundaryEnds> ends = boundaryEnds(volume, surveyVoxels(volume), 1, 0.5);
    // Voxels 10 … 14 have a gradient.
    REQUIRE(ends.size() == 5 * 9 * 9);
    for (const BoundaryEnds& b : ends) {
        CHECK(b.low == Approx(20));
        CHECK(b.high == Approx(80));
    }
    CHECK(boundaryEnds(volume, surveyVoxels(volume), 1000, 0.5).empty());
}
