// What is measured, of a coarser copy of its volume.
#pragma once

#include "session/scene.h"

namespace pellucid {

/// The same figures of the volume made coarser by a whole factor ≥ 1: opacities, saliency and clipping keep their
/// lengths. 1: the input itself.
MeasureInput coarserInput(const MeasureInput& input, int factor);

} // namespace pellucid
