#include <catch2/catch.hpp>

#include "optimize/answer/verdict.h"
#include "saliency/saliency_field.h"
#include "support/random_cases.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Answers by the cpu engine on a whole volume.
class EngineTools final : public VerdictTools {
public:
    EngineTools(std::shared_ptr<const Volume> volume, std::vector<double> targets)
        : m_volume(std::move(volume)), m_targets(std::move(targets)), m_engine(makeCpuEngine(m_volume)) {}

    const Geometry& geometry() const override { return m_volume->geometry(); }
    OptimizeResult solve(const ReachProblem& p, bool, const JobControl& job) override {
        const WeightFields weights = saliencyFields(*m_volume, p.tf);
        OptimizeOptions options;
        options.method = SearchMethod::Newton;
        options.tolerance = 1e-3;
        return optimize({EngineVws(*m_engine, p.view, p.tf, weights), m_targets, p.limits}, options, job);
    }
    std::vector<FeatureSums> sums(const ReachProblem& p, const std::vector<std::vector<double>>& candidates,
                                  const JobControl& job) override {
        const WeightFields weights = saliencyFields(*m_volume, p.tf);
        std::vector<TransferFunction> tfs;
        for (const auto& x : candidates) tfs.push_back(withFeatureOpacities(p.tf, x));
        return m_engine->sums(p.view, tfs, &weights, job);
    }
    /// F of many opacities.
    std::vector<double> objectives(const ReachProblem& p, const std::vector<std::vector<double>>& candidates) {
        if (m_gridWeights.empty()) m_gridWeights = saliencyFields(*m_volume, p.tf);
        const EngineVws f(*m_engine, p.view, p.tf, m_gridWeights);
        std::vector<double> all;
        for (const auto& w : f.evaluate(candidates)) all.push_back(objectiveOf(w, m_targets));
        return all;
    }

private:
    std::shared_ptr<const Volume> m_volume;
    std::vector<double> m_targets;
    std::unique_ptr<VisibilityEngine> m_engine;
    WeightFields m_gridWeights;
};

/// Extinctions per d0 of a grid: logarithmic from faint to what alpha's cap allows.
constexpr double kFaintest = 1e-5, kStrongest = 16.0;
constexpr int kSamples = 5; ///< along each axis, in each round
double opacityAt(double y) { return -std::expm1(-std::exp(y)); }

/// The least F by brute force: a grid over the logarithms of the free extinctions, and five finer ones around its best.
double gridMinimum(EngineTools& tools, const ReachProblem& p, const std::vector<double>& start) {
    const std::size_t n = start.size();
    std::vector<double> lo(n), hi(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto y = [](double x) { return std::log(std::clamp(-std::log1p(-x), kFaintest, kStrongest)); };
        lo[i] = y(p.limits[i].locked ? start[i] : p.limits[i].lowest);
        hi[i] = y(p.limits[i].locked ? start[i] : p.limits[i].highest >= 1 ? 1 - 1e-7 : p.limits[i].highest);
    }
    double best = 1e9;
    std::vector<double> bestY(n);
    std::vector<double> from = lo, to = hi;
    for (int round = 0; round < 6; ++round) {
        std::vector<std::vector<double>> ys{{}};
        for (std::size_t i = 0; i < n; ++i) {
            const int samples = p.limits[i].locked ? 1 : kSamples;
            std::vector<std::vector<double>> next;
            for (const auto& y : ys)
                for (int k = 0; k < samples; ++k) {
                    next.push_back(y);
                    next.back().push_back(samples == 1 ? from[i] : from[i] + (to[i] - from[i]) * k / (samples - 1));
                }
            ys = std::move(next);
        }
        std::vector<std::vector<double>> xs;
        for (const auto& y : ys) {
            xs.emplace_back();
            for (std::size_t i = 0; i < n; ++i) xs.back().push_back(p.limits[i].locked ? start[i] : opacityAt(y[i]));
        }
        const std::vector<double> all = tools.objectives(p, xs);
        for (std::size_t k = 0; k < all.size(); ++k)
            if (all[k] < best) {
                best = all[k];
                bestY = ys[k];
            }
        for (std::size_t i = 0; i < n; ++i) { // a cell and a half to each side
            const double cell = (to[i] - from[i]) / (kSamples - 1);
            from[i] = std::max(lo[i], bestY[i] - 1.5 * cell);
            to[i] = std::min(hi[i], bestY[i] + 1.5 * cell);
        }
    }
    return best;
}

