#include <catch2/catch.hpp>

#include "base/error.h"
#include "optimize/measure.h"
#include "optimize/optimizer.h"
#include "support/volumes.h"
#include "tf/shown_tf.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// An engine without a volume's geometry: feature f has visibility g_f·x_f, so that W_f = g_f x_f / Σ g x.
class ProportionalEngine final : public VisibilityEngine {
public:
    explicit ProportionalEngine(std::vector<double> gains)
        : m_volume(slab({2, 2, 2}, 0.5)), m_gains(std::move(gains)) {}
    std::string name() const override { return "proportional"; }
    const Volume& volume() const override { return *m_volume; }
    std::vector<FeatureSums> sums(const View&, std::span<const TransferFunction> tfs, const WeightFields*,
                                  const JobControl& job) override {
        job.throwIfStopped();
        ++calls;
        std::vector<FeatureSums> all;
        for (const TransferFunction& tf : tfs) {
            FeatureSums s;
            const auto x = featureOpacities(tf);
            for (std::size_t f = 0; f < x.size(); ++f) s.visibility.push_back(m_gains[f] * x[f]);
            for (const double v : s.visibility) s.allVisibility += v;
            s.weighted = {s.visibility, s.visibility};
            s.allWeighted = {s.allVisibility, s.allVisibility};
            all.push_back(s);
        }
        return all;
    }
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        SumsJacobian result{sums(view, {&tf, 1}, weights, job)[0], {}};
        for (std::size_t j = 0; j < m_gains.size(); ++j) {
            FeatureSums d;
            d.visibility.assign(m_gains.size(), 0.0);
            d.visibility[j] = d.allVisibility = m_gains[j];
            d.weighted = {d.visibility, d.visibility};
            d.allWeighted = {m_gains[j], m_gains[j]};
            result.byOpacity.push_back(d);
        }
        return result;
    }
    VisibilityField field(const View&, const TransferFunction&, const JobControl&) override {
        return {Grid<float>(m_volume->dims())};
    }

    int calls = 0;

private:
    std::shared_ptr<const Volume> m_volume;
    std::vector<double> m_gains;
};

const WeightFields kNoWeights;

OptimizeOptions with(SearchMethod method) {
    OptimizeOptions options;
    options.method = method;
    return options;
}

} // namespace

TEST_CASE("targets are normalised, and bad ones refused", "[optimize]") {
    CHECK(normalizedTargets({1, 3, 6}, 3) == std::vector<double>{0.1, 0.3, 0.6});
    CHECK(normalizedTargets({0, 5}, 2) == std::vector<double>{0, 1});
    CHECK_THROWS_AS(normalizedTargets({1, 1}, 3), UsageError);
    CHECK_THROWS_AS(normalizedTargets({0, 0, 0}, 3), UsageError);
    CHECK_THROWS_AS(normalizedTargets({1, -1, 1}, 3), UsageError);
    CHECK_THROWS_AS(normalizedTargets({1, std::nan(""), 1}, 3), UsageError);
    CHECK_THROWS_AS(normalizedTargets({}, 0), UsageError);
}

TEST_CASE("the objective is the root mean square distance (5.1)", "[optimize]") {
    const std::vector<double> w{0.5, 0.5, 0.0}, t{0.1, 0.3, 0.6};
    CHECK(objectiveOf(w, t) == Approx(std::sqrt((0.16 + 0.04 + 0.36) / 3)));
    CHECK(objectiveOf(t, t) == 0);
}

TEST_CASE("a fixed step moves by 0.05·2(W − t), clamped", "[optimize]") {
    // x = ½ each, gains 1: W = ⅓ each. Targets (0, 0, 1): d = 2·(⅓, ⅓, −⅔).
    ProportionalEngine engine({1, 1, 1});
    const EngineVws f(engine, {}, tents(3, 0.5), kNoWeights);
    OptimizeOptions options = with(SearchMethod::Fixed);
    options.maxIterations = 1;
    const OptimizeResult r = optimize({f, {0, 0, 1}}, options);
    REQUIRE(r.history.size() == 2);
    CHECK(r.history[1].opacity[0] == Approx(0.5 - 0.05 * 2 / 3));
    CHECK(r.history[1].opacity[2] == Approx(0.5 + 0.05 * 4 / 3));
    CHECK(r.evaluations == 2);
    CHECK(r.reason == StopReason::MaxIterations);
    options.normalize = true; // the same direction at unit length: (⅓, ⅓, −⅔)/√(6/9)
    CHECK(optimize({f, {0, 0, 1}}, options).history[1].opacity[0] == Approx(0.5 - 0.05 / std::sqrt(6.0)));
}

TEST_CASE("every method reaches the targets, searches in fewer moves", "[optimize]") {
    std::vector<int> moves;
    for (const auto method : {SearchMethod::Fixed, SearchMethod::Line, SearchMethod::Parallel}) {
        ProportionalEngine engine({20, 3, 1});
        const EngineVws f(engine, {}, tents(3, 0.5), kNoWeights);
        const OptimizeResult r = optimize({f, {0.1, 0.3, 0.6}}, with(method));
        INFO(name(method));
        CHECK(r.converged());
        CHECK(r.history[r.best].objective < 0.03);
        CHECK(featureOpacities(r.tf)[0] == Approx(r.history[r.best].opacity[0]));
        moves.push_back(r.iterations());
    }
    CHECK(moves[1] < moves[0]);
    CHECK(moves[2] <= moves[1]);
}

