#include "optimize/time/smoothing.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "optimize/solve/log_depths.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr double kLeastOpacity = 1e-7; ///< a logarithm has no place for 0
constexpr double kReach = 1;           ///< of ln τ: models are not good for more
constexpr double kSafety = 0.99;       ///< of the wanted distance that is aimed at: models are not exact
constexpr int kRounds = 40;            ///< of reweighting
constexpr double kSharper = 0.75;      ///< from round to round, of the jump that counts as none
constexpr double kSmallStep = 0.05;    ///< of ln τ: the usual jump is at least what that makes
constexpr double kNoJump = 1e-3;       ///< of the usual jump: what counts as none in the end
constexpr double kTrace = 3e-3;        ///< likewise: what is taken away then
constexpr double kHeld = 1e8;          ///< of the largest entry: what holds an unknown at its bound
constexpr double kDensityWeight = 1e3; ///< of the first frame's change of density, in ΔE², against jumps
constexpr double kLeastWeight = 1e-3, kMostWeight = 1e9; ///< of F², against jumps
constexpr int kBisections = 24;

/// A symmetric, positive definite matrix with zeros farther than `width` from the diagonal.
class BandMatrix {
public:
    BandMatrix(std::size_t size, std::size_t width) : m_size(size), m_stride(width + 1), m_rows(size * m_stride, 0.0) {}

    /// row ≥ column ≥ row − width
    double& at(std::size_t row, std::size_t column) { return m_rows[row * m_stride + (column + m_stride - 1 - row)]; }

    /// The x with A x = b, by Cholesky's method; leaves its factor here.
    Numbers solve(Numbers b) {
        const std::size_t width = m_stride - 1;
        for (std::size_t i = 0; i < m_size; ++i) {
            const std::size_t first = i > width ? i - width : 0;
            for (std::size_t j = first; j <= i; ++j) {
                double sum = at(i, j);
                for (std::size_t k = std::max(first, j > width ? j - width : 0); k < j; ++k) sum -= at(i, k) * at(j, k);
                at(i, j) = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / at(j, j);
            }
            for (std::size_t k = first; k < i; ++k) b[i] -= at(i, k) * b[k];
            b[i] /= at(i, i);
        }
        for (std::size_t i = m_size; i-- > 0;) {
            b[i] /= at(i, i);
            for (std::size_t k = i > width ? i - width : 0; k < i; ++k) b[k] -= at(i, k) * b[i];
        }
        return b;
    }

private:
    std::size_t m_size, m_stride;
    std::vector<double> m_rows; // of each row what lies left of the diagonal, and it
};

/// Unknowns: the changes d of ln τ of all features in all frames, frame by frame. The sum of jumps is minimised by
/// weighted squares, each weighed by what its own jump was (iteratively reweighted least squares).
class Smoother {
public:
    Smoother(const std::vector<FrameModel>& frames, const JobControl& job)
        : m_frames(frames), m_job(job), m_features(frames.front().opacity.size()),
          m_lowest(frames.size() * m_features, 0.0), m_highest(m_lowest), m_depth(m_lowest) {
        for (std::size_t t = 0; t < frames.size(); ++t) addFrame(t);
        if (m_counted > 0) m_wanted = kSafety * std::sqrt(m_wanted / static_cast<double>(m_counted));
        double way = 0, square = 0;
        for (std::size_t t = 1; t < frames.size(); ++t) {
            way += jump(m_depth, t);
            for (std::size_t f = 0; f < m_features; ++f) square += m_metric[t][f][f];
        }
        const double jumps = static_cast<double>(std::max<std::size_t>(1, frames.size() - 1));
        m_isStill = way == 0;
        m_usualJump = std::max(way / jumps, kSmallStep * std::sqrt(square / jumps));
        if (!frames.front().stays) findDensity();
    }

    std::vector<std::vector<double>> run() {
        const Numbers none(m_depth.size(), 0.0);
        if (m_counted == 0 || (m_isStill && distance(none) <= m_wanted)) return opacities(none);
        double lo = std::log10(kLeastWeight), hi = std::log10(kMostWeight); // distance falls with weight
        Numbers best = minimum(kLeastWeight);
        if (distance(best) <= m_wanted) return opacities(withoutTraces(best));
        best = minimum(kMostWeight);
        for (int i = 0; i < kBisections && distance(best) <= m_wanted; ++i) {
            const double middle = (lo + hi) / 2;
            const Numbers d = minimum(std::pow(10, middle));
            if (distance(d) <= m_wanted) {
                hi = middle;
                best = d;
            } else {
                lo = middle;
            }
        }
        return opacities(withoutTraces(best));
    }

private:
    std::size_t at(std::size_t frame, std::size_t feature) const { return frame * m_features + feature; }

