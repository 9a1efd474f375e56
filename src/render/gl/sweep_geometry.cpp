#include "render/gl/sweep_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/gl/kept_region.h"

namespace pellucid::gl {

namespace {

/// Slope, in voxels, of the flattest ray that one sweep may do alone; beyond it pyramids (slope 1) share the work.
constexpr double kAloneSlope = 1.25;
/// In voxels. The rays of an eye farther off are parallel: over 4096 voxels they diverge by less than 0.2.
constexpr double kFarEye = 1e8;

struct Sampling {
    double piecesPerVoxel; ///< samples per voxel that a ray crosses sideways, besides those on the planes
    double raysPerVoxel;   ///< along each axis
    glm::ivec2 ownPlanes;  ///< see Sweep
    double tolerance;      ///< of T between neighbouring rays, see Sweep
};
// Measured against the reference engine on the 110 first cases of tests/support/random_cases.h: largest RMS 0.0145
// (docs/method.md, "Tolerances": 0.015). Own planes help far more than more rays: what lies between two rays right in
// front of a voxel no interpolation finds. Rays per voxel are whole, so that some stand on the voxel columns.
Sampling samplingOf(Quality quality) {
    if (quality == Quality::High) return {2.5, 2.0, {6, 24}, 0.005};
    return {1.5, 1.0, {4, 16}, 0.04};
}

/// The two other axes, in order.
std::array<int, 2> lateralAxes(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

/// The volume as all sweeps see it.
struct Swept {
    const Geometry& geometry;
    VoxelClipping clipping;
    KeptVoxels kept; ///< what is not cut away
};

Sweep alongAxis(const Swept& swept, int axis, int sign) {
    const Geometry& g = swept.geometry;
    const auto [first, last] = swept.kept;
    Sweep sweep;
    sweep.axis = axis;
    sweep.sign = sign;
    const auto [a, b] = lateralAxes(axis);
    sweep.dims = {g.dims[a], g.dims[b], g.dims[axis]};
    const int farthest = g.dims[axis] - 1;
    sweep.first = {first[a], first[b], sign > 0 ? first[axis] : farthest - last[axis]};
    sweep.last = {last[a], last[b], sign > 0 ? last[axis] : farthest - first[axis]};
    const Mat3 fromQ = sweep.voxelFromQ();
    sweep.worldFromQ = g.worldFromIndex() * fromQ / g.d0();
    const auto inQ = [&](const std::vector<VoxelPlane>& planes) {
        std::vector<VoxelPlane> turned;
        for (const VoxelPlane& plane : planes)
            turned.push_back(
                {glm::transpose(fromQ) * plane.normal, plane.offset - glm::dot(plane.normal, sweep.voxelOffset())});
        return turned;
    };
    sweep.planes = inQ(swept.clipping.cut);
    sweep.faint = inQ(swept.clipping.faint);
    sweep.faintDensity = swept.clipping.density;
    sweep.reference = sweep.last.z;
    sweep.firstPlane = sweep.first.z;
    return sweep;
}

Vec3 qFromVoxel(const Sweep& sweep, const Vec3& voxel) {
    const auto [a, b] = lateralAxes(sweep.axis);
    const double c = voxel[sweep.axis];
    return {voxel[a], voxel[b], sweep.sign > 0 ? c : sweep.dims.z - 1 - c};
}

/// Without what rounding leaves of components that are 0: a view along an axis of a turned grid is one along an axis.
Vec3 withoutRounding(Vec3 direction) {
    const Vec3 size = glm::abs(direction);
    const double least = 1e-14 * std::max(size.x, std::max(size.y, size.z));
    for (int a = 0; a < 3; ++a)
        if (size[a] <= least) direction[a] = 0;
    return direction;
}

/// Points where the rays of all voxel centres meet the reference plane, along one lateral axis.
glm::dvec2 extentOnReference(const Sweep& s, int lateral) {
    const double first = s.first[lateral], last = s.last[lateral];
    double lo = first, hi = last;
    for (const double x : {first, last}) { // of the first plane; those between lie between
        const double at =
            s.perspective ? s.eye[lateral] + (x - s.eye[lateral]) * (s.reference - s.eye.z) / (s.firstPlane - s.eye.z)
                          : x + s.shear[lateral] * (s.reference - s.firstPlane);
        lo = std::min(lo, at);
        hi = std::max(hi, at);
    }
    if (s.pyramid) {
        const double reach = s.reference - s.eye.z;
        lo = std::max(lo, s.eye[lateral] - reach);
        hi = std::min(hi, s.eye[lateral] + reach);
    }
    return {lo, hi};
}

/// Fills in rays and samples; false where no voxel can belong to the sweep.
bool layOut(Sweep& s, const Sampling& sampling) {
    if (!s.planes.empty()) s.front = std::max(s.front, s.first.z - 1.0);
    if (s.perspective) {
        s.front = std::max(s.front, s.eye.z);
        // As doubles: the eye may be farther off than integers reach.
        const double planeBehindEye = std::floor(s.eye.z) + 1;
        if (planeBehindEye > s.last.z) return false;
        s.firstPlane = static_cast<int>(std::max(static_cast<double>(s.first.z), planeBehindEye));
    }
    s.raysPerVoxel = sampling.raysPerVoxel;
    s.tolerance = sampling.tolerance;
    s.ownPlanes = sampling.ownPlanes;
    double crossed = 0; // voxels sideways per plane, by the flattest ray
    for (int lateral = 0; lateral < 2; ++lateral) {
        const glm::dvec2 extent = extentOnReference(s, lateral);
        if (extent.x > extent.y) return false;
        s.grid[lateral] = std::floor(extent.x + 1e-6);
        s.rays[lateral] = static_cast<int>(std::ceil((extent.y - s.grid[lateral]) * s.raysPerVoxel - 1e-6)) + 1;
        double steepest = std::abs(s.shear[lateral]);
        if (s.perspective)
            steepest = std::max(std::abs(extent.x - s.eye[lateral]), std::abs(extent.y - s.eye[lateral])) /
                       (s.reference - s.eye.z);
        // An eye on the last plane would give infinite slopes; pyramids have none beyond their edges.
        crossed += std::min(steepest, kAloneSlope);
    }
    if (crossed == 0) { // every ray is a voxel's own line
        s.ownPlanes = {1, 1};
        s.raysPerVoxel = 1;
        s.rays = {s.last.x - s.first.x + 1, s.last.y - s.first.y + 1};
    }
    // The point d0/2 in front of a voxel must not lie in front of the planes that its own line is followed through:
    // voxel planes are the closer together the more the grid is sheared.
    const Vec3 across = glm::cross(s.worldFromQ[0], s.worldFromQ[1]);
    const double apart = std::abs(glm::dot(s.worldFromQ[2], across)) / glm::length(across);
    s.ownPlanes = glm::max(s.ownPlanes, static_cast<int>(std::ceil(0.5 / apart - 1e-6)));
    s.pieces = static_cast<int>(std::ceil(1 + sampling.piecesPerVoxel * crossed - 1e-6));
    return true;
}

/// Largest slope, in voxels, of the lines from the eye to the corners of the box; infinite where the box reaches beside
/// the eye.
double flattestSlope(const Sweep& s) {
    const double ahead = -0.5 - s.eye.z;
    if (ahead <= 0) return std::numeric_limits<double>::infinity();
    double slope = 0;
    for (int lateral = 0; lateral < 2; ++lateral)
        for (const double x : {-0.5, s.dims[lateral] - 0.5})
            slope = std::max(slope, std::abs(x - s.eye[lateral]) / ahead);
    return slope;
}

Sweep orthographicSweep(const Vec3& directionInVoxels, const Swept& swept, const Sampling& sampling) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(directionInVoxels[i]) > std::abs(directionInVoxels[axis])) axis = i;
    Sweep sweep = alongAxis(swept, axis, directionInVoxels[axis] > 0 ? 1 : -1);
    sweep.perspective = false;
    const auto [a, b] = lateralAxes(axis);
    sweep.shear = glm::dvec2(directionInVoxels[a], directionInVoxels[b]) / std::abs(directionInVoxels[axis]);
    layOut(sweep, sampling);
    return sweep;
}

} // namespace

