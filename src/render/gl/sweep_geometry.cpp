#include "render/gl/sweep_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

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

Sweep alongAxis(const Geometry& g, int axis, int sign) {
    Sweep sweep;
    sweep.axis = axis;
    sweep.sign = sign;
    const auto [a, b] = lateralAxes(axis);
    sweep.dims = {g.dims[a], g.dims[b], g.dims[axis]};
    sweep.spacing = Vec3(g.spacing[a], g.spacing[b], g.spacing[axis]) / g.d0();
    sweep.reference = sweep.dims.z - 1;
    return sweep;
}

Vec3 qFromVoxel(const Sweep& sweep, const Vec3& voxel) {
    const auto [a, b] = lateralAxes(sweep.axis);
    const double c = voxel[sweep.axis];
    return {voxel[a], voxel[b], sweep.sign > 0 ? c : sweep.dims.z - 1 - c};
}

/// Points where the rays of all voxel centres meet the reference plane, along one lateral axis.
glm::dvec2 extentOnReference(const Sweep& s, int lateral) {
    const double last = s.dims[lateral] - 1;
    double lo = 0, hi = last;
    const auto include = [&](double c) {
        for (const double x : {0.0, last}) {
            double at = 0;
            if (s.perspective)
                at = s.eye[lateral] + (x - s.eye[lateral]) * (s.reference - s.eye.z) / (c - s.eye.z);
            else
                at = x + s.shear[lateral] * (s.reference - c);
            lo = std::min(lo, at);
            hi = std::max(hi, at);
        }
    };
    include(s.firstPlane);
    if (s.pyramid) {
        const double reach = s.reference - s.eye.z;
        lo = std::max(lo, s.eye[lateral] - reach);
        hi = std::min(hi, s.eye[lateral] + reach);
    }
    return {lo, hi};
}

/// Fills in rays and samples; false where no voxel can belong to the sweep.
bool layOut(Sweep& s, const Sampling& sampling) {
    if (s.perspective) {
        s.front = std::max(s.front, s.eye.z);
        s.firstPlane = std::max(0, static_cast<int>(std::floor(s.eye.z)) + 1);
        if (s.firstPlane >= s.dims.z) return false;
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
        s.rays = {s.dims.x, s.dims.y};
    }
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

Sweep orthographicSweep(const Vec3& directionInVoxels, const Geometry& geometry, const Sampling& sampling) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(directionInVoxels[i]) > std::abs(directionInVoxels[axis])) axis = i;
    Sweep sweep = alongAxis(geometry, axis, directionInVoxels[axis] > 0 ? 1 : -1);
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

std::vector<Sweep> makeSweeps(const Camera& camera, const Geometry& geometry, Quality quality) {
    const Sampling sampling = samplingOf(quality);
    const Vec3 fromEye = (geometry.boxCenter() - camera.eye) / geometry.spacing;
    if (camera.projection == Projection::Orthographic)
        return {orthographicSweep(camera.forward() / geometry.spacing, geometry, sampling)};
    if (glm::length(fromEye) > kFarEye) return {orthographicSweep(fromEye, geometry, sampling)};

    std::vector<Sweep> pyramids;
    const Sweep* best = nullptr;
    double bestSlope = kAloneSlope;
    for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {1, -1}) {
            Sweep sweep = alongAxis(geometry, axis, sign);
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
