// The least energy at constant total opacity: what greedy is measured by.
#include "optimize/refine/refine_edges.h"
#include "optimize/solve/least_variance.h"

namespace pellucid {

RefineResult refineExact(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                         const JobControl& job) {
    EdgeLine line(histogram, tf, options.priority, options.profile);
    RefineResult result = startOf(line, tf);
    std::vector<std::size_t> movable;
    std::vector<double> start;
    std::vector<std::size_t> variableOf(line.points(), line.points());
    for (std::size_t i = 0; i < line.points(); ++i)
        if (!line.fixed[i]) {
            variableOf[i] = movable.size();
            movable.push_back(i);
            start.push_back(line.opacity[i]);
        }

    LeastVariance problem;
    problem.rows = Matrix::Zero(line.participating.size(), movable.size());
    problem.constants = Vector::Zero(line.participating.size());
    problem.lowest = Vector::Zero(movable.size());
    problem.highest = Vector::Ones(movable.size());
    problem.total = options.total.value_or(movableOpacity(tf));
    for (std::size_t row = 0; row < line.participating.size(); ++row) {
        const std::size_t edge = line.participating[row];
        const auto add = [&](std::size_t point, double coefficient) {
            if (line.fixed[point])
                problem.constants[row] += coefficient * line.opacity[point];
            else
                problem.rows(row, variableOf[point]) += coefficient;
        };
        add(edge, line.coefficients[edge].left);
        add(edge + 1, line.coefficients[edge].right);
    }
    const LeastVarianceAnswer answer = solve(problem, vectorOf(start), job);
    for (std::size_t v = 0; v < movable.size(); ++v) line.opacity[movable[v]] = answer.x[v];
    result.iterations = answer.steps;
    finish(result, line, tf);
    EnergyCurve curve;
    curve.add(result.energyMovableBefore);
    curve.add(result.energyMovableAfter);
    curve.moveInto(result);
    return result;
}

} // namespace pellucid
