// A volume's intensities and weights on the device: all of it, or as many planes at a time as there is room for.
#pragma once

#include <cstdint>

#include <optional>

#include "render/gl/volume_texture.h"

namespace pellucid::gl {

/// How a box of voxels is laid out in one 3D texture: as it is, or, where an axis is longer than textures may be, cut
/// into bricks that lie side by side. Neighbouring bricks share a layer of voxels, so that each can be interpolated
/// by itself (shaders/include/resident.glsl).
struct Folding {
    Int3 brick{1, 1, 1};  ///< cells between voxel centres; along an axis that is not cut the number of voxels
    Int3 bricks{1, 1, 1}; ///< number along each axis
    Int3 tile{1, 1, 1};   ///< voxels of one brick
    Int3 slots{1, 1, 1};  ///< bricks side by side in the texture
    bool folded() const { return bricks != Int3(1, 1, 1); }
    Int3 textureSize() const { return tile * slots; }
};

/// Textures are at most `longest` along any axis; empty where `dims` cannot be folded into one.
std::optional<Folding> foldInto(const Int3& dims, int longest);

/// What a sweep reads of the volume.
class ResidentVolume {
public:
    /// The planes [first, end) along an axis of the volume; `forward`: the sweep will go on toward higher ones.
    struct Planes {
        int axis = 0, first = 0, end = 0;
        bool forward = true;
    };

    /// `bytes`: the most that the textures may take; where the device runs out of memory they take less.
    ResidentVolume(const IntensityGrid& grid, double bytes, int longestTexture);

    bool hasInvalid() const noexcept { return m_hasInvalid; }
    /// From now on require() keeps these in the device's memory too; uploaded only when `key` or the planes change.
    /// Null: no weights. The numbers must stay where they are until the next call.
    void setWeights(const WeightFields* weights, std::uint64_t key);
    /// Makes sure that at least these planes are there. Throws OutOfMemory where there is not even room for them.
    void require(const Planes& planes);

    const Int3& first() const noexcept { return m_first; } ///< the voxel that the resident box begins with
    const Int3& size() const noexcept { return m_size; }   ///< of the resident box, voxels
    const Folding& folding() const noexcept { return m_folding; }
    const Texture3d& codes() const noexcept { return m_codes; }
    const Texture3d& weights() const noexcept { return m_weights; } ///< R32UI

private:
    void makeRoom(const Planes& planes);
    void uploadBox(Texture3d& texture, const WeightFields* weights) const; ///< null: codes

    const IntensityGrid& m_grid;
    bool m_hasInvalid;
    double m_bytes;
    int m_longest;
    const WeightFields* m_weightData = nullptr;
    std::uint64_t m_weightKey = 0, m_residentKey = 0;
    bool m_weightsResident = false, m_codesResident = false;
    Int3 m_first{0, 0, 0}, m_size{0, 0, 0}, m_room{0, 0, 0};
    Folding m_folding;
    Texture3d m_codes, m_weights;
};

} // namespace pellucid::gl
