#include "render/drawn_part.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/camera_motion.h"
#include "render/drawn_cells.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

/// Without the cells that have fewer than six others around them; all of them where none has more.
Grid<std::uint8_t> withoutSpecks(const Grid<std::uint8_t>& drawn, const JobControl& job) {
    constexpr int kFewest = 6;
    const Int3 dims = drawn.dims();
    Grid<std::uint8_t> kept(dims);
    forEachPlace(dims, job, [&](const Int3& cell, std::size_t at) {
        if (!drawn[at]) return;
        const Int3 lo = glm::max(cell - 1, Int3(0)), hi = glm::min(cell + 1, dims - 1);
        int around = -1;
        for (int k = lo.z; k <= hi.z; ++k)
            for (int j = lo.y; j <= hi.y; ++j)
                for (int i = lo.x; i <= hi.x; ++i) around += drawn.at(i, j, k);
        kept[at] = around >= kFewest;
    });
    return std::ranges::any_of(kept, [](std::uint8_t k) { return k != 0; }) ? kept : drawn;
}

/// The first and the last cell of a row along x; first = dims.x where there is none.
struct RowEnds {
    int first, last;
};
RowEnds endsOfRow(const Grid<std::uint8_t>& drawn, int j, int k) {
    const int nx = drawn.dims().x;
    RowEnds ends{0, nx - 1};
    while (ends.first < nx && !drawn.at(ends.first, j, k)) ++ends.first;
    while (ends.last > ends.first && !drawn.at(ends.last, j, k)) --ends.last;
    return ends;
}

/// Calls use(j, k, ends) for the rows that have any.
template <class Use>
void forEachRow(const Grid<std::uint8_t>& drawn, const Use& use) {
    for (int k = 0; k < drawn.dims().z; ++k)
        for (int j = 0; j < drawn.dims().y; ++j)
            if (const RowEnds ends = endsOfRow(drawn, j, k); ends.first < drawn.dims().x) use(j, k, ends);
}

/// A closer grid over what is drawn, with a cell of room; the same grid where that would be no closer.
CellGrid closerGrid(const CellGrid& grid, const Grid<std::uint8_t>& drawn) {
    Int3 first = grid.cells, last(-1);
    forEachRow(drawn, [&](int j, int k, const RowEnds& ends) {
        first = glm::min(first, Int3(ends.first, j, k));
        last = glm::max(last, Int3(ends.last, j, k));
    });
    if (last.x < 0) return grid;
    Int3 lo, hi;
    for (int a = 0; a < 3; ++a) {
        lo[a] = grid.begin(a, std::max(first[a] - 1, 0));
        hi[a] = grid.begin(a, std::min(last[a] + 2, grid.cells[a]));
    }
    return {lo, hi};
}

/// Whether `closer` has cells of at most two thirds of the size.
bool isWorthIt(const CellGrid& grid, const CellGrid& closer) {
    const auto perCell = [](const CellGrid& g) {
        return static_cast<double>(voxelCount(g.hi - g.lo)) / static_cast<double>(voxelCount(g.cells));
    };
    return perCell(closer) < 0.3 * perCell(grid);
}

double halfTangent(double fovY) { return std::tan(0.5 * fovY * std::numbers::pi / 180); }

/// Axes of a camera: x to the right, y up, z away from the eye.
struct ViewAxes {
    Vec3 right, up, forward;

    explicit ViewAxes(const Camera& camera) : right(camera.right()), up(camera.trueUp()), forward(camera.forward()) {}
    Vec3 fromWorld(const Vec3& p) const { return {glm::dot(p, right), glm::dot(p, up), glm::dot(p, forward)}; }
    Vec3 toWorld(const Vec3& p) const { return p.x * right + p.y * up + p.z * forward; }
};