struct HeldCase {
    ReachProblem problem;
    std::vector<double> targets;
};

/// Three tents of a random volume; one or two of them locked, or kept from being faint, against what is wanted of them.
HeldCase heldCase(std::uint32_t number, std::shared_ptr<const Volume>& volume) {
    RandomCase c = randomCase(number, 0.3);
    volume = c.volume;
    Random random(1000 + number);
    HeldCase held;
    held.problem.view = c.view();
    held.problem.tf = tents(3, 0.3);
    held.problem.limits.assign(3, {});
    const auto a = static_cast<std::size_t>(random.below(3)),
               b = (a + 1 + static_cast<std::size_t>(random.below(2))) % 3;
    held.targets = {0.02, 0.02, 0.02};
    const std::size_t wanted = 3 - a - b; // what is left
    held.targets[wanted] = 0.96;
    if (random.chance(0.5))
        held.problem.limits[a].locked = true;
    else
        held.problem.limits[a].lowest = random.between(0.1, 0.4);
    if (random.chance(0.5)) held.problem.limits[b].lowest = random.between(0.01, 0.05);
    held.problem.limits[wanted].highest = random.between(0.05, 0.5);
    held.problem.tf = withFeatureOpacities(held.problem.tf, {0.3, 0.3, 0.3});
    return held;
}

} // namespace

TEST_CASE("verdicts agree with a brute-force grid", "[optimize][verdict]") {
    int unreachable = 0;
    for (std::uint32_t number = 0; unreachable < 12 && number < 40; ++number) {
        std::shared_ptr<const Volume> volume;
        const HeldCase held = heldCase(number, volume);
        EngineTools tools(volume, held.targets);
        const std::vector<double> start = featureOpacities(held.problem.tf);
        const OptimizeResult found = tools.solve(held.problem, false, {});
        if (found.history[found.best].objective < 0.05) continue; // within reach
        const double least = gridMinimum(tools, held.problem, start);
        INFO("case " << number << ", grid " << least << ", found " << found.history[found.best].objective);
        const Verdict verdict =
            explain(tools, held.problem, held.targets, found, {.tolerance = 0.03, .otherViews = false});
        CHECK(verdict.objective == Approx(least).margin(0.01));
        // Each limit lifted in turn: the one that brings F down most is the limiting one.
        std::vector<double> released(3, least);
        for (std::size_t j = 0; j < 3; ++j) {
            if (held.problem.limits[j] == OpacityLimits{}) continue;
            ReachProblem p = held.problem;
            p.limits[j] = {};
            released[j] = gridMinimum(tools, p, start);
        }
        const double best = *std::min_element(released.begin(), released.end());
        if (best > least - 0.01) continue; // no single limit holds it
        ++unreachable;
        REQUIRE_FALSE(verdict.limits.empty());
        const ReachLimit& first = verdict.limits.front();
        if (first.reason != LimitReason::OutOfSight && first.reason != LimitReason::NoContrast) {
            CHECK(released[first.feature] <= best + 0.01);
            CHECK(first.objective == Approx(best).margin(0.01));
        }
        CHECK(verdict.sentences.size() >= 2);
    }
    CHECK(unreachable == 12);
}

