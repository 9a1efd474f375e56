#include "render/cradle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/view_direction.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

/// Calls use(cell, index) for the cells no farther than `reach` from one along any axis, itself included.
template <class Use>
void forEachAround(const Int3& cell, int reach, const Int3& dims, const Use& use) {
    const Int3 lo = glm::max(cell - reach, Int3(0)), hi = glm::min(cell + reach, dims - 1);
    for (int k = lo.z; k <= hi.z; ++k)
        for (int j = lo.y; j <= hi.y; ++j)
            for (int i = lo.x; i <= hi.x; ++i) use(Int3(i, j, k), voxelIndex(dims, i, j, k));
}

/// Cells that are not 0, in groups: those of a group are linked by steps of at most `reach`.
std::vector<std::vector<std::size_t>> groupsOf(const Grid<std::uint8_t>& cells, int reach) {
    const Int3 dims = cells.dims();
    std::vector<std::uint8_t> left(cells.begin(), cells.end());
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t start = 0; start < left.size(); ++start) {
        if (!left[start]) continue;
        left[start] = 0;
        std::vector<std::size_t> group{start};
        for (std::size_t n = 0; n < group.size(); ++n)
            forEachAround(voxelAt(dims, group[n]), reach, dims, [&](const Int3&, std::size_t at) {
                if (!left[at]) return;
                left[at] = 0;
                group.push_back(at);
            });
        groups.push_back(std::move(group));
    }
    return groups;
}

/// What is drawn, as bodies and the thin rest.
struct Parts {
    std::size_t bodySize = 0;               ///< cells
    std::vector<std::size_t> surface, thin; ///< of the bodies those that others do not surround
};

/// A group of cells is a body where a fifth of them or more lie deep: three quarters of the cells around are drawn.
Parts partsOf(const Grid<std::uint8_t>& drawn) {
    constexpr double kDeep = 0.2;
    constexpr int kAround = 20, kAll = 27;
    Parts parts;
    for (const std::vector<std::size_t>& group : groupsOf(drawn, 1)) {
        std::size_t deep = 0;
        std::vector<std::size_t> surface;
        for (const std::size_t cell : group) {
            int around = 0;
            forEachAround(voxelAt(drawn.dims(), cell), 1, drawn.dims(),
                          [&](const Int3&, std::size_t at) { around += drawn[at]; });
            deep += around >= kAround;
            if (around < kAll) surface.push_back(cell);
        }
        if (static_cast<double>(deep) < kDeep * static_cast<double>(group.size())) {
            parts.thin.insert(parts.thin.end(), group.begin(), group.end());
        } else {
            parts.bodySize += group.size();
            parts.surface.insert(parts.surface.end(), surface.begin(), surface.end());
        }
    }
    return parts;
}

/// Planes that touch a body, chosen one after the other so that each cuts off as many of the thin cells as it can.
class Planes {
public:
    Planes(std::span<const Vec3> body, double room) {
        for (const Vec3& normal : spreadDirections(300)) {
            double most = -std::numeric_limits<double>::infinity();
            for (const Vec3& p : body) most = std::max(most, glm::dot(normal, p));
            m_all.push_back({normal, most + room});
        }
    }

    /// Marks in `gone` what lies beyond the chosen ones.
    std::vector<ClipPlane> chosenFor(std::span<const Vec3> thin, std::vector<std::uint8_t>& gone) const {
        std::vector<ClipPlane> chosen;
        gone.assign(thin.size(), 0);
        while (chosen.size() < kMostClipPlanes) {
            const ClipPlane* best = nullptr;
            std::size_t most = thin.size() / 200; // fewer are not worth a plane
            for (const ClipPlane& plane : m_all) {
                std::size_t count = 0;
                for (std::size_t i = 0; i < thin.size(); ++i)
                    count += !gone[i] && glm::dot(plane.normal, thin[i]) > plane.offset;
                if (count <= most) continue;
                most = count;
                best = &plane;
            }
            if (best == nullptr) break;
            chosen.push_back(*best);
            for (std::size_t i = 0; i < thin.size(); ++i)
                if (glm::dot(best->normal, thin[i]) > best->offset) gone[i] = 1;
        }
        return chosen;
    }

private:
    std::vector<ClipPlane> m_all;
};

