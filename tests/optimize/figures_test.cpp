// What chapter 4 of the thesis says of its figures, as figures: three disks from both sides, a tooth under two transfer
// functions, and a colour that loses its saturation. Chapter 5 is in tests/session/figures_test.cpp.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "optimize/measure.h"
#include "support/volumes.h"
#include "tf/formats/tf_json.h"
#include "tf/lch.h"
#include "volume/loader.h"
#include "volume/procedural.h"

using namespace pellucid;

namespace {

using All = std::vector<FeatureMeasures>;
using Figure = double FeatureMeasures::*;

All measured(const std::shared_ptr<const Volume>& volume, const TransferFunction& tf, double azimuth,
             double elevation) {
    const auto engine = makeCpuEngine(volume);
    const Camera camera = cameraFromView(volume->geometry(), azimuth, elevation, 1, Projection::Perspective);
    return measure(*engine, camera, tf, saliencyFields(*volume, tf)).features;
}

All disksFrom(double azimuth) {
    return measured(std::make_shared<const Volume>(makeSample("disks")),
                    readTf(PELLUCID_SOURCE_DIR "/data/tf/disks_translucent.tf.json"), azimuth, 0);
}

/// Indices of the features, the largest figure first.
std::vector<std::size_t> order(const All& all, Figure figure) {
    std::vector<std::size_t> indices(all.size());
    std::iota(indices.begin(), indices.end(), 0);
    std::sort(indices.begin(), indices.end(),
              [&](std::size_t a, std::size_t b) { return all[a].*figure > all[b].*figure; });
    return indices;
}

// ---- the tooth

enum Tissue : std::size_t { kCementumAndPulp, kDentine, kEnamel };

/// Dentine with a cap of enamel and a pulp chamber; edges are soft over two voxels, as a scanner's are, so that a skin
/// of the intensities of cementum lies around the root. Intensities are those of the real one: 0.28, 0.64 and 0.88.
std::shared_ptr<const Volume> drawnTooth() {
    constexpr Int3 kDims{28, 24, 36};
    return test::volumeFrom(test::geometryOf(kDims), [&](int i, int j, int k) {
        const Vec3 p = (Vec3(i, j, k) + 0.5) / Vec3(kDims) * 2.0 - 1.0; // [−1, 1]
        const double taper = p.z > 0 ? 0.75 : 0.75 - 0.4 * p.z * p.z;   // of the root
        const double r = std::hypot(p.x, p.y) / taper;
        const double body = p.z > 0 ? std::hypot(r, p.z / 0.85) : std::max(r, -p.z / 0.9); // 1 at the surface
        const auto inside = [&](double radius) { return std::clamp((radius - body) / 0.16 + 0.5, 0.0, 1.0); };
        const double skin = p.z > 0.3 ? 0.88 : 0.64;
        return skin * inside(0.95) + (0.64 - skin) * inside(0.62) + (0.28 - 0.64) * inside(p.z < 0.3 ? 0.25 : 0);
    });
}

/// Null, with a word, where the scan is not at hand.
std::shared_ptr<const Volume> scannedTooth() {
    VolumeSource source;
    source.path = PELLUCID_SHARED_DIR "/data/real/tooth/tooth.mhd";
    if (!std::filesystem::exists(source.path)) {
        WARN("SKIPPED: there is no " << source.path);
        return nullptr;
    }
    source.downsample = 2; // statements, not digits
    return std::make_shared<const Volume>(loadVolume(source).withRange({0, 255}));
}

/// Figure 4.7: cementum & pulp chamber blue, dentine red, enamel yellow.
TransferFunction toothTf(const std::vector<double>& peaks) {
    struct Tent {
        const char* name;
        double lo, peak, hi;
        Rgb color;
    };
    TransferFunction tf;
    for (const Tent& t : {Tent{"cementum & pulp", 0.10, 0.28, 0.48, {0, 0, 1}},
                          Tent{"dentine", 0.52, 0.64, 0.74, {1, 0, 0}}, Tent{"enamel", 0.76, 0.88, 1, {1, 1, 0}}}) {
        tf.features.push_back({t.name, t.lo, t.hi, t.color, {}});
        tf.points.push_back({t.lo, 0, t.color, true, {}});
        tf.points.push_back({t.peak, 0.2, t.color, false, {}});
        tf.points.push_back({t.hi, 0, t.color, true, {}});
    }
    return withFeatureOpacities(tf, peaks);
}

/// What the text says of the two transfer functions of a tooth.
void checkTwoTfs(const std::shared_ptr<const Volume>& tooth) {
    const All equal = measured(tooth, toothTf({0.2, 0.2, 0.2}), 30, 20);
    const All highlighting = measured(tooth, toothTf({0.01, 0.01, 0.8}), 30, 20);
    REQUIRE(equal.size() == 3);
    for (const Figure figure : {&FeatureMeasures::vws, &FeatureMeasures::visibility}) {
        // 4.8, 4.9: "all three features are reasonably salient". A fair share is 1/3; none is below a quarter of it.
        for (const FeatureMeasures& feature : equal) CHECK(feature.*figure > 1.0 / 12);
        // 4.11, 4.12: "the enamel has significantly higher visual saliency": twice what it had,
        // and more than all others together.
        CHECK(highlighting[kEnamel].*figure > 2 * equal[kEnamel].*figure);
        CHECK(highlighting[kEnamel].*figure > 0.5);
        CHECK(equal[kEnamel].*figure < 0.5);
        for (const Tissue other : {kCementumAndPulp, kDentine})
            CHECK(highlighting[other].*figure < equal[other].*figure);
    }
}

/// The feature with a part of its chroma, as bright and of the same hue as before.
TransferFunction paler(TransferFunction tf, std::size_t feature, double part) {
    const auto pale = [part](const Rgb& color) {
        Lch lch = lchFromSrgb(color);
        lch.chroma *= part;
        return srgbFromLch(lch);
    };
    const Rgb was = tf.features[feature].color;
    for (ControlPoint& p : tf.points)
        if (p.color == was) p.color = pale(was);
    tf.features[feature].color = pale(was);
    return tf;
}

/// What the text says of a feature that loses its saturation.
void checkPaler(const All& before, const All& after, std::size_t feature, std::size_t other) {
    for (std::size_t f = 0; f < before.size(); ++f) CHECK(after[f].visibility == before[f].visibility); // to the bit
    CHECK(after[feature].vws < before[feature].vws);
    CHECK(after[other].vws > before[other].vws);
    // Brightness is what it was: it is the saturation that tells.
    CHECK(after[feature].vwsSaturation < before[feature].vwsSaturation);
    CHECK(after[other].vwsSaturation > before[other].vwsSaturation);
    CHECK(after[feature].vwsBrightness == Approx(before[feature].vwsBrightness).margin(1e-3));
}

} // namespace

