// Entropy refinement of the opacities (docs/method.md, "Entropy refinement", thesis chapter 3).
#pragma once

#include <optional>
#include <vector>

#include "base/job.h"
#include "tf/transfer_function.h"
#include "volume/histogram.h"

namespace pellucid {

/// Greedy: the steps of the thesis. Exact: the least variance of edge weights that opacities can have.
enum class RefineMethod { Greedy, Exact };

struct RefineOptions {
    double stepDown = 1.0 / 256;
    /// Empty: derived in each iteration from stepDown and the ratio of the two ends' significances.
    std::optional<double> stepUp = 1.0 / 256;
    int maxIterations = 5000;
    RefineMethod method = RefineMethod::Greedy;
    void validate() const; ///< throws UsageError: steps in (0,1], maxIterations ≥ 0
};

struct RefineResult {
    TransferFunction tf; ///< the best seen
    int iterations = 0;
    double energyBefore = 0, energyAfter = 0;               ///< over all edges
    double energyMovableBefore = 0, energyMovableAfter = 0; ///< over participating edges, decides
    std::vector<double> edgesBefore, edgesAfter;            ///< n+1 weights, of pointsWithEnds()
};

/// Edge weights e(i) of `tf` (3.3), integrated exactly: n+1 numbers, one per segment of pointsWithEnds().
std::vector<double> edgeWeights(const Histogram& histogram, const TransferFunction& tf);
/// Σ (e − ē)² (3.4).
double edgeEnergy(const std::vector<double>& edges);

RefineResult refine(const Histogram& histogram, const TransferFunction& tf, const RefineOptions& options = {},
                    const JobControl& job = {});

} // namespace pellucid
