#include "render/gl/slice_raycaster.h"

#include <array>
#include <cmath>
#include <optional>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include "base/error.h"
#include "render/gl/gl_resources.h"
#include "render/gl/shader_program.h"
#include "render/gl/slice_geometry.h"
#include "render/gl/volume_bricks.h"
#include "render/gl/volume_texture.h"
#include "tf/tf_table.h"

namespace pellucid::gl {

namespace {

constexpr int kTableSize = 16384;
/// Fragments drawn between two looks at JobControl: well under a second even where the CPU does the drawing.
constexpr double kFragmentsPerBatch = 8e6;
/// How often, while the slices are drawn, pixels that have become opaque are taken out of the work: each time costs a
/// pass over the picture.
constexpr std::size_t kMaskings = 10;

using glm::value_ptr;

/// slice.vert and slice_raycast.frag, one permutation; locations are those written there.
class SliceProgram {
public:
    explicit SliceProgram(const std::vector<std::string>& defines)
        : m_program(makeProgram({"slice.vert", "slice_raycast.frag"}, defines)), m_id(m_program.id()) {}

    void use() const { glUseProgram(m_id); }
    void setEntriesPerCode(float v) const { glProgramUniform1f(m_id, 0, v); }
    void setIntegralStart(int v) const { glProgramUniform1i(m_id, 12, v); }
    void setPictureFromFragment(const glm::vec4& v) const { glProgramUniform4fv(m_id, 1, 1, value_ptr(v)); }
    void setRays(const glm::mat3& origin, const glm::mat3& direction) const {
        glProgramUniformMatrix3fv(m_id, 2, 1, GL_FALSE, value_ptr(origin));
        glProgramUniformMatrix3fv(m_id, 3, 1, GL_FALSE, value_ptr(direction));
    }
    void setTangents(const glm::vec2& v) const { glProgramUniform2fv(m_id, 4, 1, value_ptr(v)); }
    void setPerD0(float v) const { glProgramUniform1f(m_id, 5, v); }
    void setClip(const glm::vec3& lo, const glm::vec3& hi) const {
        glProgramUniform3fv(m_id, 6, 1, value_ptr(lo));
        glProgramUniform3fv(m_id, 7, 1, value_ptr(hi));
    }
    void setShading(const glm::vec3& voxel, const glm::vec3& spacing, const glm::vec3& box, float perCode) const {
        glProgramUniform3fv(m_id, 8, 1, value_ptr(voxel));
        glProgramUniform3fv(m_id, 9, 1, value_ptr(spacing));
        glProgramUniform3fv(m_id, 10, 1, value_ptr(box));
        glProgramUniform1f(m_id, 11, perCode);
    }
    void setBrick(const VolumeBrick& b) const {
        glProgramUniform3fv(m_id, 13, 1, value_ptr(glm::vec3(b.lo)));
        glProgramUniform3fv(m_id, 14, 1, value_ptr(glm::vec3(b.hi)));
        glProgramUniform3fv(m_id, 15, 1, value_ptr(glm::vec3(b.textureFromBox)));
        glProgramUniform3fv(m_id, 16, 1, value_ptr(glm::vec3(b.textureOffset)));
        glProgramUniform3fv(m_id, 17, 1, value_ptr(glm::vec3(b.textureEnd)));
    }
    void setTileFromPicture(const glm::vec4& v) const { glProgramUniform4fv(m_id, 20, 1, value_ptr(v)); }

private:
    ProgramName m_program;
    GLuint m_id;
};

/// composite.vert and composite.frag.
class CompositeProgram {
public:
    CompositeProgram() : m_program(makeProgram({"composite.vert", "composite.frag"})), m_id(m_program.id()) {}
    void use() const { glUseProgram(m_id); }
    void setBackground(const glm::vec4& v) const { glProgramUniform4fv(m_id, 0, 1, value_ptr(v)); }
    void setTextureFromFragment(const glm::vec4& v) const { glProgramUniform4fv(m_id, 1, 1, value_ptr(v)); }

private:
    ProgramName m_program;
    GLuint m_id;
};

struct Tile {
    int x, y, width, height; ///< pixels of the picture, from its top left corner
};

Tile tileOf(const RenderSettings& settings, const DrawTarget& target) {
    Tile tile{target.tileX, target.tileY, target.tileWidth, target.tileHeight};
    if (tile.width == 0 && tile.height == 0) tile = {0, 0, settings.width, settings.height};
    PELLUCID_CHECK(tile.x >= 0 && tile.y >= 0 && tile.width > 0 && tile.height > 0 &&
                   tile.x + tile.width <= settings.width && tile.y + tile.height <= settings.height);
    return tile;
}

} // namespace

struct SliceRaycaster::Impl {
    CompositeProgram composite;
    std::array<std::optional<SliceProgram>, 4> slices; ///< compiled when first needed; index: 2·shading + invalid
    VertexArrayName sliceArray = VertexArrayName::make();
    VertexArrayName emptyArray = VertexArrayName::make();
    BufferName vertexBuffer = BufferName::make();
    ColorTarget accumulated;
    ProgramName maskProgram = makeProgram({"composite.vert", "opaque_mask.frag"});
    Texture2d depth;                 ///< of `accumulated`: 1 where the picture is open, 0 where it is opaque
    FramebufferName maskFramebuffer; ///< depth alone, since a texture must not be read and drawn at once

