// Values of some voxels, wherever they are.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include "volume/voxel_loops.h"

namespace pellucid {

/// The values of the voxels of a volume that are asked for, data units; NaN where invalid. Of a volume on several ranks
/// each rank asks for the same, and gets what the ranks have together.
class FetchedValues {
public:
    /// Indices of voxels in any order, each as often as one likes.
    FetchedValues(const Volume& volume, std::vector<std::size_t> indices);
    /// Of a voxel that was asked for.
    double operator()(std::size_t index) const;

private:
    std::vector<std::size_t> m_indices; ///< ascending
    std::vector<double> m_values;
};

/// The same of a volume whose samples are all here.
template <class T>
struct SampleValues {
    const T* samples;
    double missing;
    double operator()(std::size_t i) const {
        const auto value = static_cast<double>(samples[i]);
        return std::isfinite(value) && value != missing ? value : std::numeric_limits<double>::quiet_NaN();
    }
};

/// use(values), where values(i) is the value of voxel i: of all of a volume, or where they lie on several ranks of
/// those that `wanted(ask)` asks for, by ask(voxel).
template <class Wanted, class Use>
void withValues(const Volume& volume, const Wanted& wanted, const Use& use) {
    if (volume.elsewhere() == nullptr)
        return withSamples(volume, [&](const auto& samples) {
            use(SampleValues<typename std::decay_t<decltype(samples)>::value_type>{
                samples.data(), volume.missing().value_or(std::numeric_limits<double>::quiet_NaN())});
        });
    std::vector<std::size_t> indices;
    const Int3 dims = volume.dims();
    wanted([&](const Int3& v) {
        if (v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < dims.x && v.y < dims.y && v.z < dims.z)
            indices.push_back(voxelIndex(dims, v.x, v.y, v.z));
    });
    use(FetchedValues(volume, std::move(indices)));
}

} // namespace pellucid
