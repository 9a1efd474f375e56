// The density of a picture at equal shares: coverage, and the curve that opacities follow.
#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "optimize/density_curve.h"
#include "optimize/visibility_words.h"
#include "optimize/visible_answer.h"
#include "render/camera_motion.h"
#include "support/volumes.h"
#include "tf/opacity.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Three features of constant opacity that meet without gaps: [0, 0.35), [0.35, 0.65), [0.65, 1].
TransferFunction threeLayers(const std::vector<double>& x) {
    TransferFunction tf;
    const double borders[]{0, 0.35, 0.65, 1};
    for (std::size_t f = 0; f < 3; ++f) {
        const Rgb color{f == 0 ? 1.0 : 0.0, f == 1 ? 1.0 : 0.0, f == 2 ? 1.0 : 0.0};
        tf.points.push_back({borders[f], x[f], color, false, {}});
        tf.points.push_back({borders[f + 1], x[f], color, false, {}});
        tf.features.push_back({std::string(1, static_cast<char>('a' + f)), borders[f], borders[f + 1], color, {}});
    }
    return tf;
}

/// 15 voxels along y, five of 0.2, five of 0.5, five of 0.8, and a view along y.
std::shared_ptr<const Volume> layers() {
    return volumeFrom(geometryOf({8, 15, 8}), [](int, int j, int) { return j < 5 ? 0.2 : j < 10 ? 0.5 : 0.8; });
}
View alongY(const Volume& volume) {
    View view(lookingAlong(volume.geometry(), {0, 1, 0}));
    view.camera.height = 12;
    return view;
}

/// W_f = g_f τ_f / Σ g τ: what thin matter shows. Equal shares are all τ times the same.
class Proportional final : public VwsFunction {
public:
    Proportional(TransferFunction base, std::vector<double> g) : m_base(std::move(base)), m_g(std::move(g)) {}
    const TransferFunction& base() const override { return m_base; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl&) const override {
        std::vector<std::vector<double>> all;
        for (const auto& x : candidates) all.push_back(shares(x));
        return all;
    }
    Linear jacobian(const std::vector<double>& x, const JobControl&) const override {
        Linear linear{shares(x), {}};
        double sum = 0;
        for (std::size_t f = 0; f < x.size(); ++f) sum += m_g[f] * opticalDepthOfOpacity(x[f]);
        for (std::size_t i = 0; i < x.size(); ++i) {
            linear.derivative.emplace_back();
            for (std::size_t j = 0; j < x.size(); ++j) // dτ/dα = 1/(1 − α)
                linear.derivative[i].push_back(m_g[j] / (1 - std::min(x[j], kMaxOpacity)) / sum *
                                               ((i == j ? 1 : 0) - linear.vws[i]));
        }
        return linear;
    }

    std::vector<double> shares(const std::vector<double>& x) const {
        std::vector<double> w;
        for (std::size_t f = 0; f < x.size(); ++f) w.push_back(m_g[f] * opticalDepthOfOpacity(x[f]));
        const double sum = std::accumulate(w.begin(), w.end(), 0.0);
        for (double& v : w) v /= sum;
        return w;
    }

private:
    TransferFunction m_base;
    std::vector<double> m_g;
};

struct Bench {
    std::shared_ptr<const Volume> volume = layers();
    TransferFunction base = threeLayers({0.5, 0.5, 0.5});
    RayBundle rays{*volume, base, alongY(*volume), kCoverageRays};
    Proportional function{base, {1, 2, 3}};
    /// Of 15 voxels, five of each.
    static double coverageOf(const std::vector<double>& x) {
        return 1 - std::pow((1 - x[0]) * (1 - x[1]) * (1 - x[2]), 5);
    }
};

} // namespace