TEST_CASE("a hidden feature is aimed at nothing and keeps its opacity", "[optimize]") {
    TransferFunction tf = tents(3, 0.5);
    tf.features[1].hidden = true;
    for (const auto method : {SearchMethod::Fixed, SearchMethod::Line, SearchMethod::Parallel}) {
        ProportionalEngine engine({20, 3, 1});
        const EngineVws f(engine, {}, shownTf(tf), kNoWeights);
        const OptimizeResult r = optimize({f, shownShares(tf, {0.1, 0.6, 0.3})}, with(method));
        INFO(name(method));
        CHECK(r.converged());
        for (const OptimizeState& state : r.history) {
            CHECK(state.opacity[1] == 0);
            CHECK(state.vws[1] == 0);
        }
        // Shares of 0.1 and 0.3 among the two that are shown: 1/4 and 3/4.
        CHECK(r.history[r.best].vws[2] == Approx(0.75).margin(0.06)); // F < 0.03 over three features
        const TransferFunction found = withShownOpacities(tf, r.history[r.best].opacity);
        CHECK(featureOpacities(found)[1] == 0.5);
        CHECK(found.features[1].hidden);
    }
}

TEST_CASE("the parallel search asks for its eight steps in one engine call", "[optimize]") {
    ProportionalEngine engine({20, 3, 1});
    const EngineVws f(engine, {}, tents(3, 0.5), kNoWeights);
    const OptimizeResult r = optimize({f, {0.1, 0.3, 0.6}}, with(SearchMethod::Parallel));
    CHECK(r.evaluations == 1 + 8 * r.iterations());
    CHECK(engine.calls == 1 + r.iterations());
}

TEST_CASE("an answer is never worse than its start", "[optimize]") {
    // Feature 2 gives nothing however opaque: its target cannot be reached, and a huge fixed step overshoots.
    ProportionalEngine engine({1, 0, 1});
    const EngineVws f(engine, {}, tents(3, 0.5), kNoWeights);
    OptimizeOptions options = with(SearchMethod::Fixed);
    options.step = 10;
    options.maxIterations = 7;
    const OptimizeResult r = optimize({f, {0.4, 0.2, 0.4}}, options);
    for (const OptimizeState& state : r.history) CHECK(r.history[r.best].objective <= state.objective);
    CHECK_FALSE(r.converged());
    for (const auto method : {SearchMethod::Line, SearchMethod::Parallel}) {
        const OptimizeResult stuck = optimize({f, {0.4, 0.2, 0.4}}, with(method));
        CHECK(stuck.reason == StopReason::NoProgress); // 0.2 of what cannot be seen
        CHECK(stuck.history[stuck.best].objective <= stuck.history[0].objective);
    }
}

TEST_CASE("a start at the target needs no move", "[optimize]") {
    ProportionalEngine engine({1, 1});
    const EngineVws f(engine, {}, tents(2, 0.5), kNoWeights);
    const OptimizeResult r = optimize({f, {1, 1}}, {});
    CHECK(r.converged());
    CHECK(r.iterations() == 0);
    CHECK(r.tf == tents(2, 0.5));
}

TEST_CASE("cancelling returns what is there so far", "[optimize]") {
    ProportionalEngine engine({20, 3, 1});
    const EngineVws f(engine, {}, tents(3, 0.5), kNoWeights);
    std::stop_source stop;
    int seen = 0;
    const OptimizeResult r =
        optimize({f, {0.1, 0.3, 0.6}}, with(SearchMethod::Fixed), {stop.get_token(), {}}, [&](const OptimizeState&) {
            if (++seen == 3) stop.request_stop();
        });
    CHECK(r.reason == StopReason::Cancelled);
    CHECK(r.history.size() == 3);
    stop = {};
    stop.request_stop();
    const OptimizeResult none = optimize({f, {0.1, 0.3, 0.6}}, {}, {stop.get_token(), {}});
    CHECK(none.reason == StopReason::Cancelled);
    CHECK(none.history.empty());
    CHECK(none.iterations() == 0);
    CHECK(none.tf == tents(3, 0.5));
}

TEST_CASE("optimizing a real volume makes its core visible", "[optimize]") {
    // Three concentric shells: the outer one hides the others until its opacity falls.
    const auto volume = volumeFrom(geometryOf({32, 32, 32}), [](int i, int j, int k) {
        return std::clamp(1.05 - glm::length(Vec3(i, j, k) - 15.5) / 16, 0.0, 1.0);
    });
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const auto engine = makeCpuEngine(volume);
    const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective);
    const OptimizeResult r = optimize({EngineVws(*engine, camera, tf, weights), {0.1, 0.3, 0.6}});
    CHECK(r.converged());
    CHECK(r.history[0].vws[2] < 0.2);
    const Measures after = measure(*engine, camera, r.tf, weights);
    CHECK(after.features[2].vws == Approx(0.6).margin(0.06)); // F < 0.03: no W further off than 0.03·√3
    CHECK(after.features[0].vws == Approx(0.1).margin(0.06));
    double sum = 0;
    for (const double h : after.visibilityHistogram) sum += h;
    CHECK(sum == Approx(1));
}

TEST_CASE("impossible optimization options are refused", "[optimize]") {
    ProportionalEngine engine({1, 1});
    const EngineVws f(engine, {}, tents(2), kNoWeights);
    OptimizeOptions options;
    options.step = 0;
    CHECK_THROWS_AS(optimize({f, {1, 1}}, options), UsageError);
    options = {};
    options.tolerance = std::nan("");
    CHECK_THROWS_AS(optimize({f, {1, 1}}, options), UsageError);
    CHECK_THROWS_AS(fromName<SearchMethod>("newton2"), UsageError);
    CHECK(fromName<SearchMethod>("line") == SearchMethod::Line);
}
