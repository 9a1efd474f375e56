// Targets followed from one frame to the next: the smallest jump that comes near enough.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "optimize/time/tracking.h"

using namespace pellucid;

namespace {

/// Features side by side: each gets attention in proportion to its size and optical depth, W_i = a_i τ_i / Σ a_j τ_j.
class SideBySide final : public VwsFunction {
public:
    SideBySide(std::vector<double> sizes, const std::vector<double>& opacity) : m_sizes(std::move(sizes)) {
        m_base = withFeatureOpacities(tents(static_cast<int>(opacity.size())), opacity);
    }
    const TransferFunction& base() const override { return m_base; }
    std::vector<std::vector<double>> evaluate(std::span<const std::vector<double>> candidates,
                                              const JobControl&) const override {
        std::vector<std::vector<double>> all;
        for (const auto& x : candidates) all.push_back(vws(x));
        return all;
    }
    Linear jacobian(const std::vector<double>& x, const JobControl&) const override {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) sum -= m_sizes[i] * std::log1p(-x[i]);
        Linear linear{vws(x), {}};
        for (std::size_t i = 0; i < x.size(); ++i) {
            auto& row = linear.derivative.emplace_back();
            for (std::size_t j = 0; j < x.size(); ++j) // dτ/dx = 1/(1 − x)
                row.push_back(m_sizes[j] * ((i == j ? 1.0 : 0.0) - linear.vws[i]) / (sum * (1 - x[j])));
        }
        return linear;
    }

private:
    std::vector<double> vws(const std::vector<double>& x) const {
        std::vector<double> w;
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            w.push_back(-m_sizes[i] * std::log1p(-x[i]));
            sum += w.back();
        }
        for (double& v : w) v /= sum;
        return w;
    }
    std::vector<double> m_sizes;
    TransferFunction m_base;
};

double logDepth(double x) { return std::log(-std::log1p(-x)); }

const std::vector<double> kEqual{1, 1, 1};

} // namespace

TEST_CASE("the answer on target is the one with the smallest jump", "[tracking]") {
    // a_j τ_j must be the same for all: y_j = ln τ_j = s − ln a_j. Of these the squares of the changes have the
    // smallest sum where the changes sum to 0: s is the mean of y₀ + ln a_j.
    const std::vector<double> sizes{4, 2, 1};
    const SideBySide function(sizes, {0.1, 0.1, 0.1});
    const Tracked found = track(function, kEqual, {}, {});
    CHECK(found.objective <= kTrackGoal);
    CHECK(found.moves <= 3);
    const double mean = std::log(8.0) / 3;
    for (std::size_t j = 0; j < 3; ++j)
        CHECK(logDepth(found.opacity[j]) == Approx(logDepth(0.1) + mean - std::log(sizes[j])).margin(0.02));
}

TEST_CASE("coherence stops at the distance that it allows for", "[tracking]") {
    const SideBySide function({4, 2, 1}, {0.1, 0.1, 0.1});
    const Tracked exact = track(function, kEqual, {}, {});
    double before = 1e9;
    for (const double coherence : {0.5, 1.0, 3.0}) {
        TrackOptions options;
        options.coherence = coherence;
        CHECK(options.distance() == Approx(0.01 * coherence));
        const Tracked found = track(function, kEqual, {}, options);
        CHECK(found.objective <= options.distance());
        CHECK(found.objective > 0.6 * options.distance()); // no farther than it must
        double jump = 0;
        for (std::size_t j = 0; j < 3; ++j) jump += std::pow(logDepth(found.opacity[j]) - logDepth(0.1), 2);
        CHECK(jump < before);
        before = jump;
    }
    TrackOptions still;
    still.coherence = std::numeric_limits<double>::infinity();
    const Tracked stays = track(function, kEqual, {}, still);
    CHECK(stays.opacity == featureOpacities(function.base()));
    CHECK(stays.moves == 0);
    // Shares 4/7, 2/7, 1/7 of wanted thirds: F = √(((5/21)² + (1/21)² + (4/21)²)/3) = √42/21/√3.
    CHECK(stays.objective == Approx(std::sqrt(42.0) / 21 / std::sqrt(3.0)));
    CHECK(exact.objective < stays.objective);
}

TEST_CASE("what is near enough already does not move", "[tracking]") {
    const SideBySide function({1.01, 1, 0.99}, {0.2, 0.2, 0.2});
    TrackOptions options;
    options.coherence = 1;
    const Tracked found = track(function, kEqual, {}, options); // F is about 0.003
    CHECK(found.moves == 0);
    CHECK(found.evaluations == 1);
    CHECK(found.opacity == featureOpacities(function.base()));
}

TEST_CASE("a metric says which features may jump", "[tracking]") {
    TrackOptions options;
    options.metric = [] { return std::vector<std::vector<double>>{{1e4, 0, 0}, {0, 1, 0}, {0, 0, 1}}; };
    const std::vector<double> sizes{4, 2, 1};
    const Tracked found = track(SideBySide(sizes, {0.1, 0.1, 0.1}), kEqual, {}, options);
    CHECK(found.objective <= kTrackGoal);
    // The first feature stays; the others come to its share: y_j = y₀ + ln(a_0/a_j).
    for (std::size_t j = 0; j < 3; ++j)
        CHECK(logDepth(found.opacity[j]) == Approx(logDepth(0.1) + std::log(4 / sizes[j])).margin(0.02));
}

TEST_CASE("limits and locks are kept while targets are followed", "[tracking]") {
    const SideBySide function({4, 2, 1}, {0.1, 0.1, 0.1});
    const std::vector<OpacityLimits> limits{{0, 1, true}, {0, 1, false}, {0, 0.2, false}};
    const Tracked found = track(function, kEqual, limits, {});
    CHECK(found.opacity[0] == featureOpacities(function.base())[0]);
    CHECK(found.opacity[2] == Approx(0.2)); // it would need 1 − 0.9⁴ = 0.34
    CHECK(found.objective > kTrackGoal);
    CHECK_THROWS_AS(track(function, {1, 1}, {}, {}), UsageError);
    CHECK_THROWS_AS(track(function, kEqual, {{0, 1, false}}, {}), UsageError);
}

TEST_CASE("a target of 0 is followed to the lowest opacity", "[tracking]") {
    const Tracked found = track(SideBySide({4, 2, 1}, {0.1, 0.1, 0.1}), {1, 1, 0}, {}, {});
    CHECK(found.opacity[2] == 0);
    CHECK(found.objective <= kTrackGoal);
}

TEST_CASE("a feature that is not there does not keep the others from their targets", "[tracking]") {
    const Tracked found = track(SideBySide({4, 2, 0}, {0.1, 0.1, 0.1}), kEqual, {}, {});
    // The two others share 1: each is 1/6 above its third, the absent one 1/3 below.
    const double least = std::sqrt((1.0 / 9 + 2.0 / 36) / 3);
    CHECK(found.least == Approx(least));
    CHECK(found.objective == Approx(least).margin(1e-5));
    CHECK(found.vws[0] == Approx(0.5).margin(0.002));
    CHECK(found.moves <= 3);
}
