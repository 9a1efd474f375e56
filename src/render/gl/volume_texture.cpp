#include "render/gl/volume_texture.h"

#include "volume/check.h"

namespace pellucid::gl {

VolumeTexture uploadVolume(const IntensityGrid& grid) {
    const Int3 dims = grid.codes.dims();
    VolumeTexture volume;
    volume.maxCode = grid.maxCode;
    volume.hasInvalid = !grid.valid.empty();
    volume.texture = makeTexture3d(dims, volume.hasInvalid ? GL_RG16 : GL_R16, GL_LINEAR, "the volume");

    const std::size_t plane = static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
    std::vector<std::uint16_t> pairs(volume.hasInvalid ? 2 * plane : 0);
    glBindTexture(GL_TEXTURE_3D, volume.texture.name.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int k = 0; k < dims.z; ++k) {
        const std::size_t first = static_cast<std::size_t>(k) * plane;
        const std::uint16_t* row = grid.codes.data() + first;
        if (volume.hasInvalid) {
            for (std::size_t i = 0; i < plane; ++i) {
                const bool valid = grid.valid[first + i] != 0;
                pairs[2 * i] = valid ? row[i] : std::uint16_t{0};
                pairs[2 * i + 1] = valid ? std::uint16_t{65535} : std::uint16_t{0};
            }
            row = pairs.data();
        }
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, k, dims.x, dims.y, 1, volume.hasInvalid ? GL_RG : GL_RED,
                        GL_UNSIGNED_SHORT, row);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError("uploading the volume");
    return volume;
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
