// What visibility is weighted by: two numbers per voxel in four bytes, or in one.
#pragma once

#include <array>
#include <cstdint>

#include "base/zeroed_memory.h"
#include "volume/grid.h"

namespace pellucid {

/// How the weights of a voxel are stored.
enum class WeightForm {
    Exact,  ///< 16 bits each
    Compact ///< 4 bits each: for volumes of so many voxels that what is rounded off averages out
};

/// Per voxel the weights L(O_b) and L(O_s), ≥ 0, no unit: shape of the volume. Both are stored as fractions of the
/// largest possible one in 16 bits, so that reading them costs half of what floats would; they are off by at most
/// scale() / 2, which is 1e-5 for w1 = w2 = 1.
///
/// Compact ones are one of 16 levels, 0 and 15 that lie a factor of 1.6 apart, from 65 535 of the 16-bit units down to
/// 91. Which of the two neighbouring levels is chosen at random, by a hash of the voxel's index, with the odds that
/// make it right on average: a weight has a standard deviation of at most 0.24 of itself (above the lowest level), a
/// sum over N voxels one of 0.24/√N. Nothing depends on threads.
class WeightFields {
public:
    WeightFields() = default; ///< of no volume
    /// All 0. Weights up to `largestBrightness`, `largestSaturation` (≥ 0) can be stored.
    WeightFields(const Int3& dims, double largestBrightness, double largestSaturation,
                 WeightForm form = WeightForm::Exact);

    const Int3& dims() const noexcept { return m_dims; }
    bool empty() const noexcept { return size() == 0; }
    std::size_t size() const noexcept { return voxelCount(m_dims); }

    float brightness(std::size_t voxel) const { return static_cast<float>(units(voxel) & 0xffffu) * m_scale[0]; }
    float saturation(std::size_t voxel) const { return static_cast<float>(units(voxel) >> 16) * m_scale[1]; }
    /// 0 brightness, 1 saturation.
    float at(int attribute, std::size_t voxel) const { return attribute == 0 ? brightness(voxel) : saturation(voxel); }
    /// Both: brightness in the low 16 bits, saturation in the high ones, in units of scale().
    std::uint32_t units(std::size_t voxel) const {
        return isCompact() ? weightOfByte()[m_bytes[voxel]] : m_values[voxel];
    }
    /// Rounded to what can be stored.
    void set(std::size_t voxel, float brightness, float saturation);
    /// The weights of `count` voxels from `first` on, as units() has them.
    void store(std::size_t first, const std::uint32_t* units, std::size_t count);
    /// The same, all 0.
    void clear(std::size_t first, std::size_t count);

    bool isCompact() const noexcept { return !m_bytes.empty(); }
    /// Exact ones: units() of each voxel, x fastest.
    const std::uint32_t* data() const noexcept { return m_values.data(); }
    /// Compact ones: entries of weightOfByte(), x fastest; a multiple of four bytes can be read.
    const std::uint8_t* compactData() const noexcept { return m_bytes.data(); }
    /// units() of each byte.
    static const std::array<std::uint32_t, 256>& weightOfByte();
    /// The weight that one unit of the 16 bits stands for; 0 brightness, 1 saturation.
    float scale(int attribute) const { return m_scale[static_cast<std::size_t>(attribute)]; }

    bool operator==(const WeightFields&) const = default;

private:
    Int3 m_dims{0, 0, 0};
    std::array<float, 2> m_scale{0, 0};
    ZeroedVector<std::uint32_t> m_values;
    ZeroedVector<std::uint8_t> m_bytes;
};

/// One of the two as floats, to be written or looked at.
Grid<float> gridOf(const WeightFields& weights, int attribute);

} // namespace pellucid
