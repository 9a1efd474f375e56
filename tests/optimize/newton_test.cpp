#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "optimize/measure.h"
#include "optimize/newton.h"
#include "optimize/optimizer.h"
#include "support/random_cases.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Layers one behind the other: layer i has optical depth τ_i = −g_i·ln(1 − x_i) and V_i = (1 − e^−τ_i)·exp(−Σ_{j<i}
/// τ_j); W_i = V_i/ΣV.
class Layers final : public VwsFunction {
public:
    explicit Layers(std::vector<double> gains, double start = 0.5)
        : m_tf(tents(static_cast<int>(gains.size()), start)), m_gains(std::move(gains)) {}
    Layers(std::vector<double> gains, const std::vector<double>& start) : Layers(std::move(gains)) {
        m_tf = withFeatureOpacities(m_tf, start);
    }
    const TransferFunction& base() const override { return m_tf; }
    TransferFunction& base() { return m_tf; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl& job) const override {
        ++calls;
        std::vector<std::vector<double>> all;
        for (const auto& x : candidates) all.push_back(jacobian(x, job).vws);
        return all;
    }
    Linear jacobian(const std::vector<double>& x, const JobControl& job) const override {
        job.throwIfStopped();
        const std::size_t n = x.size();
        std::vector<double> v(n), vx(n);
        std::vector<std::vector<double>> d(n, std::vector<double>(n, 0.0)); // ∂V_i/∂x_j
        double before = 1, sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double rest = 1 - std::min(x[i], 1 - 1e-7), through = std::pow(rest, m_gains[i]);
            v[i] = before * (1 - through);
            d[i][i] = before * m_gains[i] * through / rest;
            for (std::size_t j = 0; j < i; ++j) d[i][j] = -v[i] * m_gains[j] / (1 - std::min(x[j], 1 - 1e-7));
            before *= through;
            sum += v[i];
        }
        Linear linear{std::vector<double>(n, 0.0), std::vector<std::vector<double>>(n, std::vector<double>(n, 0.0))};
        if (!(sum > 0)) return linear;
        for (std::size_t j = 0; j < n; ++j) {
            double all = 0;
            for (std::size_t i = 0; i < n; ++i) all += d[i][j];
            for (std::size_t i = 0; i < n; ++i) linear.derivative[i][j] = (d[i][j] - v[i] / sum * all) / sum;
        }
        for (std::size_t i = 0; i < n; ++i) linear.vws[i] = v[i] / sum;
        return linear;
    }
    mutable int calls = 0;

private:
    TransferFunction m_tf;
    std::vector<double> m_gains;
};

/// Two features; W_1 has a low hill where x_1 = 0.3 and a high one, of 0.9, where it is
/// 0.0005. x_2 has no say.
class TwoHills final : public VwsFunction {
public:
    const TransferFunction& base() const override { return m_tf; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl& job) const override {
        std::vector<std::vector<double>> all;
        for (const auto& x : candidates) all.push_back(jacobian(x, job).vws);
        return all;
    }
    Linear jacobian(const std::vector<double>& x, const JobControl&) const override {
        const double a = std::log(std::max(x[0], 1e-9) / 0.3) / 0.5, b = std::log(std::max(x[0], 1e-9) / 0.0005) / 0.5;
        const double low = 0.1 * std::exp(-a * a), high = 0.6 * std::exp(-b * b), w = 0.3 + low + high;
        const double d = (-2 * a * low - 2 * b * high) / 0.5 / std::max(x[0], 1e-9);
        return {{w, 1 - w}, {{d, 0}, {-d, 0}}};
    }

private:
    TransferFunction m_tf = withFeatureOpacities(tents(2), {0.3, 0.5});
};

OptimizeOptions with(SearchMethod method, Direction direction = Direction::Gradient) {
    OptimizeOptions options;
    options.method = method;
    options.direction = direction;
    return options;
}

std::vector<double> vwsAt(const VwsFunction& f, const std::vector<double>& x) { return f.evaluate({&x, 1}, {})[0]; }
double bestOf(const OptimizeResult& r) { return r.history[r.best].objective; }
const std::vector<double>& opacitiesOf(const OptimizeResult& r) { return r.history[r.best].opacity; }

/// As problems take estimates; it has to outlive them.
std::shared_ptr<const VwsFunction> borrowed(const VwsFunction& function) {
    return {std::shared_ptr<const VwsFunction>{}, &function};
}

} // namespace