/// The cells of the groups that lie in nearly all layers across an axis, at both borders too, and reach over half of
/// the box across it together; empty where there are none.
std::vector<std::size_t> runningAlong(int axis, const std::vector<std::vector<std::size_t>>& groups, const Int3& dims) {
    constexpr double kThrough = 0.85, kWide = 0.5;
    std::vector<std::size_t> all;
    Int3 lo = dims, hi(-1);
    for (const std::vector<std::size_t>& group : groups) {
        std::vector<std::uint8_t> layers(static_cast<std::size_t>(dims[axis]), 0);
        Int3 first = dims, last(-1);
        for (const std::size_t cell : group) {
            const Int3 at = voxelAt(dims, cell);
            layers[static_cast<std::size_t>(at[axis])] = 1;
            first = glm::min(first, at);
            last = glm::max(last, at);
        }
        const auto filled = static_cast<double>(std::ranges::count(layers, 1));
        if (first[axis] > 1 || last[axis] < dims[axis] - 2 || filled < kThrough * dims[axis]) continue;
        all.insert(all.end(), group.begin(), group.end());
        lo = glm::min(lo, first);
        hi = glm::max(hi, last);
    }
    for (int a = 0; a < 3; ++a)
        if (a != axis && hi[a] - lo[a] + 1 >= kWide * dims[a]) return all;
    return {};
}

} // namespace

std::optional<Holder> findCradle(const Geometry& geometry, const CellGrid& grid, const Grid<std::uint8_t>& drawn,
                                 const JobControl& job) {
    constexpr double kLeast = 0.003, kMost = 0.4; // of the cells of the body
    const Int3 dims = grid.cells;
    const Parts parts = partsOf(drawn);
    job.throwIfStopped();
    const auto whole = static_cast<double>(parts.bodySize);
    if (parts.bodySize == 0 || static_cast<double>(parts.thin.size()) < kLeast * whole) return {};
    const auto places = [&](const std::vector<std::size_t>& cells) {
        std::vector<Vec3> points;
        for (const std::size_t cell : cells)
            points.push_back(geometry.worldFromVoxel(Vec3(grid.voxelIn(voxelAt(dims, cell)))));
        return points;
    };
    // A cell stands for what lies up to half of its diagonal around it.
    const Vec3 cell = Vec3(geometry.dims) / Vec3(dims) * geometry.spacing;
    const std::vector<Vec3> body = places(parts.surface), thin = places(parts.thin);
    std::vector<std::uint8_t> gone;
    Holder holder;
    holder.without.planes = Planes(body, 0.5 * glm::length(cell)).chosenFor(thin, gone);

    Grid<std::uint8_t> beyond(dims);
    for (std::size_t i = 0; i < gone.size(); ++i) beyond[parts.thin[i]] = gone[i];
    const auto groups = groupsOf(beyond, 2);
    std::vector<std::size_t> cells;
    for (holder.along = 0; holder.along < 3; ++holder.along)
        if (cells = runningAlong(holder.along, groups, dims); !cells.empty()) break;
    const auto size = static_cast<double>(cells.size());
    if (size < kLeast * whole || size > kMost * whole) return {};

    const auto middle = [](const std::vector<Vec3>& points) {
        Vec3 sum(0);
        for (const Vec3& p : points) sum += p;
        return sum / static_cast<double>(points.size());
    };
    const Vec3 apart = middle(places(cells)) - middle(body);
    if (glm::length(apart) < glm::length(cell)) return {}; // it lies all around
    holder.toward = glm::normalize(apart);
    double most = -1;
    for (int a = 0; a < 3; ++a) {
        const double along = glm::dot(holder.toward, geometry.directions[a]);
        if (a == holder.along || std::abs(along) <= most) continue;
        most = std::abs(along);
        holder.axis = a;
        holder.isHigh = along > 0;
    }
    return holder;
}

} // namespace pellucid
