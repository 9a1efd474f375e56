#include "tf/proposal.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/parallel.h"
#include "base/round_numbers.h"
#include "tf/palette.h"
#include "tf/value_classes.h"
#include "volume/robust_range.h"
#include "volume/voxel_survey.h"

namespace pellucid {

namespace {

/// What all steps look at.
struct Evidence {
    const Volume& data;
    VoxelSurvey survey;
    std::vector<double> valid; ///< values of the valid voxels surveyed, data units
    ValueRange window;
    std::optional<double> filler;

    double span() const { return window.hi - window.lo; }
    double intensity(double value) const { return std::clamp((value - window.lo) / span(), 0.0, 1.0); }
    double value(double intensity) const { return window.lo + intensity * span(); }
    int bin(double value) const {
        return std::clamp(static_cast<int>(intensity(value) * kClassBins), 0, kClassBins - 1);
    }
    double valueOfBin(double bin) const { return value(bin / kClassBins); }
    std::string text(double value) const { return numberText(value, span()); }
};

std::string percent(double share) {
    if (share > 0 && share < 0.001) return "under 0.1 %";
    return numberText(100 * share, share < 0.0995 ? 10 : 1000) + " %";
}

// ---------------------------------------------------------------- kinds

constexpr std::size_t kMostLabels = 64;

/// The distinct values, if there are at most kMostLabels of them.
std::optional<std::vector<double>> fewValues(const Volume& data, const VoxelSurvey& survey) {
    std::set<double> values;
    for (const double v : survey.values) {
        if (!std::isnan(v)) values.insert(v);
        if (values.size() > kMostLabels) return {};
    }
    // The survey says few: a rare one may hide from it.
    constexpr std::size_t kMostVoxels = std::size_t{1} << 26;
    const std::size_t stride = (data.size() + kMostVoxels - 1) / kMostVoxels;
    double last = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < data.size(); i += stride) {
        const double v = data.value(i);
        if (v == last || !data.isValid(i)) continue;
        last = v;
        values.insert(v);
        if (values.size() > kMostLabels) return {};
    }
    return std::vector<double>(values.begin(), values.end());
}

} // namespace

const char* name(DataKind kind) {
    switch (kind) {
    case DataKind::Continuous:
        return "continuous";
    case DataKind::Ct:
        return "ct";
    case DataKind::Signed:
        return "signed";
    case DataKind::Labels:
        return "labels";
    case DataKind::Binary:
        return "binary";
    case DataKind::Constant:
        return "constant";
    case DataKind::Empty:
        break;
    }
    return "empty";
}

namespace {

/// The value of the volume's faces that is a peak of the whole, with its extent.
struct Background {
    double mode = 0;   ///< data units
    double lo = 0, hi = 0; ///< where its values end by themselves, noise included
    double faces = 0;  ///< share of the face voxels
    double share = 0;  ///< of all valid voxels
};

constexpr double kNear = 0.04; // of the window: as near to the mode as background lies
constexpr double kLeastOfFaces = 0.4, kLeastOfAll = 0.05;

std::optional<Background> findBackground(const Evidence& e) {
    std::vector<double> faces(kClassBins, 0), all(kClassBins, 0);
    std::vector<double> faceValues;
    for (std::size_t i = 0; i < e.survey.size(); ++i) {
        const double v = e.survey.values[i];
        if (std::isnan(v)) continue;
        ++all[static_cast<std::size_t>(e.bin(v))];
        if (e.survey.onFace(i)) {
            ++faces[static_cast<std::size_t>(e.bin(v))];
            faceValues.push_back(v);
        }
    }
    if (faceValues.empty()) return {};
    const std::vector<double> smooth = smoothed(faces, 2);
    const auto top = static_cast<int>(std::max_element(smooth.begin(), smooth.end()) - smooth.begin());
    Background b;
    b.mode = e.valueOfBin(top + 0.5);
    std::vector<double> near;
    for (const double v : faceValues)
        if (std::abs(e.intensity(v) - e.intensity(b.mode)) <= kNear) near.push_back(v);
    b.faces = static_cast<double>(near.size()) / static_cast<double>(faceValues.size());
    std::size_t count = 0;
    for (const double v : e.valid) count += std::abs(e.intensity(v) - e.intensity(b.mode)) <= kNear;
    b.share = static_cast<double>(count) / static_cast<double>(e.valid.size());
    if (b.faces < kLeastOfFaces || b.share < kLeastOfAll) return {};
    std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2), near.end());
    b.mode = near[near.size() / 2];
    std::vector<double> deviation;
    for (const double v : near) deviation.push_back(std::abs(v - b.mode));
    std::nth_element(deviation.begin(), deviation.begin() + static_cast<std::ptrdiff_t>(near.size() / 2),
                     deviation.end());
    const double sigma = 1.4826 * deviation[near.size() / 2];
    b.lo = b.mode - 4 * sigma;
    b.hi = b.mode + 4 * sigma;
    return b;
}

