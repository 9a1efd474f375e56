// makeSlicesEngine: the VisibilityEngine that measures with the slices of a picture (docs/method.md, "The slices
// engine"). Slices parallel to the picture are drawn front to back; what has accumulated in front of each goes into a
// layer of a 3D texture, from which a second pass gathers the light of every voxel.
#include "render/gl/slices_engine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <glm/gtc/type_ptr.hpp>

#include "base/error.h"
#include "render/gl/gl_engines.h"
#include "render/gl/headless_context.h"
#include "render/gl/layered_view.h"
#include "render/gl/measure_buffers.h"
#include "render/gl/resident_volume.h"
#include "render/gl/shader_program.h"
#include "render/gl/volume_texture.h"

namespace pellucid {

namespace gl {

namespace {

using glm::value_ptr;

struct Sampling {
    double piecesPerVoxel; ///< samples per voxel that a ray crosses sideways, besides those on voxel planes
    glm::ivec2 ownLayers;  ///< in front of a voxel that its own line is followed through: at least, at most
    float tolerance;       ///< of T between neighbouring rays, beyond which it is followed further
};
Sampling samplingOf(Quality quality) {
    if (quality == Quality::High) return {2.5, {4, 24}, 0.01f};
    return {1.5, {1, 16}, 0.04f};
}

/// The voxels of some planes along z.
struct GatheredPlanes {
    int first, end;
    std::span<const float> values;
};

/// Lives in one OpenGL context.
class SlicesDevice {
public:
    SlicesDevice(const IntensityGrid& grid, Quality quality, const SlicesBudget& budget)
        : m_grid(grid), m_budget(budget), m_sampling(samplingOf(quality)),
          m_volume(grid, std::numeric_limits<double>::infinity(), mostTexels()), m_vertices(VertexArrayName::make()) {
        requireVolume();
    }

    /// Longest edge of a picture.
    static int mostTexels() {
        requireGl43();
        return std::min(glInteger(GL_MAX_3D_TEXTURE_SIZE), glInteger(GL_MAX_TEXTURE_SIZE));
    }

    /// [slot][item] as FeatureTotals has them.
    std::vector<double> sums(const std::vector<LayeredView>& views, const DepthTables& tables,
                             const std::vector<std::uint16_t>& slotOfCode, int features, const WeightFields* weights,
                             const JobControl& job) {
        const int slots = slotsFor(features);
        if (segmentsFor(1, slots) <= 0) refuseTooManyFeatures(features);
        m_volume.setWeights(weights, weights != nullptr ? keyOf(*weights) : 0);
        requireVolume();
        m_totals.begin(slotOfCode, slots * 3);
        const Int3 dims = m_grid.codes.dims();
        const double groupsPerLayer = static_cast<double>(groups(dims.x, kGroupSide)) * groups(dims.y, kGroupSide);
        const double bytes = groupsPerLayer * slots * 3 * 4 / kPlanesPerGroup;
        run(views, tables, slots, weights != nullptr, bytes, job, [&](int first, int end) {
            m_totals.add(static_cast<GLuint>(groupsPerLayer) * groups(end - first, kPlanesPerGroup));
        });
        return m_totals.read();
    }

    void field(const std::vector<LayeredView>& views, const DepthTables& tables, const JobControl& job,
               const std::function<void(const GatheredPlanes&)>& sink) {
        m_volume.setWeights(nullptr, 0);
        requireVolume();
        const Int3 dims = m_grid.codes.dims();
        const std::size_t plane = static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
        run(views, tables, 0, false, 4.0 * static_cast<double>(plane), job, [&](int first, int end) {
            const std::size_t count = plane * static_cast<std::size_t>(end - first);
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, m_output.name.id());
            const void* data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0,
                                                static_cast<GLsizeiptr>(count * sizeof(float)), GL_MAP_READ_BIT);
            throwOnGlError("reading the visibility");
            if (data == nullptr) throw Error("the visibility cannot be read back", "OpenGL", "", Remedy::OtherEngine);
            const struct Unmap {
                ~Unmap() { glUnmapBuffer(GL_SHADER_STORAGE_BUFFER); }
            } unmap;
            sink({first, end, {static_cast<const float*>(data), count}});
        });
    }

private:
    /// slices_depth.frag and slices_gather.comp, one permutation; locations as written there.
    struct Programs {
        explicit Programs(const std::vector<std::string>& defines)
            : draw(makeProgram({"composite.vert", "slices_depth.frag"}, defines)),
              gather(makeProgram({"slices_gather.comp"}, defines)) {}
        ProgramName draw, gather;
    };
    using AfterGather = std::function<void(int first, int end)>;

