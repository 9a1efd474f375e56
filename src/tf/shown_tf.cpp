#include "tf/shown_tf.h"

#include <algorithm>

#include "base/check.h"

namespace pellucid {

namespace {

bool anyHidden(const TransferFunction& tf) { return std::ranges::any_of(tf.features, &Feature::hidden); }

} // namespace

TransferFunction shownTf(const TransferFunction& tf) {
    if (!anyHidden(tf)) return tf;
    std::vector<double> x = featureOpacities(tf);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (tf.features[i].hidden) x[i] = 0;
    return withFeatureOpacities(tf, x);
}

TransferFunction withShownOpacities(const TransferFunction& tf, std::vector<double> x) {
    PELLUCID_CHECK(x.size() == tf.features.size());
    const std::vector<double> own = featureOpacities(tf);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (tf.features[i].hidden) x[i] = own[i];
    return withFeatureOpacities(tf, x);
}

std::vector<double> shownShares(const TransferFunction& tf, std::vector<double> shares) {
    PELLUCID_CHECK(shares.size() == tf.features.size());
    if (!anyHidden(tf)) return shares;
    double sum = 0, shown = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (tf.features[i].hidden) continue;
        sum += shares[i];
        ++shown;
    }
    for (std::size_t i = 0; i < shares.size(); ++i)
        shares[i] = tf.features[i].hidden ? 0 : sum > 0 ? shares[i] / sum : 1 / shown;
    return shares;
}

std::vector<double> withShapesKept(std::vector<double> x, const std::vector<double>& was, double least) {
    for (std::size_t f = 0; f < x.size(); ++f) x[f] = std::max(x[f], std::min(was[f], least));
    return x;
}

} // namespace pellucid