    void addFrame(std::size_t t) {
        const FrameModel& frame = m_frames[t];
        if (frame.opacity.size() != m_features)
            throw UsageError("frames have " + std::to_string(m_features) + " and " +
                                 std::to_string(frame.opacity.size()) + " features",
                             "frames", "give all the same features");
        Rows& slope = m_slope.emplace_back(frame.derivative);
        for (std::size_t f = 0; f < m_features; ++f) {
            const double x = std::clamp(frame.opacity[f], kLeastOpacity, kMaxOpacity), y = logDepthOf(x);
            m_depth[at(t, f)] = y;
            for (Numbers& row : slope) row[f] *= (1 - x) * opticalDepthOfOpacity(x); // ∂x/∂y
            if (frame.stays || frame.targets[f] <= 0 || frame.opacity[f] <= 0) continue;
            const OpacityLimits& limit = frame.limits[f];
            if (limit.locked || limit.lowest >= limit.highest) continue;
            m_lowest[at(t, f)] = std::clamp(logDepthOf(std::max(limit.lowest, kLeastOpacity)) - y, -kReach, 0.0);
            m_highest[at(t, f)] = std::clamp(logDepthOf(std::max(limit.highest, kLeastOpacity)) - y, 0.0, kReach);
        }
        Rows& metric = m_metric.emplace_back(frame.metric);
        if (metric.empty()) {
            metric.assign(m_features, Numbers(m_features, 0.0));
            for (std::size_t f = 0; f < m_features; ++f) metric[f][f] = 1.0 / static_cast<double>(m_features);
        }
        if (frame.stays) return;
        ++m_counted;
        m_wanted += frame.distance * frame.distance;
    }

    double jump(const Numbers& y, std::size_t t) const {
        double square = 0;
        for (std::size_t i = 0; i < m_features; ++i)
            for (std::size_t j = 0; j < m_features; ++j)
                square += (y[at(t, i)] - y[at(t - 1, i)]) * m_metric[t][i][j] * (y[at(t, j)] - y[at(t - 1, j)]);
        return std::sqrt(std::max(0.0, square));
    }

    /// The direction in the first frame along which its shares stay, as what it does to the picture.
    void findDensity() {
        const Rows& j = m_slope.front();
        Rows normal(m_features, Numbers(m_features, 0.0));
        double trace = 0;
        for (std::size_t a = 0; a < m_features; ++a) {
            for (std::size_t b = 0; b < m_features; ++b)
                for (const Numbers& row : j) normal[a][b] += row[a] * row[b];
            trace += normal[a][a];
        }
        for (std::size_t a = 0; a < m_features; ++a) normal[a][a] += 1e-9 * trace + 1e-300;
        Numbers along(m_features, 1.0);
        for (int round = 0; round < 8; ++round) { // inverse iteration
            BandMatrix matrix(m_features, m_features);
            for (std::size_t a = 0; a < m_features; ++a)
                for (std::size_t b = 0; b <= a; ++b) matrix.at(a, b) = normal[a][b];
            along = matrix.solve(along);
            const double most = largestOf(along);
            for (double& x : along) x /= most;
        }
        m_density.assign(m_features, 0.0);
        double square = 0;
        for (std::size_t a = 0; a < m_features; ++a) {
            for (std::size_t b = 0; b < m_features; ++b) m_density[a] += m_metric.front()[a][b] * along[b];
            square += m_density[a] * along[a];
        }
        for (double& x : m_density) x /= std::sqrt(std::max(square, 1e-300));
    }

    /// The root mean square of F in the model.
    double distance(const Numbers& d) const {
        double sum = 0;
        for (std::size_t t = 0; t < m_frames.size(); ++t) {
            const FrameModel& frame = m_frames[t];
            if (frame.stays) continue;
            for (std::size_t i = 0; i < m_features; ++i) {
                double r = frame.vws[i] - frame.targets[i];
                for (std::size_t f = 0; f < m_features; ++f) r += m_slope[t][i][f] * d[at(t, f)];
                sum += r * r / static_cast<double>(m_features);
            }
        }
        return std::sqrt(sum / static_cast<double>(m_counted));
    }

    /// The d that minimises the jumps and weight/2 times the sum of F².
    Numbers minimum(double weight) const {
        Numbers d(m_depth.size(), 0.0), y = m_depth;
        std::vector<int> held(d.size(), 0); // −1, 1: at the lower, upper bound
        double none = m_usualJump;
        for (int round = 0; round < kRounds; ++round) {
            m_job.throwIfStopped();
            d = weightedMinimum(weight, none, y, held);
            for (std::size_t u = 0; u < d.size(); ++u) {
                held[u] = d[u] > m_highest[u] ? 1 : d[u] < m_lowest[u] ? -1 : 0; // else free, from the next round on
                d[u] = std::clamp(d[u], m_lowest[u], m_highest[u]);
                y[u] = m_depth[u] + d[u];
            }
            none = std::max(kNoJump * m_usualJump, kSharper * none);
        }
        return d;
    }

