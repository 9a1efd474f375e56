#include "optimize/objective.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pellucid {

std::vector<double> normalizedTargets(std::vector<double> targets, std::size_t features) {
    if (features == 0)
        throw UsageError("the transfer function has no features", "optimize",
                         "give one with features, such as tents:3");
    if (targets.size() != features)
        throw UsageError(std::to_string(targets.size()) + " targets for " + std::to_string(features) + " features",
                         "targets", "give one number per feature");
    double sum = 0;
    for (const double t : targets) {
        if (!std::isfinite(t) || t < 0)
            throw UsageError("a target must be finite and not negative", "targets", "correct it");
        sum += t;
    }
    if (!(sum > 0) || !std::isfinite(sum))
        throw UsageError("all targets are 0", "targets", "give at least one above 0");
    for (double& t : targets) t /= sum;
    return targets;
}

bool isAimed(std::span<const double> targets) {
    return std::ranges::any_of(targets, [](double t) { return t > 0; });
}

double objectiveOf(std::span<const double> vws, std::span<const double> targets) {
    double sum = 0;
    for (std::size_t i = 0; i < vws.size(); ++i) sum += (vws[i] - targets[i]) * (vws[i] - targets[i]);
    return std::sqrt(sum / static_cast<double>(vws.size()));
}

EngineVws::EngineVws(VisibilityEngine& engine, const View& view, const TransferFunction& base,
                     const WeightFields& weights, const VwsOptions& options)
    : m_engine(engine), m_view(view), m_base(base), m_weights(weights), m_options(options) {}

std::vector<std::vector<double>> EngineVws::evaluate(std::span<const std::vector<double>> candidates,
                                                     const JobControl& job) const {
    std::vector<TransferFunction> tfs;
    tfs.reserve(candidates.size());
    for (const auto& x : candidates) tfs.push_back(withFeatureOpacities(m_base, x));
    std::vector<std::vector<double>> all;
    for (const FeatureSums& sums : m_engine.sums(m_view, tfs, &m_weights, job)) all.push_back(vwsOf(sums, m_options));
    return all;
}

VwsFunction::Linear EngineVws::jacobian(const std::vector<double>& x, const JobControl& job) const {
    const SumsJacobian jacobian = m_engine.jacobian(m_view, withFeatureOpacities(m_base, x), &m_weights, job);
    return {vwsOf(jacobian.sums, m_options), vwsJacobian(jacobian, m_options)};
}

} // namespace pellucid
