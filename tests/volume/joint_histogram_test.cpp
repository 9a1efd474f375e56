#include <catch2/catch.hpp>

#include <limits>
#include <numeric>

#include "base/error.h"
#include "volume/histogram.h"
#include "volume/joint_histogram.h"

using namespace pellucid;

namespace {

/// 33 voxels along `axis`, 5 along the others: s rises by 1/32 per voxel up to 0.5, from there by 1/64, to 0.75.
Volume kinkedRamp(int axis, Vec3 spacing, bool withHole = false) {
    Int3 dims(5);
    dims[axis] = 33;
    std::vector<float> samples;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                const int n = Int3(i, j, k)[axis];
                samples.push_back(static_cast<float>(n <= 16 ? n / 32.0 : 0.5 + (n - 16) / 64.0));
            }
    if (withHole) samples[voxelCount(dims) / 2] = std::numeric_limits<float>::quiet_NaN(); // its neighbours too
    return Volume(Geometry{dims, spacing, Vec3(0)}, Samples(std::move(samples))).withRange({0, 1});
}

std::uint64_t inGradientBin(const JointHistogram& h, int bin) {
    std::uint64_t sum = 0;
    for (int i = 0; i < h.bins; ++i) sum += h.at(i, bin);
    return sum;
}

} // namespace

TEST_CASE("a ramp has one gradient per slope", "[joint]") {
    const JointHistogram h = makeJointHistogram(kinkedRamp(0, Vec3(1)), 64, 128);
    // Central differences: 16 planes of 25 voxels of slope 1/32, one of 3/128, 16 of 1/64. The axis ends at 1/32, found
    // to one of 16 384 parts of its bound 3: 0.2 % too far, so that 1/64 lies just below the middle.
    CHECK(h.mostGradient >= 1.0 / 32);
    CHECK(h.mostGradient <= 1.0 / 32 + 3.0 / 16384 + 1e-12);
    CHECK(inGradientBin(h, 127) == 400);
    CHECK(inGradientBin(h, 95) == 25); // 0.75 · 128, less 0.2 %
    CHECK(inGradientBin(h, 63) == 400);
    CHECK(std::accumulate(h.counts.begin(), h.counts.end(), std::uint64_t{0}) == 825);
    // s = 4/32 lies on the steep part, in bin 64 · 4/32 = 8; s = 0.5 + 8/64 on the flat one, in bin 40.
    CHECK(h.at(8, 127) == 25);
    CHECK(h.at(40, 63) == 25);
    CHECK(h.at(40, 127) == 0);
}

TEST_CASE("gradients are per d0, whatever the spacing of their axis", "[joint]") {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 spacing(2, 0.5, 4); // d0 = 0.5
        const JointHistogram h = makeJointHistogram(kinkedRamp(axis, spacing), 64, 128);
        const double slope = 0.5 / 32 / spacing[axis]; // 1/32 per spacing, over d0
        CHECK(h.mostGradient >= slope - 1e-12);
        CHECK(h.mostGradient <= slope + 1.5 / 16384);                              // the bound: 0.5/2 + 1 + 0.5/4 < 1.5
        CHECK(inGradientBin(h, histogramBin(slope / h.mostGradient, 128)) == 400); // the steep part
        CHECK(inGradientBin(h, histogramBin(slope / 2 / h.mostGradient, 128)) == 400);
    }
}

TEST_CASE("voxels beside an invalid one have no gradient, constant volumes have none above 0", "[joint]") {
    const JointHistogram h = makeJointHistogram(kinkedRamp(0, Vec3(1), true), 64, 128);
    CHECK(std::accumulate(h.counts.begin(), h.counts.end(), std::uint64_t{0}) == 825 - 7);
    const Volume flat(Geometry{Int3(4), Vec3(1), Vec3(0)}, Samples(std::vector<float>(64, 0.25F)));
    const JointHistogram none = makeJointHistogram(flat.withRange({0, 1}), 16, 8);
    CHECK(none.mostGradient == 0);
    CHECK(none.at(4, 0) == 64);
}

TEST_CASE("the joint histogram can be stopped", "[joint]") {
    std::stop_source stop;
    stop.request_stop();
    JobControl job;
    job.stop = stop.get_token();
    CHECK_THROWS_AS(makeJointHistogram(kinkedRamp(0, Vec3(1)), 64, 128, job), Cancelled);
}
