#include "saliency/weight_fields.h"

namespace pellucid {

namespace {

std::uint32_t fraction(float weight, float scale) {
    if (!(weight > 0) || !(scale > 0)) return 0;
    return static_cast<std::uint32_t>(std::min(weight / scale + 0.5f, 65535.0f));
}

} // namespace

WeightFields::WeightFields(const Int3& dims, double largestBrightness, double largestSaturation)
    : m_dims(dims), m_scale{static_cast<float>(largestBrightness / 65535),
                            static_cast<float>(largestSaturation / 65535)},
      m_values(voxelCount(dims)) {}

void WeightFields::set(std::size_t voxel, float brightness, float saturation) {
    m_values[voxel] = fraction(brightness, m_scale[0]) | fraction(saturation, m_scale[1]) << 16;
}

Grid<float> gridOf(const WeightFields& weights, int attribute) {
    Grid<float> grid(weights.dims());
    for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = weights.at(attribute, i);
    return grid;
}

} // namespace pellucid