    std::shared_ptr<const Volume> volume;
    std::unique_ptr<BrickedVolume> bricks;
    std::optional<TransferFunction> tf;
    TableTexture table;
    std::optional<int> tableFeature; ///< onlyFeature that the table was made for; empty: it is out of date

    Impl() {
        glBindVertexArray(sliceArray.id());
        glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer.id());
        // NOLINTNEXTLINE(performance-no-int-to-ptr): GL takes offsets into buffers as pointers
        const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(SlabVertex), offset(0));
        glEnableVertexAttribArray(1);
        glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(SlabVertex), offset(2 * sizeof(float)));
        glBindVertexArray(0);
        glBindBuffer(GL_ARRAY_BUFFER, 0);
        throwOnGlError("preparing to draw");
    }

    const SliceProgram& program(bool shading) {
        auto& slot = slices[(shading ? 2u : 0u) + (bricks->hasInvalid() ? 1u : 0u)];
        if (!slot) {
            auto defines = bricks->defines();
            if (shading) defines.push_back("SHADING");
            slot.emplace(defines);
        }
        return *slot;
    }

    /// (τ·rgb, τ) per entry, then their running integral (shaders/include/tf_segment.glsl); a feature alone
    /// leaves the other intensities transparent.
    void fillTable(const RenderSettings& settings) {
        if (tableFeature == settings.onlyFeature) return;
        const Feature* const only = settings.featureAlone(*tf);
        const TfTable made = makeTfTable(*tf, kTableSize);
        std::vector<float> values(static_cast<std::size_t>(8 * kTableSize));
        glm::dvec4 integral(0), before(0);
        for (std::size_t i = 0; i < made.rgba.size(); ++i) {
            const double s = static_cast<double>(i) / (kTableSize - 1);
            const bool drawn = only == nullptr || only->contains(s);
            const double tau = drawn ? static_cast<double>(made.opticalDepth[i]) : 0.0;
            const auto& c = made.rgba[i];
            const glm::dvec4 entry(tau * Vec3(c[0], c[1], c[2]), tau);
            if (i > 0) integral += 0.5 * (before + entry);
            before = entry;
            for (int k = 0; k < 4; ++k) {
                values[4 * i + static_cast<std::size_t>(k)] = static_cast<float>(entry[k]);
                values[4 * (kTableSize + i) + static_cast<std::size_t>(k)] = static_cast<float>(integral[k]);
            }
        }
        tableFeature.reset();
        table.fill(values, 4);
        tableFeature = settings.onlyFeature;
    }

    void resize(glm::ivec2 size);
    void maskOpaque();
    void drawSlabs(const SliceProgram& p, const std::vector<SlabVertex>& vertices, const JobControl& job);
    void accumulate(const Camera& camera, const RenderSettings& settings, const Tile& tile, const JobControl& job);
    void drawComposite(const RenderSettings& settings, const DrawTarget& target, const Tile& tile);
};

