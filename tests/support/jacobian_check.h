// ∂W_i/∂x_j of any engine against the reference's analytic ones.
#pragma once

#include <catch2/catch.hpp>

#include <memory>
#include <vector>

#include "support/disagreement.h"
#include "support/gradient_check.h"
#include "support/volumes.h"

namespace pellucid::test {

inline constexpr std::uint32_t kJacobianCases = 20;

/// The columns of opacities below 1. At exactly 1 a tent's τ has a pole: ∂T/∂x hangs on how close single samples come
/// to the peak, so that two ways of integrating, or the reference with other steps, differ by tens of percent.
inline std::vector<bool> regularColumns(const TransferFunction& tf) {
    std::vector<bool> columns;
    for (const double x : featureOpacities(tf)) columns.push_back(x < 1);
    return columns;
}

/// The jacobian() of an engine carries the same sums as its sums().
inline void checkSumsOfJacobian(const SumsJacobian& jacobian, const FeatureSums& sums) {
    CHECK(jacobian.sums.allVisibility == Approx(sums.allVisibility).epsilon(1e-4).margin(1e-6));
    for (std::size_t f = 0; f < sums.visibility.size(); ++f)
        CHECK(jacobian.sums.visibility[f] ==
              Approx(sums.visibility[f]).epsilon(1e-4).margin(1e-5 * sums.allVisibility + 1e-6));
}

/// Along each axis, where rays run through voxel centres and nothing but the integral along them can differ: 2e-3 of
/// the largest entry. The reference takes finer steps than usual: its own 16 per d0 are off by 5e-3 at vertical sides.
template <class MakeEngine>
void checkJacobianAlongAxes(const MakeEngine& makeEngine) {
    for (std::uint32_t n = 0; n < kJacobianCases; ++n) {
        const RandomCase c = gradientCase(n, 0.5);
        Vec3 direction(0);
        direction[static_cast<int>(n % 3)] = n / 3 % 2 == 0 ? -1 : 1;
        const Camera camera = lookingAlong(c.volume->geometry(), direction);
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const Jacobian expected = vwsJacobian(makeReferenceEngine(c.volume, 128)->jacobian(camera, c.tf, &weights));
        const std::unique_ptr<VisibilityEngine> engine = makeEngine(c.volume);
        const SumsJacobian found = engine->jacobian(camera, c.tf, &weights);
        INFO(c.describe() << ", but along axis " << n % 3);
        CHECK(compareJacobians(vwsJacobian(found), expected, regularColumns(c.tf)).ofLargest < 2e-3);
        checkSumsOfJacobian(found, engine->sums(camera, {&c.tf, 1}, &weights)[0]);
    }
}

/// From any side, perspective and close too: errors of the view's interpolation come in, as they do for W itself.
/// Of the largest entry, or of 0.1 where all are small.
template <class MakeEngine>
void checkJacobianFromAnywhere(const MakeEngine& makeEngine, double most, double mostMedian) {
    std::vector<double> errors;
    for (std::uint32_t n = 0; n < kJacobianCases; ++n) {
        const RandomCase c = gradientCase(n, 0.5);
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const Jacobian expected = vwsJacobian(makeReferenceEngine(c.volume)->jacobian(c.camera, c.tf, &weights));
        const std::unique_ptr<VisibilityEngine> engine = makeEngine(c.volume);
        const SumsJacobian found = engine->jacobian(c.camera, c.tf, &weights);
        INFO(c.describe());
        const double error = compareJacobians(vwsJacobian(found), expected, regularColumns(c.tf), 0.1).ofLargest;
        CHECK(error < most);
        checkSumsOfJacobian(found, engine->sums(c.camera, {&c.tf, 1}, &weights)[0]);
        errors.push_back(error);
    }
    CHECK(median(errors) < mostMedian);
}

} // namespace pellucid::test
