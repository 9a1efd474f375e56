// Distance factors, priorities, the colours of regions, and what they do to real data.
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "optimize/measure.h"
#include "optimize/refine/refine.h"
#include "optimize/refine/region_colors.h"
#include "render/camera_motion.h"
#include "render/image_renderer.h"
#include "render/standard_view.h"
#include "support/refine_cases.h"
#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// ∫ d(x) α(x) (−p ln p) dx over each edge by the midpoint rule, 2000 steps per bin and edge; d is linear between
/// `factors`. Its error is below 1e-7 of the weight: f″h²/24 of a quadratic.
std::vector<double> quadrature(const Histogram& h, const TransferFunction& tf, const std::vector<double>& factors) {
    const auto points = tf.pointsWithEnds();
    const int bins = static_cast<int>(h.counts.size());
    std::vector<double> edges;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double x0 = points[i].x, x1 = points[i + 1].x;
        double sum = 0;
        for (int b = 0; b < bins; ++b) {
            const double lo = std::max(x0, b / static_cast<double>(bins)),
                         hi = std::min(x1, (b + 1) / static_cast<double>(bins));
            if (!(lo < hi)) continue;
            const double p = static_cast<double>(h.counts[static_cast<std::size_t>(b)]) / static_cast<double>(h.total);
            if (p == 0) continue;
            constexpr int kSteps = 2000;
            for (int n = 0; n < kSteps; ++n) {
                const double t = (lo + (hi - lo) * (n + 0.5) / kSteps - x0) / (x1 - x0);
                const double alpha = (1 - t) * points[i].opacity + t * points[i + 1].opacity;
                const double d = (1 - t) * factors[i] + t * factors[i + 1];
                sum -= d * alpha * p * std::log(p) * (hi - lo) / kSteps;
            }
        }
        edges.push_back(sum);
    }
    return edges;
}

void checkAgainstQuadrature(const Histogram& h, const TransferFunction& tf, const RefinePriority& priority,
                            const std::vector<double>& factors) {
    const auto expected = quadrature(h, tf, factors), edges = edgeWeights(h, tf, priority);
    REQUIRE(edges.size() == expected.size());
    double mean = 0, energy = 0;
    for (const double e : expected) mean += e / static_cast<double>(expected.size());
    for (const double e : expected) energy += (e - mean) * (e - mean);
    for (std::size_t i = 0; i < edges.size(); ++i) CHECK(edges[i] == Approx(expected[i]).epsilon(1e-6).margin(1e-30));
    CHECK(edgeEnergy(edges) == Approx(energy).epsilon(1e-6));
}

struct HsvPlace {
    double hue, saturation, value;
};
/// Distance in the HSV cylinder (S cos H, S sin H, V).
double distance(const HsvPlace& a, const HsvPlace& b) {
    const auto turn = [](double degrees) { return degrees * std::numbers::pi / 180; };
    const double x = a.saturation * std::cos(turn(a.hue)) - b.saturation * std::cos(turn(b.hue));
    const double y = a.saturation * std::sin(turn(a.hue)) - b.saturation * std::sin(turn(b.hue));
    return std::hypot(x, y, a.value - b.value);
}

/// How large a part of the movable opacity lies in points with a ≤ x < b.
double opacityShare(const TransferFunction& tf, double a, double b) {
    double inside = 0;
    for (const ControlPoint& p : tf.points)
        if (!p.fixed && p.x >= a && p.x < b) inside += p.opacity;
    return inside / movableOpacity(tf);
}

/// How large a part of all visibility is that of intensities in [a, b).
double pictureShare(VisibilityEngine& engine, const View& view, TransferFunction tf, double a, double b) {
    tf.features = {{"chosen", a, b, {}, {}}};
    return measure(engine, view, tf, WeightFields(engine.volume().dims(), 1, 1)).features[0].visibility;
}

struct RealCase {
    const char* file;
    View view;          ///< of the region; camera not set
    ViewAngles angles;  ///< of the camera
    int x0, y0, x1, y1; ///< region, of 300 x 300 pixels
    double a, b;        ///< intensities of what is seen there
};

} // namespace

