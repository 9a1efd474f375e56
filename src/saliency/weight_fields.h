// What visibility is weighted by: two numbers per voxel in four bytes.
#pragma once

#include <array>
#include <cstdint>

#include "base/zeroed_memory.h"
#include "volume/grid.h"

namespace pellucid {

/// Per voxel the weights L(O_b) and L(O_s), ≥ 0, no unit: shape of the volume. Both are stored as fractions of the
/// largest possible one in 16 bits, so that reading them costs half of what floats would; they are off by at most
/// scale() / 2, which is 1e-5 for w1 = w2 = 1.
class WeightFields {
public:
    WeightFields() = default; ///< of no volume
    /// All 0. Weights up to `largestBrightness`, `largestSaturation` (≥ 0) can be stored.
    WeightFields(const Int3& dims, double largestBrightness, double largestSaturation);

    const Int3& dims() const noexcept { return m_dims; }
    bool empty() const noexcept { return m_values.empty(); }
    std::size_t size() const noexcept { return m_values.size(); }

    float brightness(std::size_t voxel) const { return static_cast<float>(m_values[voxel] & 0xffffu) * m_scale[0]; }
    float saturation(std::size_t voxel) const { return static_cast<float>(m_values[voxel] >> 16) * m_scale[1]; }
    /// 0 brightness, 1 saturation.
    float at(int attribute, std::size_t voxel) const { return attribute == 0 ? brightness(voxel) : saturation(voxel); }
    /// Rounded to the nearest that can be stored.
    void set(std::size_t voxel, float brightness, float saturation);

    /// One per voxel, x fastest: brightness in the low 16 bits, saturation in the high ones, in units of scale().
    const std::uint32_t* data() const noexcept { return m_values.data(); }
    std::uint32_t* data() noexcept { return m_values.data(); }
    /// The weight that one unit of the 16 bits stands for; 0 brightness, 1 saturation.
    float scale(int attribute) const { return m_scale[static_cast<std::size_t>(attribute)]; }

    bool operator==(const WeightFields&) const = default;

private:
    Int3 m_dims{0, 0, 0};
    std::array<float, 2> m_scale{0, 0};
    ZeroedVector<std::uint32_t> m_values;
};

/// One of the two as floats, to be written or looked at.
Grid<float> gridOf(const WeightFields& weights, int attribute);

} // namespace pellucid
