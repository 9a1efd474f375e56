#include "saliency/vws.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "volume/check.h"
#include "volume/histogram.h"
#include "volume/intensity_grid.h"
#include "volume/parallel.h"

namespace pellucid {

namespace {

double share(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

} // namespace

FeatureSums emptySums(std::size_t features) {
    FeatureSums sums;
    sums.visibility.assign(features, 0.0);
    for (auto& w : sums.weighted) w.assign(features, 0.0);
    return sums;
}

void addVoxel(FeatureSums& sums, int feature, double v, double brightness, double saturation) {
    sums.allVisibility += v;
    sums.allWeighted[0] += v * brightness;
    sums.allWeighted[1] += v * saturation;
    if (feature < 0) return;
    const auto f = static_cast<std::size_t>(feature);
    sums.visibility[f] += v;
    sums.weighted[0][f] += v * brightness;
    sums.weighted[1][f] += v * saturation;
}

void add(FeatureSums& total, const FeatureSums& part) {
    for (std::size_t f = 0; f < total.visibility.size(); ++f) {
        total.visibility[f] += part.visibility[f];
        for (std::size_t w = 0; w < 2; ++w) total.weighted[w][f] += part.weighted[w][f];
    }
    total.allVisibility += part.allVisibility;
    for (std::size_t w = 0; w < 2; ++w) total.allWeighted[w] += part.allWeighted[w];
}

std::array<double, 2> attributeWeights(const std::array<double, 2>& allWeighted, const VwsOptions& options) {
    const bool brightness = allWeighted[0] > 0, saturation = allWeighted[1] > 0;
    if (brightness && saturation) return {options.u1, options.u2};
    return {brightness ? 1.0 : 0.0, saturation ? 1.0 : 0.0};
}

std::vector<FeatureMeasures> featureMeasures(const FeatureSums& sums, const VwsOptions& options) {
    const auto [u1, u2] = attributeWeights(sums.allWeighted, options);
    std::vector<FeatureMeasures> all(sums.visibility.size());
    for (std::size_t f = 0; f < all.size(); ++f) {
        FeatureMeasures& m = all[f];
        m.visibility = share(sums.visibility[f], sums.allVisibility);
        m.vwsBrightness = share(sums.weighted[0][f], sums.allWeighted[0]);
        m.vwsSaturation = share(sums.weighted[1][f], sums.allWeighted[1]);
        m.vws = u1 * m.vwsBrightness + u2 * m.vwsSaturation;
    }
    return all;
}

std::vector<double> vwsOf(const FeatureSums& sums, const VwsOptions& options) {
    std::vector<double> vws;
    for (const FeatureMeasures& m : featureMeasures(sums, options)) vws.push_back(m.vws);
    return vws;
}

std::vector<std::vector<double>> vwsJacobian(const SumsJacobian& jacobian, const VwsOptions& options) {
    const FeatureSums& sums = jacobian.sums;
    const auto u = attributeWeights(sums.allWeighted, options);
    const std::size_t n = sums.visibility.size();
    std::vector<std::vector<double>> derivatives(n, std::vector<double>(n, 0.0));
    for (std::size_t a = 0; a < 2; ++a) {
        const double all = sums.allWeighted[a];
        if (!(all > 0)) continue;
        for (std::size_t j = 0; j < n; ++j) {
            const FeatureSums& d = jacobian.byOpacity[j];
            for (std::size_t i = 0; i < n; ++i)
                derivatives[i][j] += u[a] * (d.weighted[a][i] - sums.weighted[a][i] / all * d.allWeighted[a]) / all;
        }
    }
    return derivatives;
}

namespace {

/// body(slice, voxel, v, intensity) for each voxel that is seen; slices on different threads.
template <class Body>
void forEachVisible(const Volume& volume, const Grid<float>& visibility, const JobControl& job, const Body& body) {
    PELLUCID_CHECK(visibility.dims() == volume.dims());
    const auto slices = static_cast<std::size_t>(volume.dims().z);
    const std::size_t plane = volume.size() / slices;
    std::visit(
        [&](const auto& values) {
            parallelFor(slices, [&](std::size_t k) {
                job.throwIfStopped();
                for (std::size_t i = k * plane; i < (k + 1) * plane; ++i)
                    if (visibility[i] != 0)
                        body(k, i, static_cast<double>(visibility[i]),
                             volume.intensityOfValue(static_cast<double>(values[i])));
            });
        },
        volume.samples());
}

} // namespace

FeatureSums sumsOfField(const Volume& volume, const std::vector<Feature>& features, const Grid<float>& visibility,
                        const WeightFields* weights, const JobControl& job) {
    std::vector<FeatureSums> parts(static_cast<std::size_t>(volume.dims().z), emptySums(features.size()));
    forEachVisible(volume, visibility, job, [&](std::size_t slice, std::size_t i, double v, double intensity) {
        const double lb = weights ? weights->brightness(i) : 0.0, ls = weights ? weights->saturation(i) : 0.0;
        addVoxel(parts[slice], featureAt(features, intensity), v, lb, ls);
    });
    FeatureSums total = emptySums(features.size());
    for (const FeatureSums& part : parts) add(total, part);
    return total;
}

std::vector<double> visibilityHistogram(const Volume& volume, const Grid<float>& visibility, int bins,
                                        const JobControl& job) {
    std::vector<std::vector<double>> parts(static_cast<std::size_t>(volume.dims().z),
                                           std::vector<double>(static_cast<std::size_t>(bins), 0.0));
    forEachVisible(volume, visibility, job, [&](std::size_t slice, std::size_t, double v, double intensity) {
        parts[slice][static_cast<std::size_t>(histogramBin(intensity, bins))] += v;
    });
    std::vector<double> histogram(static_cast<std::size_t>(bins), 0.0);
    for (const auto& part : parts)
        for (std::size_t bin = 0; bin < part.size(); ++bin) histogram[bin] += part[bin];
    const double total = std::accumulate(histogram.begin(), histogram.end(), 0.0);
    for (double& h : histogram) h = share(h, total);
    return histogram;
}

} // namespace pellucid
