// Opacities for the first picture: what rays meet, and that the inside is seen through the outside.
#include <catch2/catch.hpp>

#include <numeric>

#include "base/parallel.h"
#include "optimize/answer/first_sight.h"
#include "render/camera_motion.h"
#include "render/image_renderer.h"
#include "render/visibility.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Intensities 0.25 up to 0.5 are the feature "front", those from there on "back", constant opacities.
TransferFunction frontAndBack(double front, double back) {
    TransferFunction tf;
    tf.points = {{0.1, front, {1, 0, 0}, false, {}},
                 {0.5, front, {1, 0, 0}, false, {}},
                 {0.5, back, {0, 0, 1}, false, {}},
                 {1, back, {0, 0, 1}, false, {}}};
    tf.features = {{"front", 0.1, 0.5, {1, 0, 0}, {}}, {"back", 0.5, 1, {0, 0, 1}, {}}};
    return tf;
}

/// Balls around the middle: `outer` beyond the radius `inner`, 200 within, 0 outside 0.85; radii of half the side.
std::shared_ptr<const Volume> nestedBalls(int n, double inner, double outer) {
    const double middle = (n - 1) / 2.0;
    return volumeFrom(
        geometryOf(Int3(n)),
        [&](int i, int j, int k) {
            const double r = glm::length(Vec3(i, j, k) - middle) / (n / 2.0);
            return r < inner ? 200.0 : r < 0.85 ? outer : 0.0;
        },
        std::nullopt);
}

View homeOf(const Volume& volume) { return View(homeCamera(volume.geometry(), Projection::Perspective)); }

std::shared_ptr<const Volume> seenThrough(const Volume& volume, const Proposal& proposal) {
    return std::make_shared<const Volume>(volume.withRange(proposal.window));
}

double alphaAt(const Image& image, int x, int y) { return static_cast<double>(image.pixel(x, y)[3]); }

} // namespace

TEST_CASE("a bundle of rays knows the alpha of a block, and of what is left of it", "[first sight]") {
    const auto volume = slab({8, 12, 8}, 0.75);
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    view.camera.height = 12;
    // 12 voxels of opacity 0.1 one behind the other: 1 − 0.9¹²; steps of d0/2 fill that length exactly.
    const auto full = RayBundle(*volume, homogeneous(0.1), view).appearances({homogeneous(0.1), homogeneous(0)});
    CHECK(full[0].alpha == Approx(1 - std::pow(0.9, 12)).margin(1e-5));
    CHECK(full[0].covers[0] == Approx(full[0].alpha));
    CHECK(full[0].shares[0] == Approx(1));
    CHECK(full[0].translucent == 1); // 0.718
    CHECK(full[1].alpha == 0);
    CHECK(full[1].shares[0] == 0);
    // Half of it is cut away, by a plane across the view.
    view.clipping.lo.y = 0.5;
    const auto half = RayBundle(*volume, homogeneous(0.1), view).appearances({homogeneous(0.1)});
    CHECK(half[0].alpha == Approx(1 - std::pow(0.9, 6)).margin(1e-5));
    // The picture is 12 wide and high, the block 8: of 72 rays along each side 48 meet it.
    CHECK(RayBundle(*volume, homogeneous(0.1), view, 72).rays() == 48 * 48);
}

TEST_CASE("covers and shares are those of compositing, front to back", "[first sight]") {
    // Seen along +y: 5 voxels of 0.3, then 7 of 0.7; between the two centres the value crosses 0.5 in the middle.
    const auto volume = volumeFrom(geometryOf({8, 12, 8}), [](int, int j, int) { return j < 5 ? 0.3 : 0.7; });
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    view.camera.height = 12;
    const TransferFunction tf = frontAndBack(0.1, 0.2);
    const RayBundle rays(*volume, tf, view);
    REQUIRE(rays.rays() > 0);
    CHECK(rays.raysOf(0) == rays.rays());
    CHECK(rays.raysOf(1) == rays.rays());
    const double front = 1 - std::pow(0.9, 5), back = (1 - front) * (1 - std::pow(0.8, 7));
    const auto a = rays.appearances({tf}).front();
    CHECK(a.covers[0] == Approx(front).margin(0.01)); // steps begin anywhere: 5 d0 ± half a step
    CHECK(a.covers[1] == Approx(back).margin(0.01));
    CHECK(a.shares[0] == Approx(front / (front + back)).margin(0.01));
    CHECK(a.alpha == Approx(front + back).margin(0.01));
    // From behind it is the other way round.
    const RayBundle behind(*volume, tf, [&] {
        View other(lookingAlong(volume->geometry(), {0, -1, 0}));
        other.camera.height = 12;
        return other;
    }());
    CHECK(behind.appearances({tf}).front().covers[1] == Approx(1 - std::pow(0.8, 7)).margin(0.01));
}

