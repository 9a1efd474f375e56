#include "render/gl/volume_texture.h"

#include "base/check.h"

namespace pellucid::gl {

namespace {

/// Lets glTexSubImage3D read a box out of a larger array; GL's defaults afterwards.
class UnpackBox {
public:
    explicit UnpackBox(const Int3& dims) {
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, dims.x);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, dims.y);
    }
    ~UnpackBox() {
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    }
    UnpackBox(const UnpackBox&) = delete;
    UnpackBox& operator=(const UnpackBox&) = delete;
};

template <class T>
void copyBox(const T* data, const Int3& dims, const Int3& first, const Int3& size, const Int3& to, GLenum format,
             GLenum type, std::size_t perVoxel) {
    const auto row = static_cast<std::size_t>(dims.x), plane = row * static_cast<std::size_t>(dims.y);
    const std::size_t start = static_cast<std::size_t>(first.z) * plane + static_cast<std::size_t>(first.y) * row +
                              static_cast<std::size_t>(first.x);
    const UnpackBox unpack(dims);
    glTexSubImage3D(GL_TEXTURE_3D, 0, to.x, to.y, to.z, size.x, size.y, size.z, format, type, data + start * perVoxel);
}

} // namespace

GLenum codeFormat(const IntensityGrid& grid) {
    if (grid.codes.isNarrow()) return GL_R8;
    return grid.valid.empty() ? GL_R16 : GL_RG16;
}

int textureMaxCode(const IntensityGrid& grid) {
    constexpr int kWideOfNarrow = 65535 / 255;
    return grid.codes.isNarrow() ? kWideOfNarrow * grid.maxCode : grid.maxCode;
}

void uploadCodes(const Texture3d& texture, const IntensityGrid& grid, const Int3& first, const Int3& size,
                 const Int3& to) {
    const Int3 dims = grid.codes.dims();
    glBindTexture(GL_TEXTURE_3D, texture.name.id());
    if (grid.codes.isNarrow()) {
        copyBox(grid.codes.narrow(), dims, first, size, to, GL_RED, GL_UNSIGNED_BYTE, 1);
    } else if (grid.valid.empty()) {
        copyBox(grid.codes.wide(), dims, first, size, to, GL_RED, GL_UNSIGNED_SHORT, 1);
    } else {
        const Int3 layer(size.x, size.y, 1);
        std::vector<std::uint16_t> pairs(2 * voxelCount(layer));
        for (int k = 0; k < size.z; ++k) {
            auto pair = pairs.begin();
            for (int j = 0; j < size.y; ++j)
                for (int i = 0; i < size.x; ++i) {
                    const std::size_t voxel = grid.codes.index(first.x + i, first.y + j, first.z + k);
                    const bool valid = grid.valid[voxel] != 0;
                    *pair++ = valid ? grid.codes[voxel] : std::uint16_t{0};
                    *pair++ = valid ? std::uint16_t{65535} : std::uint16_t{0};
                }
            copyBox(pairs.data(), layer, Int3(0), layer, to + Int3(0, 0, k), GL_RG, GL_UNSIGNED_SHORT, 2);
        }
    }
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError("uploading the volume");
}

void uploadWeights(const Texture3d& texture, const WeightFields& weights, const Int3& first, const Int3& size,
                   const Int3& to) {
    const Int3 dims = weights.dims();
    glBindTexture(GL_TEXTURE_3D, texture.name.id());
    if (!weights.isCompact()) {
        copyBox(weights.data(), dims, first, size, to, GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
    } else {
        const Int3 layer(size.x, size.y, 1);
        std::vector<std::uint32_t> units(voxelCount(layer));
        const auto nx = static_cast<std::size_t>(dims.x), ny = static_cast<std::size_t>(dims.y);
        for (int k = 0; k < size.z; ++k) {
            auto next = units.begin();
            for (int j = 0; j < size.y; ++j) {
                const std::size_t row =
                    static_cast<std::size_t>(first.x) +
                    nx * (static_cast<std::size_t>(first.y + j) + ny * static_cast<std::size_t>(first.z + k));
                for (int i = 0; i < size.x; ++i) *next++ = weights.units(row + static_cast<std::size_t>(i));
            }
            copyBox(units.data(), layer, Int3(0), layer, to + Int3(0, 0, k), GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
        }
    }
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError("uploading the saliency");
}

void uploadColors(const Texture3d& texture, const VoxelColors& colors, const IntensityGrid& grid, const Int3& first,
                  const Int3& size) {
    glBindTexture(GL_TEXTURE_3D, texture.name.id());
    if (grid.valid.empty()) {
        copyBox(colors.rgba.data(), colors.dims, first, size, Int3(0), GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, 1);
    } else {
        const Int3 layer(size.x, size.y, 1);
        std::vector<std::uint32_t> shown(voxelCount(layer));
        for (int k = 0; k < size.z; ++k) {
            auto next = shown.begin();
            for (int j = 0; j < size.y; ++j)
                for (int i = 0; i < size.x; ++i) {
                    const std::size_t voxel = grid.codes.index(first.x + i, first.y + j, first.z + k);
                    *next++ = grid.valid[voxel] != 0 ? colors.rgba[voxel] : 0u;
                }
            copyBox(shown.data(), layer, Int3(0), layer, Int3(0, 0, k), GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, 1);
        }
    }
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError("uploading the colours of voxels");
}

void TableTexture::fill(std::span<const float> values, int channels) {
    PELLUCID_CHECK((channels == 1 || channels == 4) && !values.empty());
    constexpr int kRow = 256;
    const int entries = static_cast<int>(values.size()) / channels;
    const glm::ivec2 size{kRow, (entries + kRow - 1) / kRow};
    const GLenum format = channels == 4 ? GL_RGBA32F : GL_R32F;
    if (m_texture.size != size || m_texture.format != format)
        m_texture = makeTexture2d(size, format, GL_NEAREST, "the transfer function's table");
    std::vector<float> padded(values.begin(), values.end());
    padded.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                  static_cast<std::size_t>(channels));
    glBindTexture(GL_TEXTURE_2D, m_texture.name.id());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, channels == 4 ? GL_RGBA : GL_RED, GL_FLOAT, padded.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    throwOnGlError("uploading the transfer function");
    m_entries = entries;
}

} // namespace pellucid::gl
