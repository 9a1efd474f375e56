#include "render/gl/resident_volume.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "base/error.h"

namespace pellucid::gl {

std::optional<Folding> foldInto(const Int3& dims, int longest) {
    Folding f;
    for (int a = 0; a < 3; ++a) {
        if (dims[a] <= longest) {
            f.brick[a] = f.tile[a] = dims[a];
            continue;
        }
        if (longest < 2) return {};
        const int cells = dims[a] - 1;
        f.bricks[a] = (cells + longest - 2) / (longest - 1);
        f.brick[a] = (cells + f.bricks[a] - 1) / f.bricks[a];
        f.tile[a] = f.brick[a] + 1;
    }
    std::size_t left = voxelCount(f.bricks);
    for (int a = 0; a < 3; ++a) {
        const auto fit = static_cast<std::size_t>(longest / f.tile[a]);
        if (fit == 0) return {};
        f.slots[a] = static_cast<int>(std::min(left, fit));
        left = (left + static_cast<std::size_t>(f.slots[a]) - 1) / static_cast<std::size_t>(f.slots[a]);
    }
    if (left > 1) return {};
    return f;
}

ResidentVolume::ResidentVolume(const IntensityGrid& grid, double bytes, int longestTexture)
    : m_grid(grid), m_hasInvalid(!grid.valid.empty()), m_bytes(bytes), m_longest(longestTexture) {}

void ResidentVolume::setWeights(const WeightFields* weights, std::uint64_t key) {
    m_weightData = weights;
    m_weightKey = key;
}

void ResidentVolume::require(const Planes& planes) {
    const int a = planes.axis;
    Int3 first(0), end = m_grid.codes.dims();
    first[a] = planes.first;
    end[a] = planes.end;
    const bool present = m_codesResident && glm::all(glm::greaterThanEqual(first, m_first)) &&
                         glm::all(glm::lessThanEqual(end, m_first + m_size));
    const bool weighted = m_weightData == nullptr || m_weights.name;
    if (!present || !weighted) {
        makeRoom(planes);
        m_size = m_room;
        m_first = Int3(0);
        m_first[a] =
            std::clamp(planes.forward ? planes.first : planes.end - m_room[a], 0, m_grid.codes.dims()[a] - m_room[a]);
        uploadBox(m_codes, nullptr);
        m_codesResident = true;
        m_weightsResident = false;
    }
    if (m_weightData == nullptr || (m_weightsResident && m_residentKey == m_weightKey)) return;
    uploadBox(m_weights, m_weightData);
    m_weightsResident = true;
    m_residentKey = m_weightKey;
}

/// Chooses how many planes will be resident, and makes textures for them.
void ResidentVolume::makeRoom(const Planes& planes) {
    const Int3 dims = m_grid.codes.dims();
    const int a = planes.axis, needed = planes.end - planes.first;
    const double voxelBytes = (m_hasInvalid ? 4 : m_grid.codes.isNarrow() ? 1 : 2) + (m_weightData != nullptr ? 4 : 0);
    const double planeBytes = voxelBytes * static_cast<double>(voxelCount(dims)) / dims[a];
    m_codesResident = m_weightsResident = false;
    int count = static_cast<int>(std::clamp(m_bytes / planeBytes, 0.0, static_cast<double>(dims[a])));
    for (; count >= needed; count = count > needed ? std::max(needed, count / 2) : 0) {
        m_room = dims;
        m_room[a] = count;
        const auto folding = foldInto(m_room, m_longest);
        if (!folding) continue;
        m_folding = *folding;
        try {
            const Int3 size = m_folding.textureSize();
            if (m_codes.size != size) {
                m_weights = {}; // before the new ones, so that both never need room at once
                m_codes = {};
                m_codes = makeTexture3d(size, codeFormat(m_grid), GL_LINEAR, "the volume");
            }
            if (m_weightData != nullptr && m_weights.size != size) {
                m_weights = {};
                m_weights = makeTexture3d(size, GL_R32UI, GL_NEAREST, "the saliency");
            }
            m_bytes = std::min(m_bytes, count < dims[a] ? count * planeBytes : m_bytes);
            return;
        } catch (const OutOfMemory&) {
            m_codes = {};
            m_weights = {};
        }
    }
    throw OutOfMemory("the graphics device has no memory for " + std::to_string(needed) +
                          " planes of the volume at a time (" +
                          std::to_string(static_cast<long long>(planeBytes * needed)) +
                          " bytes in textures of at most " + std::to_string(m_longest) + " along one axis)",
                      "OpenGL", "", Remedy::OtherEngine);
}

void ResidentVolume::uploadBox(Texture3d& texture, const WeightFields* weights) const {
    for (int k = 0; k < m_folding.bricks.z; ++k)
        for (int j = 0; j < m_folding.bricks.y; ++j)
            for (int i = 0; i < m_folding.bricks.x; ++i) {
                const Int3 brick(i, j, k), start = brick * m_folding.brick;
                const int number = i + m_folding.bricks.x * (j + m_folding.bricks.y * k);
                const Int3 slot(number % m_folding.slots.x, number / m_folding.slots.x % m_folding.slots.y,
                                number / (m_folding.slots.x * m_folding.slots.y));
                const Int3 size = glm::min(m_folding.tile, m_size - start);
                if (size.x <= 0 || size.y <= 0 || size.z <= 0) continue;
                if (weights)
                    uploadWeights(texture, *weights, m_first + start, size, slot * m_folding.tile);
                else
                    uploadCodes(texture, m_grid, m_first + start, size, slot * m_folding.tile);
            }
}

} // namespace pellucid::gl
