// The opacities that a proposed transfer function begins with: from how much there is of a feature, how deep it lies,
// and how long the paths through it are (docs/method.md, "The automatic start").
#pragma once

#include <vector>

#include "volume/voxel_survey.h"

namespace pellucid {

/// Where the voxels of an interval of values lie.
struct FeatureExtent {
    double share = 0; ///< of the valid voxels
    double depth = 0; ///< mean distance from the nearest voxel of no interval, or from the volume's faces, in d0
    double path = 1;  ///< mean length of the lines along the axes inside it, over those that meet it, in d0; at least 1
};

/// Of the intervals [lo, hi) of `ranges`, ascending; values beyond the first and last one's ends at the window's are
/// counted to them.
std::vector<FeatureExtent> extentsOf(const VoxelSurvey& survey, const ValueRange& window,
                                     const std::vector<ValueRange>& ranges);

/// Opacity of a path of d0, with which a path through the feature of its mean length has the alpha `cover`.
double opacityFor(double cover, const FeatureExtent& extent);

/// How deep each lies among them: 0 the outermost, 1 the innermost; all 0 where there is no difference.
std::vector<double> insideOf(const std::vector<FeatureExtent>& extents);

/// The alphas that features begin with: the more, the deeper and the rarer. Without a background depth says nothing:
/// the higher the values and the rarer.
std::vector<double> coversOf(const std::vector<FeatureExtent>& extents, bool hasBackground);

} // namespace pellucid
