// Refinements and optimizations as the JSON that commands promise, keys in the order of the documentation.
#pragma once

#include "optimize/answer/verdict.h"
#include "optimize/optimizer.h"
#include "optimize/refine/refine.h"
#include "optimize/refine/refine_outcome.h"
#include "output.h"
#include "render/camera.h"

namespace pellucid::cli {

/// The objects of `refine --json` and `optimize --json`, without what the commands add ("engine", "seconds").
/// `before`: the transfer function that was refined. `priority`: an object that says what was asked for.
Json jsonFromRefinement(const TransferFunction& before, const RefineResult& result, RefineMethod method,
                        const RefineComparison& comparison, Json priority);
/// "chosen": what became of what a priority chose; "darkening": where the picture gets dark. Null where there is none.
void addRemarks(Json& json, const std::optional<PriorityOutcome>& outcome, const std::optional<Darkening>& dark);
/// What limits, what would help, who hides whom; features by their names in `tf`.
Json jsonFromVerdict(const Verdict& verdict, const TransferFunction& tf);
Json jsonFromOptimization(const OptimizeResult& result, const OptimizeOptions& options);
/// "vws", "opacity", "objective", "coverage" and "covers" of a picture.
Json jsonFromShares(const SeenShares& shares);
/// How strong the picture is: "coverage", "covers", "exact" where it keeps the picture visible instead of the shares,
/// and "faint" where something of it cannot be seen.
void addSeen(Json& json, const OptimizeResult& result);

/// {"view":{"azimuth","elevation"},"camera":{…}}: where an eye is, in degrees, and all of the camera.
Json jsonFromView(const Camera& camera, const Geometry& geometry);

} // namespace pellucid::cli
