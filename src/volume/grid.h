// A dense three-dimensional array.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "base/check.h"

namespace pellucid {

using Int3 = glm::ivec3;
using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3; ///< columns first, as glm

/// Number of voxels of a grid; 64 bit, since nx·ny·nz overflows an int long before memory ends.
inline std::size_t voxelCount(const Int3& dims) {
    return static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(dims.z);
}

/// Number of voxels of one layer along z.
inline std::size_t layerSize(const Int3& dims) {
    return static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
}

/// Index of voxel (i, j, k) of a grid, x fastest: i + nx·(j + ny·k).
inline std::size_t voxelIndex(const Int3& dims, int i, int j, int k) {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(dims.x) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(k));
}

/// "64 x 64 x 48".
inline std::string dimsText(const Int3& dims) {
    return std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " + std::to_string(dims.z);
}

/// shape (nx, ny, nz), values in the order of voxelIndex().
template <class T>
class Grid {
public:
    Grid() = default;
    explicit Grid(const Int3& dims, T fill = T{}) : m_dims(dims), m_values(voxelCount(dims), fill) {}
    Grid(const Int3& dims, std::vector<T> values) : m_dims(dims), m_values(std::move(values)) {
        PELLUCID_CHECK(m_values.size() == voxelCount(dims));
    }

    const Int3& dims() const noexcept { return m_dims; }
    std::size_t size() const noexcept { return m_values.size(); }
    bool empty() const noexcept { return m_values.empty(); }
    std::size_t index(int i, int j, int k) const {
        PELLUCID_DCHECK(i >= 0 && j >= 0 && k >= 0 && i < m_dims.x && j < m_dims.y && k < m_dims.z);
        return voxelIndex(m_dims, i, j, k);
    }
    T& at(int i, int j, int k) { return m_values[index(i, j, k)]; }
    const T& at(int i, int j, int k) const { return m_values[index(i, j, k)]; }
    T& operator[](std::size_t i) { return m_values[i]; }
    const T& operator[](std::size_t i) const { return m_values[i]; }
    T* data() noexcept { return m_values.data(); }
    const T* data() const noexcept { return m_values.data(); }
    auto begin() noexcept { return m_values.begin(); }
    auto end() noexcept { return m_values.end(); }
    auto begin() const noexcept { return m_values.begin(); }
    auto end() const noexcept { return m_values.end(); }

private:
    Int3 m_dims{0, 0, 0};
    std::vector<T> m_values;
};

} // namespace pellucid
