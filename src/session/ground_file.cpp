#include "session/ground_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "tf/terrain.h"
#include "volume/grid.h"

namespace pellucid {

namespace {

/// The highest that lies in the box counts as meant in its units from this part of its height on.
constexpr double kLowestInBox = 0.01;
/// Of the height of the box, where heights are of another unit.
constexpr double kRise = 0.1;

/// The axes of the file that a height field lies along: the two others have one layer.
std::pair<int, int> axesOf(const Int3& dims, const std::string& path) {
    const int across = dims.z == 1 ? 2 : dims.y == 1 ? 1 : dims.x == 1 ? 0 : -1;
    if (across < 0)
        throw FileError("a ground is one layer of heights, this has " + dimsText(dims) + " voxels", path,
                        "give a file with one layer");
    const std::pair<int, int> axes{across == 0 ? 1 : 0, across == 2 ? 1 : 2};
    if (dims[axes.first] < 2 || dims[axes.second] < 2)
        throw FileError("a ground needs at least 2 x 2 heights", path, "give a file with a layer of heights");
    return axes;
}

/// World units per unit of height.
double scaleOf(const ValueRange& heights, double boxHeight) {
    const double most = std::max(std::abs(heights.lo), std::abs(heights.hi));
    if (most == 0) return 1;
    return most <= boxHeight && most >= kLowestInBox * boxHeight ? 1 : kRise * boxHeight / most;
}

} // namespace

VolumeSource sourceOf(const GroundView& view) {
    VolumeSource source;
    source.path = view.path;
    source.raw = view.raw;
    source.missing = view.missing;
    source.then = {"a ground of", sizeof(float)};
    return source;
}

Ground readGround(const GroundView& view, const Geometry& box, const JobControl& job) {
    const Volume file = loadVolume(sourceOf(view), job);
    const auto [alongX, alongY] = axesOf(file.dims(), view.path);
    if (!file.hasValidVoxels())
        throw FileError("no height is a number", view.path, "give a file with a layer of heights");

    Ground ground;
    ground.nx = file.dims()[alongX];
    ground.ny = file.dims()[alongY];
    ground.heights.resize(file.size()); // one layer: the order of the file
    // Of a negative scale they are depths.
    const bool depths = view.scale.value_or(1) < 0;
    for (std::size_t i = 0; i < file.size(); ++i)
        ground.heights[i] = file.isValid(i) ? static_cast<float>(depths ? -file.value(i) : file.value(i))
                                            : std::numeric_limits<float>::quiet_NaN();
    ValueRange heights = file.dataRange();
    if (depths) heights = {-heights.hi, -heights.lo};

    const Vec3 extent = box.spacing * Vec3(box.dims);
    ground.origin = box.corner(0);
    ground.stepX = box.directions[0] * (extent.x / (ground.nx - 1));
    ground.stepY = box.directions[1] * (extent.y / (ground.ny - 1));
    ground.up = box.directions[2] * std::abs(view.scale.value_or(scaleOf(heights, extent.z)));
    dressGround(ground, view);
    return ground;
}

void dressGround(Ground& ground, const GroundView& view) {
    groundColors(view.colorMap); // an unknown one is told now
    ground.colorMap = view.colorMap;
    ground.relief = std::clamp(view.relief, 0.0, 1.0);
    ground.lo = std::numeric_limits<double>::infinity();
    ground.hi = -ground.lo;
    for (const float height : ground.heights)
        if (std::isfinite(height)) {
            ground.lo = std::min(ground.lo, static_cast<double>(height));
            ground.hi = std::max(ground.hi, static_cast<double>(height));
        }
    // Below 0 it is sea, however deep.
    if (ground.colorMap == kTerrainMap && ground.lo < 0 && ground.hi > 0) ground.lo = 0;
    if (!(ground.lo < ground.hi)) ground.hi = ground.lo + 1;
}

} // namespace pellucid
