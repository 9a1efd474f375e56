#include "render/holder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/cradle.h"
#include "render/drawn_cells.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

/// What is drawn, looked at along one axis of the grid: p and q are the other two.
class CrossSection {
public:
    CrossSection(const Grid<std::uint8_t>& drawn, int along)
        : m_drawn(drawn), m_along(along), m_p((along + 1) % 3), m_q((along + 2) % 3),
          m_runs(static_cast<std::size_t>(sizeOfP()) * static_cast<std::size_t>(sizeOfQ())), m_rest(m_runs.size(), 0) {
        const int n = drawn.dims()[along];
        for (int q = 0; q < sizeOfQ(); ++q)
            for (int p = 0; p < sizeOfP(); ++p) {
                const int count = cellsAt(p, q);
                m_all += count;
                if (count < kThrough * n || !touchesBothEnds(p, q)) {
                    m_rest[index(p, q)] = count;
                    continue;
                }
                m_runs[index(p, q)] = 1;
                m_cells += count;
                ++m_area;
            }
        takeRims();
    }

    int axisOfP() const { return m_p; }
    int axisOfQ() const { return m_q; }
    int sizeOfP() const { return m_drawn.dims()[m_p]; }
    int sizeOfQ() const { return m_drawn.dims()[m_q]; }
    bool isHolder(int p, int q) const { return m_runs[index(p, q)] != 0; }
    int rest(int p, int q) const { return m_rest[index(p, q)]; } ///< cells of the object there
    int area() const { return m_area; }                          ///< of the holder's cross-section
    double restOfAll() const { return m_all > 0 ? 1 - static_cast<double>(m_cells) / m_all : 0; }
    int restCells() const { return m_all - m_cells; }

    /// Cells of the rest in the two end layers.
    int restInEnds() const {
        int count = 0;
        for (int q = 0; q < sizeOfQ(); ++q)
            for (int p = 0; p < sizeOfP(); ++p)
                if (rest(p, q) > 0) count += at(p, q, 0) + at(p, q, m_drawn.dims()[m_along] - 1);
        return count;
    }

private:
    static constexpr double kThrough = 0.85, kRim = 0.25; // of the way from border to border

    /// What is beside the holder's columns, and drawn for much of their length, is its surface, where cells hold two
    /// things.
    void takeRims() {
        std::vector<std::size_t> rims;
        for (int q = 0; q < sizeOfQ(); ++q)
            for (int p = 0; p < sizeOfP(); ++p)
                if (rest(p, q) >= kRim * m_drawn.dims()[m_along] && isBesideHolder(p, q)) rims.push_back(index(p, q));
        for (const std::size_t at : rims) {
            m_cells += m_rest[at];
            m_rest[at] = 0;
        }
    }
    bool isBesideHolder(int p, int q) const {
        for (int y = std::max(q - 1, 0); y <= std::min(q + 1, sizeOfQ() - 1); ++y)
            for (int x = std::max(p - 1, 0); x <= std::min(p + 1, sizeOfP() - 1); ++x)
                if (isHolder(x, y)) return true;
        return false;
    }

    std::size_t index(int p, int q) const {
        return static_cast<std::size_t>(p) + static_cast<std::size_t>(q) * static_cast<std::size_t>(sizeOfP());
    }
    int at(int p, int q, int a) const {
        Int3 cell;
        cell[m_along] = a;
        cell[m_p] = p;
        cell[m_q] = q;
        return m_drawn.at(cell.x, cell.y, cell.z);
    }
    int cellsAt(int p, int q) const {
        int count = 0;
        for (int a = 0; a < m_drawn.dims()[m_along]; ++a) count += at(p, q, a);
        return count;
    }
    bool touchesBothEnds(int p, int q) const {
        const int n = m_drawn.dims()[m_along];
        return (at(p, q, 0) || at(p, q, 1)) && (at(p, q, n - 1) || at(p, q, n - 2));
    }

