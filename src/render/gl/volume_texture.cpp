#include "render/gl/volume_texture.h"

#include <array>

#include "base/check.h"

namespace pellucid::gl {

namespace {

/// Copies a box of voxels, [first, first + size), into a texture, where it begins at `to`.
class BoxUpload {
public:
    BoxUpload(const Texture3d& texture, const Int3& dims, const Int3& first, const Int3& size, const Int3& to)
        : m_dims(dims), m_first(first), m_size(size), m_to(to) {
        glBindTexture(GL_TEXTURE_3D, texture.name.id());
    }
    void finish(const std::string& doing) const {
        glBindTexture(GL_TEXTURE_3D, 0);
        throwOnGlError(doing);
    }

    /// `data`: a value per voxel of the whole volume.
    template <class T>
    void copy(const T* data, GLenum format, GLenum type) const {
        copyPart(data + voxelIndex(m_dims, m_first.x, m_first.y, m_first.z), m_dims, m_size, m_to, format, type);
    }

    /// valueOf(index of a voxel), layer by layer.
    template <class ValueOf>
    void copyMade(const ValueOf& valueOf, GLenum format, GLenum type) const {
        const Int3 layer(m_size.x, m_size.y, 1);
        std::vector<decltype(valueOf(std::size_t{}))> values(voxelCount(layer));
        for (int k = 0; k < m_size.z; ++k) {
            auto next = values.begin();
            for (int j = 0; j < m_size.y; ++j) {
                const std::size_t row = voxelIndex(m_dims, m_first.x, m_first.y + j, m_first.z + k);
                for (std::size_t i = 0; i < static_cast<std::size_t>(m_size.x); ++i) *next++ = valueOf(row + i);
            }
            copyPart(values.data(), layer, layer, m_to + Int3(0, 0, k), format, type);
        }
    }

private:
    /// The voxels from `data` on, of an array of `dims`.
    static void copyPart(const void* data, const Int3& dims, const Int3& size, const Int3& to, GLenum format,
                         GLenum type) {
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, dims.x);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, dims.y);
        glTexSubImage3D(GL_TEXTURE_3D, 0, to.x, to.y, to.z, size.x, size.y, size.z, format, type, data);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4); // GL's defaults again
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
    }

    Int3 m_dims, m_first, m_size, m_to;
};

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
    const BoxUpload upload(texture, grid.codes.dims(), first, size, to);
    using CodeAndValid = std::array<std::uint16_t, 2>;
    const auto codeAndValid = [&](std::size_t voxel) {
        return grid.valid[voxel] != 0 ? CodeAndValid{grid.codes[voxel], 65535} : CodeAndValid{0, 0};
    };
    if (grid.codes.isNarrow())
        upload.copy(grid.codes.narrow(), GL_RED, GL_UNSIGNED_BYTE);
    else if (grid.valid.empty())
        upload.copy(grid.codes.wide(), GL_RED, GL_UNSIGNED_SHORT);
    else
        upload.copyMade(codeAndValid, GL_RG, GL_UNSIGNED_SHORT);
    upload.finish("uploading the volume");
}

void uploadWeights(const Texture3d& texture, const WeightFields& weights, const Int3& first, const Int3& size,
                   const Int3& to) {
    const BoxUpload upload(texture, weights.dims(), first, size, to);
    const auto units = [&](std::size_t voxel) { return weights.units(voxel); };
    if (weights.isCompact())
        upload.copyMade(units, GL_RED_INTEGER, GL_UNSIGNED_INT);
    else
        upload.copy(weights.data(), GL_RED_INTEGER, GL_UNSIGNED_INT);
    upload.finish("uploading the saliency");
}

void uploadColors(const Texture3d& texture, const VoxelColors& colors, const IntensityGrid& grid, const Int3& first,
                  const Int3& size) {
    const BoxUpload upload(texture, colors.dims, first, size, Int3(0));
    const auto shown = [&](std::size_t voxel) { return grid.valid[voxel] != 0 ? colors.rgba[voxel] : 0u; };
    if (grid.valid.empty())
        upload.copy(colors.rgba.data(), GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV);
    else
        upload.copyMade(shown, GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV);
    upload.finish("uploading the colours of voxels");
}

void TableTexture::fill(std::vector<float> values) {
    PELLUCID_CHECK(!values.empty());
    constexpr int kRow = 256;
    const int entries = static_cast<int>(values.size()) / 4;
    const glm::ivec2 size{kRow, (entries + kRow - 1) / kRow};
    if (m_texture.size != size)
        m_texture = makeTexture2d(size, GL_RGBA32F, GL_NEAREST, "the transfer function's table");
    values.resize(4 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    upload(m_texture, GL_RGBA, GL_FLOAT, values.data(), "uploading the transfer function");
}

} // namespace pellucid::gl
