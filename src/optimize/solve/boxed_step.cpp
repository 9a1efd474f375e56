#include "optimize/solve/boxed_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace pellucid {

namespace {

using Indices = std::vector<Eigen::Index>;

/// To the minimum over the indices `free` where the slope is `slope`, their sum kept or not.
Vector wayDown(const Matrix& a, const Indices& free, const Vector& slope, Sum sum) {
    const Eigen::LDLT<Matrix> factor(a(free, free));
    Vector way = factor.solve(-slope);
    if (sum == Sum::Free) return way;
    const Vector ones = factor.solve(Vector::Ones(slope.size()));
    way -= way.sum() / ones.sum() * ones;
    return way.array() - way.mean(); // which is of rounding
}

} // namespace

Vector boxedStep(const Matrix& a, const Vector& g, const Vector& lowest, const Vector& highest, Sum sum,
                 const JobControl& job, int* systems) {
    constexpr double kRounding = 1e-13; // of a slope, by the size of what it is the sum of
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Eigen::Index n = g.size(), most = 100 + 20 * n; // rounds, far above what is needed; ends a cycle of rounding
    Vector p = Vector::Zero(n);
    std::vector<char> bound(static_cast<std::size_t>(n));
    for (Eigen::Index i = 0; i < n; ++i) bound[i] = !(lowest[i] < 0 && highest[i] > 0);
    for (Eigen::Index round = 0; round < most; ++round) {
        job.throwIfStopped();
        Vector slope = a * p + g;
        Indices free;
        for (Eigen::Index i = 0; i < n; ++i)
            if (!bound[i]) free.push_back(i);
        if (!free.empty()) {
            const Vector here = slope(free), way = wayDown(a, free, here, sum);
            if (systems) ++*systems;
            if (way.dot(here) < 0) { // else it is the minimum but for rounding
                // As far towards the minimum over the free ones as the box goes.
                const auto end = [&](std::size_t k) { return (way[k] > 0 ? highest : lowest)[free[k]]; };
                double part = 1;
                std::size_t first = free.size();
                for (std::size_t k = 0; k < free.size(); ++k)
                    if (const double room = (end(k) - p[free[k]]) / way[k]; way[k] != 0 && room < part) {
                        part = std::max(0.0, room);
                        first = k;
                    }
                for (std::size_t k = 0; k < free.size(); ++k) {
                    const Eigen::Index i = free[k];
                    const double next = std::clamp(p[i] + part * way[k], lowest[i], highest[i]);
                    bound[i] = k == first || (way[k] != 0 && next == end(k));
                    p[i] = bound[i] ? end(k) : next;
                }
                if (first < free.size()) continue;
                slope = a * p + g;
            }
        }
        // At the minimum of this face: the bound that pulls inwards most is let go.
        const Vector size = a.cwiseAbs() * p.cwiseAbs() + g.cwiseAbs();
        double multiplier = 0; // of the sum; where nothing is free, so that what could go down lets all else go up
        if (sum == Sum::Kept && !free.empty()) multiplier = -slope(free).mean();
        if (sum == Sum::Kept && free.empty()) {
            multiplier = kInfinity;
            for (Eigen::Index i = 0; i < n; ++i)
                if (p[i] > lowest[i]) multiplier = std::min(multiplier, -slope[i]);
        }
        double worst = 0;
        Eigen::Index released = n;
        for (Eigen::Index i = 0; i < n; ++i) {
            if (!bound[i] || lowest[i] == highest[i]) continue;
            const double inwards = (p[i] == lowest[i] ? -1 : 1) * (slope[i] + multiplier);
            if (inwards > std::max(worst, kRounding * (size[i] + std::abs(multiplier)))) {
                worst = inwards;
                released = i;
            }
        }
        if (released == n) break;
        bound[released] = false;
    }
    return p;
}

Vector leastSquaresStep(const Matrix& jacobian, const Vector& residual, const Vector& lowest, const Vector& highest,
                        double ridge) {
    Matrix a = jacobian.transpose() * jacobian;
    a.diagonal().array() += ridge;
    return boxedStep(a, jacobian.transpose() * residual, lowest, highest);
}

} // namespace pellucid
