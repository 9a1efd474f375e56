#include "volume/fetched_values.h"

#include <algorithm>
#include <limits>

#include "volume/voxel_loops.h"

namespace pellucid {

FetchedValues::FetchedValues(const Volume& volume, std::vector<std::size_t> indices) : m_indices(std::move(indices)) {
    std::ranges::sort(m_indices);
    m_indices.erase(std::unique(m_indices.begin(), m_indices.end()), m_indices.end());
    m_values.assign(m_indices.size(), 0.0);
    const VoxelsElsewhere* const elsewhere = volume.elsewhere();
    const Volume* const part = elsewhere != nullptr ? volume.here().get() : &volume;
    const VoxelRegion own = elsewhere != nullptr ? elsewhere->own() : VoxelRegion{Int3(0), volume.dims()};
    const Int3 first = elsewhere != nullptr ? elsewhere->stored().lo : Int3(0);
    for (std::size_t n = 0; n < m_indices.size() && part != nullptr; ++n) {
        const Int3 v = voxelAt(volume.dims(), m_indices[n]);
        if (v.x < own.lo.x || v.y < own.lo.y || v.z < own.lo.z || v.x >= own.hi.x || v.y >= own.hi.y || v.z >= own.hi.z)
            continue;
        const std::size_t at = voxelIndex(part->dims(), v.x - first.x, v.y - first.y, v.z - first.z);
        m_values[n] = part->isValid(at) ? part->value(at) : std::numeric_limits<double>::quiet_NaN();
    }
    if (elsewhere != nullptr) elsewhere->sum(m_values); // a voxel is one rank's, the others have 0
}

double FetchedValues::operator()(std::size_t index) const {
    const auto found = std::ranges::lower_bound(m_indices, index);
    PELLUCID_DCHECK(found != m_indices.end() && *found == index);
    return m_values[static_cast<std::size_t>(found - m_indices.begin())];
}

} // namespace pellucid
