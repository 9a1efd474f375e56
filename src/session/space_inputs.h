// What a scene gives a parameter space: the volume that is fine enough, and the runs that were made.
#pragma once

#include "optimize/space_picture.h"
#include "session/scene.h"

namespace pellucid {

/// The same figures of the volume made coarser by a whole factor ≥ 1: opacities, saliency and clipping keep their
/// lengths. 1: the input itself.
MeasureInput coarserInput(const MeasureInput& input, int factor);

/// The optimizations among `runs` as ways through the opacities of `tf`, the oldest first: those whose features had the
/// names of all that have an axis. A feature that a run does not name has the opacity and VWS 0.
std::vector<SpacePath> pathsOfRuns(const std::vector<Run>& runs, const TransferFunction& tf, const ParameterAxes& axes);

} // namespace pellucid