TEST_CASE("coverage of a homogeneous block is 1 − (1 − α)ⁿ, hidden features have none", "[density]") {
    const auto volume = slab({8, 12, 8}, 0.75);
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    view.camera.height = 12;
    const RayBundle rays(*volume, homogeneous(0.1), view, kCoverageRays);
    const Coverage c = coverageOf(rays, homogeneous(0.1));
    CHECK(c.coverage == Approx(1 - std::pow(0.9, 12)).margin(1e-5));
    REQUIRE(c.covers.size() == 1);
    CHECK(c.covers[0] == Approx(c.coverage));

    // Of layers of 0.1, 0.2, 0.3 seen front to back: what is left of light in front of each, times its alpha.
    const Bench b;
    const TransferFunction tf = threeLayers({0.1, 0.2, 0.3});
    const Coverage three = coverageOf(b.rays, tf);
    CHECK(three.coverage == Approx(Bench::coverageOf({0.1, 0.2, 0.3})).margin(1e-3));
    CHECK(three.covers[0] == Approx(1 - std::pow(0.9, 5)).margin(0.01));
    CHECK(three.covers[1] == Approx(std::pow(0.9, 5) * (1 - std::pow(0.8, 5))).margin(0.01));

    TransferFunction hidden = tf;
    hidden.features[0].hidden = true;
    const Coverage without =
        coverageOf(RayBundle(*b.volume, hidden, alongY(*b.volume)), withFeatureOpacities(hidden, {0, 0.2, 0.3}));
    CHECK(without.covers[0] == 0);
    CHECK(without.coverage == Approx(1 - std::pow(0.8 * 0.7, 5)).margin(0.01));
}

TEST_CASE("where shares are proportions of depth the curve is that of depths times the same", "[density]") {
    const Bench b;
    const std::vector<double> start{0.02, 0.05, 0.1};
    const DensityCurve curve = densityCurve({b.function, nullptr, b.rays}, start);
    REQUIRE(curve.points.size() >= 8);
    for (const DensityPoint& p : curve.points) {
        const double factor = opticalDepthOfOpacity(p.opacity[0]) / opticalDepthOfOpacity(start[0]);
        for (std::size_t f = 1; f < 3; ++f)
            CHECK(opticalDepthOfOpacity(p.opacity[f]) ==
                  Approx(factor * opticalDepthOfOpacity(start[f])).epsilon(0.01));
        CHECK(p.objective < 0.001);
        CHECK(p.coverage.coverage == Approx(Bench::coverageOf(p.opacity)).margin(2e-3));
    }
    for (std::size_t i = 1; i < curve.points.size(); ++i)
        CHECK(curve.points[i].coverage.coverage > curve.points[i - 1].coverage.coverage);
    // It ends where the coverage, 1 − e^(−5 Σ τ), no longer grows, and at a tenth of that or less.
    CHECK(curve.strongest().coverage.coverage > 0.999);
    CHECK(curve.faintest().coverage.coverage < 0.1);
    // Between points too.
    for (const double coverage : {0.15, 0.33, 0.5, 0.77, 0.9}) {
        const std::vector<double> x = curve.at(coverage);
        CHECK(Bench::coverageOf(x) == Approx(coverage).epsilon(0.03));
        CHECK(objectiveOf(b.function.shares(x), curve.shares) < 0.002);
    }
    CHECK(curve.at(2) == curve.strongest().opacity);
    CHECK(curve.at(0) == curve.faintest().opacity);
}

TEST_CASE("the curve ends at bounds; locks leave one picture", "[density]") {
    const Bench b;
    const std::vector<double> start{0.02, 0.05, 0.1};
    // The second may not pass 0.2, τ = 0.2231 of 0.0513: all may grow by 4.350; the third is then 1 − 0.9^4.350.
    const DensityCurve curve = densityCurve({b.function, nullptr, b.rays, {{}, {0, 0.2}, {}}}, start);
    CHECK(curve.strongest().opacity[1] == Approx(0.2).margin(1e-3));
    CHECK(curve.strongest().opacity[2] == Approx(1 - std::pow(0.9, 4.350)).margin(3e-3));
    // The first not below 0.01, τ = 0.01005 of 0.02020: all may shrink by 0.4975.
    const DensityCurve down = densityCurve({b.function, nullptr, b.rays, {{0.01, 1}, {}, {}}}, start);
    CHECK(down.faintest().opacity[0] == Approx(0.01).margin(2e-4));
    CHECK(down.faintest().opacity[2] == Approx(1 - std::pow(0.9, 0.4975)).margin(1e-3));
    // One that stays leaves no freedom to the others.
    const DensityCurve locked = densityCurve({b.function, nullptr, b.rays, {{0, 1, true}, {}, {}}}, start);
    CHECK(locked.isPoint());
    CHECK(locked.strongest().opacity[0] == 0.02);
    CHECK(locked.strongest().opacity[2] == Approx(0.1).epsilon(0.05));
}