    const Grid<std::uint8_t>& m_drawn;
    int m_along, m_p, m_q;
    std::vector<std::uint8_t> m_runs; ///< [q][p], 1: drawn from border to border
    std::vector<int> m_rest;          ///< [q][p], cells that are drawn where nothing runs through
    int m_area = 0, m_cells = 0, m_all = 0;
};

/// The box in cells that holds the rest across `axis`, the other axis of the section, and ends before the holder along
/// `axis`.
struct Cut {
    int lo = 0, hi = 0; ///< cells lo … hi − 1 of the other axis are kept
    int end = 0;        ///< of `axis`: kept are those below, or from there on, see Holder::isHigh
    double left = 1;    ///< part of the holder that is still there
    double lost = 1;    ///< part of the rest that is not
};

/// A section with its axes named by their part: v along the axis on whose side the holder lies, u across it.
struct Sides {
    const CrossSection& section;
    bool vIsQ;
    int sizeOfU() const { return vIsQ ? section.sizeOfP() : section.sizeOfQ(); }
    int sizeOfV() const { return vIsQ ? section.sizeOfQ() : section.sizeOfP(); }
    bool isHolder(int u, int v) const { return vIsQ ? section.isHolder(u, v) : section.isHolder(v, u); }
    int rest(int u, int v) const { return vIsQ ? section.rest(u, v) : section.rest(v, u); }
};

/// The cells u of the other axis that the rest reaches over, but for half a percent of it on either side.
std::pair<int, int> reachOfRest(const Sides& s) {
    const double little = 0.005 * s.section.restCells();
    std::vector<int> counts(static_cast<std::size_t>(s.sizeOfU()), 0);
    for (int u = 0; u < s.sizeOfU(); ++u)
        for (int v = 0; v < s.sizeOfV(); ++v) counts[static_cast<std::size_t>(u)] += s.rest(u, v);
    const auto first = [&](auto begin, auto end) {
        double sum = 0;
        auto at = begin;
        while (at != end && (sum += *at) <= little) ++at;
        return static_cast<int>(at - begin);
    };
    return {std::max(0, first(counts.begin(), counts.end()) - 1),
            std::min(s.sizeOfU(), s.sizeOfU() - first(counts.rbegin(), counts.rend()) + 1)};
}

/// Of all places to end the box along v the one that leaves least of the holder and takes least of the rest.
Cut bestCut(const Sides& s, bool isHigh) {
    Cut best;
    const auto [lo, hi] = reachOfRest(s);
    int holder = 0, rest = 0;
    for (int end = 0; end <= s.sizeOfV(); ++end) {
        holder = rest = 0;
        for (int v = 0; v < s.sizeOfV(); ++v)
            for (int u = 0; u < s.sizeOfU(); ++u) {
                const bool kept = u >= lo && u < hi && (isHigh ? v < end : v >= end);
                holder += kept && s.isHolder(u, v);
                rest += kept ? 0 : s.rest(u, v);
            }
        const Cut cut{lo, hi, end, static_cast<double>(holder) / s.section.area(),
                      static_cast<double>(rest) / s.section.restCells()};
        if (cut.left + 2 * cut.lost < best.left + 2 * best.lost) best = cut;
    }
    return best;
}

/// Whether the section has something thin and wide that runs through, and beside it something that does not.
bool isLikeHolder(const CrossSection& section) {
    constexpr double kLeastRest = 0.15, kMostInEnds = 0.25, kThin = 0.12, kWide = 0.5;
    if (section.area() < 4 || section.restOfAll() < kLeastRest) return false;
    if (section.restInEnds() > kMostInEnds * 2 * section.area()) return false;
    int width = 0, height = 0; // cells along p and q that it reaches over
    for (int p = 0; p < section.sizeOfP(); ++p) {
        bool any = false;
        for (int q = 0; q < section.sizeOfQ() && !any; ++q) any = section.isHolder(p, q);
        width += any;
    }
    for (int q = 0; q < section.sizeOfQ(); ++q) {
        bool any = false;
        for (int p = 0; p < section.sizeOfP() && !any; ++p) any = section.isHolder(p, q);
        height += any;
    }
    const double wide =
        std::max(static_cast<double>(width) / section.sizeOfP(), static_cast<double>(height) / section.sizeOfQ());
    const double thick = static_cast<double>(section.area()) / std::max(width, height);
    return wide >= kWide && thick <= kThin * std::min(section.sizeOfP(), section.sizeOfQ());
}

} // namespace