void SliceRaycaster::Impl::resize(glm::ivec2 size) {
    if (accumulated.color.size == size && depth.size == size) return;
    accumulated = makeColorTarget(size, GL_RGBA32F, GL_LINEAR, "the picture");
    depth = makeTexture2d(size, GL_DEPTH_COMPONENT24, GL_NEAREST, "the picture's mask");
    maskFramebuffer = FramebufferName::make();
    glBindFramebuffer(GL_FRAMEBUFFER, maskFramebuffer.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.name.id(), 0);
    glDrawBuffer(GL_NONE);
    glBindFramebuffer(GL_FRAMEBUFFER, accumulated.framebuffer.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.name.id(), 0);
    throwOnGlError("preparing the picture");
}

/// Later slices fail the depth test where the picture is opaque already. Leaves everything ready for them.
void SliceRaycaster::Impl::maskOpaque() {
    glBindFramebuffer(GL_FRAMEBUFFER, maskFramebuffer.id());
    glUseProgram(maskProgram.id());
    glBindVertexArray(emptyArray.id());
    bindTexture(0, GL_TEXTURE_2D, accumulated.color.name);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_ALWAYS);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_FALSE);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindVertexArray(sliceArray.id());
    glBindFramebuffer(GL_FRAMEBUFFER, accumulated.framebuffer.id());
}

void SliceRaycaster::Impl::accumulate(const Camera& camera, const RenderSettings& settings, const Tile& tile,
                                      const JobControl& job) {
    const Geometry& g = volume->geometry();
    const SliceView view(camera, g, settings);

    const glm::vec2 size(accumulated.color.size);
    const glm::vec2 picture(settings.width, settings.height);
    // The tile in picture coordinates: [−1,1]² over the whole picture, y up.
    const glm::vec2 tileSize = 2.0f * glm::vec2(tile.width, tile.height) / picture;
    const glm::vec2 tileLow(2.0f * static_cast<float>(tile.x) / picture.x - 1.0f,
                            1.0f - 2.0f * static_cast<float>(tile.y + tile.height) / picture.y);

    const SliceProgram& p = program(settings.light.on);
    p.use();
    p.setEntriesPerCode(static_cast<float>(65535.0 / bricks->maxCode() * (kTableSize - 1)));
    p.setIntegralStart(kTableSize);
    p.setPictureFromFragment({tileSize / size, tileLow});
    p.setTileFromPicture({2.0f / tileSize, -2.0f * tileLow / tileSize - 1.0f});
    p.setRays(glm::mat3(view.rayOrigin(g)), glm::mat3(view.rayDirection(g)));
    p.setTangents(view.perspective ? glm::vec2(view.halfExtent) : glm::vec2(0));
    p.setPerD0(static_cast<float>(1 / g.d0()));
    p.setClip(glm::vec3(settings.clipping.lo), glm::vec3(settings.clipping.hi));
    if (settings.light.on)
        p.setShading(glm::vec3(1.0 / Vec3(g.dims)), glm::vec3(g.spacing), glm::vec3(g.boundsMax() - g.boundsMin()),
                     65535.0f / static_cast<float>(bricks->maxCode()));
    bindTexture(1, GL_TEXTURE_2D, table.name());

    glBindFramebuffer(GL_FRAMEBUFFER, accumulated.framebuffer.id());
    glViewport(0, 0, accumulated.color.size.x, accumulated.color.size.y);
    const std::array<float, 4> nothing{};
    const float open = 1.0f;
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    glClearBufferfv(GL_DEPTH, 0, &open);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LESS);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    // Under: what comes later lies behind what is there.
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);

    glBindVertexArray(sliceArray.id());
    RenderSettings sampled = settings;
    // Both ends of a segment must lie in its brick's texture.
    if (bricks->count() > 1) sampled.stepInD0 = std::min(settings.stepInD0, kBrickStep);
    const auto order = bricks->frontToBack(camera);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const VolumeBrick& brick = bricks->use(order[i]);
        p.setBrick(brick);
        drawSlabs(p, slabTriangles(view, g, sampled, glm::max(brick.lo, Vec3(0)), glm::min(brick.hi, Vec3(1))),
                  job.part(i, order.size()));
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    throwOnGlError("drawing the slices");
}