    void requireVolume() { m_volume.require({2, 0, m_grid.codes.dims().z, true}); }

    const Programs& programsFor(int slots, bool clipped) {
        const std::vector<std::string> defines = definesFor(m_volume, 1, slots, clipped);
        auto& programs = m_programs[defines];
        if (!programs) programs = std::make_unique<Programs>(defines);
        return *programs;
    }

    void describe(const Programs& programs, const LayeredView& view, const DepthTables& tables, int ring) const {
        const Folding& f = m_volume.folding();
        for (const GLuint p : {programs.draw.id(), programs.gather.id()}) {
            TableBuffers::describe(p, tables, textureMaxCode(m_grid));
            glProgramUniformMatrix3fv(p, 1, 1, GL_FALSE, value_ptr(glm::mat3(view.voxelFromLocal)));
            glProgramUniform3fv(p, 2, 1, value_ptr(glm::vec3(view.origin)));
            glProgramUniform1f(p, 3, static_cast<float>(view.inverseDistance));
            glProgramUniform4fv(p, 4, 1, value_ptr(glm::vec4(view.firstPixel, view.pixelsPerD0)));
            glProgramUniform3fv(p, 5, 1, value_ptr(glm::vec3(view.front, view.step, view.slabs)));
            glProgramUniform1f(p, 9,
                               static_cast<float>(std::ceil(1 + m_sampling.piecesPerVoxel * view.crossed - 1e-6)));
            glProgramUniform1i(p, 28, static_cast<GLint>(view.sides.size()));
            for (std::size_t i = 0; i < view.sides.size(); ++i)
                glProgramUniform4fv(p, 29 + static_cast<GLint>(i), 1,
                                    value_ptr(glm::vec4(glm::vec3(view.sides[i].normal), view.sides[i].offset)));
            glProgramUniformMatrix3fv(p, 10, 1, GL_FALSE, value_ptr(glm::mat3(1.0f)));
            glProgramUniform3fv(p, 11, 1, value_ptr(glm::vec3(0.0f)));
            glProgramUniform3iv(p, 14, 1, value_ptr(m_volume.size() - 1));
            glProgramUniform3fv(p, 15, 1, value_ptr(glm::vec3(m_volume.codes().size)));
            if (!f.folded()) continue;
            glProgramUniform3iv(p, 16, 1, value_ptr(f.brick));
            glProgramUniform3iv(p, 17, 1, value_ptr(f.bricks));
            glProgramUniform3iv(p, 18, 1, value_ptr(f.slots));
            glProgramUniform3iv(p, 19, 1, value_ptr(f.tile));
        }
        const GLuint p = programs.gather.id();
        glProgramUniformMatrix3fv(p, 6, 1, GL_FALSE, value_ptr(glm::mat3(view.localFromVoxel)));
        glProgramUniform3iv(p, 7, 1, value_ptr(m_volume.size()));
        glProgramUniform1i(p, 21, ring);
        glProgramUniform2iv(p, 23, 1, value_ptr(m_sampling.ownLayers));
        glProgramUniform1f(p, 24, m_sampling.tolerance);
        glProgramUniform2i(p, 25, view.faceAxis, view.faceSign);
        glProgramUniformMatrix3fv(p, 26, 1, GL_FALSE, value_ptr(glm::mat3(view.faceFromVoxel)));
        glProgramUniform3fv(p, 8, 1, value_ptr(glm::vec3(view.faceOffset)));
    }

    /// Makes room for the layers of a picture, and says how many there are.
    int makeLayers(const LayeredView& view) {
        const double layer = 4.0 * view.size.x * view.size.y;
        const int least = m_sampling.ownLayers.y + 2; // those behind the voxels, and one slab
        int most = std::min(view.slabs + 1 + m_sampling.ownLayers.y, mostTexels());
        most = static_cast<int>(std::clamp(m_budget.layerBytes / layer, static_cast<double>(least),
                                           std::max(static_cast<double>(most), static_cast<double>(least))));
        if (m_accumulated.color.size != view.size) {
            m_accumulated = {};
            m_accumulated = makeColorTarget(view.size, GL_R32F, GL_NEAREST, "the slices");
        }
        for (;;) {
            if (m_layers.size.x == view.size.x && m_layers.size.y == view.size.y && m_layers.size.z >= most)
                return m_layers.size.z;
            try {
                m_layers = {}; // before the new one, so that both never need room at once
                m_layers = makeTexture3d({view.size, most}, GL_R32F, GL_NEAREST, "the slices' layers");
                return most;
            } catch (const OutOfMemory&) { // fewer may do
                if (most == least) throw;
                most = std::max(least, most / 2);
            }
        }
    }

