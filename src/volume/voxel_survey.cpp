#include "volume/voxel_survey.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "volume/fetched_values.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::uint32_t hashOf(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::uint32_t h = a * 0x9e3779b1u ^ b * 0x85ebca77u ^ c * 0xc2b2ae3du;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

/// The voxels that trilinear interpolation looks at, and their weights: body(voxel, weight).
template <class Body>
void forCorners(const Vec3& p, const Body& body) {
    const Vec3 floor = glm::floor(p);
    const Int3 v(floor);
    const Vec3 f = p - floor;
    for (int corner = 0; corner < 8; ++corner) {
        const Int3 d(corner & 1, corner >> 1 & 1, corner >> 2);
        const double weight = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
        if (weight > 0) body(v + d, weight);
    }
}

/// Values of voxels: NaN where invalid or outside.
template <class Values>
class Reader {
public:
    Reader(const Int3& dims, const Values& values) : m_values(values), m_dims(dims) {}

    bool isInside(const Int3& v) const {
        return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < m_dims.x && v.y < m_dims.y && v.z < m_dims.z;
    }
    double at(const Int3& v) const { return isInside(v) ? m_values(index(v)) : kNaN; }
    std::size_t index(const Int3& v) const { return voxelIndex(m_dims, v.x, v.y, v.z); }
    /// Trilinear; NaN where a corner with weight is invalid or outside.
    double at(const Vec3& p) const {
        double sum = 0;
        forCorners(p, [&](const Int3& v, double weight) { sum += weight * at(v); });
        return sum;
    }

private:
    const Values& m_values;
    Int3 m_dims;
};

/// Those that differences() looks at.
template <class Ask>
void askAround(const Int3& v, const Ask& ask) {
    ask(v);
    for (int a = 0; a < 3; ++a) {
        Int3 step(0);
        step[a] = 1;
        ask(v - step);
        ask(v + step);
    }
}

/// Central differences per voxel step; one-sided where a neighbour is missing, 0 where both are.
template <class Values>
Vec3 differences(const Reader<Values>& read, const Int3& v, double value) {
    Vec3 d(0);
    for (int a = 0; a < 3; ++a) {
        Int3 step(0);
        step[a] = 1;
        const double before = read.at(v - step), after = read.at(v + step);
        if (!std::isnan(before) && !std::isnan(after))
            d[a] = after / 2 - before / 2;
        else if (!std::isnan(after))
            d[a] = after - value;
        else if (!std::isnan(before))
            d[a] = value - before;
    }
    return d;
}

} // namespace

bool VoxelSurvey::onFace(std::size_t i) const {
    const Int3 c = voxelAt(dims, i);
    for (int a = 0; a < 3; ++a)
        if (dims[a] > 1 && (c[a] == 0 || c[a] == dims[a] - 1)) return true;
    return false;
}

VoxelSurvey surveyVoxels(const Volume& volume, const JobControl& job) {
    const Int3 full = volume.dims();
    VoxelSurvey survey;
    survey.dims = full;
    const double factor = std::cbrt(static_cast<double>(volume.size()) / static_cast<double>(VoxelSurvey::kMostCells));
    if (factor > 1) // an axis shorter than the factor keeps one cell
        for (int a = 0; a < 3; ++a) survey.dims[a] = std::clamp(static_cast<int>(full[a] / factor), 1, full[a]);
    const double d0 = volume.geometry().d0();
    for (int a = 0; a < 3; ++a) survey.pathPerCell[a] = volume.geometry().spacing[a] / d0 * full[a] / survey.dims[a];

    const std::size_t cells = voxelCount(survey.dims);
    survey.values.resize(cells);
    survey.gradients.resize(cells);
    survey.indices.resize(cells);
    // Columns of the gradient are per d0 along each axis; oblique axes make this an approximation that ranks alike.
    const Vec3 perD0 = Vec3(d0) / volume.geometry().spacing;
    const auto pick = [&](int a, int cell, std::uint32_t random) {
        const int n = survey.dims[a];
        if (cell == 0 && n > 1) return 0;
        if (cell == n - 1 && n > 1) return full[a] - 1;
        const auto begin = static_cast<int>(static_cast<std::int64_t>(cell) * full[a] / n);
        const auto end = static_cast<int>(static_cast<std::int64_t>(cell + 1) * full[a] / n);
        return begin + static_cast<int>(random % static_cast<std::uint32_t>(end - begin));
    };
    const auto picked = [&](const Int3& cell) {
        const std::uint32_t h = hashOf(static_cast<std::uint32_t>(cell.x), static_cast<std::uint32_t>(cell.y),
                                       static_cast<std::uint32_t>(cell.z));
        return Int3(pick(0, cell.x, h), pick(1, cell.y, h >> 10), pick(2, cell.z, h >> 20));
    };
    const auto wanted = [&](const auto& ask) {
        for (std::size_t i = 0; i < cells; ++i) askAround(picked(voxelAt(survey.dims, i)), ask);
    };
    withValues(volume, wanted, [&](const auto& values) {
        const Reader read(full, values);
        forEachPlace(survey.dims, job, [&](const Int3& cell, std::size_t at) {
            const Int3 v = picked(cell);
            const double value = read.at(v);
            survey.indices[at] = read.index(v);
            survey.values[at] = value;
            survey.gradients[at] = std::isnan(value) ? kNaN : glm::length(differences(read, v, value) * perD0);
        });
    });
    return survey;
}

