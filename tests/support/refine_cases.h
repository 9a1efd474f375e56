// Histograms and transfer functions at random, for refinement.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "optimize/refine/refine.h"

namespace pellucid::test {

struct RefineCase {
    Histogram histogram;
    TransferFunction tf;
    RefineOptions options;
};

/// Histograms of noise, of up to five peaks, with gaps; tents, ramps and irregular curves with fixed points; without a
/// priority, for an intensity, for a region.
inline RefineCase randomRefineCase(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    RefineCase c;
    c.histogram.counts.assign(256, 0);
    const int kind = static_cast<int>(random() % 4), peaks = 1 + static_cast<int>(random() % 5);
    for (std::uint64_t& count : c.histogram.counts)
        if (kind != 3 || random() % 4 == 0) count = static_cast<std::uint64_t>(unit(random) * (kind == 0 ? 1000 : 20));
    for (int k = 0; kind != 2 && k < peaks; ++k) {
        const double centre = 256 * unit(random), width = 2 + 30 * unit(random), height = 1e6 * unit(random);
        for (int b = 0; b < 256; ++b)
            c.histogram.counts[static_cast<std::size_t>(b)] +=
                static_cast<std::uint64_t>(height * std::exp(-(b - centre) * (b - centre) / (2 * width * width)));
    }
    for (const std::uint64_t count : c.histogram.counts) c.histogram.total += count;

    const auto color = [&] { return Rgb{unit(random), unit(random), unit(random)}; };
    switch (random() % 4) {
    case 0:
        c.tf = tents(1 + static_cast<int>(random() % 16), 0.1 + 0.9 * unit(random));
        break;
    case 1:
        c.tf = ramp(2 + static_cast<int>(random() % 30));
        break;
    default: {
        std::vector<double> places(2 + random() % 20);
        for (double& x : places) x = unit(random);
        std::sort(places.begin(), places.end());
        for (const double x : places) {
            const double opacity = unit(random);
            const Rgb rgb = color();
            c.tf.points.push_back({x, opacity, rgb, unit(random) < 0.2, {}});
        }
    }
    }
    const auto priority = random() % 3;
    if (priority == 1) c.options.priority.intensity = unit(random);
    for (int i = 0; priority == 2 && i < 5; ++i) c.options.priority.region.push_back({color(), 1 + 10 * unit(random)});
    return c;
}

} // namespace pellucid::test