TEST_CASE("edge weights with and without priorities equal an independent integral", "[refine][priority]") {
    // Colours by their places in the cylinder, so that (3.10) can be summed up without any conversion.
    const std::vector<HsvPlace> colors{{10, 1, 1}, {100, 0.5, 0.8}, {200, 0.9, 0.4}, {350, 0.2, 1}};
    const std::vector<std::pair<HsvPlace, double>> region{{{20, 0.9, 0.9}, 3}, {{120, 0.4, 0.6}, 2}, {{0, 0, 0.5}, 1}};
    TransferFunction tf;
    const double xs[] = {0.07, 0.31, 0.31, 0.8}, opacities[] = {0.2, 0.9, 0.4, 0.6};
    for (std::size_t i = 0; i < 4; ++i)
        tf.points.push_back(
            {xs[i], opacities[i], rgbFromHsv(colors[i].hue, colors[i].saturation, colors[i].value), false, {}});
    const Histogram h = randomRefineCase(3).histogram;

    checkAgainstQuadrature(h, tf, {}, std::vector<double>(6, 1.0));
    RefinePriority intensity;
    intensity.intensity = 0.42;
    checkAgainstQuadrature(h, tf, intensity, {0.42, 0.35, 0.11, 0.11, 0.38, 0.58});
    RefinePriority byRegion;
    std::vector<double> sums;
    for (const auto& [place, count] : region)
        byRegion.region.push_back({rgbFromHsv(place.hue, place.saturation, place.value), count});
    for (const std::size_t i : {0, 0, 1, 2, 3, 3}) { // added ends have their neighbours' colours
        sums.push_back(0);
        for (const auto& [place, count] : region) sums.back() += count * distance(place, colors[i]);
    }
    const double n = sums[1] + sums[2] + sums[3] + sums[4]; // (3.11): over the user's points
    for (double& s : sums) s /= n;
    const auto factors = pointFactors(tf, byRegion);
    for (std::size_t i = 0; i < 6; ++i) CHECK(factors[i] == Approx(sums[i]).epsilon(1e-12));
    checkAgainstQuadrature(h, tf, byRegion, sums);
}

TEST_CASE("edge weights of random transfer functions equal an independent integral", "[refine][priority]") {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const RefineCase c = randomRefineCase(seed);
        INFO("case " << seed);
        checkAgainstQuadrature(c.histogram, c.tf, c.options.priority, pointFactors(c.tf, c.options.priority));
    }
}

TEST_CASE("a weight with a distance factor in closed form", "[refine][priority]") {
    // One bin of p = ½ on each half: g = ½ ln 2 everywhere. One point (½, 1), x0 = ½: α = 2x and d = ½ − x on the left.
    // e(0) = g ∫₀^½ 2x (½ − x) dx = g (1/8 − 1/12) = g/24, and e(1) likewise.
    Histogram h;
    h.counts = {5, 5};
    h.total = 10;
    TransferFunction tf;
    tf.points = {{0.5, 1.0, {}, false, {}}};
    RefinePriority priority;
    priority.intensity = 0.5;
    const auto edges = edgeWeights(h, tf, priority);
    CHECK(edges[0] == Approx(std::log(2) / 48).epsilon(1e-12));
    CHECK(edges[1] == Approx(std::log(2) / 48).epsilon(1e-12));
}

TEST_CASE("a region of the colour of every point prioritizes nothing", "[refine][priority]") {
    TransferFunction tf = tents(2);
    for (ControlPoint& p : tf.points) p.color = {1, 0, 0};
    RefinePriority priority;
    priority.region = {{{1, 0, 0}, 7}};
    CHECK(pointFactors(tf, priority) == std::vector<double>(8, 1.0 / 6));
}

TEST_CASE("impossible priorities are refused", "[refine][priority]") {
    RefineOptions options;
    options.priority.intensity = 1.5;
    CHECK_THROWS_AS(options.validate(), UsageError);
    options.priority.intensity = std::nan("");
    CHECK_THROWS_AS(options.validate(), UsageError);
    options.priority.intensity = 0.5;
    options.priority.region = {{{1, 0, 0}, 1}};
    CHECK_THROWS_AS(options.validate(), UsageError);
}

TEST_CASE("the intensity of a hue is where the transfer function has it", "[refine][priority]") {
    // tents:3: hues 60, 180, 300 at 1/6, ½, 5/6; each tent has one colour, so that its peak is the most opaque of them.
    CHECK(intensityOfHue(tents(3), 60) == Approx(1.0 / 6));
    CHECK(intensityOfHue(tents(3), 180) == Approx(0.5));
    // Hue 170 lies in the gap from yellow at 0.3 to cyan at 11/30: (1 − t, 1, t) has it at 120 + 60 (2t − 1)/t, t =
    // 6/7.
    CHECK(intensityOfHue(tents(3), 170) == Approx(0.3 + 6.0 / 7 / 15).margin(1.0 / 4096));
    CHECK(intensityOfHue(tents(3), -60) == Approx(5.0 / 6));
    // Between red and yellow, linear in sRGB, hue 30 is where green is ½.
    TransferFunction tf;
    tf.points = {{0.2, 0.5, {1, 0, 0}, false, {}}, {0.6, 0.5, {1, 1, 0}, false, {}}};
    CHECK(intensityOfHue(tf, 30) == Approx(0.4).margin(1.0 / 4096));
    CHECK(intensityOfHue(tf, 355) == Approx(0.2).margin(0.2)); // the first point and all before it are red
    for (ControlPoint& p : tf.points) p.color = {0.5, 0.5, 0.5};
    CHECK_THROWS_AS(intensityOfHue(tf, 30), Error);
}

