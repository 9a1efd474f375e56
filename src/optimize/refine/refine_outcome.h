// Whether a refinement did what it was asked for: what was chosen stands out, and the picture can still be seen.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "optimize/ray_bundle.h"
#include "optimize/refine/refine.h"

namespace pellucid {

/// Refines anew, with other options.
using RefineAgain = std::function<TransferFunction(const RefineOptions&)>;

/// What became of what a priority chose. Its part is a feature, or, under a transfer function of one feature at most,
/// the control points about the value.
struct PriorityOutcome {
    std::string name;      ///< the feature, else "the value 812"
    double valueGain = 1;  ///< α of the chosen value, after by before; of a region the part's highest
    double partGain = 1;   ///< the part's Σ α·p, after by before
    double othersGain = 0; ///< the largest of the others' that have voxels; infinite where one appears
    bool gained = false;   ///< the value is in a part, neither has fallen, and both gain on all others
    std::string text;      ///< a sentence that says why not, and what helps; empty where `gained`
};

/// Empty without a priority. `options`: those that led from `before` to `after`; `again` tells whether what the
/// sentence offers helps.
std::optional<PriorityOutcome> priorityOutcome(const Histogram& histogram, const TransferFunction& before,
                                               const TransferFunction& after, const RefineOptions& options,
                                               const RefineAgain& again);

/// A refinement that has left a picture as good as empty (docs/method.md, "Coverage").
struct Darkening {
    double before = 0, after = 0; ///< coverage
    enum class Help { None, Exact, Stop };
    Help help = Help::None;
    int iterations = 0; ///< of Help::Stop
    double helped = 0;  ///< coverage with it
};

/// Empty where the picture after can be seen, or was no stronger before. What helps has been tried: it leaves a visible
/// picture, and of what a priority chose no less than there was. `rays` are those of `before`.
std::optional<Darkening> darkeningOf(const RayBundle& rays, const Histogram& histogram, const TransferFunction& before,
                                     const TransferFunction& after, const RefineOptions& options,
                                     const RefineAgain& again);

/// "The picture gets dark: its coverage falls from 0.79 to 0.05. With the method Exact it stays at 0.62."
std::string darkeningText(const Darkening& darkening);

} // namespace pellucid
