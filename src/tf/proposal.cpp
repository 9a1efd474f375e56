#include "tf/proposal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/round_numbers.h"
#include "tf/empty_features.h"
#include "tf/first_opacities.h"
#include "tf/palette.h"
#include "tf/value_classes.h"
#include "volume/robust_range.h"
#include "volume/voxel_survey.h"

namespace pellucid {

namespace {

constexpr double kMostValue = std::numeric_limits<double>::max() / 4;

/// What all steps look at. Values are clamped to the window, as renderers do.
struct Evidence {
    const Volume& data;
    VoxelSurvey survey;
    ValueRange window;

    double intensity(double value) const { return std::clamp((value - window.lo) / (window.hi - window.lo), 0.0, 1.0); }
    double value(double intensity) const {
        if (intensity <= 0) return window.lo;
        if (intensity >= 1) return window.hi;
        return window.lo * (1 - intensity) + window.hi * intensity;
    }
    std::size_t bin(double value) const {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(intensity(value) * kClassBins), 0, kClassBins - 1));
    }
    std::string text(double value) const { return numberText(value, window.hi - window.lo); }
    std::string text(double lo, double hi) const { return text(lo) + " to " + text(hi); }
};

/// Of `count` parts of the values, what the one at `index` from below is called: their values stand beside them.
std::string levelName(std::size_t index, std::size_t count) {
    static const std::array<std::vector<const char*>, 5> kNames{
        {{"object"},
         {"low", "high"},
         {"low", "middle", "high"},
         {"low", "lower middle", "upper middle", "high"},
         {"low", "lower middle", "middle", "upper middle", "high"}}};
    if (count <= kNames.size()) return kNames[count - 1][index];
    return "level " + std::to_string(index + 1);
}

std::string percent(double share) {
    if (share > 0 && share < 0.001) return "under 0.1 %";
    return numberText(100 * share, share < 0.0995 ? 100 : 1e5) + " %";
}

// ---------------------------------------------------------------- background

struct Background {
    BackgroundValues values; ///< intensities
    double faces = 0;        ///< share of the voxels on the volume's faces
    double share = 0;        ///< of all valid voxels
};

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The most common value of the volume's faces, where it is common there and in the whole. Empty otherwise: matter
/// fills the volume.
std::optional<Background> findBackground(const Evidence& e) {
    constexpr double kNear = 0.04; // of the window: as far as its values spread
    constexpr double kLeastOfFaces = 0.4, kLeastOfAll = 0.05;
    constexpr double kNoise = 4; // standard deviations
    std::vector<double> faces, all, histogram(kClassBins, 0);
    for (std::size_t i = 0; i < e.survey.size(); ++i) {
        const double v = e.survey.values[i];
        if (std::isnan(v)) continue;
        all.push_back(e.intensity(v));
        if (!e.survey.onFace(i)) continue;
        faces.push_back(e.intensity(v));
        ++histogram[e.bin(v)];
    }
    if (faces.empty()) return {};
    const std::vector<double> smooth = smoothed(histogram, 2);
    const auto top = std::max_element(smooth.begin(), smooth.end()) - smooth.begin();
    const double peak = (static_cast<double>(top) + 0.5) / kClassBins;
    const auto isNear = [&](double x) { return std::abs(x - peak) <= kNear; };
    std::vector<double> near;
    std::ranges::copy_if(faces, std::back_inserter(near), isNear);
    Background b;
    b.faces = static_cast<double>(near.size()) / static_cast<double>(faces.size());
    b.share = static_cast<double>(std::ranges::count_if(all, isNear)) / static_cast<double>(all.size());
    if (b.faces < kLeastOfFaces || b.share < kLeastOfAll) return {};
    b.values.mode = median(near);
    std::vector<double> deviations;
    for (const double x : near) deviations.push_back(std::abs(x - b.values.mode));
    const double sigma = 1.4826 * median(deviations);
    b.values.lo = b.values.mode - kNoise * sigma;
    b.values.hi = b.values.mode + kNoise * sigma;
    return b;
}

// ---------------------------------------------------------------- evidence for classes