glm::dmat3 Sweep::voxelFromQ() const {
    const auto [a, b] = lateralAxes(axis);
    glm::dmat3 m(0.0);
    m[0][a] = 1;
    m[1][b] = 1;
    m[2][axis] = sign;
    return m;
}

Vec3 Sweep::voxelOffset() const {
    Vec3 offset(0);
    if (sign < 0) offset[axis] = dims.z - 1;
    return offset;
}

Sweep::Strides Sweep::strides() const {
    const auto [a, b] = lateralAxes(axis);
    Int3 volume;
    volume[a] = dims.x;
    volume[b] = dims.y;
    volume[axis] = dims.z;
    const std::array<std::ptrdiff_t, 3> stride{1, volume.x, static_cast<std::ptrdiff_t>(volume.x) * volume.y};
    const auto of = [&](int which) { return stride[static_cast<std::size_t>(which)]; };
    return {sign > 0 ? 0 : of(axis) * (dims.z - 1), of(a), of(b), sign * of(axis)};
}

std::vector<Sweep> makeSweeps(const View& view, const Geometry& geometry, Quality quality) {
    const Sampling sampling = samplingOf(quality);
    const Camera& camera = view.camera;
    Swept swept{geometry, clippingInVoxels(view.clipping, geometry), {}};
    const auto kept = keptVoxels(geometry, swept.clipping.cut);
    if (!kept) return {};
    swept.kept = *kept;
    const Mat3 indexFromWorld = geometry.indexFromWorld();
    const Vec3 fromEye = indexFromWorld * (geometry.boxCenter() - camera.eye);
    if (camera.projection == Projection::Orthographic)
        return {orthographicSweep(withoutRounding(indexFromWorld * camera.forward()), swept, sampling)};
    if (glm::length(fromEye) > kFarEye) return {orthographicSweep(fromEye, swept, sampling)};

    std::vector<Sweep> pyramids;
    const Sweep* best = nullptr;
    double bestSlope = kAloneSlope;
    for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {1, -1}) {
            Sweep sweep = alongAxis(swept, axis, sign);
            sweep.eye = qFromVoxel(sweep, geometry.voxelFromWorld(camera.eye));
            sweep.pyramid = true;
            pyramids.push_back(sweep);
        }
    for (const Sweep& sweep : pyramids)
        if (const double slope = flattestSlope(sweep); slope <= bestSlope) {
            best = &sweep;
            bestSlope = slope;
        }
    if (best != nullptr) {
        Sweep alone = *best;
        alone.pyramid = false;
        layOut(alone, sampling);
        return {alone};
    }
    std::vector<Sweep> sweeps;
    for (Sweep& sweep : pyramids)
        if (layOut(sweep, sampling)) sweeps.push_back(sweep);
    return sweeps;
}

} // namespace pellucid::gl
