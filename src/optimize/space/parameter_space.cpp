#include "optimize/space/parameter_space.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "base/check.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/round_numbers.h"

namespace pellucid {

namespace {

constexpr int kPerSweep = 8; ///< candidates that one sweep of an engine carries

constexpr double kVoxelsInAWhile = 3e9; ///< voxels times sweeps that two cores do in about ten seconds

} // namespace

void ParameterAxes::validate(std::size_t featureCount) const {
    const char* const where = "parameter space";
    if (features.size() != 2 && features.size() != 3)
        throw UsageError(std::to_string(features.size()) + " features cannot be its axes", where,
                         "choose two or three");
    for (const std::size_t f : features)
        if (f >= featureCount) throw UsageError("there is no feature " + std::to_string(f + 1), where, "choose others");
    if (std::set<std::size_t>(features.begin(), features.end()).size() != features.size())
        throw UsageError("a feature is chosen for two axes", where, "choose different ones");
    if (samples < 2 || samples > kMostAxisSamples)
        throw UsageError(std::to_string(samples) + " samples along an axis", where,
                         "give a number from 2 to " + std::to_string(kMostAxisSamples));
    if (!(lowest >= 1e-6 && lowest <= 0.5))
        throw UsageError("the lowest opacity is not between 1e-6 and 0.5", where, "correct it");
}

double ParameterAxes::opacityAt(double position) const {
    if (scale == AxisScale::Linear || position >= 1) return position;
    return std::pow(lowest, 1 - position);
}

double ParameterAxes::positionOf(double opacity) const {
    if (scale == AxisScale::Linear) return std::clamp(opacity, 0.0, 1.0);
    if (!(opacity > lowest)) return 0;
    return std::clamp(1 - std::log(opacity) / std::log(lowest), 0.0, 1.0);
}

int ParameterAxes::sampleCount() const {
    return features.size() == 2 ? samples * samples : samples * samples * samples;
}

int ParameterAxes::sweepCount() const { return (sampleCount() + kPerSweep - 1) / kPerSweep; }

std::vector<ParameterAxes::Tick> ParameterAxes::ticks(int wanted) const {
    std::vector<Tick> all;
    if (scale == AxisScale::Linear) {
        for (const double opacity : axisTicks(0, 1, wanted)) all.push_back({opacity, numberText(opacity, 1)});
        return all;
    }
    // Powers of ten, and the axis' end where it is none.
    const int first = static_cast<int>(std::ceil(std::log10(lowest) - 1e-9));
    if (std::abs(std::pow(10, first) / lowest - 1) > 1e-6) all.push_back({0, numberText(lowest, lowest)});
    for (int power = first; power <= 0; ++power) {
        const double opacity = std::pow(10, power);
        all.push_back({positionOf(opacity), numberText(opacity, opacity)});
    }
    return all;
}

const std::vector<double>& ParameterSpace::values(int shown) const {
    return shown == kObjective ? objective : vws.at(static_cast<std::size_t>(shown));
}

ValueRange ParameterSpace::range(int shown) const {
    const auto [least, most] = std::ranges::minmax_element(values(shown));
    return {*least, *most};
}

double ParameterSpace::valueAt(int shown, const Vec3& position) const {
    const std::vector<double>& all = values(shown);
    const Int3 n = dims();
    Int3 low{0, 0, 0};
    Vec3 way{0, 0, 0};
    for (int a = 0; a < 3; ++a) {
        const double at = std::clamp(position[a], 0.0, 1.0) * (n[a] - 1);
        low[a] = std::min(static_cast<int>(at), std::max(0, n[a] - 2));
        way[a] = at - low[a];
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double share = 1;
        std::size_t index = 0;
        for (int a = 2; a >= 0; --a) {
            const bool high = (corner >> a & 1) != 0;
            share *= high ? way[a] : 1 - way[a];
            index = index * static_cast<std::size_t>(n[a]) + static_cast<std::size_t>(low[a] + (high ? 1 : 0));
        }
        if (share > 0) sum += share * all[index];
    }
    return sum;
}

Vec3 ParameterSpace::positionOfSample(std::size_t sample) const {
    const auto n = static_cast<std::size_t>(axes.samples);
    const auto at = [&](std::size_t i) { return axes.positionOfSample(static_cast<int>(i)); };
    return {at(sample % n), at(sample / n % n), isFlat() ? 0 : at(sample / (n * n))};
}

Vec3 ParameterSpace::positionOf(const std::vector<double>& opacities) const {
    Vec3 position{0, 0, 0};
    for (std::size_t a = 0; a < axes.features.size(); ++a)
        position[static_cast<int>(a)] = axes.positionOf(opacities.at(axes.features[a]));
    return position;
}

std::vector<double> ParameterSpace::opacitiesAt(const Vec3& position) const {
    std::vector<double> x = base;
    for (std::size_t a = 0; a < axes.features.size(); ++a)
        x[axes.features[a]] = axes.opacityAt(position[static_cast<int>(a)]);
    return x;
}

Geometry ParameterSpace::geometry() const {
    Geometry g;
    g.dims = dims();
    g.spacing = Vec3(1.0 / (axes.samples - 1));
    return g;
}

std::vector<std::size_t> defaultAxes(const TransferFunction& tf, const std::vector<double>& targets) {
    PELLUCID_CHECK(targets.size() == tf.features.size());
    std::vector<std::size_t> shown;
    for (std::size_t f = 0; f < tf.features.size(); ++f)
        if (!tf.features[f].hidden) shown.push_back(f);
    if (shown.size() < 2)
        throw UsageError("a parameter space has two features or three, and " + std::to_string(shown.size()) +
                             (shown.size() == 1 ? " is shown" : " are shown"),
                         "parameter space", "give a transfer function with more, such as tents:3");
    std::ranges::stable_sort(shown, std::greater{}, [&](std::size_t f) { return targets[f]; });
    shown.resize(std::min<std::size_t>(3, shown.size()));
    std::ranges::sort(shown);
    return shown;
}

ParameterSpace sampleParameterSpace(const VwsFunction& function, const std::vector<double>& targets,
                                    const ParameterAxes& axes, const JobControl& job) {
    axes.validate(function.featureCount());
    ParameterSpace space;
    space.axes = axes;
    space.base = featureOpacities(function.base());
    const auto count = static_cast<std::size_t>(axes.sampleCount());
    space.vws.assign(function.featureCount(), std::vector<double>(count));
    std::vector<std::vector<double>> candidates;
    for (std::size_t first = 0; first < count; first += kPerSweep) {
        job.throwIfStopped();
        candidates.clear();
        for (std::size_t s = first; s < std::min(count, first + kPerSweep); ++s)
            candidates.push_back(space.opacitiesAt(space.positionOfSample(s)));
        const auto all = function.evaluate(candidates, {job.stop, {}});
        for (std::size_t c = 0; c < all.size(); ++c)
            for (std::size_t f = 0; f < all[c].size(); ++f) space.vws[f][first + c] = all[c][f];
        job.report(static_cast<double>(first + candidates.size()) / static_cast<double>(count));
    }
    space.evaluations = static_cast<int>(count);
    return withTargets(std::move(space), targets);
}

ParameterSpace withTargets(ParameterSpace space, const std::vector<double>& targets) {
    space.targets = normalizedTargets(targets, space.vws.size());
    space.objective.resize(space.vws.front().size());
    std::vector<double> w(space.vws.size());
    for (std::size_t s = 0; s < space.objective.size(); ++s) {
        for (std::size_t f = 0; f < w.size(); ++f) w[f] = space.vws[f][s];
        space.objective[s] = objectiveOf(w, space.targets);
    }
    space.best = static_cast<std::size_t>(std::ranges::min_element(space.objective) - space.objective.begin());
    return space;
}

int reductionFor(std::size_t voxels, const ParameterAxes& axes) {
    const double work = static_cast<double>(voxels) * axes.sweepCount() / kVoxelsInAWhile;
    return std::clamp(static_cast<int>(std::ceil(std::cbrt(work) - 1e-9)), 1, 8);
}

std::string csvOf(const ParameterSpace& space, const std::vector<std::string>& featureNames) {
    CsvTable csv;
    for (const std::size_t f : space.axes.features) csv << "opacity " + featureNames.at(f);
    for (const std::string& feature : featureNames) csv << "W " + feature;
    csv << "F";
    csv.endLine();
    for (std::size_t s = 0; s < space.objective.size(); ++s) {
        const Vec3 at = space.positionOfSample(s);
        for (std::size_t a = 0; a < space.axes.features.size(); ++a)
            csv << space.axes.opacityAt(at[static_cast<int>(a)]);
        for (const auto& w : space.vws) csv << w[s];
        csv << space.objective[s];
        csv.endLine();
    }
    return csv.text();
}

} // namespace pellucid
