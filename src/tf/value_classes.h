// Classes of intensity, found in how often values occur and in what boundaries join (docs/method.md, "The automatic
// start"). Intensities are those of the window, [0,1], in kClassBins bins.
#pragma once

#include <optional>
#include <vector>

namespace pellucid {

inline constexpr int kClassBins = 256;
inline constexpr int kMostClasses = 5;

struct ClassEvidence {
    std::vector<double> all; ///< voxels per bin
    /// Where materials are: voxels that lie in no boundary, and the ends of boundaries, each of sum 1; the background's
    /// own voxels are left out.
    std::vector<double> matter;
};

/// The background's most typical intensity, and how far its values reach by themselves, noise included.
struct BackgroundValues {
    double lo = 0, mode = 0, hi = 0;
};

struct ValueClass {
    double lo = 0, mode = 0, hi = 0;
};

struct ValueClasses {
    std::vector<ValueClass> classes; ///< ascending, 1 to kMostClasses; neighbours meet except about the background
    double backgroundLo = 0, backgroundHi = 0; ///< where one was given
    bool byPeaks = false;                      ///< each class is a peak of `matter`; else multi-Otsu
    double fit = 0; ///< peaks: share of `matter` near a peak; Otsu: variance that the classes explain; [0,1]
};

/// Peaks where most of `matter` lies near them, borders half-way between them; else multi-Otsu.
ValueClasses findClasses(const ClassEvidence& evidence, const std::optional<BackgroundValues>& background);

/// The typical intensities of materials: the peaks of `matter` that are not background and not where values were cut
/// off, at most kMostClasses, ascending.
std::vector<double> materialModes(const ClassEvidence& evidence, const std::optional<BackgroundValues>& background);

/// Where a density rises above its surroundings: maxima from which it falls to (1 − prominence) of their height or less
/// on both sides before it is as high again, with `mass` of the whole or more between these falls. Ascending bins.
std::vector<int> prominentPeaks(const std::vector<double>& density, double prominence, double mass);

/// Convolution with a Gaussian of `sigma` bins, cut at 3 sigma, mirrored at the ends.
std::vector<double> smoothed(const std::vector<double>& density, double sigma);

struct OtsuBorders {
    std::vector<int> borders; ///< bins at which the next class begins, ascending
    double explained = 0;     ///< variance between classes of the whole variance, [0,1]
};
/// Otsu's criterion for `classes` classes in the bins [begin, end): the borders with the largest variance between
/// classes, exactly, by dynamic programming. Fewer classes where there are fewer bins.
OtsuBorders multiOtsu(const std::vector<double>& counts, int begin, int end, int classes);

} // namespace pellucid
