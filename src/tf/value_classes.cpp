#include "tf/value_classes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/check.h"

namespace pellucid {

std::vector<double> smoothed(const std::vector<double>& density, double sigma) {
    const auto n = static_cast<int>(density.size()), radius = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> kernel(static_cast<std::size_t>(radius) + 1);
    double sum = 0;
    for (int r = 0; r <= radius; ++r) {
        kernel[static_cast<std::size_t>(r)] = std::exp(-r * r / (2 * sigma * sigma));
        sum += (r == 0 ? 1 : 2) * kernel[static_cast<std::size_t>(r)];
    }
    std::vector<double> result(density.size(), 0.0);
    const auto mirrored = [n](int i) {
        while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
        return static_cast<std::size_t>(i);
    };
    for (int i = 0; i < n; ++i)
        for (int r = -radius; r <= radius; ++r)
            result[static_cast<std::size_t>(i)] +=
                density[mirrored(i + r)] * kernel[static_cast<std::size_t>(std::abs(r))] / sum;
    return result;
}

std::vector<int> prominentPeaks(const std::vector<double>& density, double prominence, double mass) {
    const auto n = static_cast<int>(density.size());
    const auto at = [&](int i) { return density[static_cast<std::size_t>(i)]; };
    const double whole = std::accumulate(density.begin(), density.end(), 0.0);
    std::vector<int> peaks;
    for (int i = 0; i < n; ++i) {
        if (at(i) <= 0 || (i > 0 && at(i - 1) >= at(i)) || (i + 1 < n && at(i + 1) > at(i))) continue;
        // How deep the density falls on either side before it is as high again; an end of the range is a fall.
        double saddle = 0, own = at(i);
        for (const int sign : {-1, 1}) {
            double lowest = at(i);
            int j = i + sign;
            double sum = 0, sumToLowest = 0;
            for (; j >= 0 && j < n && at(j) <= at(i); j += sign) {
                sum += at(j);
                if (at(j) < lowest) lowest = at(j), sumToLowest = sum;
            }
            if (j < 0 || j >= n) lowest = 0, sumToLowest = sum;
            own += sumToLowest;
            saddle = std::max(saddle, lowest);
        }
        if (saddle <= (1 - prominence) * at(i) && own >= mass * whole) peaks.push_back(i);
    }
    return peaks;
}

OtsuBorders multiOtsu(const std::vector<double>& counts, int begin, int end, int classes) {
    PELLUCID_CHECK(0 <= begin && begin < end && end <= static_cast<int>(counts.size()) && classes >= 1);
    const auto n = static_cast<std::size_t>(end - begin);
    std::vector<double> weight(n + 1, 0), moment(n + 1, 0);
    double second = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double c = counts[static_cast<std::size_t>(begin) + i], x = static_cast<double>(i);
        weight[i + 1] = weight[i] + c;
        moment[i + 1] = moment[i] + c * x;
        second += c * x * x;
    }
    // Between-class variance is Σ moment²/weight over the classes, but for a constant (Liao, Chen and Chung 2001).
    const auto gain = [&](std::size_t a, std::size_t b) {
        const double w = weight[b] - weight[a], m = moment[b] - moment[a];
        return w > 0 ? m * m / w : 0.0;
    };
    const std::size_t used = std::min(static_cast<std::size_t>(classes), n);
    // best[k][b]: of the first b bins in k classes, the last of which begins at from[k][b].
    std::vector<std::vector<double>> best(used + 1, std::vector<double>(n + 1, -1.0));
    std::vector<std::vector<std::size_t>> from(used + 1, std::vector<std::size_t>(n + 1, 0));
    best[0][0] = 0;
    for (std::size_t k = 1; k <= used; ++k)
        for (std::size_t b = k; b <= n; ++b)
            for (std::size_t a = k - 1; a < b; ++a) {
                if (best[k - 1][a] < 0) continue;
                const double value = best[k - 1][a] + gain(a, b);
                if (value > best[k][b]) best[k][b] = value, from[k][b] = a;
            }
    OtsuBorders result;
    for (std::size_t k = used, b = n; k > 1; --k) {
        b = from[k][b];
        result.borders.insert(result.borders.begin(), begin + static_cast<int>(b));
    }
    const double mean = weight.back() > 0 ? moment.back() * moment.back() / weight.back() : 0.0;
    result.explained = second > mean ? std::clamp((best[used][n] - mean) / (second - mean), 0.0, 1.0) : 1.0;
    return result;
}