TEST_CASE("an answer goes to the strong end, or to the coverage that is asked for", "[density]") {
    const Bench b;
    const std::vector<double> start{0.02, 0.05, 0.1}, targets = b.function.shares(start);
    const DensityProblem problem{b.function, nullptr, b.rays, {{}, {}, {0, 0.3}}};
    const DensityAnswer strong = atDensity(problem, targets, start);
    CHECK(strong.point.opacity[2] == Approx(0.3).margin(1e-3));
    CHECK(strong.point.objective < 0.001);
    CHECK(strong.strongestCoverage == strong.point.coverage.coverage);
    for (const double wanted : {0.2, 0.5, 0.8}) {
        const DensityAnswer answer = atDensity(problem, targets, start, wanted);
        CHECK(answer.point.coverage.coverage == Approx(wanted).epsilon(0.01));
        CHECK(answer.point.objective < 0.001);
        CHECK(answer.history.back().opacity == answer.point.opacity);
    }
    // More than there is: the strong end.
    CHECK(atDensity(problem, targets, start, 1.0).point.coverage.coverage ==
          Approx(strong.strongestCoverage).epsilon(0.01));
    // Out of reach: the shares of the start are kept, and the distance.
    const std::vector<double> far{0.9, 0.05, 0.05};
    const DensityAnswer away = atDensity(problem, far, start);
    CHECK(away.point.objective == Approx(objectiveOf(targets, far)).margin(0.001));
    CHECK(away.point.coverage.coverage == Approx(strong.strongestCoverage).epsilon(0.01));
}

TEST_CASE("the nearest place on a curve is known again", "[density]") {
    const Bench b;
    const DensityCurve curve = densityCurve({b.function, nullptr, b.rays}, {0.02, 0.05, 0.1});
    for (const double coverage : {0.2, 0.6, 0.9}) {
        const DensityCurve::Nearest nearest = curve.nearest(curve.at(coverage));
        CHECK(nearest.coverage == Approx(coverage).epsilon(1e-6));
        CHECK(nearest.distance < 1e-9);
    }
    // Half as deep again in one feature: ln 1.5 in that, away from the direction in which all grow alike: the nearest
    // place is a third of it further on, and two thirds are left.
    std::vector<double> off = curve.at(0.4);
    off[1] = 1 - std::pow(1 - off[1], 1.5);
    CHECK(curve.nearest(off).distance == Approx(2.0 / 3 * std::log(1.5)).epsilon(0.03));
}

TEST_CASE("shares that force a picture to be faint are said so, with shares that do not", "[density]") {
    // A block of 0.2, 15 voxels deep, and in it a single column of 0.8 that is one voxel deep: with g of 2000 and 1
    // equal shares make τ of the block 1/2000 of the other's, which ends at 6.9 (0.999).
    const auto volume = volumeFrom(geometryOf({16, 15, 16}),
                                   [](int i, int j, int k) { return i == 7 && j == 3 && k == 7 ? 0.8 : 0.2; });
    TransferFunction tf;
    tf.points = {{0, 0.5, {1, 0, 0}, false, {}},
                 {0.5, 0.5, {1, 0, 0}, false, {}},
                 {0.5, 0.5, {0, 0, 1}, false, {}},
                 {1, 0.5, {0, 0, 1}, false, {}}};
    tf.features = {{"block", 0, 0.5, {1, 0, 0}, {}}, {"seed", 0.5, 1, {0, 0, 1}, {}}};
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    view.camera.height = 24;
    const RayBundle rays(*volume, tf, view, kCoverageRays);
    const Proportional function(tf, {2000, 1});
    const std::vector<OpacityLimits> limits{{}, {0, 0.999}};
    const DensityProblem problem{function, nullptr, rays, limits};

    OptimizeOptions options;
    options.method = SearchMethod::Newton;
    OptimizeResult result = optimize({function, {1, 1}, limits}, options);
    REQUIRE(result.converged());
    makeVisible(result, problem, options);
    const OptimizeState& best = result.history[result.best];
    CHECK(best.objective < 0.001);
    CHECK(best.opacity[1] > 0.99);
    REQUIRE(result.seen);
    // 1 − e^(−15 · 6.908/2000) = 0.050, and the one column more.
    CHECK(result.seen->coverage.coverage == Approx(0.05).margin(0.008));
    CHECK(result.seen->strongest >= result.seen->coverage.coverage);
    REQUIRE(result.seen->faint);
    const Faintness& faint = *result.seen->faint;
    CHECK(faint.picture);
    CHECK(faint.limiting == std::vector<std::size_t>{1});
    REQUIRE(faint.remedy);
    // A coverage of 0.3 takes τ = 0.357/15 of the block: shares 2000·0.0238 to 6.908, 0.873 to 0.127.
    CHECK(faint.remedy->shares[0] == Approx(0.87).margin(0.015));
    CHECK(faint.remedy->shares[0] + faint.remedy->shares[1] == Approx(1));
    CHECK(faint.remedy->coverage.coverage == Approx(kVisibleCoverage).epsilon(0.1));
    // Evaluated, not guessed.
    CHECK(function.shares(faint.remedy->opacity)[0] == Approx(faint.remedy->shares[0]).margin(0.002));
    CHECK(coverageOf(rays, withFeatureOpacities(tf, faint.remedy->opacity)) == faint.remedy->coverage);
    const std::string text = faintText(result);
    CHECK_THAT(text, Catch::Contains("5.") && Catch::Contains("'seed' cannot become more opaque") &&
                         Catch::Contains("Shares of " + percentText(faint.remedy->shares[0]) + ", " +
                                         percentText(faint.remedy->shares[1])));

    // Of a picture that has them nothing is said, nor where somebody wanted it as faint as that.
    OptimizeResult visible = optimize({function, {99, 1}, limits}, options);
    makeVisible(visible, problem, options);
    REQUIRE(visible.seen);
    CHECK_FALSE(visible.seen->faint);
    CHECK(faintText(visible).empty());
    options.coverage = 0.1;
    OptimizeResult wanted = optimize({function, {99, 1}, limits}, options);
    makeVisible(wanted, problem, options);
    CHECK(wanted.seen->coverage.coverage == Approx(0.1).epsilon(0.01));
    CHECK_FALSE(wanted.seen->faint);
    CHECK(wanted.seen->strongest == Approx(visible.seen->strongest).epsilon(0.02));
}

