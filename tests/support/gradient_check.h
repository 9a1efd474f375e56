// Derivatives with respect to the features' opacities, by differences: what SumsJacobian must agree with.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/visibility.h"
#include "support/random_cases.h"

namespace pellucid::test {

/// ∂(figure i)/∂x_j as [i][j].
using Jacobian = std::vector<std::vector<double>>;

/// W_F, and Σ_{i∈F} v_i, which W_F says nothing of, as shares of Σv held constant.
struct FigureJacobians {
    Jacobian vws, visibility;
};

inline FigureJacobians analyticJacobians(const SumsJacobian& jacobian, const VwsOptions& options = {}) {
    const std::size_t n = jacobian.sums.visibility.size();
    const double all = jacobian.sums.allVisibility;
    FigureJacobians result{vwsJacobian(jacobian, options), Jacobian(n, std::vector<double>(n, 0.0))};
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
            result.visibility[i][j] = all > 0 ? jacobian.byOpacity[j].visibility[i] / all : 0.0;
    return result;
}

/// The same by differences of engine.sums(), which must add in double precision (the reference does). Of second order:
/// central inside (0,1), one-sided at exactly 0 and 1.
///
/// The steps are as small as double precision allows, because τ = −ln(1 − x·shape) is nearly singular at opacity 1: a
/// sample with 1 − shape = δ lets light through as (x=1) δ^(1/16), which bends within δ, and a few samples of millions
/// have δ < 1e-6. Those with δ < 1e-7 are at the cap of α (docs/method.md, "Derivatives"), where τ no longer moves: a
/// step below 1e-7 stays on the cap too, and so sees the function that is differentiated. Rounding of the sums, about
/// 1e-15, divided by the step leaves 1e-6.
inline FigureJacobians differencesOfSums(VisibilityEngine& engine, const View& view, const TransferFunction& tf,
                                         const WeightFields& weights, const VwsOptions& options = {}) {
    const TransferFunction shapes = withFullPeaks(tf);
    const std::vector<double> x = featureOpacities(tf), raisable = featureOpacities(shapes);
    const std::size_t n = x.size();
    struct Figures {
        std::vector<double> vws, visibility;
    };
    const auto at = [&](std::size_t j, double value) {
        std::vector<double> moved = x;
        moved[j] = value;
        const TransferFunction there = withFeatureOpacities(shapes, moved);
        const FeatureSums sums = engine.sums(view, {&there, 1}, &weights)[0];
        return Figures{vwsOf(sums, options), sums.visibility};
    };
    const Figures here = at(0, x[0]);
    const double all = engine.sums(view, {&tf, 1}, &weights)[0].allVisibility;
    FigureJacobians result{Jacobian(n, std::vector<double>(n, 0.0)), Jacobian(n, std::vector<double>(n, 0.0))};
    for (std::size_t j = 0; j < n; ++j) {
        if (raisable[j] == 0) continue; // no shape, no derivative
        const auto add = [&](const Figures& f, double factor) {
            for (std::size_t i = 0; i < n; ++i) {
                result.vws[i][j] += factor * f.vws[i];
                if (all > 0) result.visibility[i][j] += factor * f.visibility[i] / all;
            }
        };
        if (x[j] > 0 && x[j] < 1) {
            const double h = std::min({1e-6, 1e-3 * (1 - x[j]), 0.5 * x[j]});
            const double up = x[j] + h, down = x[j] - h;
            add(at(j, up), 1 / (up - down));
            add(at(j, down), -1 / (up - down));
        } else {
            const double h = x[j] == 0 ? 1e-6 : -3e-9;
            add(here, -3 / (2 * h));
            add(at(j, x[j] + h), 4 / (2 * h));
            add(at(j, x[j] + 2 * h), -1 / (2 * h));
        }
    }
    return result;
}

/// Random case 200 + `n`, with opacities of its own: every second case has a feature at exactly 1, every third one at
/// 0.
inline RandomCase gradientCase(std::uint32_t n, double size) {
    RandomCase c = randomCase(200 + n, size);
    Random random(n);
    std::vector<double> x;
    for (std::size_t f = 0; f < c.tf.features.size(); ++f) x.push_back(std::pow(100.0, random.unit() - 1));
    if (n % 2 == 0) x.front() = 1;
    if (n % 3 == 0 && x.size() > 1) x.back() = 0;
    c.tf = withFullPeaks(c.tf);
    const std::vector<double> raisable = featureOpacities(c.tf);
    for (std::size_t f = 0; f < x.size(); ++f)
        if (raisable[f] == 0) x[f] = 0;
    c.tf = withFeatureOpacities(c.tf, x);
    return c;
}

struct JacobianError {
    double ofLargest = 0; ///< largest |difference|, divided by the largest |expected entry| or `least`
    double entrywise = 0; ///< largest relative difference of entries above 1 % of the largest
};

/// Below this an entry is 0 but for rounding: figures lie in [0,1], and so do opacities.
inline constexpr double kNoDerivative = 1e-3;

/// Only the columns j with `columns`[j], or all where it is empty.
inline JacobianError compareJacobians(const Jacobian& found, const Jacobian& expected,
                                      const std::vector<bool>& columns = {}, double least = kNoDerivative) {
    const auto counts = [&](std::size_t j) { return columns.empty() || columns[j]; };
    double largest = least;
    for (const auto& row : expected)
        for (std::size_t j = 0; j < row.size(); ++j)
            if (counts(j)) largest = std::max(largest, std::abs(row[j]));
    JacobianError error;
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (std::size_t j = 0; j < expected[i].size(); ++j) {
            if (!counts(j)) continue;
            const double difference = std::abs(found[i][j] - expected[i][j]);
            error.ofLargest = std::max(error.ofLargest, difference / largest);
            if (std::abs(expected[i][j]) > 0.01 * largest)
                error.entrywise = std::max(error.entrywise, difference / std::abs(expected[i][j]));
        }
    return error;
}

} // namespace pellucid::test
