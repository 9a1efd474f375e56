// What figures 4.5 and 4.6 of the thesis show: three disks from both sides.
#include <catch2/catch.hpp>

#include <algorithm>

#include "optimize/measure.h"
#include "tf/formats/tf_json.h"
#include "volume/procedural.h"

using namespace pellucid;

namespace {

std::vector<FeatureMeasures> disksFrom(double azimuth) {
    const auto volume = std::make_shared<const Volume>(makeSample("disks"));
    const TransferFunction tf = readTf(PELLUCID_SOURCE_DIR "/data/tf/disks_translucent.tf.json");
    const auto engine = makeCpuEngine(volume);
    const Camera camera = cameraFromView(volume->geometry(), azimuth, 0, 1, Projection::Perspective);
    return measure(*engine, camera, tf, saliencyFields(*volume, tf)).features;
}

std::size_t largest(const std::vector<FeatureMeasures>& all, double FeatureMeasures::*figure) {
    const auto less = [&](const auto& a, const auto& b) { return a.*figure < b.*figure; };
    return static_cast<std::size_t>(std::max_element(all.begin(), all.end(), less) - all.begin());
}

} // namespace

TEST_CASE("the nearest disk is the most visible, the magenta one the most salient by saturation", "[figures]") {
    // The captions of 4.5 and 4.6: by visibility and by brightness the disk in front leads, by saturation the middle
    // one.
    const auto left = disksFrom(-90), right = disksFrom(90);
    REQUIRE(left.size() == 3);
    REQUIRE(right.size() == 3);
    CHECK(largest(left, &FeatureMeasures::visibility) == 0);
    CHECK(largest(left, &FeatureMeasures::vwsBrightness) == 0);
    CHECK(largest(left, &FeatureMeasures::vwsSaturation) == 1);
    CHECK(largest(right, &FeatureMeasures::visibility) == 2);
    CHECK(largest(right, &FeatureMeasures::vwsBrightness) == 2);
    CHECK(largest(right, &FeatureMeasures::vwsSaturation) == 1);
    // The disks are alike but for their colour, so visibility is mirrored. The rays are not the same ones: 1e-3.
    for (std::size_t f = 0; f < 3; ++f) CHECK(left[f].visibility == Approx(right[2 - f].visibility).margin(1e-3));
    CHECK(left[2].visibility < left[1].visibility);
}
