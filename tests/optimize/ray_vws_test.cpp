// Estimates of VWS along rays, held against the engine.
#include <cmath>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "optimize/ray_vws.h"
#include "render/cpu/cpu_engine.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

std::shared_ptr<const Volume> shells() {
    const Int3 dims(44, 48, 40);
    const Vec3 middle = 0.5 * Vec3(dims - 1);
    return volumeFrom(geometryOf(dims, {1, 1, 1.2}), [&](int i, int j, int k) {
        return std::clamp(1.1 - glm::length((Vec3(i, j, k) - middle) / Vec3(dims)) * 2, 0.0, 1.0);
    });
}

std::vector<double> byRays(const Volume& volume, const View& view, const TransferFunction& tf,
                           const WeightFields& weights, const std::vector<double>& x) {
    const VwsEstimates estimates = rayEstimates(std::make_shared<RaySamples>(volume, tf, view, weights), tf);
    REQUIRE(estimates.size() == 2);
    return estimates[0]->evaluate({&x, 1})[0];
}

std::vector<double> byEngine(const std::shared_ptr<const Volume>& volume, const View& view, const TransferFunction& tf,
                             const WeightFields& weights, const std::vector<double>& x) {
    const auto engine = makeCpuEngine(volume);
    return EngineVws(*engine, view, tf, weights).evaluate({&x, 1})[0];
}

const std::vector<std::vector<double>> kOpacities{
    {0.01, 0.01, 0.01}, {0.3, 0.3, 0.3}, {0.95, 0.95, 0.95}, {0.01, 0.1, 0.9}, {0.6, 0.02, 0.2}};

} // namespace

TEST_CASE("rays through two layers see what layers in front of each other show", "[optimize][rays]") {
    // Six planes of opacity a, then six of opacity b, seen from straight in front, all weights equal: the sums are
    // 1 − (1 − a)⁶ and (1 − a)⁶·(1 − (1 − b)⁶). Half of the way between the two values belongs to each.
    const auto volume = volumeFrom(geometryOf({12, 12, 12}), [](int, int, int k) { return k < 6 ? 0.25 : 0.75; });
    TransferFunction tf;
    const Rgb red{1, 0, 0}, blue{0, 0, 1};
    tf.points = {{0, 1, red, false, {}}, {1, 1, blue, false, {}}};
    tf.features = {{"front", 0, 0.5, red, {}}, {"back", 0.5, 1, blue, {}}};
    WeightFields weights(volume->dims(), 1, 1);
    for (std::size_t i = 0; i < weights.size(); ++i) weights.set(i, 0.5f, 0.0f);
    const View view{lookingAlong(volume->geometry(), {0, 0, 1}), {}};
    for (const auto& [a, b] : {std::pair{0.01, 0.5}, {0.1, 0.1}, {0.3, 0.9}, {0.7, 0.7}}) {
        INFO(a << ", " << b);
        const TransferFunction both = withFeatureOpacities(tf, {a, b});
        const double front = 1 - std::pow(1 - a, 6), back = std::pow(1 - a, 6) * (1 - std::pow(1 - b, 6));
        const std::vector<double> w = byRays(*volume, view, both, weights, {a, b});
        CHECK(w[0] == Approx(front / (front + back)).margin(0.02));
        CHECK(w[0] + w[1] == Approx(1));
    }
}

TEST_CASE("estimates along rays are near the engine's figures", "[optimize][rays]") {
    const auto volume = shells();
    const Geometry& geometry = volume->geometry();
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    Clipping half;
    half.hi.y = 0.5;
    half.planes = {{{1, 0, 1}, 40}};
    for (const View& view : {View{cameraFromView(geometry, 30, 20, 1, Projection::Perspective), {}},
                             View{cameraFromView(geometry, -110, 65, 1, Projection::Orthographic), {}},
                             View{cameraFromView(geometry, 0, 90, 1, Projection::Perspective), {}},
                             View{cameraFromView(geometry, 30, 20, 1, Projection::Perspective), half}})
        for (const auto& x : kOpacities) {
            INFO(x[0] << " " << x[1] << " " << x[2]);
            CHECK(objectiveOf(byRays(*volume, view, tf, weights, x), byEngine(volume, view, tf, weights, x)) < 0.02);
        }
}

