// A volume's intensities as one texture, or as bricks where one would be too long or too large: what pictures are drawn
// from.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/gl/volume_texture.h"

namespace pellucid::gl {

/// Longest step of samples along a ray, in voxels along any axis, whose two ends lie in the texture of the brick that
/// holds its middle.
inline constexpr double kBrickStep = 4.0;

struct VolumeBrick {
    Int3 index{0, 0, 0};                  ///< in the grid of bricks
    Int3 first{0, 0, 0}, size{0, 0, 0};   ///< the voxels of its texture, its neighbours' included
    Vec3 lo, hi;                          ///< what it stands for, voxels; the outermost ones reach beyond the box
    Vec3 textureFromVoxel, textureOffset; ///< t of the texture = voxel · textureFromVoxel + textureOffset
    Vec3 textureEnd;                      ///< centre of the last voxel, t of the texture
};

class BrickedVolume {
public:
    /// Throws Error, OutOfMemory. `longest`: of textures, along any axis, voxels; the device's if less. `colored`: with
    /// room for colours of the voxels beside their intensities.
    BrickedVolume(const Volume& volume, int longest, bool colored = false);

    std::size_t count() const noexcept { return m_bricks.size(); }
    bool hasInvalid() const noexcept { return m_hasInvalid; }
    int maxCode() const noexcept { return m_maxCode; } ///< textureMaxCode()
    bool isColored() const noexcept { return m_colored; }
    /// Uploads colours, unless they are those that are there. isColored() is true.
    void setColors(std::shared_ptr<const VoxelColors> colors);
    /// Indices of bricks such that none hides an earlier one.
    std::vector<std::size_t> frontToBack(const Camera& camera) const;
    /// Binds the brick's texture to unit 0, and that of its colours to unit 5; uploads them first where not all have
    /// room.
    const VolumeBrick& use(std::size_t brick);

private:
    void cut(const Int3& longest);
    bool uploadAll();
    void upload(std::size_t brick, std::size_t texture);
    void makeTextures(const Int3& size, const std::string& what);

    Geometry m_geometry;
    std::shared_ptr<const IntensityGrid> m_grid; ///< kept only where something is uploaded again
    std::shared_ptr<const VoxelColors> m_colors; ///< null: none yet
    bool m_colored, m_hasInvalid;
    int m_maxCode;
    std::vector<VolumeBrick> m_bricks;
    Int3 m_counts{1, 1, 1}, m_cells{1, 1, 1}; ///< bricks along each axis; voxels that each stands for
    std::vector<Texture3d> m_textures;        ///< one per brick, or one alone that they share in turn
    std::vector<Texture3d> m_colorTextures;   ///< likewise, of the same sizes; empty: none
};

} // namespace pellucid::gl
