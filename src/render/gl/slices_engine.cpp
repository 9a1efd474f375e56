// makeSlicesEngine: the VisibilityEngine that measures with the slices of a picture (docs/method.md, "The slices
// engine"). Slices parallel to the picture are drawn front to back; what has accumulated in front of each goes into a
// layer of a 3D texture, from which a second pass gathers the light of every voxel.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"
#include "render/cpu/cpu_engine.h"
#include "render/gl/engine_budgets.h"
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

struct Sampling {
    double piecesPerVoxel; ///< samples per voxel that a ray crosses sideways, besides those on voxel planes
    glm::ivec2 ownLayers;  ///< in front of a voxel that its own line is followed through: at least, at most
    float tolerance;       ///< of T between neighbouring rays, beyond which it is followed further
};
Sampling samplingOf(Quality quality) {
    if (quality == Quality::High) return {2.5, {4, 24}, 0.01f};
    return {1.5, {1, 16}, 0.04f};
}

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

    /// `sink` takes the visibilities of some planes across z at a time.
    void field(const std::vector<LayeredView>& views, const DepthTables& tables, const JobControl& job,
               const std::function<void(int firstPlane, std::span<const float>)>& sink) {
        m_volume.setWeights(nullptr, 0);
        requireVolume();
        const std::size_t plane = layerSize(m_grid.codes.dims());
        run(views, tables, 0, false, 4.0 * static_cast<double>(plane), job, [&](int first, int end) {
            readVisibility(m_output, plane * static_cast<std::size_t>(end - first),
                           [&](std::span<const float> values) { sink(first, values); });
        });
    }

private:
    /// slices_depth.frag and slices_gather.comp, one permutation; locations as written there.
    struct Programs {
        explicit Programs(const std::vector<std::string>& defines)
            : draw({"composite.vert", "slices_depth.frag"}, defines), gather({"slices_gather.comp"}, defines) {}
        Program draw, gather;
    };
    using AfterGather = std::function<void(int first, int end)>;

    void requireVolume() { m_volume.require({2, 0, m_grid.codes.dims().z, true}); }

    void describe(const Programs& programs, const LayeredView& view, const DepthTables& tables, int ring) const {
        for (const Program* p : {&programs.draw, &programs.gather}) {
            TableBuffers::describe(*p, tables, textureMaxCode(m_grid));
            describeVolume(*p, m_volume, Mat3(1), Vec3(0));
            p->set(1, view.voxelFromLocal);
            p->set(2, view.origin);
            p->set(3, view.inverseDistance);
            p->set(4, glm::dvec4(view.firstPixel, view.pixelsPerD0));
            p->set(5, Vec3(view.front, view.step, view.slabs));
            p->set(9, std::ceil(1 + m_sampling.piecesPerVoxel * view.crossed - 1e-6));
            p->setPlanes(28, 29, view.sides);
            if (!view.faint.empty()) {
                p->set(47, view.faintDensity);
                p->setPlanes(48, 49, view.faint);
            }
        }
        const Program& p = programs.gather;
        p.set(6, view.localFromVoxel);
        p.set(7, m_volume.size());
        p.set(8, view.faceOffset);
        p.set(21, ring);
        p.set(23, m_sampling.ownLayers);
        p.set(24, m_sampling.tolerance);
        p.set(25, glm::ivec2(view.faceAxis, view.faceSign));
        p.set(26, view.faceFromVoxel);
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
            const Programs& programs =
                m_programs.of(definesFor(m_volume, 1, slots, view.sides.size() > 6, !view.faint.empty()));
            describe(programs, view, tables, ring);
            if (slots > 0) programs.gather.set(27, weighted);

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
        programs.draw.use();
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
                programs.draw.set(20, slab);
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
        programs.gather.set(20, glm::ivec2(plane, end));
        programs.gather.set(22, glm::ivec2(firstSlab, endSlab));
        gatherVoxels(programs.gather, {dims.x, dims.y, end - plane});
    }

    const IntensityGrid& m_grid;
    SlicesBudget m_budget;
    Sampling m_sampling;
    ResidentVolume m_volume;
    TableBuffers m_tables;
    FeatureTotals m_totals;
    Permutations<Programs> m_programs;
    VertexArrayName m_vertices; ///< empty: composite.vert needs none
    ColorTarget m_accumulated;
    Texture3d m_layers;
    Buffer m_output;
};

class SlicesEngine final : public DeviceEngine {
public:
    SlicesEngine(std::shared_ptr<const Volume> volume, Quality quality, const SlicesBudget& budget)
        : DeviceEngine(std::move(volume), quality) {
        m_device.emplace([&] { return std::make_unique<SlicesDevice>(*m_codes, quality, budget); });
        m_device.run([&](SlicesDevice& device) { m_mostPixels = device.mostTexels(); });
    }

    std::string name() const override { return "slices"; }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        if (tfs.empty()) return {};
        check(view, tfs, weights);
        const std::vector<LayeredView> views = viewsOf(view);
        const std::vector<Feature>& features = tfs.front().features;
        const std::vector<std::uint16_t> slots = slotsOfCodes(*m_codes, features);
        std::vector<FeatureSums> results;
        for (std::size_t n = 0; n < tfs.size(); ++n) {
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

    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        check(view, {&tf, 1}, nullptr);
        const std::vector<LayeredView> views = viewsOf(view);
        const DepthTables tables = makeDepthTables({&tf, 1}, 1, m_cells);
        VisibilityField result{Grid<float>(m_volume->dims())};
        const auto store = [&](int firstPlane, std::span<const float> values) {
            float* to = &result.values.at(0, 0, firstPlane);
            for (const float v : values) *to++ += v; // 0 but between the slices that the voxel belongs to
        };
        m_device.run([&](SlicesDevice& device) { device.field(views, tables, job, store); });
        job.report(1.0);
        return result;
    }

private:
    std::vector<LayeredView> viewsOf(const View& view) const {
        return makeLayeredViews(view, m_volume->geometry(), m_quality, m_mostPixels);
    }

    int m_mostPixels = 0;
    InContext<SlicesDevice> m_device;
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
