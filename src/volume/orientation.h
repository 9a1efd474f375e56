// Directions in the words of anatomy: L R A P S I.
#pragma once

#include <string>

#include "base/enum_names.h"
#include "volume/volume.h"

namespace pellucid {

/// In which coordinates places of a patient are shown and given: toward left, posterior, superior as DICOM and ITK have
/// it, and as the world is here; or toward right, anterior, superior as NIfTI and 3D Slicer show them.
enum class PatientAxes { Lps, Ras };
template <>
inline constexpr auto kNamesOf<PatientAxes> = enumNames("coordinates", "lps", "ras");

/// A place or direction of the world in these coordinates, and just as well the other way round. Where the world is no
/// patient's, there is but one kind of coordinates.
Vec3 inAxes(PatientAxes axes, const Geometry& geometry, const Vec3& world);
/// "LPS" or "RAS"; empty where the world is no patient's.
std::string coordinatesText(PatientAxes axes, const Geometry& geometry);

/// What lengths of the world are measured in: as the file says or, where the world is a patient's, millimetres.
LengthUnit unitOf(const Geometry& geometry);
/// The same in words: "mm", "µm"; "units" where it is not known.
const char* lengthUnit(const Geometry& geometry);
/// The same volume with lengths in another unit; as it is where either is not known.
Geometry inUnit(const Geometry& geometry, LengthUnit unit);

/// The letter of a direction along world axis x, y or z (0, 1, 2) in the patient's frame: L, P, S where `positive`,
/// else R, A, I.
char patientLetter(int axis, bool positive);

/// Where a direction of the patient's frame points: the letter of its largest component and, where it is more
/// than 22.5° off that axis toward another one, that one's: "L", "LA". `direction` has any length but 0.
std::string directionLetters(const Vec3& direction);

/// The angle between the volume's axes and the world's: of the axis i, j, k that is farthest from any of x, y, z,
/// degrees, [0, 54.8).
double obliqueAngle(const Geometry& geometry);

/// How one of i, j, k (0, 1, 2) runs, by the nearest world axis: "R→L" where the world is the patient's, else "+x".
std::string axisText(const Geometry& geometry, int axis);

/// axisText() of i, j, k: "R→L, A→P, I→S" or "+x, +y, +z";
/// with ", 12° oblique" where they are farther than half a degree from it.
std::string axesText(const Geometry& geometry);

} // namespace pellucid
