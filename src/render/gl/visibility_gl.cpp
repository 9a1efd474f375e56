// makeGlEngine: the VisibilityEngine on OpenGL (docs/method.md, "The gl engine"). Rays march through the volume and
// leave in a buffer how much light they bring to every voxel plane; a second pass gathers from it, per voxel, the light
// in front of it; a third one adds up per feature.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/cpu/cpu_engine.h"
#include "render/gl/engine_budgets.h"
#include "render/gl/gl_engines.h"
#include "render/gl/headless_context.h"
#include "render/gl/measure_buffers.h"
#include "render/gl/sweep_geometry.h"

namespace pellucid {

namespace gl {

namespace {

struct SweepRequest {
    std::vector<Sweep> sweeps;
    Vec3 eyeInVoxels{0, 0, 0};
    DepthTables tables; ///< 1, 4 or 8 candidates
    // For sums:
    int features = 0;
    std::vector<std::uint16_t> slotOfCode; ///< index of the feature; `features` for "in none"
    const WeightFields* weights = nullptr; ///< null: no weighted sums
    std::uint64_t weightsKey = 0;          ///< tells weights apart
};

/// visibility_march.comp and visibility_gather.comp, one permutation; locations as written there.
class SweepPrograms {
public:
    explicit SweepPrograms(const std::vector<std::string>& defines)
        : m_march({"visibility_march.comp"}, defines), m_gather({"visibility_gather.comp"}, defines) {}

    void describe(const SweepRequest& request, const Sweep& s, int ring, const ResidentVolume& volume,
                  int maxCode) const {
        const Vec3 first(volume.first());
        for (const Program* p : {&m_march, &m_gather}) {
            TableBuffers::describe(*p, request.tables, maxCode);
            describeVolume(*p, volume, s.voxelFromQ(), s.voxelOffset() - first);
            p->set(1, glm::dvec4(s.eye, s.perspective ? 1 : 0));
            p->set(2, s.shear);
            p->set(3, s.reference);
            p->set(4, s.worldFromQ);
            p->set(5, s.dims);
            p->set(6, Vec3(s.grid, s.raysPerVoxel));
            p->set(7, s.rays);
            p->set(8, s.front);
            p->set(9, static_cast<double>(s.pieces));
            p->set(21, ring);
            if (!s.planes.empty()) p->setPlanes(28, 29, s.planes);
            if (!s.faint.empty()) {
                p->set(47, s.faintDensity);
                p->setPlanes(48, 49, s.faint);
            }
        }
        m_gather.set(23, s.ownPlanes);
        m_gather.set(24, s.tolerance);
        m_gather.set(25, glm::ivec4(s.pyramid ? s.axis : -1, s.sign, 0, 0));
        m_gather.set(26, request.eyeInVoxels - first);
    }
    void setWeighted(bool weighted) const { m_gather.set(27, weighted); }