/// Front to back over what is accumulated already.
void SliceRaycaster::Impl::drawSlabs(const SliceProgram& p, const std::vector<SlabVertex>& vertices,
                                     const JobControl& job) {
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(SlabVertex)), vertices.data(),
                 GL_STREAM_DRAW);
    // Whole slabs only would be prettier, but any cut is right: triangles of one slab do not overlap.
    const glm::dvec2 size(accumulated.color.size);
    const double slabsPerBatch = kFragmentsPerBatch / (size.x * size.y);
    const std::size_t perBatch =
        3 * std::min(static_cast<std::size_t>(std::max(1.0, 4 * slabsPerBatch)), vertices.size() / 3 / kMaskings + 1);
    for (std::size_t first = 0; first < vertices.size(); first += perBatch) {
        job.throwIfStopped();
        if (first > 0) maskOpaque();
        p.use();
        const std::size_t count = std::min(perBatch, vertices.size() - first);
        glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
        // Without waiting the driver would queue everything, and nobody could cancel.
        if (job.stop.stop_possible() || job.progress) {
            glFinish();
            job.report(static_cast<double>(first + count) / static_cast<double>(vertices.size()));
        }
    }
}

void SliceRaycaster::Impl::drawComposite(const RenderSettings& settings, const DrawTarget& target, const Tile& tile) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(target.x, target.y, tile.width, tile.height);
    composite.use();
    const Rgb background = settings.background.value_or(Rgb{});
    composite.setBackground({background.r, background.g, background.b, settings.background ? 1.0 : 0.0});
    const glm::vec2 scale = 1.0f / glm::vec2(tile.width, tile.height);
    composite.setTextureFromFragment({scale, -glm::vec2(target.x, target.y) * scale});
    bindTexture(0, GL_TEXTURE_2D, accumulated.color.name);
    glBindVertexArray(emptyArray.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    throwOnGlError("drawing the picture");
}

SliceRaycaster::SliceRaycaster() {
    requireGl43();
    m_impl = std::make_unique<Impl>();
}
SliceRaycaster::~SliceRaycaster() = default;
SliceRaycaster::SliceRaycaster(SliceRaycaster&&) noexcept = default;
SliceRaycaster& SliceRaycaster::operator=(SliceRaycaster&&) noexcept = default;

void SliceRaycaster::setVolume(std::shared_ptr<const Volume> volume, int longestTexture) {
    m_impl->bricks = std::make_unique<BrickedVolume>(*volume, longestTexture);
    m_impl->volume = std::move(volume);
}

void SliceRaycaster::setTransferFunction(const TransferFunction& tf) {
    if (m_impl->tf == tf) return;
    m_impl->tf = tf;
    m_impl->tableFeature.reset();
}

void SliceRaycaster::draw(const Camera& camera, const RenderSettings& settings, const DrawTarget& target,
                          const JobControl& job) {
    PELLUCID_CHECK(m_impl->volume && m_impl->tf);
    PELLUCID_CHECK(target.resolutionScale > 0 && target.resolutionScale <= 1);
    settings.validate();
    camera.validate(m_impl->volume->geometry(), "camera");
    const Tile tile = tileOf(settings, target);
    throwOnGlError("preparing to draw");
    m_impl->fillTable(settings);

    const auto scaled = [&](int pixels) {
        return std::max(1, static_cast<int>(std::ceil(pixels * target.resolutionScale)));
    };
    const glm::ivec2 size(scaled(tile.width), scaled(tile.height));
    m_impl->resize(size);

    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_STENCIL_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_BLEND);
    const auto leaveTidy = [&] {
        glDisable(GL_BLEND);
        glDisable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
        glBindVertexArray(0);
        glUseProgram(0);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, 0);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindTexture(GL_TEXTURE_3D, 0);
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    };
    try {
        m_impl->accumulate(camera, settings, tile, job);
        m_impl->drawComposite(settings, target, tile);
    } catch (...) {
        leaveTidy();
        throw;
    }
    leaveTidy();
}

} // namespace pellucid::gl