namespace {

constexpr double kBandwidth = 3;         // bins: 1.2 % of the window
constexpr double kProminence = 0.2;      // a peak's fall on both sides, of its height
constexpr double kLeastMass = 0.01;      // of `matter`
constexpr double kAbsorbed = 0.08;       // of the window: a peak so near to the background belongs to it
constexpr double kNearPeak = 0.06;       // of the window: as far as a material's values spread
constexpr double kLeastFit = 0.6;        // share of `matter` near peaks from which on they are materials
constexpr double kMostLeftOut = 0.5;     // voxels between the background and the first material, of the materials'
constexpr double kLeastExplained = 0.95; // of the variance, by as few classes as do it
constexpr double kClippedMass = 0.05;    // a lesser peak at an end of the window is of values that were cut off there

double middle(int bin) { return (bin + 0.5) / kClassBins; }
double begin(int bin) { return static_cast<double>(bin) / kClassBins; }

double massBetween(const std::vector<double>& density, double lo, double hi) {
    double sum = 0;
    for (int i = 0; i < kClassBins; ++i)
        if (middle(i) >= lo && middle(i) < hi) sum += density[static_cast<std::size_t>(i)];
    return sum;
}

/// Peaks of matter that are not background and not where values were cut off, the most prominent kMostClasses.
std::vector<int> materialPeaks(const std::vector<double>& matter, const std::optional<BackgroundValues>& background) {
    const double whole = massBetween(matter, 0, 1);
    const auto isMaterial = [&](int bin) {
        const double x = middle(bin);
        if (background && x >= std::min(background->lo, background->mode - kAbsorbed) &&
            x <= std::max(background->hi, background->mode + kAbsorbed))
            return false;
        const bool atEnd = bin <= 1 || bin >= kClassBins - 2;
        return !atEnd || massBetween(matter, x - 2 * kBandwidth / kClassBins, x + 2 * kBandwidth / kClassBins) >=
                             kClippedMass * whole;
    };
    std::vector<int> peaks;
    for (double prominence = kProminence; prominence < 1; prominence += 0.05) {
        peaks.clear();
        for (const int bin : prominentPeaks(matter, prominence, kLeastMass))
            if (isMaterial(bin)) peaks.push_back(bin);
        if (peaks.size() <= static_cast<std::size_t>(kMostClasses)) break;
    }
    if (peaks.size() > static_cast<std::size_t>(kMostClasses)) peaks.clear(); // no materials: as many as noise makes
    return peaks;
}

std::vector<double> modesOf(const std::vector<int>& peaks) {
    std::vector<double> modes;
    std::ranges::transform(peaks, std::back_inserter(modes), middle);
    return modes;
}

/// Share of matter beyond the background that lies near a peak.
double fitOf(const std::vector<double>& matter, const std::vector<int>& peaks,
             const std::optional<BackgroundValues>& background) {
    double whole = 0, near = 0;
    for (int i = 0; i < kClassBins; ++i) {
        const double x = middle(i), m = matter[static_cast<std::size_t>(i)];
        if (background && std::abs(x - background->mode) <= kAbsorbed) continue;
        whole += m;
        if (std::any_of(peaks.begin(), peaks.end(), [&](int p) { return std::abs(middle(p) - x) <= kNearPeak; }))
            near += m;
    }
    return whole > 0 ? near / whole : 0;
}

/// Classes about given modes, borders half-way; the background's borders likewise, but beyond its noise.
ValueClasses classesAbout(const std::vector<double>& modes, const std::optional<BackgroundValues>& background) {
    ValueClasses result;
    const auto beyondNoise = [](double from, double to, double noise) {
        const double half = (from + to) / 2, most = from + 0.75 * (to - from);
        return from < to ? std::min(std::max(half, noise), most) : std::max(std::min(half, noise), most);
    };
    if (background) result.backgroundLo = 0, result.backgroundHi = 1;
    for (std::size_t k = 0; k < modes.size(); ++k) {
        ValueClass c{0, modes[k], 1};
        if (k > 0) c.lo = (modes[k - 1] + modes[k]) / 2;
        if (k + 1 < modes.size()) c.hi = (modes[k] + modes[k + 1]) / 2;
        if (background && modes[k] > background->mode && (k == 0 || modes[k - 1] < background->mode))
            result.backgroundHi = c.lo = beyondNoise(background->mode, modes[k], background->hi);
        if (background && modes[k] < background->mode && (k + 1 == modes.size() || modes[k + 1] > background->mode))
            result.backgroundLo = c.hi = beyondNoise(background->mode, modes[k], background->lo);
        result.classes.push_back(c);
    }
    return result;
}

/// The mean of the voxels in [lo, hi).
double meanIn(const std::vector<double>& counts, double lo, double hi) {
    double sum = 0, moment = 0;
    for (int i = 0; i < kClassBins; ++i)
        if (middle(i) >= lo && middle(i) < hi) {
            sum += counts[static_cast<std::size_t>(i)];
            moment += counts[static_cast<std::size_t>(i)] * middle(i);
        }
    return sum > 0 ? moment / sum : (lo + hi) / 2;
}

/// Multi-Otsu over all voxels; the class that holds the background's mode is the background.
ValueClasses classesByOtsu(const std::vector<double>& all, const std::optional<BackgroundValues>& background) {
    // One class for the background, and as few others as explain the variance.
    const int fewest = background ? 3 : 2, most = background ? 5 : 4;
    OtsuBorders otsu;
    for (int k = fewest; k <= most; ++k) {
        otsu = multiOtsu(all, 0, kClassBins, k);
        if (otsu.explained >= kLeastExplained) break;
    }
    const auto withEnds = [&] {
        std::vector<double> borders{0};
        for (const int b : otsu.borders) borders.push_back(begin(b));
        borders.push_back(1);
        return borders;
    };
    std::vector<double> borders = withEnds();
    const auto hasEmptyClass = [&] {
        for (std::size_t k = 0; k + 1 < borders.size(); ++k)
            if (massBetween(all, borders[k], borders[k + 1]) == 0) return true;
        return false;
    };
    while (borders.size() > 2 && hasEmptyClass()) { // fewer values than classes
        otsu = multiOtsu(all, 0, kClassBins, static_cast<int>(borders.size()) - 2);
        borders = withEnds();
    }
    ValueClasses result;
    result.fit = otsu.explained;
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
        const double lo = borders[k], hi = borders[k + 1];
        if (background && background->mode >= lo && (background->mode < hi || hi == 1)) {
            result.backgroundLo = lo == 0 ? 0 : std::min(lo, std::max(background->lo, 0.0));
            result.backgroundHi = hi == 1 ? 1 : std::max(hi, std::min(background->hi, 1.0));
        } else {
            result.classes.push_back({lo, meanIn(all, lo, hi), hi});
        }
    }
    // Noise may carry the background's border into its neighbours.
    if (background) {
        std::vector<ValueClass> kept;
        for (ValueClass c : result.classes) {
            if (c.mode > background->mode) c.lo = std::max(c.lo, result.backgroundHi);
            if (c.mode < background->mode) c.hi = std::min(c.hi, result.backgroundLo);
            if (c.lo < c.hi) kept.push_back({c.lo, std::clamp(c.mode, c.lo, c.hi), c.hi});
        }
        result.classes = std::move(kept);
    }
    return result;
}

