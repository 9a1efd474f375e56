// The density of a picture at equal shares: coverage, and the curve that opacities follow.
#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "optimize/answer/density_curve.h"
#include "optimize/answer/visibility_words.h"
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

TEST_CASE("the curve ends at bounds, locks leave one picture", "[density]") {
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

TEST_CASE("of equal shares the answer has the coverage of the start, or the one that is asked for", "[density]") {
    const Bench b;
    // Shares of {0.02, 0.05, 0.1}; the start has others, and a coverage of 1 − (0.95·0.95·0.95)⁵ = 0.537.
    const std::vector<double> targets = b.function.shares({0.02, 0.05, 0.1});
    const Proportional function(threeLayers({0.05, 0.05, 0.05}), {1, 2, 3});
    OptimizeProblem problem{function, targets};
    problem.rays = &b.rays;
    const auto answer = [&](const OptimizeOptions& options) {
        const OptimizeResult r = optimize(problem, options);
        REQUIRE(r.seen);
        CHECK(r.history[r.best].objective < 0.001);
        CHECK_FALSE(r.seen->exact);
        CHECK(r.seen->coverage.coverage == Approx(Bench::coverageOf(r.history[r.best].opacity)).margin(2e-3));
        return r.seen->coverage.coverage;
    };
    CHECK(answer({}) == Approx(0.537).epsilon(0.11));
    for (const double wanted : {0.25, 0.5, 0.8}) {
        OptimizeOptions options;
        options.coverage = wanted;
        CHECK(answer(options) == Approx(wanted).epsilon(0.11));
    }
    // A start that hides everything behind it is brought to 0.7, one that is nearly nothing to 0.2.
    const Proportional dense(threeLayers({0.9, 0.9, 0.9}), {1, 2, 3}), thin(threeLayers({1e-3, 1e-3, 1e-3}), {1, 2, 3});
    OptimizeProblem other{dense, targets};
    other.rays = &b.rays;
    CHECK(optimize(other).seen->coverage.coverage == Approx(0.7).epsilon(0.11));
    OptimizeProblem third{thin, targets};
    third.rays = &b.rays;
    CHECK(optimize(third).seen->coverage.coverage == Approx(0.2).epsilon(0.11));
    // More than limits let it have is as much as they do: with τ of the third at most 0.3567 (0.3), 3.385 times that of
    // 0.1, all τ are, and 1 − e^(−5·3.385·(0.0202 + 0.0513 + 0.1054)) = 0.950.
    OptimizeProblem limited{function, targets, {{}, {}, {0, 0.3}}};
    limited.rays = &b.rays;
    OptimizeOptions most;
    most.coverage = 1;
    CHECK(optimize(limited, most).seen->coverage.coverage == Approx(0.950).margin(0.01));
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

TEST_CASE("shares that would make the picture vanish give way to the nearest that can be seen", "[density]") {
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
    OptimizeProblem problem{function, {1, 1}, {{}, {0, 0.999}}};
    problem.rays = &rays;

    const OptimizeResult kept = optimize(problem);
    REQUIRE(kept.seen);
    CHECK(kept.reason == StopReason::Visible);
    // A coverage of 0.2 takes τ = 0.2231/15 of the block: shares 2000·0.01488 to 6.908, 0.811 to 0.189; a little more
    // is aimed at.
    CHECK(kept.history[kept.best].vws[0] == Approx(0.811).margin(0.015));
    CHECK(kept.seen->coverage.coverage >= kFaintCoverage * 0.998);
    CHECK(kept.seen->coverage.coverage < kFaintCoverage * 1.1);
    CHECK_FALSE(kept.seen->faint);
    // What was asked for is one click away, as strong as it can be: 1 − e^(−15 · 6.908/2000) = 0.050.
    REQUIRE(kept.seen->exact);
    CHECK(kept.seen->exact->objective < 0.001);
    CHECK(kept.seen->exact->look.coverage == Approx(0.05).margin(0.008));
    CHECK(function.shares(kept.seen->exact->opacity)[0] == Approx(0.5).margin(0.001));
    CHECK_THAT(keptText(kept), Catch::StartsWith("Asked for 50 % and 50 %; kept 8") && Catch::Contains("opaque"));
    CHECK(faintText(kept).empty());

    OptimizeOptions exact;
    exact.exactShares = true;
    const OptimizeResult asked = optimize(problem, exact);
    CHECK(asked.converged());
    REQUIRE(asked.seen);
    CHECK(asked.seen->faint);
    CHECK(asked.seen->coverage.coverage == Approx(0.05).margin(0.008));
    REQUIRE(asked.seen->visible);
    CHECK(asked.seen->visible->look.coverage >= kFaintCoverage * 0.998);
    CHECK(function.shares(asked.seen->visible->opacity)[0] == Approx(asked.seen->visible->vws[0]).margin(1e-9));
    CHECK_THAT(faintText(asked), Catch::StartsWith("The picture is") && Catch::Contains("Shares of 8"));
    CHECK(keptText(asked).empty());

    // Whoever asks for less gets it, and is told nothing.
    OptimizeOptions thin;
    thin.coverage = 0.04;
    const OptimizeResult wanted = optimize(problem, thin);
    CHECK(wanted.converged());
    CHECK(wanted.seen->coverage.coverage == Approx(0.04).epsilon(0.11));
    CHECK(faintText(wanted).empty());
    CHECK(keptText(wanted).empty());

    // The thesis's methods find shares; their picture does not vanish either.
    OptimizeOptions parallel;
    parallel.method = SearchMethod::Parallel;
    const OptimizeResult searched = optimize(problem, parallel);
    CHECK(searched.seen->coverage.coverage >= kFaintCoverage * 0.998);
    CHECK(searched.laterSteps() > 0);
}

TEST_CASE("coverage counts the rays that meet what is wanted", "[density]") {
    // A column of 0.8 through a block of 0.2, 15 voxels deep; alone, at α of 0.2, it covers its own rays by 1 − 0.8¹⁵ =
    // 0.965, whatever part of the picture that is.
    const auto volume =
        volumeFrom(geometryOf({17, 15, 17}), [](int i, int, int k) { return i == 8 && k == 8 ? 0.8 : 0.2; });
    TransferFunction tf;
    // Between centres the column is fainter: from half-way on it counts.
    tf.points = {{0, 0.1, {1, 0, 0}, false, {}},
                 {0.35, 0.1, {1, 0, 0}, false, {}},
                 {0.45, 0, {0, 0, 1}, false, {}},
                 {0.5, 0.2, {0, 0, 1}, false, {}},
                 {1, 0.2, {0, 0, 1}, false, {}}};
    tf.features = {{"block", 0, 0.35, {1, 0, 0}, {}}, {"column", 0.45, 1, {0, 0, 1}, {}}};
    View view(lookingAlong(volume->geometry(), {0, 1, 0}));
    view.camera.height = 18;
    const RayBundle rays(*volume, tf, view, kCoverageRays);
    const TransferFunction alone = withFeatureOpacities(tf, {0, 0.2});
    const Coverage wanted = coverageOf(rays, {alone}, {0, 1})[0], drawn = coverageOf(rays, alone),
                   all = coverageOf(rays, {alone}, {1, 1})[0];
    CHECK(wanted.coverage > 0.5); // interpolation takes some of its border
    CHECK(drawn == wanted);
    CHECK(all.coverage < 0.1);
    CHECK(all.covers == wanted.covers);
}

TEST_CASE("shares and parts of alpha in words", "[density]") {
    CHECK(percentText(0.123) == "12 %");
    CHECK(percentText(0.0123) == "1.2 %");
    CHECK(percentText(0.0996) == "10 %");
    CHECK(percentText(0.0001) == "< 0.1 %");
    CHECK(percentText(0) == "0 %");
    OptimizeResult r;
    r.tf = tents(3);
    r.targets = {0.25, 0.25, 0.5};
    r.history = {{0.1, {0.3, 0.25, 0.45}, {0.1, 0.1, 0.1}, 0}};
    r.seen = Seen{{0.2, {0.1, 0.1, 0.1}}, false, {}, {}, {}};
    CHECK(keptText(r).empty());
    r.seen->exact = SeenShares{{0, 0, 0}, {0.25, 0.25, 0.5}, 0, {0.065, {0.001, 0.015, 0.1}}};
    CHECK(keptText(r) ==
          "Asked for 25 %, 25 % and 50 %; kept 30 %, 25 % and 45 %, so that all of it can be seen: with the "
          "shares asked for the picture is 6.5 % opaque, and 'f1' and 'f2' add at most 1.5 % to the "
          "pixels that they cover.");
    r.seen.emplace();
    r.seen->coverage = {0.065, {0.1, 0.1, 0.001}};
    r.seen->faint = true;
    r.seen->unseen = {2};
    CHECK(faintText(r) == "The picture is 6.5 % opaque, and 'f3' adds 0.1 % to the pixels that it covers.");
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