TEST_CASE("the colours of a region are those of its visible pixels", "[refine][region]") {
    Image image(4, 2); // red red green (transparent) / blue ×4
    const auto paint = [&](int x, int y, float r, float g, float b, float a) {
        const float rgba[] = {r, g, b, a};
        std::copy(rgba, rgba + 4, image.pixel(x, y));
    };
    paint(0, 0, 1, 0, 0, 1);
    paint(1, 0, 1, 0, 0, 0.1f);
    paint(2, 0, 0, 1, 0, 0.5f);
    paint(3, 0, 1, 1, 1, 0);
    for (int x = 0; x < 4; ++x) paint(x, 1, 0, 0, 1, 1);
    const ImageRegion top{{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}};
    CHECK(regionColors(image, top) == std::vector<RegionColor>{{{0, 1, 0}, 1}, {{1, 0, 0}, 2}});
    const ImageRegion transparent{{{0.75, 0}, {1, 0}, {1, 0.5}, {0.75, 0.5}}};
    CHECK_THROWS_AS(regionColors(image, transparent), Error);
    CHECK_THROWS_AS(regionColors(image, ImageRegion{}), Error);
    // A triangle with its corners at the left and the middle of the lower edge holds the centres (⅛, ¾) and no other:
    // at height ¾ it reaches from 0 to ¼.
    const ImageRegion triangle{{{0, 0.5}, {0.5, 1}, {0, 1}}};
    CHECK(regionColors(image, triangle) == std::vector<RegionColor>{{{0, 0, 1}, 1}});
}

TEST_CASE("a region that crosses itself holds what an odd number of edges surrounds", "[refine][region]") {
    // A bow tie: left and right triangle in, above and below the crossing out.
    const ImageRegion bow{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
    CHECK(bow.contains(0.1, 0.5));
    CHECK(bow.contains(0.9, 0.5));
    CHECK_FALSE(bow.contains(0.5, 0.1));
    CHECK_FALSE(bow.contains(0.5, 0.9));
    CHECK_FALSE(bow.contains(-0.1, 0.5));
}

TEST_CASE("what is chosen becomes more opaque than global refinement leaves it, and is seen more",
          "[refine][priority][real]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/";
    if (!std::filesystem::is_directory(folder)) {
        WARN("SKIPPED: there is no folder " << folder);
        return;
    }
    // The skull as a ring on a cut through the head, seen from above; enamel and its border on a cut through the tooth.
    // The intensities are those of the tents, and of the ramp's points, whose colours are seen there.
    View headCut, toothCut;
    headCut.clipping.hi.z = 0.6;
    toothCut.clipping.lo.y = 0.5;
    const RealCase cases[] = {{"cranium_ct/cranium_ct.nrrd", headCut, anglesOf(StandardView::Top, WorldAxes::Patient),
                               96, 150, 101, 190, 2.0 / 6, 4.0 / 6},
                              {"tooth/tooth.mhd", toothCut, {0, 0, 1}, 105, 190, 115, 215, 4.0 / 6, 1}};
    for (const RealCase& c : cases) {
        VolumeSource source;
        source.path = folder + c.file;
        const auto volume = std::make_shared<const Volume>(loadVolume(source));
        const Histogram histogram = makeHistogram(*volume);
        const auto engine = makeCpuEngine(volume);
        const View home(homeCamera(volume->geometry(), Projection::Perspective));
        for (const TransferFunction& tf : {tents(6), ramp(6)}) {
            const TransferFunction global = refine(histogram, tf).tf;
            const auto isChosen = [&](const RefineOptions& options, const View& view, double a, double b) {
                const TransferFunction chosen = refine(histogram, tf, options).tf;
                CHECK(opacityShare(chosen, a, b) > opacityShare(global, a, b));
                CHECK(pictureShare(*engine, view, chosen, a, b) > pictureShare(*engine, view, global, a, b));
            };
            for (const int color : {1, 2, 3}) {
                INFO(c.file << ", " << tf.features.size() << " features, colour " << color);
                RefineOptions options;
                options.priority.intensity = (color + 0.5) / 6;
                isChosen(options, home, color / 6.0, (color + 1) / 6.0);
            }
            INFO(c.file << ", " << tf.features.size() << " features, region");
            View view = c.view;
            view.camera =
                cameraFromView(volume->geometry(), c.angles.azimuth, c.angles.elevation, 1, Projection::Perspective);
            RenderSettings settings;
            settings.width = settings.height = 300;
            settings.background.reset();
            settings.clipping = view.clipping;
            const Image picture = makeCpuRenderer(volume)->render(view.camera, tf, settings);
            RefineOptions options;
            options.priority.region = regionColors(picture, {{{c.x0 / 300.0, c.y0 / 300.0},
                                                              {c.x1 / 300.0, c.y0 / 300.0},
                                                              {c.x1 / 300.0, c.y1 / 300.0},
                                                              {c.x0 / 300.0, c.y1 / 300.0}}});
            isChosen(options, view, c.a, c.b);
        }
    }
}
