#include "tf/data_kind.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "base/byte_stream.h"
#include "base/parallel.h"
#include "volume/robust_range.h"
#include "volume/volume_part.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostValues = 64; // of labels

using Values = std::set<double>;

/// The valid values of voxels begin, begin + stride, … below end; more than kMostValues where there are more.
template <class T>
Values valuesOf(const T* samples, std::size_t begin, std::size_t end, std::size_t stride,
                std::optional<double> missing) {
    Values values;
    std::optional<T> last;
    for (std::size_t i = begin; i < end && values.size() <= kMostValues; i += stride) {
        if (last == samples[i]) continue;
        last = samples[i];
        const auto v = static_cast<double>(*last);
        if (std::isfinite(v) && v != missing) values.insert(v);
    }
    return values;
}

/// Those of any process.
Values ofAll(const VoxelsElsewhere& all, const Values& values) {
    const std::vector<double> mine(values.begin(), values.end());
    Values found;
    for (const auto& bytes : all.gather(std::as_bytes(std::span(mine))))
        for (ByteReader reader(bytes); !reader.atEnd();) found.insert(reader.take<double>());
    return found;
}

/// All values, where they are few; empty where they are more than kMostValues.
Values fewValues(const Volume& data, const VoxelSurvey& survey, const JobControl& job) {
    Values values;
    for (const double v : survey.values) {
        if (!std::isnan(v)) values.insert(v);
        if (values.size() > kMostValues) return {};
    }
    // The survey knows few: whether a rare one hid from it, all voxels tell.
    constexpr std::size_t kMostVoxels = std::size_t{1} << 26, kPieces = 64;
    const std::size_t stride = (data.size() + kMostVoxels - 1) / kMostVoxels;
    std::vector<Values> found(kPieces);
    const Volume* const part = partHere(data).volume;
    const auto look = [&](const auto& samples) {
        parallelFor(kPieces, [&](std::size_t p) {
            job.throwIfStopped();
            found[p] = valuesOf(samples.data(), part->size() * p / kPieces, part->size() * (p + 1) / kPieces, stride,
                                data.missing());
        });
    };
    if (part != nullptr) withSamples(*part, look);
    for (Values& piece : found) values.merge(piece);
    if (data.elsewhere() != nullptr) values = ofAll(*data.elsewhere(), values);
    return values.size() <= kMostValues ? values : Values{};
}

/// The valid ones, ascending.
std::vector<double> sortedValues(const VoxelSurvey& survey) {
    std::vector<double> sorted;
    for (const double v : survey.values)
        if (!std::isnan(v)) sorted.push_back(v);
    std::ranges::sort(sorted);
    return sorted;
}

/// Share of the voxels that equal all their neighbours, of those that are not of the most common value.
double flatShare(const VoxelSurvey& survey) {
    const std::vector<double> sorted = sortedValues(survey);
    const double common = sorted.empty() ? 0 : sorted[longestRun(sorted).begin];
    std::size_t others = 0, flat = 0;
    for (std::size_t i = 0; i < survey.size(); ++i) {
        if (std::isnan(survey.values[i]) || survey.values[i] == common) continue;
        ++others;
        flat += survey.gradients[i] == 0;
    }
    return others > 0 ? static_cast<double>(flat) / static_cast<double>(others) : 0;
}

bool areLabels(const Values& values, const VoxelSurvey& survey) {
    constexpr std::size_t kAlwaysLabels = 5; // so few whole numbers are no intensities
    constexpr double kFlat = 0.4;
    if (values.size() < 3 || !std::all_of(values.begin(), values.end(), [](double v) { return v == std::floor(v); }))
        return false;
    return values.size() <= kAlwaysLabels || flatShare(survey) >= kFlat;
}

double shareIn(const std::vector<double>& sorted, double lo, double hi) {
    const auto a = std::lower_bound(sorted.begin(), sorted.end(), lo);
    const auto b = std::upper_bound(sorted.begin(), sorted.end(), hi);
    return a < b ? static_cast<double>(b - a) / static_cast<double>(sorted.size()) : 0;
}

/// Air, tissue of about the density of water, and nothing that CT cannot hold.
bool isCt(const std::vector<double>& sorted) {
    constexpr double kLeastAir = 0.03, kLeastTissue = 0.03;
    if (quantile(sorted, 0.0005) < -3100 || quantile(sorted, 0.999) > 5000) return false;
    return shareIn(sorted, kAirHounsfield.lo, kAirHounsfield.hi) >= kLeastAir &&
           shareIn(sorted, -200, 200) >= kLeastTissue;
}

/// The spread about 0 where values of both signs lie around it, 0 where they do not.
double signedSpread(const std::vector<double>& sorted) {
    constexpr double kBalance = 5;   // how many times farther one side may reach
    constexpr double kCentred = 0.2; // the median's distance from 0, of the farther side
    std::vector<double> values;      // that say something: 0 fills what was masked
    for (const double v : sorted)
        if (v != 0) values.push_back(v);
    if (values.size() < 16) return 0;
    const double low = -quantile(values, 0.005), high = quantile(values, 0.995), median = quantile(values, 0.5);
    if (!(low > 0 && high > 0) || low > kBalance * high || high > kBalance * low) return 0;
    if (std::abs(median) > kCentred * std::max(low, high)) return 0;
    for (double& v : values) v = std::abs(v);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return 1.4826 * values[values.size() / 2];
}

} // namespace

const char* unitOf(DataKind kind) { return kind == DataKind::Ct ? "HU" : ""; }

RecognisedKind recogniseKind(const Volume& data, const VoxelSurvey& survey, const JobControl& job) {
    if (!data.hasValidVoxels()) return {DataKind::Empty, {}, 0};
    if (data.isConstant()) return {DataKind::Constant, {}, 0};
    const Values few = fewValues(data, survey, job);
    if (few.size() == 2) return {DataKind::Binary, {few.begin(), few.end()}, 0};
    if (areLabels(few, survey)) return {DataKind::Labels, {few.begin(), few.end()}, 0};
    const std::vector<double> sorted = sortedValues(survey);
    if (sorted.empty()) return {};
    if (isCt(sorted)) return {DataKind::Ct, {}, 0};
    if (const double sigma = signedSpread(sorted); sigma > 0) return {DataKind::Signed, {}, sigma};
    return {};
}

} // namespace pellucid