TEST_CASE("what is wanted grows with what a ray meets, and favours the inside", "[first sight]") {
    const auto volume =
        volumeFrom(geometryOf({8, 12, 8}), [](int i, int j, int) { return i < 4 || j < 5 ? 0.3 : 0.7; });
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    const RayBundle rays(*volume, frontAndBack(0.1, 0.2), view);
    const std::vector<double> wanted = wantedCovers(rays, {0.0, 1.0}, false);
    // Half of the rays meet the front alone, and want 0.55 of it; the others 0.95 of both, 0.12 parts to 1.12.
    const double both = rays.raysOf(1), all = rays.rays();
    CHECK(both / all == Approx(0.5).margin(0.1));
    CHECK(wanted[1] == Approx(0.95 * 1.12 / 1.24));
    CHECK(wanted[0] == Approx(((all - both) * 0.55 + both * 0.95 * 0.12 / 1.24) / all));
}

TEST_CASE("the inner one of two balls is seen through the outer one", "[first sight]") {
    const double outer = GENERATE(60.0, 120.0);
    const double inner = GENERATE(0.3, 0.55);
    CAPTURE(outer, inner);
    const auto data = nestedBalls(48, inner, outer);
    const Proposal proposal = propose(*data);
    REQUIRE(proposal.features.size() == 2);
    const auto volume = seenThrough(*data, proposal);
    const View home = homeOf(*volume);
    const FirstSight sight = withOpacitiesForView(*volume, proposal, proposal.tf, home);
    const TransferFunction& tf = sight.tf;
    tf.validate();
    CHECK(tf.features == proposal.tf.features); // opacities alone have changed
    // What it aims at, as shares of all: wanted covers times the rays that they are a mean over.
    const RayBundle rays(*volume, proposal.tf, home, 72);
    const std::vector<double> wanted = wantedCovers(rays, importanceOf(proposal), !proposal.background);
    const double first = wanted[0] * rays.raysOf(0), second = wanted[1] * rays.raysOf(1);
    REQUIRE(sight.shares.size() == 2);
    CHECK(sight.shares[0] == Approx(first / (first + second)));
    CHECK(sight.shares[1] == Approx(second / (first + second)));
    CHECK(tf.range == proposal.tf.range);

    const FeatureSums sums = makeCpuEngine(volume)->sums(home, std::vector<TransferFunction>{tf}, nullptr)[0];
    CHECK(sums.visibility[0] / sums.allVisibility > 0.1);
    CHECK(sums.visibility[1] / sums.allVisibility > 0.1);

    RenderSettings settings;
    settings.width = settings.height = 96;
    settings.background.reset();
    const Image image = makeCpuRenderer(volume)->render(home.camera, tf, settings);
    // The middle goes through both balls, a point at 0.7 of the outer radius through the outer one alone. The box's
    // bounding sphere fills the picture's height: half a side is 48/√3 pixels and a bit of perspective.
    const int beside = 48 + static_cast<int>(0.7 * 0.85 * 48 / std::sqrt(3.0));
    const double middle = alphaAt(image, 48, 48), side = alphaAt(image, beside, 48);
    CHECK(middle > 0.75);
    CHECK(side > 0.1);
    CHECK(side < 0.8);
    CHECK(side < middle);
}