    /// Jumps are weighed by what they are at y.
    Numbers weightedMinimum(double weight, double none, const Numbers& y, const std::vector<int>& held) const {
        const std::size_t n = m_features, size = y.size();
        BandMatrix a(size, 2 * n - 1);
        Numbers b(size, 0.0);
        for (std::size_t t = 0; t < m_frames.size(); ++t) {
            const FrameModel& frame = m_frames[t];
            if (!frame.stays)
                for (std::size_t i = 0; i < n; ++i)
                    for (std::size_t p = 0; p < n; ++p) {
                        const double slope = weight * m_slope[t][i][p] / static_cast<double>(n);
                        b[at(t, p)] -= slope * (frame.vws[i] - frame.targets[i]);
                        for (std::size_t q = 0; q <= p; ++q) a.at(at(t, p), at(t, q)) += slope * m_slope[t][i][q];
                    }
            if (t == 0) continue;
            const double w = 1 / std::hypot(jump(y, t), none);
            for (std::size_t p = 0; p < n; ++p)
                for (std::size_t q = 0; q < n; ++q) {
                    const double g = w * m_metric[t][p][q];
                    const double v = m_depth[at(t, q)] - m_depth[at(t - 1, q)];
                    b[at(t, p)] -= g * v;
                    b[at(t - 1, p)] += g * v;
                    a.at(at(t, p), at(t - 1, q)) -= g;
                    if (q > p) continue;
                    a.at(at(t, p), at(t, q)) += g;
                    a.at(at(t - 1, p), at(t - 1, q)) += g;
                }
        }
        for (std::size_t p = 0; p < m_density.size(); ++p)
            for (std::size_t q = 0; q <= p; ++q) a.at(p, q) += kDensityWeight * m_density[p] * m_density[q];
        double most = 0;
        for (std::size_t u = 0; u < size; ++u) most = std::max(most, a.at(u, u));
        for (std::size_t u = 0; u < size; ++u) {
            a.at(u, u) += 1e-12 * most; // what neither is seen nor counts stays
            if (held[u] == 0 && m_lowest[u] < m_highest[u]) continue;
            a.at(u, u) += kHeld * most;
            b[u] += kHeld * most * (held[u] > 0 ? m_highest[u] : m_lowest[u]);
        }
        return a.solve(std::move(b));
    }

    /// What is left of a jump that there is no reason for is none.
    Numbers withoutTraces(Numbers d) const {
        Numbers y = m_depth;
        for (std::size_t u = 0; u < d.size(); ++u) y[u] += d[u];
        for (std::size_t t = 1; t < m_frames.size(); ++t) {
            if (jump(y, t) > kTrace * m_usualJump) continue;
            for (std::size_t f = 0; f < m_features; ++f) {
                const std::size_t u = at(t, f);
                d[u] = std::clamp(y[at(t - 1, f)] - m_depth[u], m_lowest[u], m_highest[u]);
                y[u] = m_depth[u] + d[u];
            }
        }
        return d;
    }

    std::vector<std::vector<double>> opacities(const Numbers& d) const {
        std::vector<std::vector<double>> all;
        for (std::size_t t = 0; t < m_frames.size(); ++t) {
            std::vector<double> x = m_frames[t].opacity;
            for (std::size_t f = 0; f < m_features; ++f) {
                if (d[at(t, f)] == 0) continue;
                const OpacityLimits& limit = m_frames[t].limits[f];
                x[f] = std::clamp(opacityOfLogDepth(m_depth[at(t, f)] + d[at(t, f)]), limit.lowest, limit.highest);
            }
            all.push_back(std::move(x));
        }
        return all;
    }

    const std::vector<FrameModel>& m_frames;
    const JobControl& m_job;
    const std::size_t m_features;
    Numbers m_lowest, m_highest; // of d, ≤ 0 and ≥ 0
    Numbers m_depth;             // ln τ where the models were taken
    std::vector<Rows> m_slope;   // [frame][i][j]: ∂W_i/∂y_j
    std::vector<Rows> m_metric;
    Numbers m_density;         // what (m_density·d of the first frame)² is of the picture; empty: that stays
    std::size_t m_counted = 0; // frames that do not stay
    double m_wanted = 0;       // root mean square of F that is aimed at
    double m_usualJump = 0;    // of the start, about
    bool m_isStill = false;    // it has no jumps
};

} // namespace

std::vector<std::vector<double>> smoothed(const std::vector<FrameModel>& frames, const JobControl& job) {
    if (frames.empty()) return {};
    return Smoother(frames, job).run();
}

} // namespace pellucid
