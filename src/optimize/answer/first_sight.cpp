#include "optimize/answer/first_sight.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace pellucid {

std::vector<double> importanceOf(const Proposal& proposal) {
    double common = 0, rare = 1, farthest = 0;
    for (const ProposedFeature& f : proposal.features) {
        common = std::max(common, f.share);
        rare = std::min(rare, std::max(f.share, 1e-6));
        farthest = std::max(farthest, std::abs(f.mode));
    }
    std::vector<double> importance;
    for (const ProposedFeature& f : proposal.features) {
        const double rarity =
            common > 1.5 * rare ? std::log(common / std::max(f.share, 1e-6)) / std::log(common / rare) : 0.5;
        if (proposal.kind == DataKind::Ct) // soft tissue in front of bone
            importance.push_back(f.mode < 150 ? 0.08 : f.mode < 700 ? 0.9 : 1);
        else if (proposal.kind == DataKind::Signed) // the more, the farther from 0
            importance.push_back(farthest > 0 ? std::abs(f.mode) / farthest : 0);
        else if (proposal.background)
            importance.push_back(0.5 * f.inside + 0.5 * rarity);
        else { // matter everywhere, where depth says nothing
            const double height = proposal.features.size() < 2 ? 0.5
                                                               : static_cast<double>(importance.size()) /
                                                                     static_cast<double>(proposal.features.size() - 1);
            importance.push_back(std::pow((height + rarity) / 2, 2));
        }
    }
    return importance;
}

std::vector<double> wantedCovers(const RayBundle& rays, const std::vector<double>& importance, bool everywhere) {
    const auto features = static_cast<int>(importance.size());
    constexpr double kOneAlpha = 0.8, kInnerAlpha = 0.95;
    const double outerAlpha = everywhere ? 0.2 : 0.55, outerWeight = everywhere ? 0.04 : 0.12;
    std::vector<double> wanted(importance.size(), 0.0);
    for (int r = 0; r < rays.rays(); ++r) {
        double deepest = 0, weights = 0;
        for (int f = 0; f < features; ++f)
            if (rays.meets(r, f)) {
                deepest = std::max(deepest, importance[static_cast<std::size_t>(f)]);
                weights += outerWeight + importance[static_cast<std::size_t>(f)];
            }
        const double alpha = features == 1 ? kOneAlpha : outerAlpha + (kInnerAlpha - outerAlpha) * deepest;
        for (int f = 0; f < features; ++f)
            if (rays.meets(r, f))
                wanted[static_cast<std::size_t>(f)] +=
                    alpha * (outerWeight + importance[static_cast<std::size_t>(f)]) / weights;
    }
    for (int f = 0; f < features; ++f) wanted[static_cast<std::size_t>(f)] /= std::max(1, rays.raysOf(f));
    return wanted;
}

namespace {

constexpr double kLeast = 1e-4, kMost = 0.98; // of a peak
constexpr double kUnimportant = 0.2;          // what a feature of no importance counts, to 1.2 of the most important

/// `tf` with other peaks. Where two features meet without a step it stays without one, at the lower of the two
/// opacities: withFeatureOpacities() alone would put one there.
TransferFunction withPeaks(const TransferFunction& tf, const std::vector<double>& peaks) {
    TransferFunction scaled = withFeatureOpacities(tf, peaks);
    for (std::size_t f = 0; f + 1 < tf.features.size(); ++f) {
        const double x = tf.features[f].b;
        if (tf.features[f + 1].a != x) continue;
        const auto pointsAt = [x](auto& points) {
            const auto begin = std::ranges::find_if(points, [x](const auto& p) { return p.x == x; });
            const auto end = std::find_if(begin, points.end(), [x](const auto& p) { return p.x != x; });
            return std::pair(begin, end);
        };
        const auto [first, end] = pointsAt(tf.points);
        if (first == end || first->opacity != std::prev(end)->opacity) continue;
        const auto [scaledFirst, scaledEnd] = pointsAt(scaled.points);
        const double opacity = std::min(scaledFirst->opacity, std::prev(scaledEnd)->opacity);
        std::vector<ControlPoint> joined(first, end);
        for (ControlPoint& p : joined) p.opacity = opacity;
        const auto at = scaled.points.erase(scaledFirst, scaledEnd);
        scaled.points.insert(at, joined.begin(), joined.end());
    }
    return scaled;
}

class Search {
public:
    Search(const RayBundle& rays, const TransferFunction& tf, const std::vector<double>& importance, bool everywhere,
           const JobControl& job)
        : m_rays(rays), m_tf(tf), m_importance(importance), m_wanted(wantedCovers(rays, importance, everywhere)),
          m_job(job), m_peaks(featureOpacities(tf)) {
        for (double& p : m_peaks) p = std::clamp(p, kLeast, kMost);
        consider({m_peaks});
    }