/// Voxels per bin; and where materials are, by voxels in no boundary and by the ends of boundaries. What is flat, the
/// data's own gradients tell: those of the calmer third of what is not background.
ClassEvidence classEvidence(const Evidence& e, const std::optional<Background>& background, const JobControl& job) {
    constexpr double kCalm = 0.3;        // quantile of the gradients that are noise
    constexpr double kLeastNoise = 0.01; // of the window per d0
    constexpr double kSteep = 2, kLeastSteep = 0.03;
    const auto isBackground = [&](double v) {
        return background && e.intensity(v) >= background->values.lo && e.intensity(v) <= background->values.hi;
    };
    const double span = e.window.hi - e.window.lo;
    std::vector<double> gradients;
    ClassEvidence evidence{std::vector<double>(kClassBins, 0), std::vector<double>(kClassBins, 0)};
    for (std::size_t i = 0; i < e.survey.size(); ++i) {
        const double v = e.survey.values[i];
        if (std::isnan(v)) continue;
        ++evidence.all[e.bin(v)];
        if (!isBackground(v)) gradients.push_back(e.survey.gradients[i] / span);
    }
    if (gradients.empty()) return evidence;
    const auto calm = gradients.begin() + static_cast<std::ptrdiff_t>(kCalm * static_cast<double>(gradients.size()));
    std::nth_element(gradients.begin(), calm, gradients.end());
    const double noise = *calm;

    const auto addShares = [&](const std::vector<double>& counts) {
        const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
        for (std::size_t b = 0; sum > 0 && b < counts.size(); ++b) evidence.matter[b] += counts[b] / sum;
    };
    std::vector<double> flat(kClassBins, 0), ends(kClassBins, 0);
    for (std::size_t i = 0; i < e.survey.size(); ++i) {
        const double v = e.survey.values[i];
        if (std::isnan(v) || isBackground(v)) continue;
        const double q = e.survey.gradients[i] / span / (noise + kLeastNoise);
        flat[e.bin(v)] += 1 / (1 + q * q * q * q);
    }
    addShares(flat);
    for (const BoundaryEnds& b : boundaryEnds(e.data, e.survey, std::max(kSteep * noise, kLeastSteep) * span,
                                              std::max(noise, kLeastNoise) * span, job))
        for (const double v : {b.low, b.high})
            if (!isBackground(v)) ++ends[e.bin(v)];
    addShares(ends);
    return evidence;
}

// ---------------------------------------------------------------- features

/// A feature with what it looks like.
struct Part {
    ProposedFeature feature;
    Rgb color;
    double cover = 0; ///< alpha of a path of mean length through it
};

ValueRange rangeOf(const Part& p) { return {p.feature.lo, p.feature.hi}; }

std::vector<ValueRange> rangesOf(const std::vector<Part>& parts) {
    std::vector<ValueRange> ranges;
    std::ranges::transform(parts, std::back_inserter(ranges), rangeOf);
    return ranges;
}

/// Trapezoids from border to border. Where two features meet, the opacity is the lower of the two, so that neither
/// rises beyond its own and nothing between them is left out; beside the background it falls to 0, and stays there:
/// these points are fixed, so that no refinement brings back what was left out.
TransferFunction trapezoids(const Evidence& e, const std::vector<Part>& parts, const std::vector<double>& opacities) {
    constexpr double kSlope = 0.5; // of the way from border to mode
    TransferFunction tf;
    tf.range = e.window;
    for (std::size_t f = 0; f < parts.size(); ++f) {
        const ProposedFeature& p = parts[f].feature;
        const double own = opacities[f];
        const double a = e.intensity(p.lo), b = e.intensity(p.hi), m = std::clamp(e.intensity(p.mode), a, b);
        const bool meetsBefore = f > 0 && parts[f - 1].feature.hi == p.lo;
        const bool meetsAfter = f + 1 < parts.size() && parts[f + 1].feature.lo == p.hi;
        const double before = meetsBefore ? std::min(opacities[f - 1], own) : a <= 0 ? own : 0;
        const double after = meetsAfter ? std::min(own, opacities[f + 1]) : b >= 1 ? own : 0;
        const auto add = [&](double x, double opacity) {
            tf.points.push_back({std::clamp(x, tf.points.empty() ? 0.0 : tf.points.back().x, 1.0),
                                 opacity,
                                 parts[f].color,
                                 opacity == 0,
                                 {}});
        };
        add(a, before);
        if (before < own) add(a + kSlope * (m - a), own);
        if (after < own) add(b - kSlope * (b - m), own);
        add(b, after);
        tf.features.push_back({p.name, a, b, parts[f].color, {}});
    }
    return tf;
}

