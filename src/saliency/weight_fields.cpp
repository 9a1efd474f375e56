#include "saliency/weight_fields.h"

#include <cmath>
#include <cstring>
#include <vector>

namespace pellucid {

namespace {

constexpr double kLevelRatio = 0.625; ///< of a level to the next one; a mean of the two has σ ≤ (1 − r)/(2√r) of itself
constexpr int kLevels = 16, kOddsBits = 12;

std::uint32_t fraction(float weight, float scale) {
    if (!(weight > 0) || !(scale > 0)) return 0;
    return static_cast<std::uint32_t>(std::min(weight / scale + 0.5f, 65535.0f));
}

std::uint32_t unitsOfLevel(int level) {
    return level == 0 ? 0 : static_cast<std::uint32_t>(std::lround(65535 * std::pow(kLevelRatio, kLevels - 1 - level)));
}

/// Per 16-bit weight the level below it, and in the bits above the odds of the one above it.
const std::vector<std::uint16_t>& levelsOfUnits() {
    static const std::vector<std::uint16_t> table = [] {
        std::vector<std::uint16_t> entries(65536);
        int level = 0;
        for (std::uint32_t units = 0; units < entries.size(); ++units) {
            while (level + 1 < kLevels && unitsOfLevel(level + 1) <= units) ++level;
            std::uint32_t odds = 0;
            if (level + 1 < kLevels) {
                const double low = unitsOfLevel(level), high = unitsOfLevel(level + 1);
                odds = static_cast<std::uint32_t>((units - low) / (high - low) * (1 << kOddsBits) + 0.5);
                odds = std::min(odds, (1u << kOddsBits) - 1);
            }
            entries[units] = static_cast<std::uint16_t>(odds << 4 | static_cast<std::uint32_t>(level));
        }
        return entries;
    }();
    return table;
}

/// The byte of a voxel's two weights.
std::uint8_t compact(const std::uint16_t* levels, std::uint32_t units, std::size_t voxel) {
    std::uint64_t random = (voxel + 1) * 0x9e3779b97f4a7c15u;
    random = (random ^ random >> 29) * 0xbf58476d1ce4e5b9u;
    const auto level = [&](std::uint32_t weight, int shift) {
        const std::uint32_t entry = levels[weight];
        const auto lot = static_cast<std::uint32_t>(random >> shift) & ((1u << kOddsBits) - 1);
        return (entry & 15u) + (lot < entry >> 4 ? 1u : 0u);
    };
    return static_cast<std::uint8_t>(level(units & 0xffffu, 40) | level(units >> 16, 52) << 4);
}

} // namespace

WeightFields::WeightFields(const Int3& dims, double largestBrightness, double largestSaturation, WeightForm form)
    : m_dims(dims), m_scale{static_cast<float>(largestBrightness / 65535),
                            static_cast<float>(largestSaturation / 65535)} {
    if (form == WeightForm::Compact)
        m_bytes = ZeroedVector<std::uint8_t>((voxelCount(dims) + 3) / 4 * 4);
    else
        m_values = ZeroedVector<std::uint32_t>(voxelCount(dims));
}

void WeightFields::set(std::size_t voxel, float brightness, float saturation) {
    const std::uint32_t units = fraction(brightness, m_scale[0]) | fraction(saturation, m_scale[1]) << 16;
    store(voxel, &units, 1);
}

void WeightFields::store(std::size_t first, const std::uint32_t* units, std::size_t count) {
    if (!isCompact()) {
        std::memcpy(m_values.data() + first, units, count * sizeof(std::uint32_t));
        return;
    }
    const std::uint16_t* levels = levelsOfUnits().data();
    for (std::size_t i = 0; i < count; ++i) m_bytes[first + i] = compact(levels, units[i], first + i);
}

void WeightFields::clear(std::size_t first, std::size_t count) {
    if (isCompact())
        std::memset(m_bytes.data() + first, 0, count);
    else
        std::memset(m_values.data() + first, 0, count * sizeof(std::uint32_t));
}

const std::array<std::uint32_t, 256>& WeightFields::weightOfByte() {
    static const std::array<std::uint32_t, 256> table = [] {
        std::array<std::uint32_t, 256> units{};
        for (int high = 0; high < kLevels; ++high)
            for (int low = 0; low < kLevels; ++low)
                units[static_cast<std::size_t>(high << 4 | low)] = unitsOfLevel(low) | unitsOfLevel(high) << 16;
        return units;
    }();
    return table;
}

Grid<float> gridOf(const WeightFields& weights, int attribute) {
    Grid<float> grid(weights.dims());
    for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = weights.at(attribute, i);
    return grid;
}

} // namespace pellucid
