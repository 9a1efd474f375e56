#include "volume/fetched_values.h"

#include <algorithm>
#include <limits>

#include "volume/volume_part.h"

namespace pellucid {

FetchedValues::FetchedValues(const Volume& volume, std::vector<std::size_t> indices) : m_indices(std::move(indices)) {
    std::ranges::sort(m_indices);
    m_indices.erase(std::unique(m_indices.begin(), m_indices.end()), m_indices.end());
    m_values.assign(m_indices.size(), 0.0);
    const VolumePart part = partHere(volume);
    for (std::size_t n = 0; n < m_indices.size() && part.volume != nullptr; ++n) {
        const Int3 v = voxelAt(volume.dims(), m_indices[n]);
        if (!part.owns(v)) continue;
        const std::size_t at = part.indexOf(v);
        m_values[n] = part.volume->isValid(at) ? part.volume->value(at) : std::numeric_limits<double>::quiet_NaN();
    }
    if (volume.elsewhere() != nullptr) volume.elsewhere()->sum(m_values); // a voxel is one rank's, the others have 0
}

double FetchedValues::operator()(std::size_t index) const {
    const auto found = std::ranges::lower_bound(m_indices, index);
    PELLUCID_DCHECK(found != m_indices.end() && *found == index);
    return m_values[static_cast<std::size_t>(found - m_indices.begin())];
}

} // namespace pellucid