/// Share, depth and mean path of each feature, from the survey.
struct Extent {
    double share = 0, depth = 0, path = 1;
};

std::vector<Extent> extentsOf(const Evidence& e, const std::vector<ProposedFeature>& features) {
    const Int3 d = e.survey.dims;
    const std::size_t n = e.survey.size(), classes = features.size();
    std::vector<int> of(n, -1);
    for (std::size_t i = 0; i < n; ++i) {
        const double v = e.survey.values[i];
        if (std::isnan(v)) continue;
        const double c = std::clamp(v, e.window.lo, e.window.hi);
        for (std::size_t f = 0; f < classes; ++f)
            if (c >= features[f].lo && (c < features[f].hi || (features[f].hi >= e.window.hi && c <= features[f].hi)))
                of[i] = static_cast<int>(f);
    }
    // Steps to the outside, by two passes over the six neighbours.
    std::vector<float> depth(n, 0);
    const auto nx = static_cast<std::size_t>(d.x), nxy = nx * static_cast<std::size_t>(d.y);
    const auto visit = [&](auto&& body, bool forward) {
        for (std::size_t s = 0; s < n; ++s) {
            const std::size_t i = forward ? s : n - 1 - s;
            const auto x = static_cast<int>(i % nx), y = static_cast<int>(i % nxy / nx), z = static_cast<int>(i / nxy);
            body(i, x, y, z);
        }
    };
    constexpr float kFar = 1e9f;
    for (std::size_t i = 0; i < n; ++i) depth[i] = of[i] >= 0 ? kFar : 0;
    const Vec3 path = e.survey.pathPerCell;
    visit(
        [&](std::size_t i, int x, int y, int z) {
            if (of[i] < 0) return;
            const auto from = [&](bool edge, int a, std::size_t back) {
                depth[i] = std::min(depth[i], (edge ? 0 : depth[i - back]) + static_cast<float>(path[a]));
            };
            if (d.x > 1) from(x == 0, 0, 1);
            if (d.y > 1) from(y == 0, 1, nx);
            if (d.z > 1) from(z == 0, 2, nxy);
        },
        true);
    visit(
        [&](std::size_t i, int x, int y, int z) {
            if (of[i] < 0) return;
            const auto from = [&](bool edge, int a, std::size_t forth) {
                depth[i] = std::min(depth[i], (edge ? 0 : depth[i + forth]) + static_cast<float>(path[a]));
            };
            if (d.x > 1) from(x == d.x - 1, 0, 1);
            if (d.y > 1) from(y == d.y - 1, 1, nx);
            if (d.z > 1) from(z == d.z - 1, 2, nxy);
        },
        false);

    std::vector<Extent> extents(classes);
    std::vector<double> cells(classes, 0), depths(classes, 0);
    for (std::size_t i = 0; i < n; ++i)
        if (of[i] >= 0) {
            cells[static_cast<std::size_t>(of[i])] += 1;
            depths[static_cast<std::size_t>(of[i])] += std::min(depth[i], kFar / 2);
        }
    // Mean length of the paths along the axes that meet the class at all.
    std::vector<double> lengths(classes, 0), columns(classes, 0);
    const std::size_t strides[3] = {1, nx, nxy};
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        for (int j = 0; j < d[c]; ++j)
            for (int i = 0; i < d[b]; ++i) {
                std::vector<double> met(classes, 0);
                std::size_t at = static_cast<std::size_t>(i) * strides[b] + static_cast<std::size_t>(j) * strides[c];
                for (int k = 0; k < d[a]; ++k, at += strides[a])
                    if (of[at] >= 0) met[static_cast<std::size_t>(of[at])] += path[a];
                for (std::size_t f = 0; f < classes; ++f)
                    if (met[f] > 0) lengths[f] += met[f], columns[f] += 1;
            }
    }
    for (std::size_t f = 0; f < classes; ++f) {
        extents[f].share = cells[f] / static_cast<double>(std::max<std::size_t>(1, e.valid.size()));
        extents[f].depth = cells[f] > 0 ? depths[f] / cells[f] : 0;
        extents[f].path = columns[f] > 0 ? std::max(1.0, lengths[f] / columns[f]) : 1.0;
    }
    return extents;
}

} // namespace

