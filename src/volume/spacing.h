// Which distances between voxels can be computed with.
#pragma once

#include <string>

#include "volume/grid.h"

namespace pellucid {

/// Bounds of a spacing, world units: between them figures do not depend on the unit of length. Products of a few
/// lengths stay within floats of single precision, and no length passes for zero.
inline constexpr double kLeastSpacing = 1e-12, kMostSpacing = 1e24;

/// What is wrong with the distances between voxels along each axis or the place of the first one, world units: "the
/// spacing of axis 1 is 0, it must be positive and finite". Empty where nothing is.
std::string geometryProblem(const Vec3& spacing, const Vec3& origin);

/// How readers end what they say of a distance that a file leaves out, which is no longer so where the user sets it.
inline constexpr const char* kUnlessSet = " unless you set the spacing";

} // namespace pellucid
