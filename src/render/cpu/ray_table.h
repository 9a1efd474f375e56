// The transfer function as rays read it: running integrals over the intensity.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tf/transfer_function.h"
#include "volume/intensity_grid.h"

namespace pellucid {

/// Cells of equal width around equidistant intensities, those of a volume's values where they are few; τ and colour are
/// constant in each. See PacketScene for the layout.
class RayTable {
public:
    /// Of the emission and absorption of `tf`, inside `only` alone where it is not null.
    RayTable(const TransferFunction& tf, const Feature* only, const IntensityGrid& grid);
    /// Opaque where `shown` holds, without colours: tells where rays have to be looked at.
    RayTable(const std::function<bool(double s)>& shown, const IntensityGrid& grid);

    float cellOfCode() const noexcept { return m_cellOfCode; }
    std::size_t cells() const noexcept { return m_cells; }
    float depthUnit() const noexcept { return m_depthUnit; }
    const std::int32_t* integral() const noexcept { return m_integral.data(); }
    const std::int32_t* colors() const noexcept { return m_colors.data(); }
    /// Whether any of the codes from `low` to `high`, or between them, is opaque.
    bool isOpaque(int low, int high) const;

private:
    explicit RayTable(const IntensityGrid& grid);
    void integrate(const std::vector<double>& tau, const std::vector<std::array<double, 3>>& emission);
    double intensity(std::size_t cell) const { return static_cast<double>(cell) / static_cast<double>(m_cells - 1); }

    std::size_t m_cells = 0;
    float m_cellOfCode = 0, m_depthUnit = 0;
    std::vector<std::int32_t> m_integral, m_colors;
};

} // namespace pellucid
