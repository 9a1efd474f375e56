#include "volume/grid_axes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <glm/matrix.hpp>

#include "base/error.h"
#include "volume/excerpt.h"
#include "volume/orientation.h"

namespace pellucid {

namespace {

constexpr std::array<std::string_view, 3> kPatientLetters{"RL", "AP", "IS"}; // toward −, toward +
constexpr std::string_view kWorldLetters = "xyz";

std::size_t axisOf(int along) { return static_cast<std::size_t>(std::abs(along) - 1); }

/// Axis and direction that a letter of the patient names; 0: none.
int alongOf(char letter) {
    for (int a = 0; a < 3; ++a)
        if (const auto at = kPatientLetters[static_cast<std::size_t>(a)].find(letter); at != std::string_view::npos)
            return at == 1 ? a + 1 : -(a + 1);
    return 0;
}

Mat3 directionsOf(const GridAxes& axes) {
    Mat3 directions(0.0);
    for (int a = 0; a < 3; ++a) {
        const int along = axes.along[static_cast<std::size_t>(a)];
        directions[a][std::abs(along) - 1] = along > 0 ? 1 : -1;
    }
    return directions;
}

/// The middle of all data that a volume is made of, in its own voxel coordinates.
Vec3 middleOfData(const Volume& volume) {
    const auto [first, factors] = placeInData(volume);
    return (0.5 * (Vec3(volume.excerpt ? volume.excerpt->fullDims : volume.dims()) - 1.0) - first) / factors;
}

} // namespace

GridAxes parseGridAxes(const std::string& text) {
    GridAxes axes;
    axes.along = {0, 0, 0};
    if (text.size() == 3) {
        axes.patient = true;
        for (std::size_t a = 0; a < 3; ++a) axes.along[a] = alongOf(text[a]);
    } else if (text.size() == 6) {
        for (std::size_t a = 0; a < 3; ++a) {
            const char sign = text[2 * a];
            const auto at = kWorldLetters.find(text[2 * a + 1]);
            if ((sign == '+' || sign == '-') && at != std::string_view::npos)
                axes.along[a] = (sign == '+' ? 1 : -1) * static_cast<int>(at + 1);
        }
    }
    if (!isComplete(axes))
        throw UsageError("'" + text + "' does not say how the three axes run", "axes",
                         "say where i, j and k point: LPS (three letters of L R A P S I) for a patient, or +x-y+z");
    return axes;
}

std::string gridAxesText(const GridAxes& axes) {
    std::string text;
    for (const int along : axes.along) {
        if (axes.patient)
            text += kPatientLetters[axisOf(along)][along > 0 ? 1 : 0];
        else
            text.append(1, along > 0 ? '+' : '-').append(1, kWorldLetters[axisOf(along)]);
    }
    return text;
}

bool isComplete(const GridAxes& axes) {
    std::array<bool, 3> seen{};
    for (const int along : axes.along) {
        if (along == 0) return false;
        seen[axisOf(along)] = true;
    }
    return seen[0] && seen[1] && seen[2];
}

bool isMirrored(const GridAxes& axes) { return glm::determinant(directionsOf(axes)) < 0; }

GridAxes nearestAxes(const Geometry& geometry) {
    // Of the six ways to pair the axes, the one whose cosines have the largest sum.
    GridAxes nearest;
    nearest.patient = geometry.worldAxes == WorldAxes::Patient;
    std::array<int, 3> order{0, 1, 2};
    double most = -1;
    do {
        double sum = 0;
        for (int a = 0; a < 3; ++a) sum += std::abs(geometry.directions[a][order[static_cast<std::size_t>(a)]]);
        if (sum <= most + 1e-12) continue;
        most = sum;
        for (int a = 0; a < 3; ++a) {
            const int axis = order[static_cast<std::size_t>(a)];
            nearest.along[static_cast<std::size_t>(a)] = geometry.directions[a][axis] < 0 ? -(axis + 1) : axis + 1;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return nearest;
}

GridAxes turned(GridAxes axes, int around) {
    const int from = (around + 1) % 3 + 1, to = (around + 2) % 3 + 1;
    for (int& along : axes.along) {
        const int sign = along > 0 ? 1 : -1;
        if (std::abs(along) == from)
            along = sign * to;
        else if (std::abs(along) == to)
            along = -sign * from;
    }
    return axes;
}

GridAxes mirrored(GridAxes axes, int along) {
    for (int& a : axes.along)
        if (std::abs(a) == along + 1) a = -a;
    return axes;
}

Volume withPlacement(const Volume& volume, const std::optional<GridAxes>& axes,
                     const std::optional<GridSpacing>& spacing) {
    const Geometry inFile = volume.inFile.value_or(volume.geometry());
    Geometry geometry = spacing ? withSpacing(volume, inFile, *spacing) : inFile;
    if (axes) {
        if (axes->patient) // whose lengths are millimetres
            geometry = inUnit(geometry, LengthUnit::Millimetre);
        else // and remain so
            geometry.lengthUnit = unitOf(geometry);
        const Vec3 middle = middleOfData(volume), place = geometry.worldFromVoxel(middle);
        geometry.directions = directionsOf(*axes);
        geometry.worldAxes = axes->patient ? WorldAxes::Patient : WorldAxes::File;
        geometry.origin += place - geometry.worldFromVoxel(middle);
    }
    Volume other = volume.withGeometry(geometry);
    other.inFile.reset();
    if (axes || spacing) other.inFile = inFile;
    return other;
}

} // namespace pellucid
