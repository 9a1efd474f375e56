#include "render/cpu/ray_table.h"

#include <algorithm>
#include <cmath>

#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr int kMostCells = 8192;
/// Integrals are 32-bit integers in units of 2⁻²⁹ of the whole: differences of floats would lose a small τ.
constexpr double kUnits = 1 << 29;

} // namespace

RayTable::RayTable(const IntensityGrid& grid) {
    const int values = grid.maxCode / grid.codeStep; // and the first
    const int perValue = std::max(1, (kMostCells - 1) / values);
    m_cells = static_cast<std::size_t>(std::min(values * perValue, kMostCells - 1)) + 1;
    m_cellOfCode = static_cast<float>(m_cells - 1) / static_cast<float>(grid.maxCode);
}

RayTable::RayTable(const TransferFunction& tf, const Feature* only, const IntensityGrid& grid) : RayTable(grid) {
    const TfSampler sampler(tf);
    std::vector<double> tau(m_cells);
    std::vector<std::array<double, 3>> emission(m_cells);
    for (std::size_t i = 0; i < m_cells; ++i) {
        const double s = intensity(i);
        if (only && !only->contains(s)) continue;
        tau[i] = opticalDepthOfOpacity(sampler.opacity(s));
        if (tau[i] == 0) continue;
        const Rgb c = sampler.color(s);
        emission[i] = {tau[i] * c.r, tau[i] * c.g, tau[i] * c.b};
    }
    integrate(tau, emission);
}

RayTable::RayTable(const std::function<bool(double)>& shown, const IntensityGrid& grid) : RayTable(grid) {
    std::vector<double> tau(m_cells);
    // What lies between two cells counts for both.
    for (std::size_t i = 0; i < m_cells; ++i)
        if (shown(intensity(i)))
            for (std::size_t j = i > 0 ? i - 1 : 0; j <= std::min(i + 1, m_cells - 1); ++j) tau[j] = 1;
    integrate(tau, std::vector<std::array<double, 3>>(m_cells));
}

void RayTable::integrate(const std::vector<double>& tau, const std::vector<std::array<double, 3>>& emission) {
    double whole = 0;
    for (const double t : tau) whole += t;
    const double unit = whole > 0 ? whole / kUnits : 1;
    m_depthUnit = static_cast<float>(unit);
    m_integral.assign(m_cells + 1, 0);
    m_colors.assign(4 * (m_cells + 1), 0);
    const auto inUnits = [&](double v) { return static_cast<std::int32_t>(std::lround(v / unit)); };
    double sum = 0;
    std::array<double, 3> colors{};
    for (std::size_t i = 0; i < m_cells; ++i) {
        m_integral[i] = 2 * inUnits(sum);
        sum += tau[i];
        const std::int32_t next = 2 * inUnits(sum);
        if (next != m_integral[i]) m_integral[i] |= 1;
        m_integral[i + 1] = next;
        m_colors[4 * i + 3] = m_integral[i];
        for (std::size_t c = 0; c < 3; ++c) {
            colors[c] += emission[i][c];
            m_colors[4 * (i + 1) + c] = inUnits(colors[c]);
        }
    }
    m_colors[4 * m_cells + 3] = m_integral[m_cells];
}

bool RayTable::isOpaque(int low, int high) const {
    // The kernel's own rounding may differ by a hair from this one.
    constexpr float kHair = 0.01f;
    const float first = static_cast<float>(low) * m_cellOfCode + 0.5f - kHair,
                last = static_cast<float>(high) * m_cellOfCode + 0.5f + kHair;
    const auto end = std::min(static_cast<std::size_t>(last) + 1, m_cells);
    return (m_integral[end] >> 1) != (m_integral[static_cast<std::size_t>(first)] >> 1);
}

} // namespace pellucid
