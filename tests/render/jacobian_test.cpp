// ∂Σ/∂x_j of the engines: closed forms, and differences of the reference's sums.
#include <catch2/catch.hpp>

#include "support/jacobian_check.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("the reference's derivatives match differences of its sums", "[visibility][reference][jacobian]") {
    for (std::uint32_t n = 0; n < 20; ++n) {
        const RandomCase c = gradientCase(n, 0.4);
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const auto engine = makeReferenceEngine(c.volume);
        const SumsJacobian jacobian = engine->jacobian(c.camera, c.tf, &weights);
        const FigureJacobians found = analyticJacobians(jacobian);
        const FigureJacobians expected = differencesOfSums(*engine, c.camera, c.tf, weights);
        INFO(c.describe());
        const JacobianError w = compareJacobians(found.vws, expected.vws);
        CHECK(w.ofLargest < 1e-4);
        CHECK(w.entrywise < 1e-4);
        const JacobianError v = compareJacobians(found.visibility, expected.visibility);
        CHECK(v.ofLargest < 1e-4);
        CHECK(v.entrywise < 1e-4);
        const FeatureSums sums = engine->sums(c.camera, {&c.tf, 1}, &weights)[0];
        CHECK(jacobian.sums.allVisibility == Approx(sums.allVisibility).epsilon(1e-12));
        CHECK(jacobian.sums.weighted[0].back() == Approx(sums.weighted[0].back()).epsilon(1e-12));
    }
}

TEST_CASE("derivatives of a homogeneous block are those of its closed form", "[visibility][reference][jacobian]") {
    // n planes of 3 × 2 voxels along y, shape 1 everywhere, v_k = α(1 − α)^k: the sum over a column is 1 − (1 − α)^n,
    // its derivative n(1 − α)^(n − 1). At α = 0 every voxel gains 1.
    const int n = 7;
    const auto volume = slab({3, n, 2}, 0.5);
    const auto engine = makeReferenceEngine(volume);
    const Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    WeightFields weights(volume->dims(), 1, 1);
    for (std::size_t i = 0; i < volume->size(); ++i) weights.set(i, 0.25f, 0.5f);
    const double lb = weights.brightness(0), ls = weights.saturation(0); // to 16 bits
    for (const double alpha : {0.0, 0.1, 0.5, 0.9}) {
        TransferFunction tf = homogeneous(alpha);
        tf.points.insert(tf.points.begin() + 1, {0.5, alpha, {1, 0, 0}, false, {}}); // what a peak of 0 is raised by
        const SumsJacobian j = engine->jacobian(camera, tf, &weights);
        const double expected = 6 * n * std::pow(1 - alpha, n - 1);
        INFO("alpha " << alpha);
        REQUIRE(j.byOpacity.size() == 1);
        CHECK(j.byOpacity[0].allVisibility == Approx(expected));
        CHECK(j.byOpacity[0].visibility[0] == Approx(expected));
        CHECK(j.byOpacity[0].weighted[0][0] == Approx(lb * expected));
        CHECK(j.byOpacity[0].allWeighted[1] == Approx(ls * expected));
        CHECK(vwsJacobian(j)[0][0] == Approx(0).margin(1e-12)); // one feature has W = 1 always
    }
    // At the cap T does not move any more (docs/method.md, "Visibility"), and T = 1e-7 behind the first plane.
    const SumsJacobian opaque = engine->jacobian(camera, homogeneous(1), &weights);
    CHECK(opaque.byOpacity[0].allVisibility == Approx(6 * (1 + 1e-7)).epsilon(1e-9));
}

TEST_CASE("derivatives of two slabs are those of their closed form", "[visibility][reference][jacobian]") {
    // Along +x: m planes of the front slab, one of an intensity between them and transparent, n planes of the back one.
    // Interpolation meets both slabs' intensities at half opacity or less; boxes that start beyond those half-way
    // intensities make the slabs end half a voxel beyond their outer planes: exactly m and n units of path.
    //   front: Σ = 1 − (1 − p)^m; back: the voxel behind k of its planes sees (1 − p)^m (1 − q)^k, without the half
    //   plane in front of the point d0/2 before its centre: Σ = (1 − p)^m (1 − (1 − q)^n).
    const int m = 3, n = 4;
    const auto volume = volumeFrom(geometryOf({m + 1 + n, 2, 2}), [](int i, int, int) {
        return i < m ? 0.9 : i == m ? 0.5 : 0.1;
    });
    TransferFunction tf;
    const auto box = [&](const char* name, double a, double b, double opacity) {
        for (const auto& [x, alpha] : {std::pair{a, 0.0}, {a, opacity}, {b, opacity}, {b, 0.0}})
            tf.points.push_back({x, alpha, {}, false, {}});
        tf.features.push_back({name, a, b, {}, {}});
    };
    const double p = 0.3, q = 0.6;
    box("back", 0, 0.3, q);
    box("front", 0.7, 1, p);
    const SumsJacobian j =
        makeReferenceEngine(volume)->jacobian(lookingAlong(volume->geometry(), {1, 0, 0}), tf, nullptr);
    const double through = std::pow(1 - p, m);
    const auto& byBack = j.byOpacity[0].visibility;
    const auto& byFront = j.byOpacity[1].visibility;
    CHECK(j.sums.visibility[1] == Approx(4 * (1 - through)));
    CHECK(j.sums.visibility[0] == Approx(4 * through * (1 - std::pow(1 - q, n))));
    CHECK(byFront[1] == Approx(4 * m * std::pow(1 - p, m - 1)));
    CHECK(byFront[0] == Approx(-4 * m * std::pow(1 - p, m - 1) * (1 - std::pow(1 - q, n))));
    CHECK(byBack[1] == Approx(0).margin(1e-12));
    CHECK(byBack[0] == Approx(4 * through * n * std::pow(1 - q, n - 1)));
}

TEST_CASE("the cpu engine's derivatives match the reference's along axes", "[visibility][cpu][jacobian]") {
    checkJacobianAlongAxes([](auto volume) { return makeCpuEngine(volume); });
}

TEST_CASE("the cpu engine's derivatives match the reference's from anywhere", "[visibility][cpu][jacobian]") {
    checkJacobianFromAnywhere([](auto volume) { return makeCpuEngine(volume); }, 0.03, 0.01);
}

TEST_CASE("more features than one sweep has lanes for have their derivatives too", "[visibility][cpu][jacobian]") {
    std::mt19937 random(21);
    const auto volume = roughVolume(random, {24, 20, 22}, {1, 1, 1});
    const TransferFunction tf = tents(40, 0.4);
    const WeightFields weights = saliencyFields(*volume, tf);
    const Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    const SumsJacobian found = makeCpuEngine(volume)->jacobian(camera, tf, &weights);
    REQUIRE(found.byOpacity.size() == 40);
    const Jacobian expected = vwsJacobian(makeReferenceEngine(volume, 128)->jacobian(camera, tf, &weights));
    CHECK(compareJacobians(vwsJacobian(found), expected).ofLargest < 2e-3);
    // A higher opacity shows more of the feature itself, whichever sweep it was in.
    int seen = 0;
    for (std::size_t j = 0; j < 40; ++j) {
        if (found.sums.visibility[j] == 0) continue; // no voxel has these intensities
        ++seen;
        CHECK(found.byOpacity[j].visibility[j] > 0);
    }
    CHECK(seen > 30);
}
