#include "saliency/vws.h"

namespace pellucid {

namespace {

double share(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

} // namespace

template <>
std::span<const Setting> settingsOf<VwsOptions>() {
    static const Setting kSettings[] = {
        {.key = "u1",
         .at = member<&VwsOptions::u1>,
         .words = "u1, brightness",
         .help = "The share of brightness in VWS, eq. 4.13; u1 and u2 add up to 1, so that one of them determines the "
                 "other."},
        {.key = "u2",
         .at = member<&VwsOptions::u2>,
         .words = "u2, saturation",
         .help = "The share of saturation in VWS, eq. 4.13; u1 and u2 add up to 1, so that one of them determines the "
                 "other."},
    };
    return kSettings;
}

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

} // namespace pellucid