TEST_CASE("every method goes along every direction to the targets", "[optimize]") {
    for (const auto method : {SearchMethod::Newton, SearchMethod::Parallel, SearchMethod::Line, SearchMethod::Fixed})
        for (const auto direction : {Direction::Gradient, Direction::Backward, Direction::Second, Direction::Exact}) {
            INFO(name(method) << " " << name(direction));
            const Layers f({1, 1, 1});
            const OptimizeResult r = optimize({f, {0.3, 0.3, 0.4}}, with(method, direction));
            CHECK(r.converged());
            CHECK(bestOf(r) < 0.03);
            CHECK(bestOf(r) == objectiveOf(vwsAt(f, opacitiesOf(r)), r.targets));
            if (method == SearchMethod::Newton) CHECK(bestOf(r) < kNewtonGoal);
        }
}

TEST_CASE("directions are what the thesis says of them", "[optimize]") {
    // One move, from x = ½ each, gains 1: V = ½, ¼, ⅛, W = 4/7, 2/7, 1/7; the first move knows no state before.
    const Layers f({1, 1, 1});
    OptimizeOptions options = with(SearchMethod::Fixed);
    options.maxIterations = 2;
    options.tolerance = 1e-9;
    const std::vector<double> t{0.2, 0.3, 0.5};
    const auto run = [&](Direction direction, double b) {
        options.direction = direction;
        options.b = b;
        return optimize({f, t}, options).history;
    };
    const auto gradient = run(Direction::Gradient, 1), twice = run(Direction::Gradient, 2);
    CHECK(gradient[1].opacity[0] == Approx(0.5 - 0.05 * 2 * (4.0 / 7 - 0.2)));
    CHECK(twice[1].opacity[0] == Approx(0.5 - 0.05 * 2 * 2 * (4.0 / 7 - 0.2)));
    CHECK(run(Direction::Backward, 1)[1] == gradient[1]);
    CHECK(run(Direction::Second, 1)[1] == gradient[1]);
    // Then differences between these two states, feature by feature.
    std::vector<double> secant(3), backward(3);
    double slopes = 0, lengths = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const OptimizeState &a = gradient[0], &b = gradient[1];
        const double slope = 2 * (b.vws[i] - t[i]), rise = (b.vws[i] - a.vws[i]) / (b.opacity[i] - a.opacity[i]);
        secant[i] = slope / (2 * std::abs(rise)); // F'/F'', F' = 2(W − t), F'' = ∇F'/∇x
        backward[i] = slope * rise;
        slopes += slope * slope;
        lengths += backward[i] * backward[i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(run(Direction::Second, 1)[2].opacity[i] == Approx(gradient[1].opacity[i] - 0.05 * secant[i]));
        CHECK(run(Direction::Backward, 1)[2].opacity[i] ==
              Approx(gradient[1].opacity[i] - 0.05 * backward[i] * std::sqrt(slopes / lengths)));
    }
    // The exact one: downhill on F².
    const auto exact = run(Direction::Exact, 1);
    const auto d = f.jacobian({0.5, 0.5, 0.5}, {}).derivative;
    std::vector<double> moved(3), down(3);
    double along = 0, moves = 0, downs = 0;
    for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) down[j] -= (exact[0].vws[i] - t[i]) * d[i][j];
        moved[j] = exact[1].opacity[j] - 0.5;
        along += moved[j] * down[j];
        moves += moved[j] * moved[j];
        downs += down[j] * down[j];
    }
    CHECK(along == Approx(std::sqrt(moves * downs)));
}

TEST_CASE("Newton arrives in few moves, wherever it starts", "[optimize]") {
    const std::vector<std::vector<double>> starts{{1, 1, 1}, {0.002, 1, 1}, {0.002, 0.001, 0.003}, {1, 1e-6, 1e-6},
                                                  {0, 0, 0}, {0.5, 0, 0.5}, {0.999, 0.99, 0.9},    {1, 0, 0}};
    for (const auto& start : starts)
        for (const std::vector<double>& t :
             {std::vector<double>{0.1, 0.3, 0.6}, {1, 1, 1}, {6, 3, 1}, {0.001, 1, 1}, {1, 1, 0.001}}) {
            INFO(start[0] << ", " << start[1] << ", " << start[2] << " to " << t[0] << ", " << t[1] << ", " << t[2]);
            const Layers f({20, 3, 1}, start);
            const OptimizeResult r = optimize({f, t});
            CHECK(r.converged());
            CHECK(bestOf(r) < kNewtonGoal);
            CHECK(r.iterations() <= 20);
            CHECK(bestOf(r) <= r.history[0].objective);
        }
}

