// What features gather of a stored visibility field, voxel by voxel: what engines and measure() are held to.
#pragma once

#include <vector>

#include "saliency/vws.h"
#include "volume/histogram.h"

namespace pellucid::test {

/// `weights` may be null: then `weighted` stays 0.
inline FeatureSums sumsOfField(const Volume& volume, const std::vector<Feature>& features,
                               const Grid<float>& visibility, const WeightFields* weights) {
    FeatureSums sums = emptySums(features.size());
    for (std::size_t i = 0; i < visibility.size(); ++i) {
        if (visibility[i] == 0) continue;
        const double lb = weights ? weights->brightness(i) : 0.0, ls = weights ? weights->saturation(i) : 0.0;
        addVoxel(sums, featureAt(features, volume.intensity(i)), static_cast<double>(visibility[i]), lb, ls);
    }
    return sums;
}

/// v_i summed per intensity bin, divided by Σ v_i.
inline std::vector<double> histogramOfField(const Volume& volume, const Grid<float>& visibility, int bins) {
    std::vector<double> histogram(static_cast<std::size_t>(bins), 0.0);
    double total = 0;
    for (std::size_t i = 0; i < visibility.size(); ++i) {
        const auto v = static_cast<double>(visibility[i]);
        if (v == 0) continue;
        histogram[static_cast<std::size_t>(histogramBin(volume.intensity(i), bins))] += v;
        total += v;
    }
    for (double& h : histogram) h /= total;
    return histogram;
}

} // namespace pellucid::test
