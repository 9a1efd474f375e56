// Seeded random transfer functions: features that touch or do not, steps, points of no feature.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/random_cases.h"

namespace pellucid::test {

inline TransferFunction randomTf(Random& random) {
    TransferFunction tf;
    const auto color = [&] { return Rgb{random.unit(), random.unit(), random.unit()}; };
    const auto place = [&] { // half of them on a grid, so that things meet
        return random.chance(0.5) ? random.below(17) / 16.0 : random.unit();
    };
    const int points = random.below(14);
    for (int i = 0; i < points; ++i)
        tf.points.push_back({place(), random.chance(0.3) ? 0.0 : random.unit(), color(), random.chance(0.3), {}});
    std::sort(tf.points.begin(), tf.points.end(),
              [](const ControlPoint& p, const ControlPoint& q) { return p.x < q.x; });
    std::vector<double> ends;
    for (int i = 0; i < 8; ++i) ends.push_back(place());
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (ends[i + 1] - ends[i] < 1e-3 || random.chance(0.3)) continue;
        tf.features.push_back({"f" + std::to_string(i), ends[i], ends[i + 1], color(), {}});
        tf.features.back().hidden = random.chance(0.2);
        tf.features.back().id = i + 1;
    }
    if (random.chance(0.3)) std::reverse(tf.features.begin(), tf.features.end());
    return tf;
}

/// The largest difference of α, on both sides of every point of either.
inline double mostDifference(const TransferFunction& p, const TransferFunction& q) {
    double most = 0;
    const auto at = [&](double x) {
        if (x >= 0 && x <= 1) most = std::max(most, std::abs(p.opacity(x) - q.opacity(x)));
    };
    for (int i = 0; i <= 1000; ++i) at(i / 1000.0 + 1.7e-5);
    for (const TransferFunction* tf : {&p, &q})
        for (const ControlPoint& point : tf->points)
            for (const double side : {-1e-13, 1e-13}) at(point.x + side);
    return most;
}

} // namespace pellucid::test
