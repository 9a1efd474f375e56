// Directions in the words of anatomy: L R A P S I.
#pragma once

#include <string>

#include "volume/volume.h"

namespace pellucid {

/// The letter of a direction along world axis x, y or z (0, 1, 2) in the patient's frame: L, P, S where `positive`,
/// else R, A, I.
char patientLetter(int axis, bool positive);

/// Where a direction of the patient's frame points: the letter of its largest component and, where it is more
/// than 22.5° off that axis toward another one, that one's: "L", "LA". `direction` has any length but 0.
std::string directionLetters(const Vec3& direction);

/// The angle between the volume's axes and the world's: of the axis i, j, k that is farthest from any of x, y, z,
/// degrees, [0, 54.8).
double obliqueAngle(const Geometry& geometry);

/// How i, j, k run: "R→L, A→P, I→S" where the world is the patient's, else "+x, +y, +z", by the nearest world axis;
/// with ", 12° oblique" where they are farther than half a degree from it.
std::string axesText(const Geometry& geometry);

} // namespace pellucid