    /// Slab by slab; `bytesPerPlane` of m_output per voxel plane.
    void run(const std::vector<LayeredView>& views, const DepthTables& tables, int slots, bool weighted,
             double bytesPerPlane, const JobControl& job, const AfterGather& after) {
        m_tables.upload(tables);
        const int planes = m_grid.codes.dims().z;
        int atOnce =
            static_cast<int>(std::clamp(m_budget.bufferBytes / bytesPerPlane, 1.0, static_cast<double>(planes)));
        if (atOnce > kPlanesPerGroup) atOnce = atOnce / kPlanesPerGroup * kPlanesPerGroup;
        ensureStorage(m_output, bytesPerPlane * kPlanesPerGroup * groups(atOnce, kPlanesPerGroup),
                      slots == 0 ? "the visibility" : "the sums");
        const struct Tidy {
            ~Tidy() {
                glDisable(GL_BLEND);
                glDisable(GL_SCISSOR_TEST);
                glBindFramebuffer(GL_FRAMEBUFFER, 0);
                glUseProgram(0);
            }
        } tidy;
        for (std::size_t v = 0; v < views.size(); ++v) {
            const LayeredView& view = views[v];
            const JobControl part = job.part(v, views.size());
            const int ring = makeLayers(view);
            const Programs& programs = programsFor(slots, view.sides.size() > 6);
            describe(programs, view, tables, ring);
            if (slots > 0) glProgramUniform1i(programs.gather.id(), 27, weighted ? 1 : 0);

            beginPicture(view);
            const int perBatch = std::min(ring - m_sampling.ownLayers.y - 1, view.slabs);
            for (int slab = 0; slab < view.slabs; slab += perBatch) {
                const int end = std::min(slab + perBatch, view.slabs);
                drawSlabs(programs, view, slab, end, ring, part);
                for (int plane = 0; plane < planes; plane += atOnce) {
                    part.throwIfStopped();
                    gather(programs, slab, end, plane, std::min(plane + atOnce, planes));
                    after(plane, std::min(plane + atOnce, planes));
                }
            }
        }
        throwOnGlError("measuring visibility");
    }

    void beginPicture(const LayeredView& view) {
        const std::array<float, 4> nothing{};
        glBindFramebuffer(GL_FRAMEBUFFER, m_accumulated.framebuffer.id());
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_DEPTH_TEST);
        glClearBufferfv(GL_COLOR, 0, nothing.data());
        glViewport(0, 0, view.size.x, view.size.y);
        copyToLayer(0);
    }

    void copyToLayer(int layer) {
        bindTexture(3, GL_TEXTURE_3D, m_layers.name);
        glCopyTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, layer, 0, 0, m_accumulated.color.size.x,
                            m_accumulated.color.size.y);
    }

    /// What has accumulated before each slice, front to back, into its layer.
    void drawSlabs(const Programs& programs, const LayeredView& view, int first, int end, int ring,
                   const JobControl& job) {
        glBindFramebuffer(GL_FRAMEBUFFER, m_accumulated.framebuffer.id());
        glBindVertexArray(m_vertices.id());
        glUseProgram(programs.draw.id());
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE);
        glEnable(GL_SCISSOR_TEST);
        for (int slab = first; slab < end; ++slab) {
            if (slab % m_budget.slabsPerStep == 0) {
                if (job.stop.stop_possible() || job.progress) glFinish(); // else nobody could cancel
                job.throwIfStopped();
                job.report(static_cast<double>(slab) / view.slabs);
            }
            const auto& [from, to] = view.rectangles[static_cast<std::size_t>(slab)];
            if (from.x < to.x && from.y < to.y) {
                bindTexture(0, GL_TEXTURE_3D, m_volume.codes().name);
                glScissor(from.x, from.y, to.x - from.x, to.y - from.y);
                glProgramUniform1i(programs.draw.id(), 20, slab);
                glDrawArrays(GL_TRIANGLES, 0, 3);
            }
            copyToLayer((slab + 1) % ring);
        }
        glBindVertexArray(0);
    }

    void gather(const Programs& programs, int firstSlab, int endSlab, int plane, int end) {
        const Int3 dims = m_grid.codes.dims();
        bindTexture(0, GL_TEXTURE_3D, m_volume.codes().name);
        bindTexture(2, GL_TEXTURE_3D, m_volume.weights().name);
        bindTexture(3, GL_TEXTURE_3D, m_layers.name);
        bindStorage(5, m_output);
        glProgramUniform2i(programs.gather.id(), 20, plane, end);
        glProgramUniform2i(programs.gather.id(), 22, firstSlab, endSlab);
        glUseProgram(programs.gather.id());
        glDispatchCompute(groups(dims.x, kGroupSide), groups(dims.y, kGroupSide), groups(end - plane, kPlanesPerGroup));
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                        GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    }

    const IntensityGrid& m_grid;
    SlicesBudget m_budget;
    Sampling m_sampling;
    ResidentVolume m_volume;
    TableBuffers m_tables;
    FeatureTotals m_totals;
    std::map<std::vector<std::string>, std::unique_ptr<Programs>> m_programs;
    VertexArrayName m_vertices; ///< empty: composite.vert needs none
    ColorTarget m_accumulated;
    Texture3d m_layers;
    Buffer m_output;
};