/// Drops the parts that no voxel belongs to; the part below reaches over them, so that no hole is left. Where the
/// survey has not seen something of each part, all voxels are asked. Where nothing is valid all parts stay.
void dropEmpty(std::vector<Part>& parts, const Evidence& e) {
    const std::vector<FeatureExtent> seen = extentsOf(e.survey, e.window, rangesOf(parts));
    if (std::ranges::all_of(seen, [](const FeatureExtent& extent) { return extent.share > 0; })) return;
    if (!e.data.hasValidVoxels()) return;
    const Histogram histogram = makeHistogram(e.data.withRange(e.window));
    std::vector<Part> kept;
    for (Part& p : parts) {
        Feature feature;
        feature.a = e.intensity(p.feature.lo);
        feature.b = e.intensity(p.feature.hi);
        if (hasVoxel(feature, histogram))
            kept.push_back(std::move(p));
        else if (!kept.empty() && kept.back().feature.hi == p.feature.lo)
            kept.back().feature.hi = p.feature.hi;
    }
    parts = std::move(kept);
}

/// Shares, depths, opacities and the transfer function of `parts`. Covers of 0 are chosen here.
void finish(Proposal& result, const Evidence& e, std::vector<Part> parts) {
    std::erase_if(parts, [](const Part& p) { return !(p.feature.lo < p.feature.hi); });
    dropEmpty(parts, e);
    const std::vector<FeatureExtent> extents = extentsOf(e.survey, e.window, rangesOf(parts));
    const std::vector<double> inside = insideOf(extents), covers = coversOf(extents, result.background.has_value());
    std::vector<double> opacities;
    for (std::size_t f = 0; f < parts.size(); ++f) {
        parts[f].feature.share = extents[f].share;
        parts[f].feature.inside = inside[f];
        opacities.push_back(opacityFor(parts[f].cover > 0 ? parts[f].cover : covers[f], extents[f]));
        result.features.push_back(parts[f].feature);
    }
    result.tf = trapezoids(e, parts, opacities);
}

void sayBackground(Proposal& result, const Evidence& e, const Background& b) {
    result.why.push_back("background about " + e.text(e.value(b.values.mode)) + ": " + percent(b.faces) +
                         " of the voxels on the volume's faces, " + percent(b.share) + " of all");
}

// ---------------------------------------------------------------- one function per kind

/// Nothing to tell apart: one feature over everything.
Proposal proposeUniform(const Volume& data, VoxelSurvey survey, DataKind kind) {
    Proposal result;
    result.kind = kind;
    const double value = std::clamp(data.dataRange().lo, -kMostValue, kMostValue);
    const double half = std::max(0.5, std::abs(value) * 1e-3);
    Evidence e{data, std::move(survey), {value - half, value + half}};
    result.window = e.window;
    const std::string text = numberText(value, std::abs(value));
    const bool empty = kind == DataKind::Empty;
    result.why = {empty ? "no voxel has a valid value" : "every voxel has the value " + text};
    Part everything;
    everything.feature = {empty ? "no values" : "value " + text, e.window.lo, e.window.hi, value, 0, 0};
    everything.color = classColors(1).front();
    everything.cover = 0.5;
    finish(result, e, std::vector<Part>(1, everything));
    return result;
}

/// Those that lie in the window, which NaN does not.
std::vector<double> valuesIn(const std::vector<double>& values, const ValueRange& window) {
    std::vector<double> inside;
    std::ranges::copy_if(values, std::back_inserter(inside),
                         [&](double v) { return window.lo <= v && v <= window.hi; });
    return inside;
}