TEST_CASE("neither empty nor solid, whatever one starts from", "[first sight]") {
    const auto data = nestedBalls(40, 0.4, 90);
    const Proposal proposal = propose(*data);
    const auto volume = seenThrough(*data, proposal);
    const View home = homeOf(*volume);
    for (const double start : {0.0005, 0.9}) {
        const TransferFunction from =
            withFeatureOpacities(proposal.tf, std::vector<double>(proposal.features.size(), start));
        const TransferFunction tf = withOpacitiesForView(*volume, proposal, from, home).tf;
        const auto a = RayBundle(*volume, tf, home).appearances({tf}).front();
        CHECK(a.translucent > 0.05);
        CHECK(a.translucent < 0.95);
        CHECK(a.alpha > 0.2);
        CHECK(*std::min_element(a.shares.begin(), a.shares.end()) > 0.1);
    }
}

TEST_CASE("one feature alone is neither empty nor solid", "[first sight]") {
    const auto data = volumeFrom(
        geometryOf(Int3(32)), [](int i, int j, int k) { return glm::length(Vec3(i, j, k) - 15.5) < 12 ? 1.0 : 0.0; });
    const Proposal proposal = propose(*data);
    REQUIRE(proposal.features.size() == 1);
    const auto volume = seenThrough(*data, proposal);
    const TransferFunction tf = withOpacitiesForView(*volume, proposal, proposal.tf, homeOf(*volume)).tf;
    const auto a = RayBundle(*volume, tf, homeOf(*volume)).appearances({tf}).front();
    CHECK(a.translucent > 0.02);
    CHECK(a.translucent < 0.98);
    CHECK(a.alpha == Approx(0.8).margin(0.15));
}

TEST_CASE("features that meet go on meeting, without a step", "[first sight]") {
    const auto data = nestedBalls(32, 0.5, 90);
    const Proposal proposal = propose(*data);
    REQUIRE(proposal.features.size() == 2);
    REQUIRE(proposal.features[0].hi == proposal.features[1].lo);
    const auto volume = seenThrough(*data, proposal);
    const TransferFunction tf = withOpacitiesForView(*volume, proposal, proposal.tf, homeOf(*volume)).tf;
    REQUIRE(featureOpacities(tf) != featureOpacities(proposal.tf));
    const double x = tf.features[0].b;
    CHECK(tf.opacity(x - 1e-9) == Approx(tf.opacity(x)).margin(1e-6));
    const std::vector<double> peaks = featureOpacities(tf);
    CHECK(tf.opacity(x) == Approx(std::min(peaks[0], peaks[1])));
    CHECK(tf.points.size() == proposal.tf.points.size());
}

TEST_CASE("the same opacities for any number of threads", "[first sight]") {
    const auto data = nestedBalls(32, 0.5, 90);
    const Proposal proposal = propose(*data);
    const auto volume = seenThrough(*data, proposal);
    setThreadCount(1);
    const TransferFunction one = withOpacitiesForView(*volume, proposal, proposal.tf, homeOf(*volume)).tf;
    setThreadCount(5);
    const TransferFunction five = withOpacitiesForView(*volume, proposal, proposal.tf, homeOf(*volume)).tf;
    setThreadCount(0);
    CHECK(one == five);
}

TEST_CASE("where there is nothing to see opacities stay", "[first sight]") {
    const auto nothing = volumeFrom(
        geometryOf(Int3(8)), [](int, int, int) { return NAN; }, std::nullopt);
    const Proposal proposal = propose(*nothing);
    CHECK(withOpacitiesForView(*nothing, proposal, proposal.tf, homeOf(*nothing)).tf == proposal.tf);
    CHECK(withOpacitiesForView(*nothing, proposal, proposal.tf, homeOf(*nothing)).shares.empty());
    TransferFunction bare = tents(2);
    bare.features.clear();
    const auto volume = slab(Int3(8), 0.5);
    CHECK(withOpacitiesForView(*volume, proposal, bare, homeOf(*volume)).tf == bare);
    std::stop_source stop;
    stop.request_stop();
    const auto balls = nestedBalls(16, 0.5, 90);
    const Proposal two = propose(*balls);
    CHECK_THROWS_AS(withOpacitiesForView(*balls, two, two.tf, homeOf(*balls), {stop.get_token(), {}}), Cancelled);
}