TEST_CASE("§4.3.5, figures 4.5 and 4.6: the nearest disk is the most visible, the magenta one the most saturated",
          "[figures]") {
    const auto left = disksFrom(-90), right = disksFrom(90);
    REQUIRE(left.size() == 3);
    REQUIRE(right.size() == 3);
    using Order = std::vector<std::size_t>;
    // "Feature visibility (a) and visibility-weighted saliency from brightness (b) both suggest that the top disk is
    // the most visible and the bottom disk is the least visible", and from the other side "the bottom disk is the
    // most". Brightness "shows similar patterns as the feature visibility": the same order.
    CHECK(order(left, &FeatureMeasures::visibility) == Order{0, 1, 2});
    CHECK(order(left, &FeatureMeasures::vwsBrightness) == Order{0, 1, 2});
    CHECK(order(right, &FeatureMeasures::visibility) == Order{2, 1, 0});
    CHECK(order(right, &FeatureMeasures::vwsBrightness) == Order{2, 1, 0});
    for (const All& side : {left, right}) {
        // "the middle disk with magenta color is significantly more salient than the other two … in terms of
        // saturation", though it is neither the nearest nor the most visible.
        CHECK(order(side, &FeatureMeasures::vwsSaturation)[0] == 1);
        CHECK(side[1].vwsSaturation > side[1].visibility);
        // (d): "with equal weights of brightness and saturation".
        for (const FeatureMeasures& disk : side)
            CHECK(disk.vws == Approx((disk.vwsBrightness + disk.vwsSaturation) / 2).margin(1e-12));
    }
    // The disks are alike but for their colour, so visibility is mirrored. The rays are not the same ones: 1e-3.
    for (std::size_t f = 0; f < 3; ++f) CHECK(left[f].visibility == Approx(right[2 - f].visibility).margin(1e-3));
}

TEST_CASE("§4.4, figures 4.9 and 4.12: a transfer function for the enamel makes it stand out", "[figures]") {
    checkTwoTfs(drawnTooth());
}

TEST_CASE("§4.4, figures 4.9 and 4.12, on the scanned tooth", "[figures][real]") {
    if (const auto tooth = scannedTooth()) checkTwoTfs(tooth);
}

TEST_CASE("§4.5.6, figures 4.18 and 4.19: VWS sees that a colour has lost its saturation, visibility does not",
          "[figures]") {
    const auto check = [](const std::shared_ptr<const Volume>& tooth) {
        const TransferFunction tf = toothTf({0.1, 0.1, 0.1});
        // "the red feature has lower VWS and the yellow feature has higher VWS in Figure 4.19 (c)"; "the feature
        // visibility in Figure 4.19 (b) is the same as that in Figure 4.18 (b)".
        for (const double part : {0.7, 0.4})
            checkPaler(measured(tooth, tf, 30, 20), measured(tooth, paler(tf, kDentine, part), 30, 20), kDentine,
                       kEnamel);
    };
    check(drawnTooth());
    if (const auto tooth = scannedTooth()) check(tooth);
}