namespace {

/// How much of the light that comes through should end in a feature.
double coverOf(double inside, double rarity, std::size_t count) {
    if (count == 1) return 0.75;
    return 0.25 + 0.65 * (0.6 * inside + 0.4 * rarity);
}

std::vector<double> firstOpacities(const std::vector<Extent>& extents, std::vector<ProposedFeature>& features) {
    double shallow = 1e300, deep = 0, common = 0, rare = 1;
    for (const Extent& x : extents) {
        shallow = std::min(shallow, x.depth);
        deep = std::max(deep, x.depth);
        common = std::max(common, x.share);
        rare = std::min(rare, std::max(x.share, 1e-6));
    }
    std::vector<double> opacities;
    for (std::size_t f = 0; f < extents.size(); ++f) {
        const Extent& x = extents[f];
        features[f].share = x.share;
        features[f].inside = deep > shallow ? (x.depth - shallow) / (deep - shallow) : 0;
        const double rarity =
            common > rare ? std::log(common / std::max(x.share, 1e-6)) / std::log(common / rare) : 0;
        const double cover = coverOf(features[f].inside, rarity, extents.size());
        opacities.push_back(std::clamp(1 - std::pow(1 - cover, 1 / x.path), 0.001, 0.95));
    }
    return opacities;
}

/// Trapezoids from border to border: where two features meet, the opacity is the lower of the two, so that neither
/// rises beyond its own and nothing between them is empty.
TransferFunction trapezoids(const Evidence& e, const std::vector<ProposedFeature>& features,
                            const std::vector<double>& opacities, const std::vector<Rgb>& colors) {
    TransferFunction tf;
    tf.range = e.window;
    const auto add = [&](double x, double opacity, const Rgb& color) {
        x = std::clamp(x, tf.points.empty() ? 0.0 : tf.points.back().x, 1.0);
        tf.points.push_back({x, opacity, color, false, {}});
    };
    const auto intensity = [&](double value) { return e.intensity(value); };
    for (std::size_t f = 0; f < features.size(); ++f) {
        const ProposedFeature& p = features[f];
        const double a = intensity(p.lo), b = intensity(p.hi), m = std::clamp(intensity(p.mode), a, b);
        const bool meetsBefore = f > 0 && features[f - 1].hi == p.lo;
        const bool meetsAfter = f + 1 < features.size() && features[f + 1].lo == p.hi;
        const double before = meetsBefore ? std::min(opacities[f - 1], opacities[f]) : a <= 0 ? opacities[f] : 0;
        const double after = meetsAfter ? std::min(opacities[f], opacities[f + 1]) : b >= 1 ? opacities[f] : 0;
        add(a, before, colors[f]);
        if (before < opacities[f]) add(a + 0.5 * (m - a), opacities[f], colors[f]);
        if (after < opacities[f]) add(b - 0.5 * (b - m), opacities[f], colors[f]);
        if (!meetsAfter || after == opacities[f]) add(b, after, colors[f]);
        tf.features.push_back({p.name, a, b, colors[f], {}});
    }
    return tf;
}

} // namespace