std::optional<Holder> findHolder(const Volume& volume, const TransferFunction& tf, const JobControl& job) {
    constexpr double kMostLeft = 0.1, kMostLost = 0.05;
    const CellGrid grid(Int3(0), volume.dims());
    if (std::min({grid.cells.x, grid.cells.y, grid.cells.z}) < 8) return {};
    const Grid<std::uint8_t> drawn = drawnCells(volume, tf, {}, grid, job);
    std::optional<Holder> found;
    double least = kMostLeft + 2 * kMostLost;
    for (int along = 0; along < 3; ++along) {
        const CrossSection section(drawn, along);
        if (!isLikeHolder(section)) continue;
        for (const bool vIsQ : {true, false})
            for (const bool isHigh : {true, false}) {
                const Cut cut = bestCut({section, vIsQ}, isHigh);
                if (cut.left > kMostLeft || cut.lost > kMostLost || cut.left + 2 * cut.lost >= least) continue;
                least = cut.left + 2 * cut.lost;
                Holder holder{along, vIsQ ? section.axisOfQ() : section.axisOfP(), isHigh, {}, {}, cut.lost};
                holder.toward = volume.geometry().directions[holder.axis] * (isHigh ? 1.0 : -1.0);
                const int u = vIsQ ? section.axisOfP() : section.axisOfQ();
                const auto fraction = [&](int axis, int cell) {
                    return static_cast<double>(grid.begin(axis, cell)) / volume.dims()[axis];
                };
                holder.without.lo[u] = fraction(u, cut.lo);
                holder.without.hi[u] = fraction(u, cut.hi);
                (isHigh ? holder.without.hi : holder.without.lo)[holder.axis] = fraction(holder.axis, cut.end);
                found = holder;
            }
    }
    if (!found) found = findCradle(volume.geometry(), grid, drawn, job);
    return found;
}

FaintRest faintRest(const Holder& holder, const Volume& volume, const TransferFunction& tf, const JobControl& job) {
    constexpr double kNothing = 0.05, kLeast = 0.002, kMost = 0.5;
    const CellGrid grid(Int3(0), volume.dims());
    const TfSampler sampler(tf);
    const std::vector<VoxelPlane> planes = planesInVoxels(holder.without, volume.geometry());
    const int axis = holder.axis;
    // Optical depths of lines along the axis, from what lies outside.
    const double path = volume.geometry().spacing[axis] / volume.geometry().d0();
    const Grid<double> depths = ofCells(volume, grid, job, [&](const Int3& voxel, double s) {
        return std::isnan(s) || keeps(planes, Vec3(voxel)) ? 0.0 : path * opticalDepthOfOpacity(sampler.opacity(s));
    });
    Grid<double> lines([&] {
        Int3 dims = grid.cells;
        dims[axis] = 1;
        return dims;
    }());
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const Int3 cell = voxelAt(grid.cells, i);
        Int3 line = cell;
        line[axis] = 0;
        lines.at(line.x, line.y, line.z) +=
            depths[i] * (grid.begin(axis, cell[axis] + 1) - grid.begin(axis, cell[axis]));
    }
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i] < kNothing) continue;
        sum += lines[i];
        ++count;
    }
    const double density = opticalDepthOfOpacity(kFaintHolder) * count / sum;
    return {holder.without, count == 0 ? kMost : std::clamp(density, kLeast, kMost)};
}

} // namespace pellucid