/// One feature per value, borders half-way; the most common one on the faces is the background.
void proposeValues(Proposal& result, const Evidence& e, const std::vector<double>& values) {
    constexpr std::size_t kMostFeatures = 12;
    std::vector<std::size_t> faces(values.size(), 0);
    std::size_t onFaces = 0;
    for (std::size_t i = 0; i < e.survey.size(); ++i) {
        if (std::isnan(e.survey.values[i]) || !e.survey.onFace(i)) continue;
        const auto at = std::lower_bound(values.begin(), values.end(), e.survey.values[i]);
        if (at != values.end()) ++faces[static_cast<std::size_t>(at - values.begin())], ++onFaces;
    }
    const auto most = static_cast<std::size_t>(std::max_element(faces.begin(), faces.end()) - faces.begin());
    const bool hasBackground = onFaces > 0 && 2 * faces[most] > onFaces;
    const auto border = [&](std::size_t above) { // between values above − 1 and above
        if (above == 0) return e.window.lo;
        if (above == values.size()) return e.window.hi;
        return values[above - 1] / 2 + values[above] / 2;
    };
    std::vector<Part> parts;
    const std::size_t others = values.size() - (hasBackground ? 1 : 0);
    const std::size_t each = (others + kMostFeatures - 1) / kMostFeatures; // values that share a feature
    for (std::size_t v = 0; v < values.size();) {
        if (hasBackground && v == most) {
            result.background = ValueRange{border(v), border(v + 1)};
            ++v;
            continue;
        }
        std::size_t end = std::min(v + each, values.size());
        if (hasBackground && v < most) end = std::min(end, most);
        const std::string text =
            end - v == 1 ? "value " + e.text(values[v]) : "values " + e.text(values[v], values[end - 1]);
        parts.push_back({{text, border(v), border(end), (values[v] + values[end - 1]) / 2, 0, 0}, {}, 0});
        v = end;
    }
    const std::vector<Rgb> colors = classColors(static_cast<int>(parts.size()));
    for (std::size_t f = 0; f < parts.size(); ++f) parts[f].color = colors[f];
    result.why.push_back(values.size() == 2 ? "two values: " + e.text(values[0]) + " and " + e.text(values[1])
                                            : std::to_string(values.size()) + " whole numbers: labels");
    if (hasBackground)
        result.why.push_back("background " + e.text(values[most]) + ": " +
                             percent(static_cast<double>(faces[most]) / static_cast<double>(onFaces)) +
                             " of the voxels on the volume's faces");
    finish(result, e, std::move(parts));
}

/// Blue below 0, red above, nothing near 0.
void proposeSigned(Proposal& result, const Evidence& e, double sigma) {
    constexpr double kSignificant = 3, kMostOfRange = 0.35;
    const double end = std::max(std::abs(e.window.lo), std::abs(e.window.hi));
    const double weak = std::min(kSignificant * sigma, kMostOfRange * end), strong = (weak + end) / 2;
    const std::vector<Rgb> colors = divergingColors();
    std::vector<Part> parts;
    const auto add = [&](const char* name, double lo, double hi, double mode, std::size_t color, double cover) {
        lo = std::max(lo, e.window.lo);
        hi = std::min(hi, e.window.hi);
        if (lo < hi) parts.push_back({{name, lo, hi, std::clamp(mode, lo, hi), 0, 0}, colors[color], cover});
    };
    constexpr double kWeak = 0.3, kStrong = 0.9;
    add("strongly negative", -end, -strong, -end, 0, kStrong);
    add("negative", -strong, -weak, -strong, 1, kWeak);
    add("positive", weak, strong, strong, 2, kWeak);
    add("strongly positive", strong, end, end, 3, kStrong);
    result.background = ValueRange{std::max(-weak, e.window.lo), std::min(weak, e.window.hi)};
    result.why.push_back("values of both signs about 0: blue below, red above; nearer to 0 than " + e.text(weak) +
                         " (three robust standard deviations, or 35 % of the range) is left out");
    finish(result, e, std::move(parts));
}