Proposal propose(const Volume& data, const JobControl& job) {
    Proposal result;
    Evidence e{data, surveyVoxels(data, job), {}, data.range(), {}};
    for (const double v : e.survey.values)
        if (!std::isnan(v)) e.valid.push_back(v);
    const ValueRange whole = data.dataRange();
    if (!data.hasValidVoxels() || !(whole.lo < whole.hi) || e.valid.empty()) {
        result.kind = data.hasValidVoxels() ? DataKind::Constant : DataKind::Empty;
        const double half = std::max(0.5, std::abs(whole.lo) * 1e-3);
        e.window = result.window = {whole.lo - half, whole.lo + half};
        const std::string what = data.hasValidVoxels() ? numberText(whole.lo, std::abs(whole.lo)) : "no values";
        result.features = {{what, e.window.lo, e.window.hi, whole.lo, 1, 0}};
        const auto opacities = firstOpacities(extentsOf(e, result.features), result.features);
        const Rgb color = classColors(1).front();
        result.tf.range = result.window;
        result.tf.points = {{0, opacities[0], color, false, {}}, {1, opacities[0], color, false, {}}};
        result.tf.features = {{what, 0, 1, color, {}}};
        result.why = {data.hasValidVoxels() ? "every voxel has the value " + what : "no voxel has a valid value"};
        return result;
    }
    if (data.range() == whole) {
        const RobustRange robust = robustRange(e.valid, whole);
        e.window = robust.range;
        e.filler = robust.filler;
    }
    result.window = e.window;
    result.kind = DataKind::Continuous;

    const std::optional<Background> background = findBackground(e);
    std::vector<double> counts(kClassBins, 0);
    int begin = 0, end = kClassBins;
    if (background) begin = std::min(e.bin(background->hi) + 1, kClassBins - 1);
    for (const double v : e.valid)
        if (e.bin(v) >= begin) ++counts[static_cast<std::size_t>(e.bin(v))];
    double explained = 0;
    std::vector<int> borders;
    for (int k = 2; k <= 4 && explained < 0.9; ++k) borders = multiOtsu(counts, begin, end, k, explained);
    borders.insert(borders.begin(), begin);
    borders.push_back(end);
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
        const double lo = k == 0 && !background ? e.window.lo : e.valueOfBin(borders[k]);
        const double hi = borders[k + 1] == kClassBins ? e.window.hi : e.valueOfBin(borders[k + 1]);
        result.features.push_back({e.text(lo) + " to " + e.text(hi), lo, hi, (lo + hi) / 2, 0, 0});
    }
    if (background) {
        result.background = ValueRange{e.window.lo, result.features.front().lo};
        result.why.push_back("background about " + e.text(background->mode) + ": " + percent(background->faces) +
                             " of the faces of the volume, " + percent(background->share) + " of its voxels");
    }
    const auto opacities = firstOpacities(extentsOf(e, result.features), result.features);
    result.tf = trapezoids(e, result.features, opacities, classColors(static_cast<int>(result.features.size())));
    std::size_t outside = 0;
    for (const double v : e.valid) outside += v < e.window.lo || v > e.window.hi;
    result.outside = static_cast<double>(outside) / static_cast<double>(e.valid.size());
    (void)fewValues;
    return result;
}

} // namespace pellucid
