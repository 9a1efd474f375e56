#include "optimize/time/smoothing.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "optimize/solve/block_tridiagonal.h"
#include "optimize/solve/flattest_direction.h"
#include "optimize/solve/log_depths.h"

namespace pellucid {

namespace {

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

/// Unknowns: the changes d of ln τ of all features in all frames, a column per frame. The sum of jumps is minimised by
/// weighted squares, each weighed by what its own jump was (iteratively reweighted least squares).
class Smoother {
public:
    Smoother(const std::vector<FrameModel>& frames, const JobControl& job)
        : m_models(frames), m_job(job), m_features(static_cast<Eigen::Index>(frames.front().opacity.size())),
          m_lowest(Matrix::Zero(m_features, static_cast<Eigen::Index>(frames.size()))), m_highest(m_lowest),
          m_depth(m_lowest) {
        for (const FrameModel& frame : frames) addFrame(frame);
        if (m_counted > 0) m_wanted = kSafety * std::sqrt(m_wanted / static_cast<double>(m_counted));
        double way = 0, square = 0;
        for (std::size_t t = 1; t < frames.size(); ++t) {
            way += jump(m_depth, t);
            square += m_frames[t].metric.trace();
        }
        const double jumps = static_cast<double>(std::max<std::size_t>(1, frames.size() - 1));
        m_isStill = way == 0;
        m_usualJump = std::max(way / jumps, kSmallStep * std::sqrt(square / jumps));
        if (!frames.front().stays) findDensity();
    }

