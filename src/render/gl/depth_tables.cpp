#include "render/gl/depth_tables.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "tf/opacity.h"
#include "volume/intensity_grid.h"

namespace pellucid::gl {

namespace {

constexpr int kCells = 4096; ///< with 8 candidates 128 KiB each for τ and its integral: stays in a GPU's cache
constexpr int kMostCells = 16384, kMostCellsHigh = 65535;

/// τ at a point of a transfer function, and ∫τ dα up to there: ∫ −ln(1 − a) da = α + (1 − α)·ln(1 − α).
struct Depth {
    explicit Depth(double a) : alpha(std::min(a, kMaxOpacity)), tau(opticalDepthOfOpacity(a)) {
        integral = alpha - (1 - alpha) * tau;
    }
    double alpha, tau, integral;
};

/// Mean of τ while α goes linearly from one to the other.
double meanTau(const Depth& a, const Depth& b) {
    const double change = b.alpha - a.alpha;
    return std::abs(change) < 1e-6 ? 0.5 * (a.tau + b.tau) : (b.integral - a.integral) / change;
}

/// Adds to tau[entry] and cellIntegrals[cell] what one transfer function has there.
void fillOne(const TransferFunction& tf, int cells, std::vector<double>& tau, std::vector<double>& cellIntegrals) {
    const auto points = tf.pointsWithEnds();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double x0 = points[i].x * cells, x1 = points[i + 1].x * cells;
        const double a0 = points[i].opacity, a1 = points[i + 1].opacity;
        if (!(x1 > x0) || (a0 == 0 && a1 == 0)) continue;
        Depth before(a0);
        double from = x0;
        for (int entry = static_cast<int>(std::ceil(x0)); from < x1; ++entry) {
            const double to = std::min(x1, static_cast<double>(entry));
            const Depth now(a0 + (a1 - a0) * (to - x0) / (x1 - x0));
            if (to > from)
                cellIntegrals[static_cast<std::size_t>(std::min(static_cast<int>(from), cells - 1))] +=
                    meanTau(before, now) * (to - from);
            if (to == entry && (to < x1 || entry == cells)) tau[static_cast<std::size_t>(entry)] = now.tau;
            before = now;
            from = to;
        }
    }
}

} // namespace

int tableCells(const Volume& volume, Quality quality) {
    const int most = quality == Quality::High ? kMostCellsHigh : kMostCells;
    if (!IntensityCoder(volume).exact()) return most;
    const int span = static_cast<int>(std::lround(volume.range().hi - volume.range().lo));
    return span <= kCells ? span * (kCells / span) : std::min(span, most);
}

DepthTables makeDepthTables(std::span<const TransferFunction> tfs, int candidates, int cells) {
    PELLUCID_CHECK(!tfs.empty() && static_cast<int>(tfs.size()) <= candidates && cells > 0);
    const auto lanes = static_cast<std::size_t>(candidates), entries = static_cast<std::size_t>(cells) + 1;
    DepthTables tables;
    tables.candidates = candidates;
    tables.cells = cells;
    tables.tau.resize(entries * lanes);
    tables.integral.resize(entries * lanes);
    tables.opaqueBefore.resize(entries);

    std::vector<std::vector<double>> integrals(tfs.size());
    std::vector<char> opaque(entries, 0);
    double largest = 0;
    for (std::size_t t = 0; t < tfs.size(); ++t) {
        std::vector<double> tau(entries, 0.0), &integral = integrals[t];
        integral.assign(entries, 0.0);
        fillOne(tfs[t], cells, tau, integral);
        double sum = 0;
        for (std::size_t i = 0; i < entries; ++i) {
            if (integral[i] > 0) opaque[i] = 1;
            sum += std::exchange(integral[i], sum);
            for (std::size_t lane = t; lane < (t + 1 == tfs.size() ? lanes : t + 1); ++lane)
                tables.tau[i * lanes + lane] = static_cast<float>(tau[i]);
        }
        largest = std::max(largest, sum);
    }
    tables.unit = largest > 0 ? largest / 2147483647.0 : 1.0;
    for (std::size_t i = 0; i < entries; ++i)
        for (std::size_t lane = 0; lane < lanes; ++lane)
            tables.integral[i * lanes + lane] =
                static_cast<std::uint32_t>(integrals[std::min(lane, tfs.size() - 1)][i] / tables.unit + 0.5);
    for (std::size_t i = 1; i < entries; ++i)
        tables.opaqueBefore[i] = tables.opaqueBefore[i - 1] + (opaque[i - 1] != 0 ? 1u : 0u);
    return tables;
}

} // namespace pellucid::gl
