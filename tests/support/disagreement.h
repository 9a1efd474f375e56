// How far an engine lies from the reference: the figures of docs/method.md, "Tolerances".
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/visibility.h"
#include "support/field_sums.h"

namespace pellucid::test {

struct Disagreement {
    double visibilityRms = 0; ///< of the reference's largest visibility
    double visibility = 0;    ///< largest |ΔFV_F|
    double vws = 0;           ///< largest |ΔW_F|
};

/// `engine` against `expected`, the reference's field of the engine's own volume.
inline Disagreement compareWithField(const Grid<float>& expected, VisibilityEngine& engine, const View& view,
                                     const TransferFunction& tf, const WeightFields& weights) {
    Disagreement d;
    const Grid<float> found = engine.field(view, tf).values;
    double largest = 0, squares = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        largest = std::max(largest, static_cast<double>(expected[i]));
        squares += std::pow(static_cast<double>(expected[i]) - static_cast<double>(found[i]), 2);
    }
    if (largest > 0) d.visibilityRms = std::sqrt(squares / static_cast<double>(expected.size())) / largest;
    const auto a = featureMeasures(sumsOfField(engine.volume(), tf.features, expected, &weights));
    const auto b = featureMeasures(engine.sums(view, {&tf, 1}, &weights)[0]);
    for (std::size_t f = 0; f < a.size(); ++f) {
        d.visibility = std::max(d.visibility, std::abs(a[f].visibility - b[f].visibility));
        d.vws = std::max(d.vws, std::abs(a[f].vws - b[f].vws));
    }
    return d;
}

inline Disagreement compare(VisibilityEngine& reference, VisibilityEngine& engine, const View& view,
                            const TransferFunction& tf, const WeightFields& weights) {
    return compareWithField(reference.field(view, tf).values, engine, view, tf, weights);
}

/// The upper median: of `values`, which are not empty.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// What each engine is held to (docs/method.md, "Tolerances").
struct Tolerances {
    double visibilityRms = 0, figure = 0; ///< per case; `figure` of FV and of W
    double median = 0;                    ///< over cases, of FV and of W
};
inline constexpr Tolerances kNormalTolerances{0.015, 0.01, 0.003};
inline constexpr Tolerances kHighTolerances{0.008, 0.005, 0.0015};
inline constexpr Tolerances kSlicesTolerances{0.025, 0.02, 0.004}; ///< of the slices engine, normal quality

} // namespace pellucid::test
