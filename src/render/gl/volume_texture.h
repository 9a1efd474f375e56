// A volume's intensities, and tables of transfer functions, as textures.
#pragma once

#include <vector>

#include "render/gl/gl_resources.h"
#include "saliency/weight_fields.h"
#include "volume/intensity_grid.h"
#include "volume/voxel_colors.h"

namespace pellucid::gl {

/// The format of textures for codes: R16 = code/65535; where some voxels are invalid RG16 = (code·valid, valid); R8 for
/// narrow codes, which read as if they were codes of 16 bits, 257 times as large.
GLenum codeFormat(const IntensityGrid& grid);
/// The largest code that can be read from such a texture, times 65535.
int textureMaxCode(const IntensityGrid& grid);

/// Copies a box of the volume, the voxels [first, first + size), into a part of a texture that begins at `to`: codes
/// into one of codeFormat(), weights (WeightFields::units()) into R32UI.
void uploadCodes(const Texture3d& texture, const IntensityGrid& grid, const Int3& first, const Int3& size,
                 const Int3& to);
void uploadWeights(const Texture3d& texture, const WeightFields& weights, const Int3& first, const Int3& size,
                   const Int3& to);

/// Likewise colours into RGBA8: 0 where a voxel is invalid.
void uploadColors(const Texture3d& texture, const VoxelColors& colors, const IntensityGrid& grid, const Int3& first,
                  const Int3& size);

/// A table for tfTexel() of include/tf_segment.glsl: rows of 256 entries, unfiltered. Refilled in place while its size
/// stays.
class TableTexture {
public:
    /// `values`: four floats for each entry.
    void fill(std::vector<float> values);
    const TextureName& name() const noexcept { return m_texture.name; }

private:
    Texture2d m_texture;
};

} // namespace pellucid::gl
