#include "optimize/solve/least_variance.h"

#include "optimize/solve/boxed_step.h"

namespace pellucid {

Vector nearestOfTotal(const Vector& x, double total, const Vector& lowest, const Vector& highest) {
    if (total <= lowest.sum()) return lowest;
    if (total >= highest.sum()) return highest;
    const auto shifted = [&](double by) -> Vector { return (x.array() + by).max(lowest.array()).min(highest.array()); };
    if (Vector here = shifted(0); here.sum() == total) return here;
    // Every x within [0,1] is at its lower bound at the one and at its upper one at the other.
    double lo = -1, hi = 1;
    for (int i = 0; i < 100; ++i) {
        const double middle = lo + (hi - lo) / 2;
        (shifted(middle).sum() < total ? lo : hi) = middle;
    }
    return shifted(hi);
}

/// Directions in which the energy is flat make the Hessian singular. So each round minimises the energy plus a little
/// times the squared distance from the round before: what is left of that term goes to 0 with the rounds.
LeastVarianceAnswer solve(const LeastVariance& problem, const Vector& start, const JobControl& job) {
    constexpr int kRounds = 30;
    constexpr double kLittle = 1e-10, kSettled = 1e-13;
    LeastVarianceAnswer answer{nearestOfTotal(start, problem.total, problem.lowest, problem.highest), 0, 0};
    if (problem.rows.size() == 0) return answer;
    const Matrix centred = problem.rows.rowwise() - problem.rows.colwise().mean(); // of which e − ē is made
    const Vector offset = problem.constants.array() - problem.constants.mean();
    const auto deviations = [&](const Vector& x) -> Vector { return centred * x + offset; };
    answer.energy = deviations(answer.x).squaredNorm();
    Matrix hessian = centred.transpose() * centred; // half of it, as of the gradient below
    const double little = kLittle * hessian.diagonal().maxCoeff();
    if (!(little > 0)) return answer; // nothing depends on x
    hessian.diagonal().array() += little;
    Vector x = answer.x;
    for (int round = 0; round < kRounds; ++round) {
        const Vector lowest = problem.lowest - x, highest = problem.highest - x;
        const Vector step =
            boxedStep(hessian, centred.transpose() * deviations(x), lowest, highest, Sum::Kept, job, &answer.steps);
        for (Eigen::Index v = 0; v < x.size(); ++v)
            x[v] = step[v] == lowest[v]    ? problem.lowest[v]
                   : step[v] == highest[v] ? problem.highest[v]
                                           : x[v] + step[v];
        if (step.lpNorm<Eigen::Infinity>() < kSettled) break;
    }
    if (const double energy = deviations(x).squaredNorm(); energy <= answer.energy) {
        answer.x = x;
        answer.energy = energy;
    }
    return answer;
}

} // namespace pellucid