/// Tissues by their density. Borders lie half-way between the densities found, or where they usually lie.
void proposeCt(Proposal& result, const Evidence& e, const JobControl& job) {
    std::optional<Background> found = findBackground(e);
    if (found && e.value(found->values.mode) > kAirHounsfield.hi) found.reset();
    const double air = found ? std::clamp(e.value(found->values.mode), kAirHounsfield.lo, kAirHounsfield.hi) : -1000;
    const BackgroundValues background{e.intensity(kAirHounsfield.lo), e.intensity(air), e.intensity(kAirHounsfield.hi)};
    const ClassEvidence evidence = classEvidence(e, Background{background, 0, 0}, job);
    std::optional<double> fat, soft, bone, dense;
    for (const double m : materialModes(evidence, background)) {
        const double hu = e.value(m);
        if (hu >= -180 && hu < -40 && !fat) fat = hu;
        if (hu >= -40 && hu < 150 && !soft) soft = hu;
        if (hu >= 180 && !bone)
            bone = hu;
        else if (hu >= 180)
            dense = hu;
    }
    const double softMode = soft.value_or(40), fatMode = fat.value_or(-100);
    const double skinBorder = std::clamp((air + (fat ? *fat : softMode)) / 2, -650.0, -300.0);
    const double softBorder = fat && soft ? (*fat + *soft) / 2 : -30;
    const double boneBorder = bone ? std::clamp((softMode + *bone) / 2, 130.0, 300.0) : 180;
    const double denseBorder = bone && dense ? (*bone + *dense) / 2 : 700;
    const TissueColors colors = tissueColors();
    // Lungs are as thin as foam and clothes, but lie deeper than the tissue around them.
    const std::vector<FeatureExtent> trial =
        extentsOf(e.survey, e.window, {{-950, skinBorder}, {skinBorder, e.window.hi}});
    constexpr double kLeastLung = 0.03, kLeastShare = 0.0002;
    const bool lung = trial[0].share >= kLeastLung && trial[0].depth > trial[1].depth;

    std::vector<Part> parts;
    if (lung) parts.push_back({{"lung", -950, skinBorder, -850, 0, 0}, colors.lung, 0.25});
    parts.push_back({{"skin and fat", skinBorder, softBorder, fatMode, 0, 0}, colors.fat, 0.6});
    parts.push_back({{"soft tissue", softBorder, boneBorder, softMode, 0, 0}, colors.soft, 0.35});
    parts.push_back({{"bone", boneBorder, denseBorder, bone.value_or(400), 0, 0}, colors.bone, 0.85});
    parts.push_back({{"dense bone", denseBorder, e.window.hi, dense.value_or(1200), 0, 0}, colors.dense, 0.92});
    // What is not there is part of what comes before it.
    for (std::size_t f = parts.size(); f-- > 1;) {
        const bool none = parts[f].feature.lo >= e.window.hi ||
                          extentsOf(e.survey, e.window, {rangeOf(parts[f])}).front().share < kLeastShare;
        if (!none) continue;
        parts[f - 1].feature.hi = std::min(parts[f].feature.hi, e.window.hi);
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(f));
    }
    for (Part& p : parts) {
        p.feature.lo = std::clamp(p.feature.lo, e.window.lo, e.window.hi);
        p.feature.hi = std::clamp(p.feature.hi, e.window.lo, e.window.hi);
        p.feature.mode = std::clamp(p.feature.mode, p.feature.lo, p.feature.hi);
    }
    if (parts.front().feature.lo > e.window.lo) result.background = ValueRange{e.window.lo, parts.front().feature.lo};
    result.why.emplace_back("CT in Hounsfield units: air about -1000 and tissue about 0");
    if (found) sayBackground(result, e, *found);
    std::string peaks;
    for (const auto& [text, mode] :
         {std::pair("fat", fat), {"soft tissue", soft}, {"bone", bone}, {"dense bone", dense}})
        if (mode) peaks += (peaks.empty() ? "" : ", ") + std::string(text) + " " + e.text(*mode);
    result.why.push_back(peaks.empty() ? "tissues by their usual densities"
                                       : "typical densities: " + peaks + " HU; borders half-way between them");
    finish(result, e, std::move(parts));
}

void proposeClasses(Proposal& result, const Evidence& e, const JobControl& job) {
    const std::optional<Background> background = findBackground(e);
    const ClassEvidence evidence = classEvidence(e, background, job);
    const ValueClasses found = findClasses(evidence, background ? std::optional(background->values) : std::nullopt);
    if (background) {
        result.background = ValueRange{e.value(found.backgroundLo), e.value(found.backgroundHi)};
        sayBackground(result, e, *background);
    } else {
        result.why.emplace_back("no background: no value is common on the volume's faces");
    }
    std::vector<Part> parts;
    const std::vector<Rgb> colors = classColors(static_cast<int>(found.classes.size()));
    for (std::size_t f = 0; f < found.classes.size(); ++f) {
        const ValueClass& c = found.classes[f];
        const double lo = e.value(c.lo), hi = e.value(c.hi);
        parts.push_back({{levelName(f, found.classes.size()), lo, hi, e.value(c.mode), 0, 0}, colors[f], 0});
    }
    const std::string count =
        std::to_string(parts.size()) + (parts.size() == 1 ? " class of intensity" : " classes of intensity");
    result.why.push_back(found.byPeaks
                             ? count +
                                   ", one per peak of the values away from boundaries (LH histogram), with borders "
                                   "half-way between peaks; " +
                                   percent(found.fit) + " of these values lie near a peak"
                             : count + " by multi-Otsu, which explains " + percent(found.fit) + " of the variance");
    finish(result, e, std::move(parts));
}