/// Whether the classes hold most of what is not background. Where values rise gradually from the background, half-way
/// to the first peak is too far.
bool coverMatter(const ValueClasses& found, const ClassEvidence& evidence, const BackgroundValues& background) {
    double held = 0;
    for (const ValueClass& c : found.classes) held += massBetween(evidence.all, c.lo, c.hi);
    const double noise = std::max(kNearPeak, background.hi - background.mode);
    const double leftOut = massBetween(evidence.all, found.backgroundLo, background.mode - noise) +
                           massBetween(evidence.all, background.mode + noise, found.backgroundHi);
    return leftOut <= kMostLeftOut * held;
}

} // namespace

std::vector<double> materialModes(const ClassEvidence& evidence, const std::optional<BackgroundValues>& background) {
    return modesOf(materialPeaks(smoothed(evidence.matter, kBandwidth), background));
}

ValueClasses findClasses(const ClassEvidence& evidence, const std::optional<BackgroundValues>& background) {
    const std::vector<double> matter = smoothed(evidence.matter, kBandwidth);
    const std::vector<int> peaks = materialPeaks(matter, background);
    const double fit = fitOf(matter, peaks, background);
    if ((peaks.size() >= 2 || (background && peaks.size() == 1 && fit >= 0.75)) && fit >= kLeastFit) {
        ValueClasses result = classesAbout(modesOf(peaks), background);
        result.byPeaks = true;
        result.fit = fit;
        if (!background || coverMatter(result, evidence, *background)) return result;
    }
    ValueClasses result = classesByOtsu(evidence.all, background);
    if (result.classes.empty()) { // the background is all there is: what stands out from it, however little
        result.backgroundLo = 0;
        result.backgroundHi = background ? std::clamp(background->hi, 0.0, 1 - 1.0 / kClassBins) : 0;
        result.classes.push_back({result.backgroundHi, (result.backgroundHi + 1) / 2, 1});
    }
    return result;
}

} // namespace pellucid
