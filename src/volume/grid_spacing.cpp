#include "volume/grid_spacing.h"

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/excerpt.h"
#include "volume/orientation.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

UsageError wrongSpacing(const std::string& problem) {
    return {problem, "spacing", "give three distances, SX,SY,SZ, and perhaps their unit, such as mm or um"};
}

} // namespace

GridSpacing parseGridSpacing(const std::string& text) {
    const std::vector<std::string> parts = splitAt(',', text);
    if (parts.size() < 3 || parts.size() > 4) throw wrongSpacing("'" + text + "' is not three distances");
    GridSpacing spacing;
    for (int a = 0; a < 3; ++a) {
        const std::string part = trimmed(parts[static_cast<std::size_t>(a)]);
        if (!parseNumber(part, spacing.distances[a])) throw wrongSpacing("'" + part + "' is not a number");
    }
    if (const std::string wrong = geometryProblem(spacing.distances, Vec3(0)); !wrong.empty())
        throw wrongSpacing(wrong);
    if (parts.size() == 4) {
        const auto unit = lengthUnitNamed(parts[3]);
        if (!unit) throw wrongSpacing("'" + parts[3] + "' is not a unit of length");
        spacing.unit = *unit;
    }
    return spacing;
}

std::string gridSpacingText(const GridSpacing& spacing) {
    const Vec3& d = spacing.distances;
    std::string text = exactText(d.x) + "," + exactText(d.y) + "," + exactText(d.z);
    if (spacing.unit != LengthUnit::Unknown) text += "," + std::string(plainSign(spacing.unit));
    return text;
}

GridSpacing spacingOfData(const Volume& volume) {
    const Geometry& geometry = volume.geometry();
    return {geometry.spacing / placeInData(volume).factors, unitOf(geometry)};
}

Geometry withSpacing(const Volume& volume, const Geometry& geometry, const GridSpacing& spacing) {
    Geometry made = geometry;
    Vec3 distances = spacing.distances;
    if (geometry.worldAxes == WorldAxes::Patient) {
        for (int a = 0; a < 3; ++a) distances[a] = converted(distances[a], spacing.unit, unitOf(geometry));
    } else if (spacing.unit != LengthUnit::Unknown) {
        made = inUnit(made, spacing.unit);
        made.lengthUnit = spacing.unit;
    }
    if (const std::string wrong = geometryProblem(distances, Vec3(0)); !wrong.empty()) throw wrongSpacing(wrong);
    const auto [first, factors] = placeInData(volume);
    made.origin -= made.directions * (first * made.spacing / factors);
    made.spacing = distances * factors;
    made.origin += made.directions * (first * distances);
    if (geometry.referenceLength > 0) made.referenceLength = glm::min(distances.x, glm::min(distances.y, distances.z));
    return made;
}

} // namespace pellucid
