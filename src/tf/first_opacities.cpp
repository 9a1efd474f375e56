#include "tf/first_opacities.h"

#include <algorithm>
#include <cmath>

#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr float kUnknown = 1e9f;

/// Index of the range of each surveyed voxel, −1 for none.
std::vector<int> rangeOfVoxels(const VoxelSurvey& survey, const ValueRange& window,
                               const std::vector<ValueRange>& ranges) {
    std::vector<int> of(survey.size(), -1);
    for (std::size_t i = 0; i < survey.size(); ++i) {
        if (std::isnan(survey.values[i])) continue;
        const double v = std::clamp(survey.values[i], window.lo, window.hi);
        for (std::size_t f = 0; f < ranges.size(); ++f)
            if (v >= ranges[f].lo && (v < ranges[f].hi || (ranges[f].hi >= window.hi && v <= ranges[f].hi)))
                of[i] = static_cast<int>(f);
    }
    return of;
}

/// Distance in d0 along the axes to the nearest cell of no range or to the outside, in two passes.
std::vector<float> depthOfCells(const VoxelSurvey& survey, const std::vector<int>& of) {
    const Int3 d = survey.dims;
    const std::size_t strides[3] = {1, static_cast<std::size_t>(d.x), layerSize(d)};
    std::vector<float> depth(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) depth[i] = of[i] >= 0 ? kUnknown : 0;
    const auto relax = [&](std::size_t i, int towards) {
        if (of[i] < 0) return;
        const Int3 c = voxelAt(d, i);
        for (int a = 0; a < 3; ++a) {
            if (d[a] == 1) continue; // no way out along this axis
            const bool edge = towards < 0 ? c[a] == 0 : c[a] == d[a] - 1;
            const float next = edge ? 0 : depth[towards < 0 ? i - strides[a] : i + strides[a]];
            depth[i] = std::min(depth[i], next + static_cast<float>(survey.pathPerCell[a]));
        }
    };
    for (std::size_t i = 0; i < of.size(); ++i) relax(i, -1);
    for (std::size_t i = of.size(); i-- > 0;) relax(i, 1);
    return depth;
}

} // namespace

std::vector<FeatureExtent> extentsOf(const VoxelSurvey& survey, const ValueRange& window,
                                     const std::vector<ValueRange>& ranges) {
    const std::vector<int> of = rangeOfVoxels(survey, window, ranges);
    const std::vector<float> depth = depthOfCells(survey, of);
    const std::size_t count = ranges.size();
    std::vector<double> cells(count, 0), depths(count, 0), lengths(count, 0), lines(count, 0);
    double valid = 0;
    for (std::size_t i = 0; i < of.size(); ++i) {
        valid += !std::isnan(survey.values[i]);
        if (of[i] < 0) continue;
        cells[static_cast<std::size_t>(of[i])] += 1;
        depths[static_cast<std::size_t>(of[i])] += depth[i] < kUnknown ? depth[i] : 0;
    }
    const Int3 d = survey.dims;
    const std::size_t strides[3] = {1, static_cast<std::size_t>(d.x), layerSize(d)};
    std::vector<double> met(count);
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        for (int j = 0; j < d[c]; ++j)
            for (int i = 0; i < d[b]; ++i) {
                std::fill(met.begin(), met.end(), 0.0);
                std::size_t at = static_cast<std::size_t>(i) * strides[b] + static_cast<std::size_t>(j) * strides[c];
                for (int k = 0; k < d[a]; ++k, at += strides[a])
                    if (of[at] >= 0) met[static_cast<std::size_t>(of[at])] += survey.pathPerCell[a];
                for (std::size_t f = 0; f < count; ++f)
                    if (met[f] > 0) lengths[f] += met[f], lines[f] += 1;
            }
    }
    std::vector<FeatureExtent> extents(count);
    for (std::size_t f = 0; f < count; ++f) {
        if (cells[f] == 0) continue;
        extents[f] = {cells[f] / valid, depths[f] / cells[f], std::max(1.0, lengths[f] / lines[f])};
    }
    return extents;
}

double opacityFor(double cover, const FeatureExtent& extent) {
    return std::clamp(1 - std::pow(1 - cover, 1 / extent.path), 0.001, 0.95);
}

std::vector<double> insideOf(const std::vector<FeatureExtent>& extents) {
    const auto [least, most] = std::ranges::minmax_element(extents, {}, &FeatureExtent::depth);
    std::vector<double> inside;
    for (const FeatureExtent& x : extents)
        inside.push_back(most->depth > least->depth ? (x.depth - least->depth) / (most->depth - least->depth) : 0);
    return inside;
}

std::vector<double> coversOf(const std::vector<FeatureExtent>& extents, bool hasBackground) {
    constexpr double kOne = 0.9;                                     // the only feature
    constexpr double kThrough = 0.45, kLeastOuter = 0.3;             // what outer features let through, each hides
    constexpr double kMost = 0.96;                                   // the innermost and rarest
    constexpr double kLeastEverywhere = 0.08, kMostEverywhere = 0.9; // where matter is everywhere
    constexpr double kLeastShare = 1e-6;
    if (extents.size() == 1) return {kOne};
    double common = 0, rare = 1;
    for (const FeatureExtent& x : extents) {
        common = std::max(common, x.share);
        rare = std::min(rare, std::max(x.share, kLeastShare));
    }
    const auto outer = static_cast<double>(extents.size() - 1);
    const double least = std::max(kLeastOuter, 1 - std::pow(kThrough, 1 / outer));
    const std::vector<double> inside = insideOf(extents);
    std::vector<double> covers;
    for (std::size_t f = 0; f < extents.size(); ++f) {
        const double share = std::max(extents[f].share, kLeastShare);
        // No rarity to speak of where shares are within a factor of 1½.
        const double rarity = common > 1.5 * rare ? std::log(common / share) / std::log(common / rare) : 0.5;
        const double height = static_cast<double>(f) / outer;
        const double weight = hasBackground ? (inside[f] + rarity) / 2 : (height + rarity) / 2;
        covers.push_back(hasBackground ? least + (kMost - least) * weight
                                       : kLeastEverywhere + (kMostEverywhere - kLeastEverywhere) * weight * weight);
    }
    return covers;
}

} // namespace pellucid
