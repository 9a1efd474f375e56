// Opacities of all frames of a series at once.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "optimize/solve/log_depths.h"
#include "optimize/time/smoothing.h"
#include "support/random_cases.h"

using namespace pellucid;

namespace {

constexpr double kStart = 0.3, kSlope = 0.1;

/// Two features of opacity 0.3, half of what is seen for each where the difference q of their ln τ has grown by
/// `shift`: W₁ = ½ + 0.1·(q − shift), W₂ = 1 − W₁, so that F = 0.1·|q − shift|. With the metric 1/2·identity a jump is
/// at least |Δq|/2, where both move by half of it.
FrameModel frameOf(double shift, double distance) {
    FrameModel frame;
    frame.opacity = {kStart, kStart};
    frame.vws = {0.5 - kSlope * shift, 0.5 + kSlope * shift};
    const double tau = -std::log1p(-kStart), byOpacity = kSlope / ((1 - kStart) * tau); // ∂x/∂ln τ = (1 − x) τ
    frame.derivative = {{byOpacity, -byOpacity}, {-byOpacity, byOpacity}};
    frame.targets = {0.5, 0.5};
    frame.limits.resize(2);
    frame.distance = distance;
    return frame;
}

std::vector<FrameModel> framesOf(const std::vector<double>& shifts, double distance) {
    std::vector<FrameModel> frames;
    for (const double shift : shifts) frames.push_back(frameOf(shift, distance));
    return frames;
}

double differenceOf(const std::vector<double>& x) { return logDepthOf(x[0]) - logDepthOf(x[1]); }
double meanOf(const std::vector<double>& x) { return (logDepthOf(x[0]) + logDepthOf(x[1])) / 2; }

double rmsOf(const std::vector<double>& shifts, const std::vector<std::vector<double>>& x) {
    double sum = 0;
    for (std::size_t t = 0; t < x.size(); ++t) sum += std::pow(kSlope * (differenceOf(x[t]) - shifts[t]), 2);
    return std::sqrt(sum / static_cast<double>(x.size()));
}

double wayOf(const std::vector<std::vector<double>>& x) {
    double sum = 0;
    for (std::size_t t = 1; t < x.size(); ++t) sum += std::abs(differenceOf(x[t]) - differenceOf(x[t - 1]));
    return sum;
}

} // namespace

TEST_CASE("what goes to and fro within the distance stands still", "[smoothing]") {
    std::vector<double> shifts;
    for (int t = 0; t < 20; ++t) shifts.push_back(t % 2 == 0 ? 0.1 : -0.1); // F is 0.01 where q stays 0
    std::vector<FrameModel> frames = framesOf(shifts, 0.011);
    const auto x = smoothed(frames);
    // Frames begin where they are, all at one place: nothing has to move.
    for (const auto& opacity : x) CHECK(opacity == std::vector<double>{kStart, kStart});

    // From where each is on target, too.
    for (int t = 0; t < 20; ++t) {
        FrameModel& frame = frames[static_cast<std::size_t>(t)];
        const double half = shifts[static_cast<std::size_t>(t)] / 2;
        const double tau = -std::log1p(-kStart);
        frame.opacity = {-std::expm1(-tau * std::exp(half)), -std::expm1(-tau * std::exp(-half))};
        frame.vws = {0.5, 0.5};
        for (auto& row : frame.derivative)
            for (std::size_t f = 0; f < 2; ++f) {
                const double alpha = frame.opacity[f];
                row[f] = (row[f] > 0 ? kSlope : -kSlope) / ((1 - alpha) * -std::log1p(-alpha));
            }
    }
    const auto y = smoothed(frames);
    CHECK(wayOf(y) < 1e-9);
    CHECK(rmsOf(shifts, y) <= 0.011);
}

