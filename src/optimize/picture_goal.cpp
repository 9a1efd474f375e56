#include "optimize/picture_goal.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

constexpr double kNothing = 1e-7;  ///< of alpha: a logarithm has no place for 0
constexpr double kAim = 1.03;      ///< times the floor: what is aimed at is met within a few per cent
constexpr double kOfMost = 0.97;   ///< of what can be had, where that is below the floor: the rest needs opacities of 1
constexpr double kNearAsked = 0.8; ///< of a wanted coverage: nearer is not asked for
constexpr int kEvery = 5;          ///< ray, where some will do

double logRatio(double wanted, double have) { return std::log(wanted / std::max(have, kNothing)); }

} // namespace

PictureGoal::PictureGoal(const RayBundle& rays, const TransferFunction& base, const std::vector<double>& targets,
                         const std::vector<OpacityLimits>& limits, const std::vector<double>& start,
                         std::optional<double> coverage)
    : m_rays(rays), m_base(base) {
    const std::size_t n = targets.size();
    for (const double t : targets) m_wanted.push_back(t > 0);
    // Alpha grows with every opacity, so that all at their highest have the largest coverage; and a feature covers most
    // where it is alone.
    std::vector<double> least = start, most;
    for (std::size_t f = 0; f < n; ++f)
        if (!limits[f].locked) least[f] = limits[f].lowest;
    most = least;
    for (std::size_t f = 0; f < n; ++f)
        if (m_wanted[f] && !limits[f].locked) most[f] = limits[f].highest;
    std::vector<std::vector<double>> extremes{start, most};
    for (std::size_t f = 0; f < n; ++f) {
        extremes.push_back(least);
        extremes.back()[f] = most[f];
    }
    const std::vector<Coverage> looks = this->looks(extremes);
    const double largest = looks[1].coverage;
    // What somebody has asked to be faint may be so.
    if (coverage) m_asked = std::min(1.0, kNearAsked * *coverage / kFaintCoverage);
    m_leastCoverage = std::min(kFaintCoverage * m_asked, kOfMost * largest);
    for (std::size_t f = 0; f < n; ++f)
        m_leastCovers.push_back(m_wanted[f] ? std::min(kFaintCover * m_asked, kOfMost * looks[2 + f].covers[f]) : 0);
    m_coverage = coverage ? *coverage : std::clamp(looks[0].coverage, kFaintCoverage, kMostCoverage);
    m_coverage = std::min(m_coverage, largest);
}

std::vector<Coverage> PictureGoal::looks(const std::vector<std::vector<double>>& opacities, Rays rays) const {
    std::vector<TransferFunction> tfs;
    for (const auto& x : opacities) tfs.push_back(withFeatureOpacities(m_base, x));
    return coverageOf(m_rays, tfs, m_wanted, rays == Rays::All ? 1 : kEvery);
}

double PictureGoal::lack(const Coverage& look) const {
    double most = m_leastCoverage > kNothing ? logRatio(m_leastCoverage, look.coverage) : 0;
    for (std::size_t f = 0; f < m_leastCovers.size(); ++f)
        if (m_leastCovers[f] > kNothing) most = std::max(most, logRatio(m_leastCovers[f], look.covers[f]));
    return std::max(0.0, most);
}

std::vector<double> PictureGoal::shortfalls(const Coverage& look) const {
    std::vector<double> all;
    if (m_leastCoverage > kNothing) all.push_back(logRatio(kAim * m_leastCoverage, look.coverage));
    for (std::size_t f = 0; f < m_leastCovers.size(); ++f)
        if (m_leastCovers[f] > kNothing) all.push_back(logRatio(kAim * m_leastCovers[f], look.covers[f]));
    return all;
}

double PictureGoal::excess(const Coverage& look) const {
    return m_coverage > kNothing ? -logRatio(m_coverage, look.coverage) : 0;
}

double PictureGoal::miss(const Coverage& look) const { return std::abs(excess(look)); }

Seen PictureGoal::seen(const Coverage& look) const {
    const double part = m_asked * std::exp(-kShownLack);
    Seen seen{look, look.coverage < kFaintCoverage * part, {}, {}, {}};
    for (std::size_t f = 0; f < m_wanted.size(); ++f)
        if (m_wanted[f] && look.covers[f] < kFaintCover * part) seen.unseen.push_back(f);
    return seen;
}

} // namespace pellucid