class SlicesEngine final : public VisibilityEngine {
public:
    SlicesEngine(std::shared_ptr<const Volume> volume, Quality quality, const SlicesBudget& budget)
        : m_volume(std::move(volume)), m_quality(quality), m_codes(sharedIntensityGrid(*m_volume)),
          m_cells(tableCells(*m_volume, quality)) {
        m_device.emplace([&] { return std::make_unique<SlicesDevice>(*m_codes, quality, budget); });
        m_device.run([&](SlicesDevice& device) { m_mostPixels = device.mostTexels(); });
    }

    std::string name() const override { return "slices"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        if (tfs.empty()) return {};
        const std::vector<LayeredView> views = viewsOf(view);
        const std::vector<Feature>& features = tfs.front().features;
        if (weights != nullptr) PELLUCID_CHECK(weights->dims() == m_volume->dims());
        const std::vector<std::uint16_t> slots = slotsOfCodes(*m_codes, features);
        std::vector<FeatureSums> results;
        for (std::size_t n = 0; n < tfs.size(); ++n) {
            PELLUCID_CHECK(tfs[n].features == features);
            const DepthTables tables = makeDepthTables(tfs.subspan(n, 1), 1, m_cells);
            std::vector<double> totals;
            m_device.run([&](SlicesDevice& device) {
                totals = device.sums(views, tables, slots, static_cast<int>(features.size()), weights,
                                     job.part(n, tfs.size()));
            });
            results.push_back(featureSumsOf(totals, features.size(), 0, 1, weights));
        }
        job.report(1.0);
        return results;
    }

    /// Slices have no derivatives: the cpu engine answers, on the same volume.
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        if (!m_cpu) m_cpu = makeCpuEngine(m_volume, m_quality);
        return m_cpu->jacobian(view, tf, weights, job);
    }

    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        const std::vector<LayeredView> views = viewsOf(view);
        const DepthTables tables = makeDepthTables({&tf, 1}, 1, m_cells);
        VisibilityField result{Grid<float>(m_volume->dims())};
        const auto store = [&](const GatheredPlanes& planes) {
            float* to = &result.values.at(0, 0, planes.first);
            for (const float v : planes.values) *to++ += v; // 0 but between the slices that the voxel belongs to
        };
        m_device.run([&](SlicesDevice& device) { device.field(views, tables, job, store); });
        job.report(1.0);
        return result;
    }

private:
    std::vector<LayeredView> viewsOf(const View& view) const {
        view.camera.validate(m_volume->geometry(), "camera");
        view.clipping.validate();
        return makeLayeredViews(view, m_volume->geometry(), m_quality, m_mostPixels);
    }

    std::shared_ptr<const Volume> m_volume;
    Quality m_quality;
    std::shared_ptr<const IntensityGrid> m_codes;
    int m_cells, m_mostPixels = 0;
    InContext<SlicesDevice> m_device;
    std::unique_ptr<VisibilityEngine> m_cpu; ///< made when first needed
};

} // namespace

std::unique_ptr<VisibilityEngine> makeSlicesEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                   const SlicesBudget& budget) {
    return std::make_unique<SlicesEngine>(std::move(volume), quality, budget);
}

} // namespace gl

std::unique_ptr<VisibilityEngine> makeSlicesEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return gl::makeSlicesEngine(std::move(volume), quality, gl::SlicesBudget{});
}

} // namespace pellucid