TEST_CASE("a drift is followed no farther than the distance asks for", "[smoothing]") {
    // The least total variation near a ramp s is the ramp with its ends cut off level, q = clamp(s, c, S − c): a way of
    // S − 2c. With T = 41 frames over S = 2 and c = 0.3 the six frames below c deviate by 0.3, 0.25 … 0.05, as many
    // above: Σ (s − q)² = 2·0.2275 = 0.455, so that the root mean square of F is 0.1·√(0.455/41) = 0.010535. The
    // search aims at 99 % of what it may.
    std::vector<double> shifts;
    for (int t = 0; t <= 40; ++t) shifts.push_back(0.05 * t - 1);
    std::vector<FrameModel> frames = framesOf(shifts, 0.010535 / 0.99);
    const auto x = smoothed(frames);
    for (std::size_t t = 0; t < x.size(); ++t) {
        INFO("frame " << t);
        CHECK(differenceOf(x[t]) == Approx(std::clamp(shifts[t], -0.7, 0.7)).margin(0.02));
        // Density is free in every frame but costs jumps, and the first frame keeps it.
        CHECK(meanOf(x[t]) == Approx(logDepthOf(kStart)).margin(1e-3));
    }
    CHECK(rmsOf(shifts, x) == Approx(0.010535).epsilon(0.02));
    CHECK(wayOf(x) == Approx(1.4).epsilon(0.02));

    SECTION("from a key that stays") {
        // The first frame at q = −1 where it is not counted: the level end is at that, and only the far end is cut.
        frames.front().stays = true;
        frames.front().opacity = x.front();
        const auto from = smoothed(frames);
        CHECK(from.front() == x.front());
        CHECK(wayOf(from) < wayOf(x) + 0.1);
    }
    SECTION("to a key that stays") {
        frames.back().stays = true;
        const auto to = smoothed(frames);
        CHECK(to.back() == std::vector<double>{kStart, kStart});
    }
    SECTION("a frame that may be far is let go") {
        frames[20].distance = 1; // as one whose feature has no voxel: all together have the more room
        const auto wide = smoothed(frames);
        CHECK(wayOf(wide) < 0.01);
    }
}

TEST_CASE("limits, locks and targets of zero hold while frames are smoothed", "[smoothing]") {
    std::vector<double> shifts;
    for (int t = 0; t < 30; ++t) shifts.push_back(1.6 * t / 29 - 0.8);
    std::vector<FrameModel> frames = framesOf(shifts, 0.005);
    SECTION("limits") {
        for (FrameModel& frame : frames) frame.limits[0] = {0.25, 0.35, false};
        const auto x = smoothed(frames);
        double least = 1, most = 0;
        for (const auto& opacity : x) {
            least = std::min(least, opacity[0]);
            most = std::max(most, opacity[0]);
        }
        CHECK(least == Approx(0.25).margin(1e-6)); // the ramp would take it farther
        CHECK(most == Approx(0.35).margin(1e-6));
        CHECK(rmsOf(shifts, x) <= 0.0051); // the other feature goes the rest of the way
    }
    SECTION("a lock") {
        for (FrameModel& frame : frames) frame.limits[1].locked = true;
        const auto x = smoothed(frames);
        for (const auto& opacity : x) CHECK(opacity[1] == kStart);
        CHECK(rmsOf(shifts, x) <= 0.0051);
    }
    SECTION("a target of zero") {
        for (FrameModel& frame : frames) frame.targets = {1, 0};
        for (const auto& opacity : smoothed(frames)) CHECK(opacity[1] == kStart);
    }
    SECTION("an opacity of zero") {
        for (FrameModel& frame : frames) frame.opacity[1] = 0;
        for (const auto& opacity : smoothed(frames)) CHECK(opacity[1] == 0);
    }
}

TEST_CASE("no other path within the distance is shorter", "[smoothing]") {
    // Paths near the answer that are as near to the targets are not shorter, whatever is changed of it.
    test::Random random(7);
    std::vector<double> shifts;
    double shift = 0;
    for (int t = 0; t < 25; ++t) shifts.push_back(shift += random.between(-0.3, 0.35));
    const double distance = 0.02;
    const auto x = smoothed(framesOf(shifts, distance));
    CHECK(rmsOf(shifts, x) <= distance);
    CHECK(rmsOf(shifts, x) >= 0.95 * distance); // what may be strayed is spent
    const double way = wayOf(x), rms = rmsOf(shifts, x);
    for (int trial = 0; trial < 2000; ++trial) {
        auto other = x;
        const std::size_t from = static_cast<std::size_t>(random.below(25));
        const std::size_t to = from + static_cast<std::size_t>(random.below(static_cast<int>(25 - from)));
        const double by = std::exp(random.between(-0.1, 0.1));
        for (std::size_t t = from; t <= to; ++t) other[t][0] = -std::expm1(std::log1p(-other[t][0]) * by);
        if (rmsOf(shifts, other) <= rms) CHECK(wayOf(other) >= way - 0.02);
    }
}

TEST_CASE("frames of other features are refused, and none are none", "[smoothing]") {
    CHECK(smoothed({}).empty());
    std::vector<FrameModel> frames = framesOf({0, 0.1}, 0.01);
    frames[1].opacity.push_back(0.5);
    CHECK_THROWS_AS(smoothed(frames), UsageError);
}
