#include "render/gl/volume_bricks.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "base/check.h"

namespace pellucid::gl {

namespace {

/// Voxels around what a brick stands for: half a step, one for interpolation and one for the gradient.
constexpr int kMargin = static_cast<int>(kBrickStep / 2) + 2;
constexpr int kShortest = 2 * kMargin + 8; ///< texture, voxels: shorter ones would be mostly margin

} // namespace

BrickedVolume::BrickedVolume(const Volume& volume, int longest, bool colored)
    : m_geometry(volume.geometry()), m_grid(sharedIntensityGrid(volume)), m_colored(colored),
      m_hasInvalid(!m_grid->valid.empty()), m_maxCode(textureMaxCode(*m_grid)) {
    longest = std::min(longest, glInteger(GL_MAX_3D_TEXTURE_SIZE));
    PELLUCID_CHECK(longest >= kShortest);
    cut(Int3(longest));
    if (uploadAll()) {
        if (!m_colored) m_grid.reset(); // the device has it now
        return;
    }
    // One brick at a time, half as long until it fits.
    for (Int3 size = glm::min(Int3(longest), m_geometry.dims);;) {
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const bool smallest = size[axis] <= kShortest;
        size[axis] = std::max(kShortest, size[axis] / 2);
        cut(size);
        m_textures.clear();
        m_colorTextures.clear();
        try {
            Int3 most(0);
            for (const VolumeBrick& brick : m_bricks) most = glm::max(most, brick.size);
            makeTextures(most, "a brick of the volume");
            return;
        } catch (const OutOfMemory&) {
            if (smallest) throw;
        }
    }
}

/// Cuts the volume into bricks whose textures are at most `longest`.
void BrickedVolume::cut(const Int3& longest) {
    const Int3 dims = m_geometry.dims;
    for (int a = 0; a < 3; ++a) {
        m_counts[a] = dims[a] <= longest[a] ? 1 : (dims[a] + longest[a] - 2 * kMargin - 1) / (longest[a] - 2 * kMargin);
        m_cells[a] = (dims[a] + m_counts[a] - 1) / m_counts[a];
    }
    m_bricks.clear();
    for (int k = 0; k < m_counts.z; ++k)
        for (int j = 0; j < m_counts.y; ++j)
            for (int i = 0; i < m_counts.x; ++i) {
                VolumeBrick brick;
                brick.index = {i, j, k};
                for (int a = 0; a < 3; ++a) {
                    const int first = brick.index[a] * m_cells[a], end = std::min(first + m_cells[a], dims[a]);
                    const bool isFirst = first == 0, isLast = end == dims[a];
                    brick.lo[a] = isFirst ? -1.0 : first - 0.5;
                    brick.hi[a] = isLast ? dims[a] : end - 0.5;
                    brick.first[a] = std::max(0, first - kMargin);
                    brick.size[a] = std::min(end + kMargin, dims[a]) - brick.first[a];
                }
                if (brick.size.x > 0 && brick.size.y > 0 && brick.size.z > 0) m_bricks.push_back(brick);
            }
}

/// One more.
void BrickedVolume::makeTextures(const Int3& size, const std::string& what) {
    m_textures.push_back(makeTexture3d(size, codeFormat(*m_grid), GL_LINEAR, what));
    if (m_colored) m_colorTextures.push_back(makeTexture3d(size, GL_RGBA8, GL_LINEAR, "the colours of " + what));
}

void BrickedVolume::upload(std::size_t brick, std::size_t texture) {
    const VolumeBrick& b = m_bricks[brick];
    uploadCodes(m_textures[texture], *m_grid, b.first, b.size, Int3(0));
    if (m_colors) uploadColors(m_colorTextures[texture], *m_colors, *m_grid, b.first, b.size);
}

bool BrickedVolume::uploadAll() {
    try {
        for (std::size_t i = 0; i < m_bricks.size(); ++i) {
            makeTextures(m_bricks[i].size, "the volume");
            upload(i, i);
        }
        return true;
    } catch (const OutOfMemory&) {
        m_textures.clear();
        m_colorTextures.clear();
        return false;
    }
}

void BrickedVolume::setColors(std::shared_ptr<const VoxelColors> colors) {
    PELLUCID_CHECK(m_colored && colors);
    if (colors == m_colors) return;
    m_colors = std::move(colors);
    if (m_textures.size() < m_bricks.size()) return; // they go up with each brick
    for (std::size_t i = 0; i < m_bricks.size(); ++i)
        uploadColors(m_colorTextures[i], *m_colors, *m_grid, m_bricks[i].first, m_bricks[i].size);
}

std::vector<std::size_t> BrickedVolume::frontToBack(const Camera& camera) const {
    // From brick to brick along a ray, this number of faces crossed since the eye's own brick only grows.
    const Vec3 eye = glm::floor((m_geometry.voxelFromWorld(camera.eye) + 0.5) / Vec3(m_cells));
    const Vec3 forward = m_geometry.indexFromWorld() * camera.forward();
    const auto faces = [&](std::size_t brick) {
        double sum = 0;
        for (int a = 0; a < 3; ++a) {
            const double i = m_bricks[brick].index[a];
            sum += camera.projection == Projection::Perspective ? std::abs(i - eye[a]) : forward[a] > 0 ? i : -i;
        }
        return sum;
    };
    std::vector<std::size_t> order(m_bricks.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, faces);
    return order;
}

const VolumeBrick& BrickedVolume::use(std::size_t index) {
    VolumeBrick& brick = m_bricks[index];
    const bool shared = m_textures.size() < m_bricks.size();
    const std::size_t at = shared ? 0 : index;
    if (shared) upload(index, at);
    const Texture3d& texture = m_textures[at];
    const Vec3 size(texture.size);
    brick.textureFromVoxel = 1.0 / size;
    brick.textureOffset = (0.5 - Vec3(brick.first)) / size;
    brick.textureEnd = (Vec3(brick.size) - 0.5) / size;
    if (m_colored) bindTexture(5, GL_TEXTURE_3D, m_colorTextures[at].name);
    bindTexture(0, GL_TEXTURE_3D, texture.name);
    return brick;
}

} // namespace pellucid::gl
