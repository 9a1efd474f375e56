// Classes of intensity, found in how often values occur and in what boundaries join (docs/method.md, "The automatic
// start").
#pragma once

#include <vector>

namespace pellucid {

inline constexpr int kClassBins = 256;

/// Densities over [0,1] in kClassBins bins.
struct ClassEvidence {
    std::vector<double> all;      ///< every voxel
    std::vector<double> matter;   ///< voxels that do not lie in a boundary, and the ends of boundaries
    std::vector<double> boundary; ///< middles of boundaries
};

struct ValueClass {
    double lo = 0, mode = 0, hi = 0; ///< [0,1]
};

/// Where a density rises above its surroundings: local maxima whose height falls to less than (1 − prominence) of
/// itself on both sides before it rises higher, with at least `mass` of the whole. Ascending bins.
std::vector<int> prominentPeaks(const std::vector<double>& density, double prominence, double mass);

/// Convolution with a Gaussian of `sigma` bins, cut at 3 sigma, mirrored at the ends.
std::vector<double> smoothed(const std::vector<double>& density, double sigma);

/// Otsu's criterion for `classes` classes in the bins [begin, end): the borders (bins at which the next class begins)
/// with the largest variance between classes, exactly, by dynamic programming. `explained` gets its part of the whole
/// variance, [0,1].
std::vector<int> multiOtsu(const std::vector<double>& counts, int begin, int end, int classes, double& explained);

} // namespace pellucid