TEST_CASE("a target of 0 takes a feature away", "[optimize]") {
    for (const std::vector<double>& t : {std::vector<double>{0, 1, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 1}}) {
        const OptimizeResult r = optimize({Layers({20, 3, 1}), t});
        CHECK(bestOf(r) < kNewtonGoal);
        for (std::size_t i = 0; i < 3; ++i) // unless nobody sees it from the start
            if (t[i] == 0 && r.iterations() > 0) CHECK(opacitiesOf(r)[i] == 0);
    }
}

TEST_CASE("locks and limits hold in every method", "[optimize]") {
    std::vector<OpacityLimits> limits(3);
    limits[0].locked = true;
    limits[1] = {0.2, 0.4, false};
    for (const auto method : {SearchMethod::Newton, SearchMethod::Parallel, SearchMethod::Line, SearchMethod::Fixed}) {
        INFO(name(method));
        const OptimizeResult r = optimize({Layers({1, 1, 1}), {1, 3, 6}, limits}, with(method));
        for (const OptimizeState& state : r.history) {
            CHECK(state.opacity[0] == 0.5);
            CHECK(state.opacity[1] >= 0.2); // the start, 0.5, is taken to 0.4
            CHECK(state.opacity[1] <= 0.4);
        }
    }
    // A half-opaque first layer has most: as near as the other two can come, 0.2 and 1 (a grid agrees).
    const Layers f({1, 1, 1});
    const OptimizeResult r = optimize({f, {1, 3, 6}, limits});
    double least = 1;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 200; ++j)
            least = std::min(least, objectiveOf(vwsAt(f, {0.5, 0.2 + i * 0.005, j * 0.005}), r.targets));
    CHECK(bestOf(r) <= least + 1e-6);
    CHECK(r.reason == StopReason::NoProgress);
    CHECK(r.spreadStarts > 0);
    // Everything locked: nothing moves.
    limits.assign(3, {0, 1, true});
    CHECK(optimize({f, {1, 3, 6}, limits}).history.size() == 1);
    CHECK_THROWS_AS(optimize({f, {1, 3, 6}, {{0, 1, false}}}), UsageError);
    limits[0] = {0.5, 0.4, false};
    CHECK_THROWS_AS(optimize({f, {1, 3, 6}, limits}), UsageError);
}

TEST_CASE("a feature without say stays where it is", "[optimize]") {
    // The second layer has no depth whatever its opacity.
    const Layers f({20, 0, 1}, {0.5, 0.37, 0.5});
    OptimizeOptions options;
    options.restarts = false;
    const OptimizeResult r = optimize({f, {0.3, 0.1, 0.6}}, options);
    for (const OptimizeState& state : r.history) CHECK(state.opacity[1] == Approx(0.37));
    // The others share what it cannot have: 0.35 and 0.65 are nearest, F = sqrt((0.05² + 0.1² + 0.05²)/3).
    CHECK(bestOf(r) == Approx(std::sqrt(0.015 / 3)).epsilon(1e-3));
    CHECK(r.reason == StopReason::NoProgress);
}

TEST_CASE("where it is stuck Newton looks elsewhere", "[optimize]") {
    const TwoHills f;
    // On top of the low hill W_1 = 0.4 no derivative leads to the target of 0.85.
    OptimizeOptions options;
    options.restarts = false;
    const OptimizeResult stuck = optimize({f, {0.85, 0.15}}, options);
    CHECK(stuck.reason == StopReason::NoProgress);
    CHECK(bestOf(stuck) > 0.4);
    CHECK(stuck.spreadStarts == 0);
    const OptimizeResult found = optimize({f, {0.85, 0.15}});
    CHECK(found.converged());
    CHECK(bestOf(found) < kNewtonGoal);
    CHECK(found.spreadStarts > 0);
    CHECK(optimize({f, {0.85, 0.15}}).history == found.history); // nothing is left to chance
}

