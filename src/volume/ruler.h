// What people measure in a volume: distances, angles, and the values in a sphere or a box.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/enum_names.h"
#include "base/job.h"
#include "volume/orientation.h"
#include "volume/volume.h"

namespace pellucid {

enum class RulerKind {
    Distance, ///< of two points
    Angle,    ///< at the middle one of three points
    Sphere,   ///< the values around a point
    Box       ///< the values between two corners, along the axes of the world
};
template <>
inline constexpr auto kNamesOf<RulerKind> = enumNames("measure", "distance", "angle", "sphere", "box");

/// One of them. All lengths and places are the world's.
struct Ruler {
    RulerKind kind = RulerKind::Distance;
    std::string name = {}; ///< what people call it
    /// Two ends; two ends with the corner of the angle between them; a centre; the corners of the least and of the
    /// greatest coordinates.
    std::vector<Vec3> points = {};
    double radius = 0; ///< of a sphere, > 0
    bool shown = true; ///< in pictures and slices
    int number = 0;    ///< tells it from the others of its session, from 1 on; given by addRuler()
    bool operator==(const Ruler&) const = default;
};

/// How many points a kind has.
constexpr std::size_t pointsOf(RulerKind kind) {
    return std::array<std::size_t, 4>{2, 3, 1, 2}[static_cast<std::size_t>(kind)];
}

/// The box that two opposite corners span.
Ruler boxRuler(const Vec3& corner, const Vec3& opposite);

/// The same with its points in these coordinates, or back: of a box, with its corners in order again.
Ruler inAxes(PatientAxes axes, const Geometry& geometry, const Ruler& ruler);

/// Why it cannot be measured: "the two points of a leg of the angle are the same". Empty where it can.
std::string rulerProblem(const Ruler& ruler);

/// What is found among the voxels of a body: those whose centres lie in it or on its surface. Invalid voxels do not
/// count.
struct BodyValues {
    std::size_t count = 0;                      ///< of valid voxels; where there is none, the four below are 0
    std::size_t invalid = 0;                    ///< of voxels that are not
    double mean = 0, sigma = 0, lo = 0, hi = 0; ///< data units; sigma is of these voxels themselves (by n, not n − 1)
    /// Share of the body that lies beyond the voxels, [0,1]: told by the places that voxels would have if the grid went
    /// on.
    double outside = 0;
};

/// `radius` > 0. Same bits with any number of threads. Throw Cancelled.
BodyValues valuesInSphere(const Volume& volume, const Vec3& center, double radius, const JobControl& job = {});
/// `lo` ≤ `hi` along each axis.
BodyValues valuesInBox(const Volume& volume, const Vec3& lo, const Vec3& hi, const JobControl& job = {});

/// What a ruler says: one of the three.
struct RulerReading {
    std::optional<double> length = {};     ///< of a distance, world units
    std::optional<double> angle = {};      ///< degrees, [0, 180]
    std::optional<BodyValues> values = {}; ///< of a sphere or box
};

/// What needs no volume: of a sphere or box, nothing. rulerProblem() is empty.
RulerReading readGeometry(const Ruler& ruler);
RulerReading read(const Ruler& ruler, const Volume& volume, const JobControl& job = {});

/// For the picture: "12.35 mm", "45.0°", mean and sigma as "103.2 ± 12.1". `span`: the width of the range of
/// the data.
std::string labelOf(const RulerReading& reading, const Geometry& geometry, double span);
/// All that was found: "12.3456 mm", "mean 103.2, sigma 12.1, 80.0 to 140.0, 523 voxels, 12 % outside the volume".
std::string textOf(const RulerReading& reading, const Geometry& geometry, double span);

/// Puts it behind the others, with a number above theirs and, where it has none, a name: "Distance 2". Returns the
/// number.
int addRuler(std::vector<Ruler>& rulers, Ruler ruler);

inline constexpr std::size_t kMostRulers = 1000; ///< of a session

} // namespace pellucid