namespace {

/// In 24³, the left half holds 0.25, the right half 0.75; nothing around them, nor within `gap` of the border between.
std::shared_ptr<const Volume> halves(int gap = 0) {
    Geometry g;
    g.dims = {24, 24, 24};
    std::vector<float> values;
    for (int k = 0; k < 24; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 0; i < 24; ++i) {
                const bool inside =
                    std::min({i, j, k}) >= 4 && std::max({i, j, k}) < 20 && (i < 12 - gap || i >= 12 + gap);
                values.push_back(!inside ? 0.0F : i < 12 ? 0.25F : 0.75F);
            }
    values[0] = 1;
    return std::make_shared<const Volume>(g, Samples(SampleArray<float>(std::move(values))));
}

/// Features around 0.25 and 0.75.
TransferFunction twoTents() {
    TransferFunction tf = tents(2, 0.5);
    tf.features[0].name = "left";
    tf.features[1].name = "right";
    return tf;
}

} // namespace

TEST_CASE("what is clipped away is said to be out of sight, and that the clipping is why", "[optimize][verdict]") {
    const auto volume = halves();
    ReachProblem p{View(cameraFromView(volume->geometry(), 0, 0, 1, Projection::Orthographic)), twoTents(), {{}, {}}};
    p.view.clipping.hi.x = 0.45; // of 24: all of the right half lies beyond
    EngineTools tools(volume, {0.5, 0.5});
    const OptimizeResult found = tools.solve(p, false, {});
    CHECK(found.history[found.best].objective == Approx(0.5)); // W = (1, 0) whatever the opacities are
    const Verdict v = explain(tools, p, {0.5, 0.5}, found, {});
    REQUIRE_FALSE(v.limits.empty());
    CHECK(v.limits[0].feature == 1);
    CHECK(v.limits[0].reason == LimitReason::OutOfSight);
    REQUIRE_FALSE(v.helps.empty());
    CHECK(v.helps[0].kind == ReachHelp::Kind::Clipping);
    CHECK(v.helps[0].objective < 0.01);
    CHECK(v.sentences.back().find("Without clipping the targets are reached") == 0);
}

TEST_CASE("what has the colour of the background needs another one", "[optimize][verdict]") {
    // Six voxels apart, more than 2σ = 4: black in black has no saliency at all.
    const auto volume = halves(3);
    ReachProblem p{View(cameraFromView(volume->geometry(), 0, 0, 1, Projection::Orthographic)), twoTents(), {{}, {}}};
    for (ControlPoint& c : p.tf.points)
        if (c.x > 0.5) c.color = {0, 0, 0};
    p.tf.features[1].color = {0, 0, 0};
    EngineTools tools(volume, {0.2, 0.8});
    const OptimizeResult found = tools.solve(p, false, {});
    CHECK(found.history[found.best].objective == Approx(0.8)); // W = (1, 0): sqrt((0.8² + 0.8²)/2)
    const Verdict v = explain(tools, p, {0.2, 0.8}, found, {});
    REQUIRE_FALSE(v.limits.empty());
    CHECK(v.limits[0].feature == 1);
    CHECK(v.limits[0].reason == LimitReason::NoContrast);
    REQUIRE_FALSE(v.helps.empty());
    CHECK(v.helps[0].kind == ReachHelp::Kind::Color);
    CHECK(v.helps[0].feature == 1);
    CHECK(v.helps[0].objective < 0.01);
}

