// What people have measured in a volume, as a table.
#pragma once

#include <string>
#include <vector>

#include "session/scene.h"

namespace pellucid {

/// A line for each measure, hidden ones too, under a line of names: name, kind, length, angle (degrees), radius, mean,
/// sigma, min, max, voxels, invalid, outside (share of the body beyond the volume, 0 to 1), unit of lengths, x1 … z3 of
/// its points, coordinates ("LPS", "RAS", or "file"). What a kind does not have is empty; and so is what `readings`
/// do not tell.
std::string csvOf(const std::vector<Ruler>& rulers, const RulerReadings& readings, const Geometry& geometry,
                  PatientAxes axes);

} // namespace pellucid
