#include "render/gl/sweep_device.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/type_ptr.hpp>

#include "base/error.h"
#include "render/gl/shader_program.h"

namespace pellucid::gl {

namespace {

using glm::value_ptr;

int longestTexture3d() {
    requireGl43();
    return glInteger(GL_MAX_3D_TEXTURE_SIZE);
}

/// Planes whose light is kept besides those that a step adds.
int ringExtra(const Sweep& s) { return s.ownPlanes.y - s.ownPlanes.x + 1; }

} // namespace

/// visibility_march.comp and visibility_gather.comp, one permutation; locations as written there.
class SweepDevice::Programs {
public:
    explicit Programs(const std::vector<std::string>& defines)
        : m_march(makeProgram({"visibility_march.comp"}, defines)),
          m_gather(makeProgram({"visibility_gather.comp"}, defines)) {}

    void setTables(const DepthTables& tables, int maxCode) const {
        for (const GLuint p : {m_march.id(), m_gather.id()}) TableBuffers::describe(p, tables, maxCode);
    }
    void setSweep(const Sweep& s, int ring) const {
        for (const GLuint p : {m_march.id(), m_gather.id()}) {
            glProgramUniform4f(p, 1, static_cast<float>(s.eye.x), static_cast<float>(s.eye.y),
                               static_cast<float>(s.eye.z), s.perspective ? 1.0f : 0.0f);
            glProgramUniform2fv(p, 2, 1, value_ptr(glm::vec2(s.shear)));
            glProgramUniform1f(p, 3, static_cast<float>(s.reference));
            glProgramUniformMatrix3fv(p, 4, 1, GL_FALSE, value_ptr(glm::mat3(s.worldFromQ)));
            glProgramUniform3iv(p, 5, 1, value_ptr(s.dims));
            glProgramUniform3fv(p, 6, 1, value_ptr(glm::vec3(s.grid, s.raysPerVoxel)));
            glProgramUniform2iv(p, 7, 1, value_ptr(s.rays));
            glProgramUniform1f(p, 8, static_cast<float>(s.front));
            glProgramUniform1f(p, 9, static_cast<float>(s.pieces));
            glProgramUniform1i(p, 21, ring);
            if (s.planes.empty()) continue;
            glProgramUniform1i(p, 28, static_cast<GLint>(s.planes.size()));
            for (std::size_t i = 0; i < s.planes.size(); ++i)
                glProgramUniform4fv(p, 29 + static_cast<GLint>(i), 1,
                                    value_ptr(glm::vec4(glm::vec3(s.planes[i].normal), s.planes[i].offset)));
        }
        glProgramUniform2iv(m_gather.id(), 23, 1, value_ptr(s.ownPlanes));
        glProgramUniform1f(m_gather.id(), 24, static_cast<float>(s.tolerance));
        glProgramUniform4i(m_gather.id(), 25, s.pyramid ? s.axis : -1, s.sign, 0, 0);
    }
    void setVolume(const Sweep& s, const ResidentVolume& volume, const Vec3& eyeInVoxels) const {
        const Vec3 first(volume.first());
        const Folding& f = volume.folding();
        for (const GLuint p : {m_march.id(), m_gather.id()}) {
            glProgramUniformMatrix3fv(p, 10, 1, GL_FALSE, value_ptr(glm::mat3(s.voxelFromQ())));
            glProgramUniform3fv(p, 11, 1, value_ptr(glm::vec3(s.voxelOffset() - first)));
            glProgramUniform3iv(p, 14, 1, value_ptr(volume.size() - 1));
            glProgramUniform3fv(p, 15, 1, value_ptr(glm::vec3(volume.codes().size)));
            if (!f.folded()) continue;
            glProgramUniform3iv(p, 16, 1, value_ptr(f.brick));
            glProgramUniform3iv(p, 17, 1, value_ptr(f.bricks));
            glProgramUniform3iv(p, 18, 1, value_ptr(f.slots));
            glProgramUniform3iv(p, 19, 1, value_ptr(f.tile));
        }
        glProgramUniform3fv(m_gather.id(), 26, 1, value_ptr(glm::vec3(eyeInVoxels - first)));
    }
    void setWeighted(bool weighted) const { glProgramUniform1i(m_gather.id(), 27, weighted ? 1 : 0); }