TEST_CASE("a locked feature in front is held responsible, and the view from behind is found", "[optimize][verdict]") {
    const auto volume = halves();
    // From the left (azimuth −90) the left half hides the right one.
    ReachProblem p{View(cameraFromView(volume->geometry(), -90, 0, 1, Projection::Orthographic)), twoTents(), {{}, {}}};
    p.tf = withFeatureOpacities(p.tf, {0.9, 0.5});
    p.limits[0].locked = true;
    EngineTools tools(volume, {0.3, 0.7});
    const OptimizeResult found = tools.solve(p, false, {});
    // 12 layers of opacity 0.9 let 1e-12 through (8 of them at 16 voxels' width).
    CHECK(found.history[found.best].vws[1] < 0.01);
    const Verdict v = explain(tools, p, {0.3, 0.7}, found, {});
    REQUIRE(v.limits.size() == 1);
    CHECK(v.limits[0].feature == 0);
    CHECK(v.limits[0].reason == LimitReason::Locked);
    CHECK(v.limits[0].objective < 0.03);
    CHECK(v.occlusion[1][0] > 0.99);
    CHECK(v.occlusion[0][1] < 0.01);
    const auto view = std::find_if(v.helps.begin(), v.helps.end(),
                                   [](const ReachHelp& h) { return h.kind == ReachHelp::Kind::View; });
    REQUIRE(view != v.helps.end());
    CHECK(view->objective < found.history[found.best].objective - 0.1);
    CHECK(std::find(v.sentences.begin(), v.sentences.end(), "There, left hides 100 % of right.") != v.sentences.end());
}

namespace {

/// Says what each search would reach, as a function of the direction of the eye.
class ToldTools final : public VerdictTools {
public:
    explicit ToldTools(double fromElsewhere) : m_fromElsewhere(fromElsewhere) {}
    const Geometry& geometry() const override { return m_geometry; }
    OptimizeResult solve(const ReachProblem&, bool, const JobControl&) override { return resultOf(m_fromElsewhere); }
    std::vector<FeatureSums> sums(const ReachProblem&, const std::vector<std::vector<double>>& candidates,
                                  const JobControl&) override {
        FeatureSums sums; // the second feature is out of sight
        sums.visibility = {1, 0};
        sums.weighted[0] = sums.weighted[1] = {1, 0};
        sums.allVisibility = 1;
        return std::vector<FeatureSums>(candidates.size(), sums);
    }
    static OptimizeResult resultOf(double objective) {
        OptimizeResult result;
        OptimizeState state;
        state.objective = objective;
        state.vws = {1, 0};
        state.opacity = {0.5, 0.5};
        result.history = {state};
        return result;
    }

private:
    Geometry m_geometry = geometryOf({8, 8, 8});
    double m_fromElsewhere;
};

} // namespace

TEST_CASE("a view that hardly helps is not offered", "[optimize][verdict]") {
    const ReachProblem p{
        View(cameraFromView(geometryOf({8, 8, 8}), 0, 0, 1, Projection::Orthographic)), twoTents(), {{}, {}}};
    const auto offersView = [&](double here, double elsewhere) {
        ToldTools tools(elsewhere);
        const Verdict v = explain(tools, p, {0.3, 0.7}, ToldTools::resultOf(here), {});
        return std::ranges::any_of(v.helps, [](const ReachHelp& h) { return h.kind == ReachHelp::Kind::View; });
    };
    CHECK_FALSE(offersView(0.646, 0.622));
    CHECK_FALSE(offersView(0.4, 0.301)); // more than three quarters are left
    CHECK(offersView(0.4, 0.299));
    CHECK(offersView(0.038, 0.029));        // on target, whatever the part
    CHECK_FALSE(offersView(0.034, 0.0296)); // by less than 0.005
}

TEST_CASE("occlusion is what a feature's removal uncovers", "[optimize][verdict]") {
    // Two layers of one voxel along y: v = α_0 of the front one, α_1 (1 − α_0) of the one behind.
    FeatureSums as, without0, without1;
    as.visibility = {0.5, 0.25};
    without0.visibility = {0, 0.5};
    without1.visibility = {0.5, 0};
    const OcclusionMatrix m = occlusionOf({as, without0, without1});
    CHECK(m[1][0] == Approx(0.5));
    CHECK(m[0][1] == 0);
    CHECK(m[0][0] == 0);
    TransferFunction tf = tents(2);
    CHECK(occlusionWords(m, tf.features) == std::vector<std::string>{"f1 hides 50 % of f2"});
}