TEST_CASE("estimates along rays hold for noise, invalid voxels and voxels that are no cubes", "[optimize][rays]") {
    std::mt19937 random(5);
    const auto rough = roughVolume(random, {50, 40, 30}, {1, 1, 1.7});
    const auto holed = volumeFrom(rough->geometry(), [&](int i, int j, int k) {
        return i > 20 && j > 15 && k < 12 ? std::numeric_limits<double>::quiet_NaN()
                                          : rough->intensity(static_cast<std::size_t>(i + 50 * (j + 40 * k)));
    });
    for (const auto& volume : {rough, holed}) {
        const TransferFunction tf = tents(3);
        const WeightFields weights = saliencyFields(*volume, tf);
        const View view{cameraFromView(volume->geometry(), 200, 35, 1, Projection::Perspective), {}};
        for (const auto& x : kOpacities) {
            INFO(x[0] << " " << x[1] << " " << x[2]);
            CHECK(objectiveOf(byRays(*volume, view, tf, weights, x), byEngine(volume, view, tf, weights, x)) < 0.03);
        }
    }
}

TEST_CASE("estimates are of the whole volume, however much of it the picture shows", "[optimize][rays]") {
    const auto volume = shells();
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const std::vector<double> x{0.1, 0.2, 0.3};
    Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective);
    const std::vector<double> whole = byRays(*volume, camera, tf, weights, x);
    camera.fovY /= 10;
    CHECK(byRays(*volume, camera, tf, weights, x) == whole);
    camera.center = camera.center + 0.4 * volume->geometry().radius() * camera.right();
    CHECK(objectiveOf(byRays(*volume, camera, tf, weights, x), whole) < 0.02);
    // From so near no bundle holds the volume: no estimates, and the search looks at the volume alone.
    camera.eye = volume->geometry().boxCenter() + Vec3(0, -0.9 * volume->geometry().radius(), 0);
    camera.center = volume->geometry().boxCenter();
    CHECK(rayEstimates(std::make_shared<RaySamples>(*volume, tf, camera, weights), tf).empty());
}

TEST_CASE("derivatives along rays are those of the estimate", "[optimize][rays]") {
    const auto volume = shells();
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const View view{cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective), {}};
    const VwsEstimates estimates = rayEstimates(std::make_shared<RaySamples>(*volume, tf, view, weights), tf);
    for (const auto& estimate : estimates)
        for (const std::vector<double>& x : {std::vector{0.02, 0.1, 0.4}, {0.4, 0.4, 0.9}}) {
            const VwsFunction::Linear linear = estimate->jacobian(x);
            CHECK(objectiveOf(linear.vws, estimate->evaluate({&x, 1})[0]) < 1e-6);
            for (std::size_t j = 0; j < 3; ++j) {
                std::vector<std::vector<double>> sides{x, x};
                sides[0][j] *= 0.99;
                sides[1][j] *= 1.01;
                const auto w = estimate->evaluate(sides);
                for (std::size_t i = 0; i < 3; ++i)
                    CHECK(linear.derivative[i][j] ==
                          Approx((w[1][i] - w[0][i]) / (0.02 * x[j])).epsilon(0.05).margin(0.02));
            }
        }
}

TEST_CASE("estimates have the same bits for any number of threads", "[optimize][rays]") {
    const auto volume = shells();
    const TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const View view{cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective), {}};
    setThreadCount(1);
    const std::vector<double> one = byRays(*volume, view, tf, weights, kOpacities[3]);
    setThreadCount(3);
    const std::vector<double> three = byRays(*volume, view, tf, weights, kOpacities[3]);
    setThreadCount(0);
    CHECK(one == three);
}

TEST_CASE("nothing to be seen gives no estimate, and a stop is heard", "[optimize][rays]") {
    const auto volume = shells();
    TransferFunction tf = tents(3);
    const WeightFields weights = saliencyFields(*volume, tf);
    const View view{cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective), {}};
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(RaySamples(*volume, tf, view, weights, {stop.get_token(), {}}), Cancelled);
    for (Feature& feature : tf.features) feature.hidden = true;
    CHECK(RaySamples(*volume, tf, view, weights).empty());
}