/// Where an eye has to be, in the axes of the view, for all points to lie within a pyramid of half tangent t, as near
/// as can be and with the points in the middle: lines of slope ±t that touch them from either side meet there.
Vec3 eyeOfPyramid(const std::vector<Vec3>& points, double t) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double left = kFar, right = -kFar, bottom = kFar, top = -kFar;
    for (const Vec3& p : points) {
        right = std::max(right, p.x - t * p.z);
        left = std::min(left, p.x + t * p.z);
        top = std::max(top, p.y - t * p.z);
        bottom = std::min(bottom, p.y + t * p.z);
    }
    return {(left + right) / 2, (bottom + top) / 2, std::min(left - right, bottom - top) / (2 * t)};
}

/// The half tangent of the widest angle, up to the normal one, from which the eye that fits `points` is outside.
double widestTangent(const std::vector<Vec3>& points, const std::function<bool(const Vec3& eye)>& isOutside) {
    constexpr double kSmallestFovY = 0.5; // degrees
    double wide = halfTangent(kNormalFovY), narrow = halfTangent(kSmallestFovY);
    const auto fits = [&](double t) { return isOutside(eyeOfPyramid(points, kFilledByFit * t)); };
    if (fits(wide)) return wide;
    for (int i = 0; i < 20; ++i) {
        const double middle = std::sqrt(narrow * wide);
        (fits(middle) ? narrow : wide) = middle;
    }
    return narrow;
}

} // namespace

DrawnPart drawnPart(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, const JobControl& job) {
    const Geometry& geometry = volume.geometry();
    const std::vector<VoxelPlane> planes = planesInVoxels(clipping, geometry);
    CellGrid grid(Int3(0), volume.dims());
    const auto look = [&] { return withoutSpecks(drawnCells(volume, tf, planes, grid, job), job); };
    Grid<std::uint8_t> drawn = look();
    while (!grid.isFine()) {
        const CellGrid closer = closerGrid(grid, drawn);
        if (!isWorthIt(grid, closer)) break;
        grid = closer;
        drawn = look();
    }
    DrawnPart part;
    forEachRow(drawn, [&](int j, int k, const RowEnds& ends) {
        const Vec3 lo(grid.begin(0, ends.first), grid.begin(1, j), grid.begin(2, k));
        const Vec3 hi(grid.begin(0, ends.last + 1), grid.begin(1, j + 1), grid.begin(2, k + 1));
        for (int corner = 0; corner < 8; ++corner)
            part.push_back(geometry.worldFromVoxel(
                Vec3(corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z) - 0.5));
    });
    return part;
}

Camera fittedTo(const DrawnPart& part, const Camera& camera, const Geometry& geometry) {
    if (part.empty()) return fitted(camera, geometry);
    const ViewAxes axes(camera);
    std::vector<Vec3> points;
    points.reserve(part.size());
    std::ranges::transform(part, std::back_inserter(points), [&](const Vec3& p) { return axes.fromWorld(p); });
    Vec3 lo = points.front(), hi = points.front();
    for (const Vec3& p : points) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    Camera c = camera;
    c.up = axes.up;
    const double outside = 1.02 * geometry.radius(); // as near as zoomed() comes
    const auto isOutside = [&](const Vec3& eye) {
        return glm::length(axes.toWorld(eye) - geometry.boxCenter()) >= outside;
    };
    Vec3 eye = (lo + hi) / 2.0;
    bool isFar = false;
    if (c.projection == Projection::Perspective) {
        const double t = widestTangent(points, isOutside);
        c.fovY = 2 * std::atan(t) * 180 / std::numbers::pi;
        eye = eyeOfPyramid(points, kFilledByFit * t);
        isFar = isOutside(eye);
    } else {
        c.height = std::max(hi.x - lo.x, hi.y - lo.y) / kFilledByFit;
    }
    c.center = axes.toWorld({eye.x, eye.y, (lo.z + hi.z) / 2});
    c.eye =
        isFar ? axes.toWorld(eye) : c.center - (outside + glm::length(c.center - geometry.boxCenter())) * axes.forward;
    return c;
}

} // namespace pellucid