    void march(const Sweep& s, int firstPlane, int endPlane) const {
        m_march.set(20, glm::ivec2(firstPlane, endPlane));
        m_march.set(22, firstPlane == s.firstPlane);
        m_march.use();
        glDispatchCompute(groups(s.rays.x, kGroupSide), groups(s.rays.y, kGroupSide), 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    void gather(const Sweep& s, int firstPlane, int endPlane) const {
        m_gather.set(20, glm::ivec2(firstPlane, endPlane));
        gatherVoxels(m_gather, {s.dims.x, s.dims.y, endPlane - firstPlane});
    }

private:
    Program m_march, m_gather;
};

int longestTexture3d() {
    requireGl43();
    return glInteger(GL_MAX_3D_TEXTURE_SIZE);
}

/// Planes whose light is kept besides those that a step adds.
int ringExtra(const Sweep& s) { return s.ownPlanes.y - s.ownPlanes.x + 1; }

/// The planes [first, end) of a sweep, c, as planes of the volume.
ResidentVolume::Planes inVolume(const Sweep& s, int first, int end) {
    return {s.axis, s.sign > 0 ? first : s.dims.z - end, s.sign > 0 ? end : s.dims.z - first, s.sign > 0};
}

/// The sweeps of one volume. Lives in one OpenGL context.
class SweepDevice {
public:
    /// `grid` must outlive the device. Throws Error where the context is older than 4.3.
    SweepDevice(const IntensityGrid& grid, const VisibilityBudget& budget)
        : m_grid(grid), m_budget(budget),
          m_volume(grid, budget.volumeBytes, std::min(budget.textureSize, longestTexture3d())) {
        // Better now than later: who asked for the best engine takes another one where the volume is too large.
        m_volume.require({2, 0, std::min(grid.codes.dims().z, 20), true});
    }

    /// How many candidates one pass can carry within the device's limits: 1, 4 or 8. Throws Error where not even one.
    int candidatesAtOnce(const SweepRequest& request) const {
        double rays = 0;
        int planes = 0;
        for (const Sweep& s : request.sweeps) {
            rays = std::max(rays, static_cast<double>(s.rays.x) * s.rays.y);
            planes = std::max(planes, 1 + ringExtra(s));
        }
        for (const int candidates : {8, 4, 1})
            if (segmentsFor(candidates, slotsFor(request.features)) > 0 &&
                4.0 * candidates * rays * planes <= bufferLimit())
                return candidates;
        refuseTooManyFeatures(request.features);
        refuse("the light of " + std::to_string(static_cast<long long>(rays)) + " rays at " + std::to_string(planes) +
               " planes does not fit into");
    }

    /// [slot][item][candidate] for the slots 0 … features; items are Σv, Σv·brightness, Σv·saturation, the weights in
    /// units of their 16 bits. The same bits in every run. Throws Error, Cancelled.
    std::vector<double> sums(const SweepRequest& request, const JobControl& job) {
        const int slots = slotsFor(request.features);
        m_totals.begin(request.slotOfCode, slots * 3 * request.tables.candidates);
        runSweeps(request, slots, job, [&](const Sweep& s, int plane, int end) {
            m_totals.add(groups(s.dims.x, kGroupSide) * groups(s.dims.y, kGroupSide) *
                         groups(end - plane, kPlanesPerGroup));
        });
        return m_totals.read();
    }

    /// All planes that have voxels, in the order of the sweeps, some at a time; one candidate. `sink` takes the first
    /// of them and their visibilities: a fastest, then b, then c. Throws Error, Cancelled.
    void field(const SweepRequest& request, const JobControl& job,
               const std::function<void(const Sweep&, int first, std::span<const float>)>& sink) {
        runSweeps(request, 0, job, [&](const Sweep& s, int plane, int end) {
            readVisibility(m_output, voxelCount({s.dims.x, s.dims.y, end - plane}),
                           [&](std::span<const float> values) { sink(s, plane, values); });
        });
    }

private:
    using AfterPlanes = std::function<void(const Sweep&, int first, int end)>;

    double bufferLimit() const {
        return std::min(m_budget.bufferBytes, static_cast<double>(glInteger(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)));
    }
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(what + " the device's buffers of " + std::to_string(static_cast<long long>(bufferLimit())) +
                        " bytes",
                    "OpenGL", "", Remedy::OtherEngine);
    }

    /// Makes room for the steps of a sweep, the volume included, and says how many planes one can take.
    int prepare(const Sweep& s, int candidates, int slots) {
        const double layer = 4.0 * candidates * s.rays.x * s.rays.y, area = static_cast<double>(s.dims.x) * s.dims.y;
        const double groupsPerLayer = static_cast<double>(groups(s.dims.x, kGroupSide)) * groups(s.dims.y, kGroupSide);
        // What each so many planes leave.
        const int outputPlanes = slots == 0 ? 1 : kPlanesPerGroup;
        const double outputBytes = slots == 0 ? 4 * area : groupsPerLayer * slots * 3 * candidates * 4;
        const double light = std::floor(bufferLimit() / layer) - ringExtra(s);
        const double output = std::floor(bufferLimit() / outputBytes) * outputPlanes;
        if (light < 1 || output < 1) refuse("a single plane of voxels needs more than");
        // Few enough planes that a step takes well under a second.
        const double wanted = std::max(1.0, m_budget.voxelsPerStep / area);
        int planes = static_cast<int>(std::min({wanted, light, output, static_cast<double>(s.dims.z)}));
        for (;; planes /= 2) {
            if (planes > kPlanesPerGroup) planes = planes / kPlanesPerGroup * kPlanesPerGroup;
            try {
                m_volume.require(inVolume(s, 0, std::min(s.dims.z, planes + s.ownPlanes.y + 1)));
                ensureStorage(m_light, layer * (planes + ringExtra(s)), "the rays' light");
                ensureStorage(m_output, outputBytes * groups(planes, outputPlanes),
                              slots == 0 ? "the visibility" : "the sums");
                return planes;
            } catch (const OutOfMemory&) { // fewer planes may do
                if (planes == 1) throw;
            }
        }
    }

    void runSweep(const SweepRequest& request, const Sweep& s, int slots, const JobControl& job,
                  const AfterPlanes& after) {
        const int candidates = request.tables.candidates;
        const int atOnce = prepare(s, candidates, slots);
        const int ring = atOnce + ringExtra(s);

        int marched = s.firstPlane; // the rays have come so far
        const int lastEnd = s.last.z + 1;
        for (int plane = s.firstPlane; plane < lastEnd; plane += atOnce) {
            job.throwIfStopped();
            job.report(static_cast<double>(plane - s.firstPlane) / (lastEnd - s.firstPlane));
            const int end = std::min(plane + atOnce, lastEnd);
            m_volume.require(inVolume(s, std::max(0, plane - s.ownPlanes.y - 1), end));

            const SweepPrograms& programs =
                m_programs.of(definesFor(m_volume, candidates, slots, !s.planes.empty(), !s.faint.empty()));
            programs.describe(request, s, ring, m_volume, textureMaxCode(m_grid));
            if (slots > 0) programs.setWeighted(request.weights != nullptr);
            bindTexture(2, GL_TEXTURE_3D, m_volume.weights().name);
            bindTexture(0, GL_TEXTURE_3D, m_volume.codes().name);
            bindStorage(0, m_light);
            bindStorage(5, m_output);
            if (const int marchEnd = end - s.ownPlanes.x; marchEnd > marched) {
                programs.march(s, marched, marchEnd);
                marched = marchEnd;
            }
            programs.gather(s, plane, end);
            after(s, plane, end);
            // Without waiting the driver would queue everything, and nobody could cancel.
            if (job.stop.stop_possible() || job.progress) glFinish();
        }
    }

    /// Sweeps everything, some planes at a time; `after` is called when the shaders have been given their work.
    /// `slots` 0: the visibility per voxel goes to m_output; else the sums of the work groups.
    void runSweeps(const SweepRequest& request, int slots, const JobControl& job, const AfterPlanes& after) {
        m_volume.setWeights(request.weights, request.weightsKey);
        m_tables.upload(request.tables);
        for (std::size_t i = 0; i < request.sweeps.size(); ++i)
            runSweep(request, request.sweeps[i], slots, job.part(i, request.sweeps.size()), after);
        glUseProgram(0);
        throwOnGlError("measuring visibility");
    }

    const IntensityGrid& m_grid;
    VisibilityBudget m_budget;
    ResidentVolume m_volume;
    Permutations<SweepPrograms> m_programs;
    TableBuffers m_tables;
    FeatureTotals m_totals;
    Buffer m_light, m_output;
};

class GlEngine final : public DeviceEngine {
public:
    GlEngine(std::shared_ptr<const Volume> volume, Quality quality, const VisibilityBudget& budget)
        : DeviceEngine(std::move(volume), quality) {
        m_device.emplace([&] { return std::make_unique<SweepDevice>(*m_codes, budget); });
    }