/// Whether renderers tell the values apart, whose tables hold a few thousand intensities.
bool canTellApart(const std::vector<double>& values, const ValueRange& window) {
    constexpr double kLeastGap = 1.0 / 1024; // of the window
    for (std::size_t v = 1; v < values.size(); ++v)
        if (values[v] - values[v - 1] < kLeastGap * (window.hi - window.lo)) return false;
    return true;
}

/// The window: what somebody has chosen, else a robust range; of CT from −1024 on, of labels from label to label, all
/// of them where their values can be told apart.
ValueRange windowFor(const Volume& data, const VoxelSurvey& survey, const RecognisedKind& kind, Proposal& result) {
    const ValueRange whole = data.dataRange();
    if (data.range() != whole) return data.range();
    if (kind.kind == DataKind::Binary || (kind.kind == DataKind::Labels && canTellApart(kind.values, whole)))
        return whole;
    const RobustRange robust = robustRange(valuesIn(survey.values, whole), whole);
    if (kind.kind == DataKind::Labels) {
        const std::vector<double> inside = valuesIn(kind.values, robust.range);
        return inside.size() < 2 ? whole : ValueRange{inside.front(), inside.back()};
    }
    ValueRange window = robust.range;
    if (kind.kind == DataKind::Ct) {
        constexpr double kLeastHounsfield = -1024, kAtLeastTo = 300;
        window.lo = std::max(window.lo, kLeastHounsfield);
        window.hi = std::max(window.hi, std::min(whole.hi, kAtLeastTo));
    } else if (kind.kind == DataKind::Signed) {
        const double end = std::max(std::abs(window.lo), std::abs(window.hi));
        window = {-end, end};
    } else if (robust.filler) {
        const double filler = *robust.filler;
        result.why.push_back(numberText(filler, std::abs(filler)) + " is far from all other values: a filler");
    }
    if (!(window.lo < window.hi)) window = whole;
    // A window's width is a number.
    return {std::max(window.lo, -kMostValue), std::min(window.hi, kMostValue)};
}

} // namespace

Proposal propose(const Volume& data, const JobControl& job) {
    VoxelSurvey survey = surveyVoxels(data, job);
    const RecognisedKind kind = recogniseKind(data, survey, job);
    if (kind.kind == DataKind::Empty || kind.kind == DataKind::Constant)
        return proposeUniform(data, std::move(survey), kind.kind);

    Proposal result;
    result.kind = kind.kind;
    result.unit = unitOf(kind.kind);
    result.window = windowFor(data, survey, kind, result);
    Evidence e{data, std::move(survey), result.window};
    std::size_t outside = 0, valid = 0;
    for (double& v : e.survey.values) {
        if (std::isnan(v)) continue;
        ++valid;
        outside += v < result.window.lo || v > result.window.hi;
        v = std::clamp(v, result.window.lo, result.window.hi);
    }
    result.outside = valid > 0 ? static_cast<double>(outside) / static_cast<double>(valid) : 0;
    const ValueRange whole = data.dataRange();
    if (result.window.lo > whole.lo || result.window.hi < whole.hi)
        result.why.push_back("range clipped to " + e.text(result.window.lo, result.window.hi) + " (" +
                             percent(result.outside) + " of voxels outside)");
    switch (kind.kind) {
    case DataKind::Labels:
    case DataKind::Binary:
        proposeValues(result, e, valuesIn(kind.values, e.window));
        break;
    case DataKind::Signed:
        proposeSigned(result, e, kind.sigma);
        break;
    case DataKind::Ct:
        proposeCt(result, e, job);
        break;
    default:
        proposeClasses(result, e, job);
    }
    return result;
}

} // namespace pellucid
