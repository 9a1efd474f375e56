#include "volume/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace pellucid {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// The component of largest magnitude; of equal ones the first.
int largest(const Vec3& v) {
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (std::abs(v[a]) > std::abs(v[axis]) * (1 + 1e-12)) axis = a;
    return axis;
}

} // namespace

Vec3 inAxes(PatientAxes axes, const Geometry& geometry, const Vec3& world) {
    const bool turns = axes == PatientAxes::Ras && geometry.worldAxes == WorldAxes::Patient;
    return turns ? Vec3(0 - world.x, 0 - world.y, world.z) : world;
}

std::string coordinatesText(PatientAxes axes, const Geometry& geometry) {
    if (geometry.worldAxes != WorldAxes::Patient) return {};
    return axes == PatientAxes::Ras ? "RAS" : "LPS";
}

LengthUnit unitOf(const Geometry& geometry) {
    if (geometry.lengthUnit != LengthUnit::Unknown) return geometry.lengthUnit;
    return geometry.worldAxes == WorldAxes::Patient ? LengthUnit::Millimetre : LengthUnit::Unknown;
}

const char* lengthUnit(const Geometry& geometry) { return sign(unitOf(geometry)); }

Geometry inUnit(const Geometry& geometry, LengthUnit unit) {
    const LengthUnit own = unitOf(geometry);
    if (own == unit || own == LengthUnit::Unknown || unit == LengthUnit::Unknown) return geometry;
    const double scale = converted(1, own, unit);
    Geometry scaled = geometry;
    scaled.spacing *= scale;
    scaled.origin *= scale;
    scaled.referenceLength *= scale;
    scaled.lengthUnit = unit;
    return scaled;
}

char patientLetter(int axis, bool positive) {
    constexpr std::array<const char*, 3> kLetters{"RL", "AP", "IS"};
    return kLetters[static_cast<std::size_t>(axis)][positive ? 1 : 0];
}

std::string directionLetters(const Vec3& direction) {
    constexpr double kTangent = 0.41421356; // of 22.5°
    const int main = largest(direction);
    std::string letters(1, patientLetter(main, direction[main] > 0));
    Vec3 rest = direction;
    rest[main] = 0;
    const int second = largest(rest);
    if (std::abs(rest[second]) > kTangent * std::abs(direction[main]))
        letters += patientLetter(second, rest[second] > 0);
    return letters;
}

double obliqueAngle(const Geometry& geometry) {
    double most = 0;
    for (int a = 0; a < 3; ++a) {
        const Vec3 d = glm::normalize(geometry.directions[a]);
        most = std::max(most, std::acos(std::min(1.0, std::abs(d[largest(d)]))));
    }
    return most * kDegrees;
}

std::string axisText(const Geometry& geometry, int axis) {
    const Vec3& d = geometry.directions[axis];
    const int nearest = largest(d);
    const bool positive = d[nearest] > 0;
    std::string text;
    if (geometry.worldAxes == WorldAxes::Patient)
        text.append(1, patientLetter(nearest, !positive)).append("→").append(1, patientLetter(nearest, positive));
    else
        text.append(positive ? "+" : "-").append(1, "xyz"[nearest]);
    return text;
}

std::string axesText(const Geometry& geometry) {
    std::string text = axisText(geometry, 0) + ", " + axisText(geometry, 1) + ", " + axisText(geometry, 2);
    if (const double angle = obliqueAngle(geometry); angle > 0.5)
        text += ", " + std::to_string(std::lround(angle)) + "° oblique";
    return text;
}

} // namespace pellucid