TEST_CASE("the first moves are made by estimates, the last word has the volume", "[optimize]") {
    const std::vector<double> t{0.1, 0.3, 0.6};
    const Layers full({20, 3, 1}), near({21, 2.8, 1.05}), farther({24, 2.5, 1.2});
    OptimizeProblem problem{full, t};
    problem.estimates = {borrowed(near), borrowed(farther)};
    const OptimizeResult r = optimize(problem);
    CHECK(bestOf(r) < kNewtonGoal);
    CHECK(r.iterations() <= 2);
    CHECK(r.coarseIterations() > 0);
    CHECK(r.history.front().level == 0);
    CHECK(r.history[r.best].level == 0);
    int last = 2;
    for (std::size_t i = 1; i < r.history.size(); ++i) { // ever finer
        CHECK(r.history[i].level <= last);
        last = r.history[i].level;
    }
    OptimizeOptions options;
    options.coarse = false;
    CHECK(optimize(problem, options).coarseIterations() == 0);
    CHECK(optimize(problem, with(SearchMethod::Parallel)).coarseIterations() == 0);
    // Estimates of something else cost moves, but mislead nobody.
    const Layers wrong({1, 3, 20}), blind({0, 0, 0});
    for (const Layers* coarse : {&wrong, &blind}) {
        problem.estimates = {borrowed(*coarse)};
        const OptimizeResult all = optimize(problem);
        CHECK(bestOf(all) < kNewtonGoal);
        CHECK(all.history[all.best].vws[2] == Approx(0.6).margin(0.002));
    }
    // One that is on target says nothing where the volume is not; the start counts on the volume.
    const Layers met({20, 3, 1}, opacitiesOf(r));
    OptimizeProblem there{met, t};
    there.estimates = {borrowed(wrong)};
    CHECK(optimize(there).history.size() == 1);
}

TEST_CASE("limits of moves are those of the volume", "[optimize]") {
    const Layers f({20, 3, 1});
    for (int most = 0; most < 4; ++most) {
        OptimizeOptions options;
        options.maxIterations = most;
        options.tolerance = 1e-9;
        const OptimizeResult r = optimize({f, {1, 3, 6}}, options);
        CHECK(r.iterations() <= most);
        if (most < 2) CHECK(r.reason == StopReason::MaxIterations);
    }
}

TEST_CASE("cancelling Newton leaves what is there so far", "[optimize]") {
    const Layers f({20, 3, 1}), near({21, 2.8, 1.05});
    OptimizeProblem problem{f, {1, 3, 6}};
    problem.estimates = {borrowed(near)};
    for (int after = 1; after < 5; ++after) {
        std::stop_source stop;
        int seen = 0;
        const OptimizeResult r = optimize(problem, {}, {stop.get_token(), {}}, [&](const OptimizeState&) {
            if (++seen == after) stop.request_stop();
        });
        CHECK(r.reason == StopReason::Cancelled);
        CHECK(r.history.size() == static_cast<std::size_t>(after));
        CHECK(r.history[r.best].level == 0);
    }
}

TEST_CASE("what random transfer functions show is reached from random starts", "[optimize]") {
    constexpr int kCases = 100;
    int newtonClose = 0, parallelBelow = 0;
    std::vector<int> moves;
    for (int number = 0; number < kCases; ++number) {
        const RandomCase c = randomCase(static_cast<std::uint32_t>(number), 0.4);
        Random random(static_cast<std::uint32_t>(1000 + number));
        const int n = 3 + number % 7;
        const auto opacities = [&] {
            std::vector<double> x;
            for (int i = 0; i < n; ++i) x.push_back(std::pow(10, random.between(-2.5, 0)));
            return x;
        };
        const TransferFunction start = withFeatureOpacities(tents(n), opacities());
        const WeightFields weights = saliencyFields(*c.volume, start);
        const auto engine = makeCpuEngine(c.volume);
        const EngineVws f(*engine, c.view(), start, weights);
        const std::vector<double> t = vwsAt(f, opacities());
        if (std::none_of(t.begin(), t.end(), [](double share) { return share > 0; })) continue; // nothing is seen
        const OptimizeResult newton = optimize({f, t}), parallel = optimize({f, t}, with(SearchMethod::Parallel));
        INFO(c.describe() << ", " << n << " features: newton " << bestOf(newton) << " in " << newton.iterations()
                          << ", parallel " << bestOf(parallel) << " in " << parallel.iterations());
        CHECK(bestOf(newton) < 0.01);
        CHECK(bestOf(newton) <= newton.history[0].objective);
        CHECK(bestOf(parallel) <= parallel.history[0].objective);
        newtonClose += bestOf(newton) < kNewtonGoal ? 1 : 0;
        parallelBelow += bestOf(parallel) < 0.03 ? 1 : 0;
        moves.push_back(newton.iterations());
    }
    const auto cases = static_cast<int>(moves.size());
    std::sort(moves.begin(), moves.end());
    CHECK(cases >= 95);
    CHECK(newtonClose >= cases - 2);
    CHECK(moves[moves.size() / 2] <= 3);
    CHECK(parallelBelow >= cases - 2);
}
