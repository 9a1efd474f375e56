#include "optimize/coverage.h"

#include <algorithm>

namespace pellucid {

std::vector<char> drawnFeatures(const TransferFunction& tf) {
    const std::vector<double> opacity = featureOpacities(tf);
    std::vector<char> drawn;
    for (std::size_t f = 0; f < opacity.size(); ++f) drawn.push_back(!tf.features[f].hidden && opacity[f] > 0);
    if (std::ranges::none_of(drawn, [](char d) { return d; })) drawn.assign(drawn.size(), 1);
    return drawn;
}

std::vector<Coverage> coverageOf(const RayBundle& rays, const std::vector<TransferFunction>& tfs,
                                 const std::vector<char>& wanted, int every) {
    std::vector<Coverage> all;
    all.reserve(tfs.size());
    for (RayBundle::Appearance& a : rays.appearances(tfs, wanted, every)) all.push_back({a.alpha, std::move(a.covers)});
    return all;
}

bool isFaint(const Coverage& look, const std::vector<double>& targets) {
    if (look.coverage < kFaintCoverage) return true;
    for (std::size_t f = 0; f < targets.size(); ++f)
        if (targets[f] > 0 && look.covers[f] < kFaintCover) return true;
    return false;
}

Coverage coverageOf(const RayBundle& rays, const TransferFunction& tf) {
    return coverageOf(rays, std::vector<TransferFunction>{tf}, drawnFeatures(tf))[0];
}

} // namespace pellucid
