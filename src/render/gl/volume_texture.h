// A volume's intensities, and tables of transfer functions, as textures.
#pragma once

#include <span>
#include <vector>

#include "render/gl/gl_resources.h"
#include "volume/intensity_grid.h"

namespace pellucid::gl {

/// shape (nx, ny, nz); R16 = code/65535, or RG16 = (code·valid, valid) where some voxels are invalid.
struct VolumeTexture {
    Texture3d texture;
    int maxCode = 65535; ///< intensity = code / maxCode
    bool hasInvalid = false;

    /// The shaders' permutation.
    std::vector<std::string> defines() const {
        if (hasInvalid) return {"HAS_INVALID"};
        return {};
    }
};

/// Linear filtering. Throws Error: an axis longer than the device's textures, out of memory.
VolumeTexture uploadVolume(const IntensityGrid& grid);

/// A table for tfEntry() of include/tf.glsl: rows of 256 entries, unfiltered. Refilled in place while its size stays.
class TableTexture {
public:
    /// `values`: entries × channels floats; channels 1 or 4.
    void fill(std::span<const float> values, int channels);
    int entries() const noexcept { return m_entries; }
    const TextureName& name() const noexcept { return m_texture.name; }

private:
    Texture2d m_texture;
    int m_entries = 0;
};

} // namespace pellucid::gl