    std::vector<double> run() {
        constexpr int kRounds = 6;
        for (int round = 0; round < kRounds; ++round) {
            // Each feature by what it lacks, all by one factor, and each alone.
            std::vector<double> lacking(m_peaks.size(), 0.0);
            for (std::size_t f = 0; f < m_peaks.size(); ++f)
                if (m_wanted[f] > 0) lacking[f] = lack(m_appearance, f);
            along(lacking, {0.25, 0.5, 0.75, 1, 1.35, 1.8, 2.5, 4});
            const double step = std::pow(0.7, round);
            const std::vector<double> factors{-2 * step, -step,    -step / 2, -step / 4,
                                              step / 4,  step / 2, step,      2 * step};
            along(std::vector<double>(m_peaks.size(), 1.0), factors);
            for (std::size_t f = 0; f < m_peaks.size(); ++f) {
                std::vector<double> alone(m_peaks.size(), 0.0);
                alone[f] = 1;
                along(alone, factors);
            }
        }
        return m_peaks;
    }

    const std::vector<double>& wanted() const { return m_wanted; } ///< covers

private:
    /// ln of the wanted cover over that there is.
    double lack(const RayBundle::Appearance& a, std::size_t f) const {
        return std::log(m_wanted[f] / std::max(a.covers[f], 1e-5));
    }

    double objective(const RayBundle::Appearance& a) const {
        double sum = 0, weights = 0;
        std::size_t seen = 0;
        for (std::size_t f = 0; f < m_wanted.size(); ++f)
            if (m_wanted[f] > 0) {
                const double l = lack(a, f);
                const double weight = kUnimportant + m_importance[f];
                sum += weight * l * l;
                weights += weight;
                ++seen;
            }
        if (seen > 0) sum /= weights;
        const double oneSided = std::max(0.0, std::abs(a.translucent - 0.5) - 0.44);
        sum += 400 * oneSided * oneSided;
        if (seen > 1) {
            std::vector<double> shares = a.shares;
            std::nth_element(shares.begin(), shares.begin() + 1, shares.end(), std::greater<>());
            const double little = std::max(0.0, 0.15 - shares[1]);
            sum += 100 * little * little;
        }
        return sum;
    }

    /// Opacities as exponents: peaks times e^(factor·direction).
    void along(const std::vector<double>& direction, const std::vector<double>& factors) {
        m_job.throwIfStopped();
        std::vector<std::vector<double>> candidates;
        for (const double factor : factors) {
            std::vector<double> peaks = m_peaks;
            for (std::size_t f = 0; f < peaks.size(); ++f)
                peaks[f] = std::clamp(peaks[f] * std::exp(factor * direction[f]), kLeast, kMost);
            candidates.push_back(std::move(peaks));
        }
        consider(candidates);
    }

    void consider(const std::vector<std::vector<double>>& candidates) {
        std::vector<TransferFunction> tfs;
        for (const auto& peaks : candidates) tfs.push_back(withPeaks(m_tf, peaks));
        const std::vector<RayBundle::Appearance> all = m_rays.appearances(tfs);
        for (std::size_t i = 0; i < all.size(); ++i)
            if (const double value = objective(all[i]); value < m_best) {
                m_best = value;
                m_peaks = candidates[i];
                m_appearance = all[i];
            }
    }

    const RayBundle& m_rays;
    const TransferFunction& m_tf;
    const std::vector<double>& m_importance;
    const std::vector<double> m_wanted;
    const JobControl& m_job;
    std::vector<double> m_peaks;
    RayBundle::Appearance m_appearance;
    double m_best = std::numeric_limits<double>::infinity();
};

} // namespace

FirstSight withOpacitiesForView(const Volume& volume, const Proposal& proposal, const TransferFunction& tf,
                                const View& view, const JobControl& job) {
    if (tf.features.empty() || tf.features.size() != proposal.features.size()) return {tf, {}, {}};
    const RayBundle rays(volume, tf, view, 72, job);
    if (rays.rays() == 0) return {tf, {}, {}};
    const std::vector<double> importance = importanceOf(proposal);
    Search search(rays, tf, importance, !proposal.background, job);
    // A cover is a mean over the rays that meet the feature: a share is of all rays.
    std::vector<double> shares = search.wanted();
    double all = 0;
    for (std::size_t f = 0; f < shares.size(); ++f) all += shares[f] *= rays.raysOf(static_cast<int>(f));
    for (double& share : shares) share /= all;
    return {withPeaks(tf, search.run()), std::move(shares), {}};
}

} // namespace pellucid
