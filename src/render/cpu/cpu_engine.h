// The cpu engine with its choice of instructions in sight; render/visibility.h is the way in for everybody else.
#pragma once

#include "render/cpu/sweep.h"
#include "render/visibility.h"

namespace pellucid {

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                SweepKernel kernel);

} // namespace pellucid
