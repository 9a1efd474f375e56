// The greedy search of thesis section 3.4.2 as it reads: every edge of every transfer function integrated anew.
#include <algorithm>

#include "optimize/refine/refine_edges.h"

namespace pellucid {

namespace {

/// e(i) of every edge, and s at every point, from the histogram.
void integrate(EdgeLine& line, const Histogram& histogram) {
    line.information = informationOf(histogram);
    line.weigh();
}

} // namespace

RefineResult refineReference(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options,
                             const JobControl& job) {
    options.validate();
    EdgeLine line(histogram, tf, options.priority, options.profile);
    RefineResult result = startOf(line, tf);
    EnergyCurve curve;
    curve.add(result.energyMovableBefore);
    EdgeLine best = line;
    double bestEnergy = result.energyMovableBefore;
    const int patience = 2 * static_cast<int>(line.edges());
    for (int sinceBest = 0; !line.participating.empty() && result.iterations < options.maxIterations &&
                            !(options.untilStable && sinceBest >= patience);) {
        job.throwIfStopped();
        integrate(line, histogram);
        const std::vector<double> edges = line.weights();
        const auto lighter = [&](std::size_t a, std::size_t b) { return edges[a] < edges[b]; };
        std::vector<std::size_t> which;
        for (const std::size_t i : line.participating)
            if (!line.isSkipped(i)) which.push_back(i);
        if (which.empty()) break;
        const std::size_t heaviest = *std::ranges::max_element(which, lighter);
        const std::size_t lightest = *std::ranges::min_element(which, lighter);
        const std::size_t down = line.endToMove(heaviest, true), up = line.endToMove(lightest, false);
        const double rise = line.stepUp(options, down, up);
        line.opacity[down] = std::clamp(line.opacity[down] - options.stepDown, 0.0, 1.0);
        line.opacity[up] = std::clamp(line.opacity[up] + rise, 0.0, 1.0);
        ++result.iterations;
        ++sinceBest;
        const double energy = energyOf(line.participatingWeights());
        curve.add(energy);
        if (energy < bestEnergy) {
            bestEnergy = energy;
            best = line;
            sinceBest = 0;
        }
    }
    finish(result, best, tf);
    curve.moveInto(result);
    return result;
}

} // namespace pellucid