    std::string name() const override { return "gl"; }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        check(view, tfs, weights);
        if (tfs.empty()) return {};
        const std::vector<Feature>& features = tfs.front().features;
        SweepRequest request = requestOf(view);
        request.slotOfCode = slotsOfCodes(*m_codes, features);
        request.features = static_cast<int>(features.size());
        if (weights != nullptr) {
            request.weights = weights;
            request.weightsKey = keyOf(*weights);
        }
        int atOnce = 0;
        m_device.run([&](SweepDevice& device) { atOnce = device.candidatesAtOnce(request); });

        const std::size_t size = static_cast<std::size_t>(atOnce), groups = (tfs.size() + size - 1) / size;
        std::vector<FeatureSums> results;
        while (results.size() < tfs.size()) {
            const std::size_t first = results.size();
            const auto group = tfs.subspan(first, std::min(size, tfs.size() - first));
            const int lanes = group.size() == 1 ? 1 : group.size() <= 4 ? 4 : 8;
            request.tables = makeDepthTables(group, lanes, m_cells);
            std::vector<double> totals;
            m_device.run([&](SweepDevice& device) { totals = device.sums(request, job.part(first / size, groups)); });
            for (std::size_t lane = 0; lane < group.size(); ++lane)
                results.push_back(
                    featureSumsOf(totals, features.size(), lane, static_cast<std::size_t>(lanes), weights));
        }
        job.report(1.0);
        return results;
    }

    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        check(view, {&tf, 1}, nullptr);
        SweepRequest request = requestOf(view);
        request.tables = makeDepthTables({&tf, 1}, 1, m_cells);
        VisibilityField result{Grid<float>(m_volume->dims())};
        const auto store = [&](const Sweep& sweep, int firstPlane, std::span<const float> values) {
            const auto stride = sweep.strides();
            auto v = values.begin();
            for (int c = firstPlane; v != values.end(); ++c)
                for (int b = 0; b < sweep.dims.y; ++b)
                    for (int a = 0; a < sweep.dims.x; ++a) { // 0 but in the one sweep the voxel belongs to
                        const auto at = stride.base + a * stride.a + b * stride.b + c * stride.c;
                        result.values[static_cast<std::size_t>(at)] += *v++;
                    }
        };
        m_device.run([&](SweepDevice& device) { device.field(request, job, store); });
        job.report(1.0);
        return result;
    }

private:
    SweepRequest requestOf(const View& view) const {
        SweepRequest request;
        request.sweeps = makeSweeps(view, m_volume->geometry(), m_quality);
        request.eyeInVoxels = m_volume->geometry().voxelFromWorld(view.camera.eye);
        return request;
    }

    InContext<SweepDevice> m_device;
};

} // namespace

std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                               const VisibilityBudget& budget) {
    return std::make_unique<GlEngine>(std::move(volume), quality, budget);
}

} // namespace gl

std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return gl::makeGlEngine(std::move(volume), quality, gl::VisibilityBudget{});
}

} // namespace pellucid
