#include "optimize/measure.h"

#include <algorithm>
#include <chrono>

#include "volume/histogram.h"

namespace pellucid {

namespace {

constexpr int kBins = 256;

/// Every intensity in exactly one interval, none of which crosses a border of a feature or of a bin.
std::vector<Feature> intervalsWithin(const std::vector<Feature>& features) {
    std::vector<double> borders;
    for (int bin = 0; bin <= kBins; ++bin) borders.push_back(static_cast<double>(bin) / kBins);
    for (const Feature& f : features) {
        borders.push_back(f.a);
        borders.push_back(f.b);
    }
    std::ranges::sort(borders);
    borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
    std::vector<Feature> intervals;
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) intervals.push_back({{}, borders[i], borders[i + 1], {}, {}});
    return intervals;
}

} // namespace

Measures measure(VisibilityEngine& engine, const View& view, const TransferFunction& tf, const WeightFields& weights,
                 const VwsOptions& options, const JobControl& job) {
    const auto start = std::chrono::steady_clock::now();
    // To the engine the histogram's bins are features too, so that one sweep gives it all and no field is stored.
    TransferFunction divided = tf;
    divided.features = intervalsWithin(tf.features);
    const FeatureSums parts = engine.sums(view, {&divided, 1}, &weights, job)[0];

    Measures measures;
    measures.visibilityHistogram.assign(kBins, 0.0);
    FeatureSums sums = emptySums(tf.features.size());
    sums.allVisibility = parts.allVisibility;
    sums.allWeighted = parts.allWeighted;
    for (std::size_t i = 0; i < divided.features.size(); ++i) {
        const double s = divided.features[i].a;
        if (parts.allVisibility > 0)
            measures.visibilityHistogram[static_cast<std::size_t>(histogramBin(s, kBins))] +=
                parts.visibility[i] / parts.allVisibility;
        const int feature = featureAt(tf.features, s);
        if (feature < 0) continue;
        const auto f = static_cast<std::size_t>(feature);
        sums.visibility[f] += parts.visibility[i];
        for (std::size_t w = 0; w < 2; ++w) sums.weighted[w][f] += parts.weighted[w][i];
    }
    measures.features = featureMeasures(sums, options);
    measures.opacities = featureOpacities(tf);
    measures.visibilitySeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return measures;
}

} // namespace pellucid