    std::vector<std::vector<double>> run() {
        const Matrix none = Matrix::Zero(m_features, m_depth.cols());
        if (m_counted == 0 || (m_isStill && distance(none) <= m_wanted)) return opacities(none);
        double lo = std::log10(kLeastWeight), hi = std::log10(kMostWeight); // distance falls with weight
        Matrix best = minimum(kLeastWeight);
        if (distance(best) <= m_wanted) return opacities(withoutTraces(best));
        best = minimum(kMostWeight);
        for (int i = 0; i < kBisections && distance(best) <= m_wanted; ++i) {
            const double middle = (lo + hi) / 2;
            const Matrix d = minimum(std::pow(10, middle));
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
    /// r + slope·d is what is left of W − t, over the root of their number; 0 where the frame stays.
    struct Frame {
        LogDepths depths;
        Vector residual;
        Matrix slope, metric;
    };

    void addFrame(const FrameModel& frame) {
        if (static_cast<Eigen::Index>(frame.opacity.size()) != m_features)
            throw UsageError("frames have " + std::to_string(m_features) + " and " +
                                 std::to_string(frame.opacity.size()) + " features",
                             "frames", "give all the same features");
        std::vector<double> wanted(frame.opacity.size(), 0.0);
        for (std::size_t f = 0; f < wanted.size(); ++f)
            if (!frame.stays && frame.opacity[f] > 0) wanted[f] = frame.targets[f];
        const LogDepths all({}, std::vector<double>(wanted.size(), 1.0));
        Frame& added = m_frames.emplace_back(Frame{{frame.limits, wanted},
                                                   Vector::Zero(m_features),
                                                   Matrix::Zero(m_features, m_features),
                                                   matrixOf(frame.metric)});
        if (added.metric.size() == 0)
            added.metric.setIdentity(m_features, m_features) /= static_cast<double>(m_features);
        const auto t = static_cast<Eigen::Index>(m_frames.size() - 1);
        m_depth.col(t) = all.from(frame.opacity);
        const auto [lowest, highest] = added.depths.stepsFrom(added.depths.from(frame.opacity), kReach);
        m_lowest.col(t)(added.depths.features()) = lowest;
        m_highest.col(t)(added.depths.features()) = highest;
        if (frame.stays) return;
        const double root = std::sqrt(static_cast<double>(m_features));
        added.residual = (vectorOf(frame.vws) - vectorOf(frame.targets)) / root;
        added.slope = all.derivatives(matrixOf(frame.derivative), frame.opacity) / root;
        ++m_counted;
        m_wanted += frame.distance * frame.distance;
    }

    double jump(const Matrix& y, std::size_t t) const {
        const Vector v = y.col(t) - y.col(t - 1);
        return std::sqrt(std::max(0.0, v.dot(m_frames[t].metric * v)));
    }

    /// The direction in the first frame along which its shares stay, as what it does to the picture.
    void findDensity() {
        const Frame& first = m_frames.front();
        const Vector along = flattestDirection(first.slope);
        m_density = first.metric * along;
        m_density /= std::sqrt(std::max(m_density.dot(along), 1e-300));
    }

    /// The root mean square of F in the model.
    double distance(const Matrix& d) const {
        double sum = 0;
        for (std::size_t t = 0; t < m_frames.size(); ++t)
            sum += (m_frames[t].residual + m_frames[t].slope * d.col(t)).squaredNorm();
        return std::sqrt(sum / static_cast<double>(m_counted));
    }

    /// The d that minimises the jumps and weight/2 times the sum of F².
    Matrix minimum(double weight) const {
        Matrix d = Matrix::Zero(m_features, m_depth.cols());
        Eigen::ArrayXXi held = Eigen::ArrayXXi::Zero(d.rows(), d.cols()); // −1, 1: at the lower, upper bound
        double none = m_usualJump;
        for (int round = 0; round < kRounds; ++round) {
            m_job.throwIfStopped();
            d = weightedMinimum(weight, none, m_depth + d, held);
            held = (d.array() > m_highest.array()).cast<int>() - (d.array() < m_lowest.array()).cast<int>();
            d = d.cwiseMax(m_lowest).cwiseMin(m_highest); // what is not held is free, from the next round on
            none = std::max(kNoJump * m_usualJump, kSharper * none);
        }
        return d;
    }

    /// Jumps are weighed by what they are at y.
    Matrix weightedMinimum(double weight, double none, const Matrix& y, const Eigen::ArrayXXi& held) const {
        const std::size_t frames = m_frames.size();
        std::vector<Matrix> own, jumps;
        Matrix b(m_features, m_depth.cols());
        for (std::size_t t = 0; t < frames; ++t) {
            const Frame& frame = m_frames[t];
            own.push_back(weight * frame.slope.transpose() * frame.slope);
            b.col(t) = -weight * frame.slope.transpose() * frame.residual;
            jumps.push_back(t == 0 ? Matrix::Zero(m_features, m_features).eval()
                                   : (frame.metric / std::hypot(jump(y, t), none)).eval());
            if (t == 0) continue;
            const Vector pull = jumps[t] * (m_depth.col(t) - m_depth.col(t - 1));
            b.col(t) -= pull;
            b.col(t - 1) += pull;
            own[t] += jumps[t];
            own[t - 1] += jumps[t];
        }
        if (m_density.size() > 0) own[0] += kDensityWeight * m_density * m_density.transpose();
        double most = 0;
        for (const Matrix& block : own) most = std::max(most, block.diagonal().maxCoeff());
        for (std::size_t t = 0; t < frames; ++t)
            for (Eigen::Index f = 0; f < m_features; ++f) {
                own[t](f, f) += 1e-12 * most; // what neither is seen nor counts stays
                if (held(f, t) == 0 && m_lowest(f, t) < m_highest(f, t)) continue;
                own[t](f, f) += kHeld * most;
                b(f, t) += kHeld * most * (held(f, t) > 0 ? m_highest(f, t) : m_lowest(f, t));
            }
        return solveBlockTridiagonal(std::move(own), jumps, std::move(b));
    }

    /// What is left of a jump that there is no reason for is none.
    Matrix withoutTraces(Matrix d) const {
        for (std::size_t t = 1; t < m_frames.size(); ++t) {
            const Matrix y = m_depth + d;
            if (jump(y, t) > kTrace * m_usualJump) continue;
            d.col(t) = (y.col(t - 1) - m_depth.col(t)).cwiseMax(m_lowest.col(t)).cwiseMin(m_highest.col(t));
        }
        return d;
    }

    std::vector<std::vector<double>> opacities(const Matrix& d) const {
        std::vector<std::vector<double>> all;
        for (std::size_t t = 0; t < m_frames.size(); ++t) {
            const LogDepths& depths = m_frames[t].depths;
            const Vector change = d.col(t)(depths.features());
            all.push_back(depths.opacities(depths.from(m_models[t].opacity) + change, m_models[t].opacity));
        }
        return all;
    }

    const std::vector<FrameModel>& m_models;
    const JobControl& m_job;
    const Eigen::Index m_features;
    std::vector<Frame> m_frames;
    Matrix m_lowest, m_highest; // of d, ≤ 0 and ≥ 0
    Matrix m_depth;             // ln τ where the models were taken
    Vector m_density;           // what (m_density·d of the first frame)² is of the picture; empty: that stays
    std::size_t m_counted = 0;  // frames that do not stay
    double m_wanted = 0;        // root mean square of F that is aimed at
    double m_usualJump = 0;     // of the start, about
    bool m_isStill = false;     // it has no jumps
};

} // namespace

std::vector<std::vector<double>> smoothed(const std::vector<FrameModel>& frames, const JobControl& job) {
    if (frames.empty()) return {};
    return Smoother(frames, job).run();
}

} // namespace pellucid