    void march(const Sweep& s, int firstPlane, int endPlane) const {
        glProgramUniform2i(m_march.id(), 20, firstPlane, endPlane);
        glProgramUniform1i(m_march.id(), 22, firstPlane == s.firstPlane ? 1 : 0);
        glUseProgram(m_march.id());
        glDispatchCompute(groups(s.rays.x, kGroupSide), groups(s.rays.y, kGroupSide), 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    void gather(const Sweep& s, int firstPlane, int endPlane) const {
        glProgramUniform2i(m_gather.id(), 20, firstPlane, endPlane);
        glUseProgram(m_gather.id());
        glDispatchCompute(groups(s.dims.x, kGroupSide), groups(s.dims.y, kGroupSide),
                          groups(endPlane - firstPlane, kPlanesPerGroup));
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                        GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    }

private:
    ProgramName m_march, m_gather;
};

SweepDevice::SweepDevice(const IntensityGrid& grid, const VisibilityBudget& budget)
    : m_grid(grid), m_budget(budget),
      m_volume(grid, budget.volumeBytes, std::min(budget.textureSize, longestTexture3d())) {
    // Better now than later: who asked for the best engine takes another one where the volume is too large.
    m_volume.require({2, 0, std::min(grid.codes.dims().z, 20), true});
}

SweepDevice::~SweepDevice() = default;

double SweepDevice::bufferLimit() const {
    return std::min(m_budget.bufferBytes, static_cast<double>(glInteger(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)));
}

int SweepDevice::candidatesAtOnce(const SweepRequest& request) const {
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
    throw Error("the light of " + std::to_string(static_cast<long long>(rays)) + " rays at " + std::to_string(planes) +
                    " planes does not fit into the device's buffers of " +
                    std::to_string(static_cast<long long>(bufferLimit())) + " bytes",
                "OpenGL", "", Remedy::OtherEngine);
}

const SweepDevice::Programs& SweepDevice::programsFor(int candidates, int slots, bool clipped) {
    const std::vector<std::string> defines = definesFor(m_volume, candidates, slots, clipped);
    auto& programs = m_programs[defines];
    if (!programs) programs = std::make_unique<Programs>(defines);
    return *programs;
}

int SweepDevice::prepare(const Sweep& s, int candidates, int slots) {
    const double layer = 4.0 * candidates * s.rays.x * s.rays.y, area = static_cast<double>(s.dims.x) * s.dims.y;
    const double groupsPerLayer = static_cast<double>(groups(s.dims.x, kGroupSide)) * groups(s.dims.y, kGroupSide);
    // What each so many planes leave.
    const int outputPlanes = slots == 0 ? 1 : kPlanesPerGroup;
    const double outputBytes = slots == 0 ? 4 * area : groupsPerLayer * slots * 3 * candidates * 4;
    const double light = std::floor(bufferLimit() / layer) - ringExtra(s);
    const double output = std::floor(bufferLimit() / outputBytes) * outputPlanes;
    if (light < 1 || output < 1)
        throw Error("a single plane of voxels needs more than the device's buffers of " +
                        std::to_string(static_cast<long long>(bufferLimit())) + " bytes",
                    "OpenGL", "", Remedy::OtherEngine);
    // Few enough planes that a step takes well under a second.
    const double wanted = std::max(1.0, m_budget.voxelsPerStep / area);
    int planes = static_cast<int>(std::min({wanted, light, output, static_cast<double>(s.dims.z)}));
    for (;; planes /= 2) {
        if (planes > kPlanesPerGroup) planes = planes / kPlanesPerGroup * kPlanesPerGroup;
        try {
            const int resident = std::min(s.dims.z, planes + s.ownPlanes.y + 1);
            m_volume.require(
                {s.axis, s.sign > 0 ? 0 : s.dims.z - resident, s.sign > 0 ? resident : s.dims.z, s.sign > 0});
            ensureStorage(m_light, layer * (planes + ringExtra(s)), "the rays' light");
            ensureStorage(m_output, outputBytes * groups(planes, outputPlanes),
                          slots == 0 ? "the visibility" : "the sums");
            return planes;
        } catch (const OutOfMemory&) { // fewer planes may do
            if (planes == 1) throw;
        }
    }
}

void SweepDevice::runSweep(const SweepRequest& request, const Sweep& s, int slots, const JobControl& job,
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
        const int front = std::max(0, plane - s.ownPlanes.y - 1);
        m_volume.require(
            {s.axis, s.sign > 0 ? front : s.dims.z - end, s.sign > 0 ? end : s.dims.z - front, s.sign > 0});

        const Programs& programs = programsFor(candidates, slots, !s.planes.empty());
        programs.setTables(request.tables, textureMaxCode(m_grid));
        programs.setSweep(s, ring);
        programs.setVolume(s, m_volume, request.eyeInVoxels);
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

void SweepDevice::runSweeps(const SweepRequest& request, int slots, const JobControl& job, const AfterPlanes& after) {
    m_volume.setWeights(request.weights, request.weightsKey);
    m_tables.upload(request.tables);
    for (std::size_t i = 0; i < request.sweeps.size(); ++i)
        runSweep(request, request.sweeps[i], slots, job.part(i, request.sweeps.size()), after);
    glUseProgram(0);
    throwOnGlError("measuring visibility");
}

std::vector<double> SweepDevice::sums(const SweepRequest& request, const JobControl& job) {
    const int slots = slotsFor(request.features);
    m_totals.begin(request.slotOfCode, slots * 3 * request.tables.candidates);
    runSweeps(request, slots, job, [&](const Sweep& s, int plane, int end) {
        m_totals.add(groups(s.dims.x, kGroupSide) * groups(s.dims.y, kGroupSide) *
                     groups(end - plane, kPlanesPerGroup));
    });
    return m_totals.read();
}

void SweepDevice::field(const SweepRequest& request, const JobControl& job,
                        const std::function<void(const SweptPlanes&)>& sink) {
    runSweeps(request, 0, job, [&](const Sweep& s, int plane, int end) {
        const std::size_t count = static_cast<std::size_t>(s.dims.x) * static_cast<std::size_t>(s.dims.y) *
                                  static_cast<std::size_t>(end - plane);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, m_output.name.id());
        const void* data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(float)),
                                            GL_MAP_READ_BIT);
        throwOnGlError("reading the visibility");
        if (data == nullptr) throw Error("the visibility cannot be read back", "OpenGL", "", Remedy::OtherEngine);
        const struct Unmap {
            ~Unmap() { glUnmapBuffer(GL_SHADER_STORAGE_BUFFER); }
        } unmap;
        sink({s, plane, end, {static_cast<const float*>(data), count}});
    });
}

} // namespace pellucid::gl