TEST_CASE("shares and parts of alpha in words", "[density]") {
    CHECK(percentText(0.123) == "12 %");
    CHECK(percentText(0.0123) == "1.2 %");
    CHECK(percentText(0.0996) == "10 %");
    CHECK(percentText(0.0001) == "< 0.1 %");
    CHECK(percentText(0) == "0 %");
    TransferFunction tf = tents(3);
    Faintness faint;
    faint.picture = true;
    faint.features = {0, 1};
    faint.limiting = {2};
    CHECK(
        faintText(tf, faint, 0.065) ==
        "the picture has 6.5 % of alpha at most, and 'f1' and 'f2' have less than 2.0 % where they are seen, because "
        "'f3' cannot become more opaque and more of anything else would take from its share. No shares close to these "
        "were found that would be visible.");
    faint.searched = false; // of a search without a move nothing is said that was not looked for
    CHECK(faintText(tf, faint, 0.065) ==
          "the picture has 6.5 % of alpha, and 'f1' and 'f2' have less than 2.0 % where they are seen.");
}

TEST_CASE("on a real view equal shares are kept over a tenth of the coverage and more", "[density]") {
    std::mt19937 random(5);
    const auto volume = roughVolume(random, Int3(24), Vec3(1));
    const TransferFunction tf = tents(3, 0.2);
    const View view(homeCamera(volume->geometry(), Projection::Perspective));
    const auto engine = makeCpuEngine(volume);
    const WeightFields weights = saliencyFields(*volume, tf);
    const EngineVws function(*engine, view, tf, weights);
    const RayBundle rays(*volume, tf, view, kCoverageRays);
    const DensityCurve curve = densityCurve({function, nullptr, rays}, {0.2, 0.2, 0.2});
    for (const DensityPoint& p : curve.points) CHECK(p.objective < 0.005);
    CHECK(curve.faintest().coverage.coverage < 0.15 * curve.strongest().coverage.coverage);
    CHECK(curve.strongest().coverage.coverage > coverageOf(rays, withFeatureOpacities(tf, {0.2, 0.2, 0.2})).coverage);
    // The same bits for any number of threads.
    setThreadCount(1);
    const DensityCurve again = densityCurve({function, nullptr, rays}, {0.2, 0.2, 0.2});
    setThreadCount(0);
    REQUIRE(again.points.size() == curve.points.size());
    CHECK(again.strongest().opacity == curve.strongest().opacity);
    // Cancelled at once.
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(densityCurve({function, nullptr, rays}, {0.2, 0.2, 0.2}, {}, {stop.get_token(), {}}), Cancelled);
}