std::vector<BoundaryEnds> boundaryEnds(const Volume& volume, const VoxelSurvey& survey, double least, double flat,
                                       const JobControl& job) {
    std::vector<std::size_t> steep;
    for (std::size_t i = 0; i < survey.size(); ++i)
        if (survey.gradients[i] > least) steep.push_back(survey.indices[i]);
    const std::size_t count = std::min(steep.size(), kMostBoundaries);
    std::vector<BoundaryEnds> ends(count);
    const Vec3 perD0 = Vec3(volume.geometry().d0()) / volume.geometry().spacing;
    constexpr std::size_t kPiece = 1024;
    constexpr int kMostSteps = 8;
    const auto voxelOf = [&](std::size_t n) { return voxelAt(volume.dims(), steep[n * steep.size() / count]); };
    const auto inPieces = [&](const auto& body) {
        parallelFor((count + kPiece - 1) / kPiece, [&](std::size_t piece) {
            job.throwIfStopped();
            for (std::size_t n = piece * kPiece; n < std::min(count, (piece + 1) * kPiece); ++n) body(n);
        });
    };

    // Where each path begins, and which way it goes.
    std::vector<double> begins(count);
    std::vector<Vec3> steps(count); // one d0, in voxels
    const auto around = [&](const auto& ask) {
        for (std::size_t n = 0; n < count; ++n) askAround(voxelOf(n), ask);
    };
    withValues(volume, around, [&](const auto& values) {
        const Reader read(volume.dims(), values);
        inPieces([&](std::size_t n) {
            begins[n] = read.at(voxelOf(n));
            const Vec3 gradient = differences(read, voxelOf(n), begins[n]) * perD0;
            steps[n] = gradient / glm::length(gradient) * perD0;
        });
    });
    // Along it, to either side.
    const auto alongPaths = [&](const auto& ask) {
        for (std::size_t n = 0; n < count; ++n)
            for (int s = -kMostSteps; s <= kMostSteps; ++s)
                if (s != 0)
                    forCorners(Vec3(voxelOf(n)) + static_cast<double>(s) * steps[n],
                               [&](const Int3& v, double) { ask(v); });
    };
    withValues(volume, alongPaths, [&](const auto& values) {
        const Reader read(volume.dims(), values);
        inPieces([&](std::size_t n) {
            const auto walk = [&](double sign) {
                double last = begins[n];
                for (int s = 1; s <= kMostSteps; ++s) {
                    const double next = read.at(Vec3(voxelOf(n)) + sign * s * steps[n]);
                    if (std::isnan(next) || sign * (next - last) <= 0) break;
                    const double change = sign * (next - last);
                    last = next;
                    if (change < flat) break;
                }
                return last;
            };
            ends[n] = {walk(-1), walk(1)};
        });
    });
    return ends;
}

} // namespace pellucid
