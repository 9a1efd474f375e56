#include "tf/empty_features.h"

#include <algorithm>

namespace pellucid {

bool hasVoxel(const Feature& feature, const Histogram& histogram) {
    const auto intensity = [&](std::uint16_t code) { return static_cast<double>(code) / histogram.maxCode; };
    const auto first = std::ranges::lower_bound(histogram.codes, feature.a, {}, intensity);
    return first != histogram.codes.end() && feature.contains(intensity(*first));
}

std::vector<bool> emptyFeatures(const TransferFunction& tf, const Histogram& histogram) {
    std::vector<bool> empty;
    for (const Feature& f : tf.features) empty.push_back(!hasVoxel(f, histogram));
    return empty;
}

std::vector<std::string> namesWithEmpty(const TransferFunction& tf, const Histogram& histogram) {
    std::vector<std::string> names;
    for (const Feature& f : tf.features) names.push_back(f.name + (hasVoxel(f, histogram) ? "" : " (empty)"));
    return names;
}

TransferFunction withEmptyHidden(TransferFunction tf, const Histogram& histogram) {
    for (Feature& f : tf.features) f.hidden = f.hidden || !hasVoxel(f, histogram);
    return tf;
}

std::string emptyTargetText(const TransferFunction& tf, const Histogram& histogram,
                            const std::vector<double>& targets) {
    std::vector<std::string> names;
    for (std::size_t f = 0; f < tf.features.size() && f < targets.size(); ++f)
        if (targets[f] > 0 && !hasVoxel(tf.features[f], histogram)) names.push_back("'" + tf.features[f].name + "'");
    if (names.empty()) return {};
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i)
        list += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
    return list +
           (names.size() == 1 ? " has no voxel: its target counts as 0" : " have no voxels: their targets count as 0");
}

} // namespace pellucid
