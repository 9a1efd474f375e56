// makeGlEngine: visibility by OpenGL (MEASURES §4). Rays march through the volume and leave the optical depth of every
// slab in a 3D texture; a second pass gathers from it, per voxel, the transmittance in front of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include <glm/gtc/type_ptr.hpp>

#include "render/gl/engines.h"
#include "render/gl/gl_resources.h"
#include "render/gl/headless_context.h"
#include "render/gl/shader_program.h"
#include "render/gl/sweep_geometry.h"
#include "render/gl/visibility_gl.h"
#include "render/gl/volume_texture.h"
#include "tf/opacity.h"
#include "volume/parallel.h"

namespace pellucid {

namespace gl {

namespace {

constexpr int kGroup = 8; ///< local_size of the shaders, both axes

using glm::value_ptr;

/// Uniforms of include/rays.glsl and include/tf.glsl; locations as written there.
void setSweep(GLuint program, const Sweep& s, const VolumeTexture& volume) {
    glProgramUniform1f(program, 0, 65535.0f);
    glProgramUniform4f(program, 1, static_cast<float>(s.eye.x), static_cast<float>(s.eye.y),
                       static_cast<float>(s.eye.z), s.perspective ? 1.0f : 0.0f);
    glProgramUniform2fv(program, 2, 1, value_ptr(glm::vec2(s.shear)));
    glProgramUniform1f(program, 3, static_cast<float>(s.reference));
    glProgramUniform3fv(program, 4, 1, value_ptr(glm::vec3(s.spacing)));
    glProgramUniform3iv(program, 5, 1, value_ptr(s.dims));
    glProgramUniform3fv(program, 6, 1, value_ptr(glm::vec3(s.grid, s.raysPerVoxel)));
    glProgramUniform2iv(program, 7, 1, value_ptr(s.rays));
    glProgramUniform2f(program, 8, static_cast<float>(s.firstLayer), static_cast<float>(s.layerStep));
    // t = (voxel + ½) / size
    const Vec3 size(volume.texture.size);
    glm::dmat3 texFromQ = s.voxelFromQ();
    for (int column = 0; column < 3; ++column) texFromQ[column] /= size;
    glProgramUniformMatrix3fv(program, 10, 1, GL_FALSE, value_ptr(glm::mat3(texFromQ)));
    glProgramUniform3fv(program, 11, 1, value_ptr(glm::vec3((s.voxelOffset() + 0.5) / size)));
}

/// visibility_march.comp and visibility_gather.comp for one number of candidates; locations as written there.
class SweepPrograms {
public:
    SweepPrograms(int candidates, std::vector<std::string> defines) {
        defines.push_back("CANDIDATES " + std::to_string(candidates));
        m_march = makeProgram({"visibility_march.comp"}, defines);
        m_gather = makeProgram({"visibility_gather.comp"}, defines);
    }

    void begin(const Sweep& sweep, const Geometry& g, const Camera& camera, const VolumeTexture& volume) const {
        setSweep(m_march.id(), sweep, volume);
        setSweep(m_gather.id(), sweep, volume);
        glProgramUniform4i(m_gather.id(), 13, sweep.pyramid ? sweep.axis : -1, sweep.sign, 0, 0);
        glProgramUniform3fv(m_gather.id(), 14, 1, value_ptr(glm::vec3(g.voxelFromWorld(camera.eye))));
        glProgramUniform3fv(m_gather.id(), 15, 1, value_ptr(glm::vec3(g.spacing / g.d0())));
        glProgramUniform1f(m_gather.id(), 16, static_cast<float>(sweep.tolerance));
    }
    void march(const Sweep& sweep, int firstLayer, int lastLayer) const {
        glProgramUniform2i(m_march.id(), 9, firstLayer, lastLayer);
        glUseProgram(m_march.id());
        dispatch(sweep.rays, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                        GL_TEXTURE_UPDATE_BARRIER_BIT);
    }
    void gather(const Sweep& sweep, int firstLayer, int lastLayer, int firstPlane, int endPlane) const {
        glProgramUniform2i(m_gather.id(), 9, firstLayer, lastLayer);
        glProgramUniform2i(m_gather.id(), 12, firstPlane, endPlane);
        glUseProgram(m_gather.id());
        dispatch(glm::ivec2(sweep.dims), endPlane - firstPlane);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    }

private:
    static void dispatch(glm::ivec2 size, int planes) {
        const auto groups = [](int n) { return static_cast<GLuint>((n + kGroup - 1) / kGroup); };
        glDispatchCompute(groups(size.x), groups(size.y), static_cast<GLuint>(planes));
    }
    ProgramName m_march, m_gather;
};

/// The visibilities of some planes of one sweep, on the CPU's side.
struct Planes {
    const Sweep& sweep;
    int first, end;                ///< c
    int candidates;                ///< floats per voxel
    std::span<const float> values; ///< a fastest, then b, then c − first
};
using PlanesSink = std::function<void(const Planes&)>;

/// Everything on the device; lives in its context.
class Device {
public:
    Device(const IntensityGrid& grid, const VisibilityBudget& budget) : m_budget(budget) {
        requireGl43();
        m_volume = uploadVolume(grid);
    }

    /// `tables`: optical depth of d0 per code (0 … maxCode) and candidate, `candidates` (1 or 4) floats per code.
    void sweep(const Camera& camera, const Geometry& g, Quality quality, std::span<const float> tables, int candidates,
               const JobControl& job, const PlanesSink& sink) {
        m_table.fill(tables, candidates);
        auto found = m_programs.find(candidates);
        if (found == m_programs.end())
            found = m_programs.emplace(candidates, SweepPrograms(candidates, m_volume.defines())).first;
        const auto sweeps = makeSweeps(camera, g, quality);
        for (std::size_t i = 0; i < sweeps.size(); ++i) {
            JobControl part = job;
            if (job.progress)
                part.progress = [&](double f) {
                    job.progress((static_cast<double>(i) + f) / static_cast<double>(sweeps.size()));
                };
            found->second.begin(sweeps[i], g, camera, m_volume);
            runSweep(found->second, sweeps[i], candidates, part, sink);
        }
    }

private:
    void runSweep(const SweepPrograms& programs, const Sweep& s, int candidates, const JobControl& job,
                  const PlanesSink& sink) {
        // As many planes at a time as the bounds allow, at least one.
        const double texel = 4.0 * candidates;
        const double layerBytes = texel * s.rays.x * s.rays.y, planeBytes = texel * s.dims.x * s.dims.y;
        const double depthLimit = glInteger(GL_MAX_3D_TEXTURE_SIZE);
        const double blockLimit = glInteger(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
        if (planeBytes > blockLimit)
            throw Error("one plane of voxels takes " + std::to_string(static_cast<long long>(planeBytes)) +
                            " bytes, the device's buffers " + std::to_string(static_cast<long long>(blockLimit)),
                        "OpenGL", "use --engine cpu");
        const double visibilityBytes = std::min(m_budget.visibilityBytes, blockLimit);
        const double layersAtOnce = std::min(m_budget.depthTextureBytes / layerBytes, depthLimit) - 4;
        const int planesAtOnce = std::clamp(
            static_cast<int>(std::min(layersAtOnce * s.layerStep, visibilityBytes / planeBytes)), 1, s.dims.z);
        const int layersNeeded =
            std::min(s.layers, static_cast<int>(std::ceil((planesAtOnce + 1) / s.layerStep)) + 2) + 1;
        const GLenum format = candidates == 4 ? GL_RGBA32F : GL_R32F;
        const glm::ivec3 size(s.rays, layersNeeded);
        if (m_depth.size != size || m_depth.format != format) {
            m_depth = {}; // before the new one, so that both never need room at once
            m_depth = makeTexture3d(size, format, GL_NEAREST, "the rays' optical depth");
        }
        const std::size_t bytes = static_cast<std::size_t>(planeBytes) * static_cast<std::size_t>(planesAtOnce);
        if (m_visibility.bytes < bytes) {
            m_visibility = {};
            m_visibility = makeBuffer(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_STREAM_READ, "the visibility");
        }

        bindTexture(2, GL_TEXTURE_3D, m_depth.name);
        bindTexture(1, GL_TEXTURE_2D, m_table.name());
        bindTexture(0, GL_TEXTURE_3D, m_volume.texture.name);
        glBindImageTexture(0, m_depth.name.id(), 0, GL_TRUE, 0, GL_READ_WRITE, format);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, m_visibility.name.id());

        int present = 0; // layer that the depth texture begins with
        for (int plane = s.firstPlane; plane < s.dims.z; plane += planesAtOnce) {
            job.throwIfStopped();
            job.report(static_cast<double>(plane - s.firstPlane) / (s.dims.z - s.firstPlane));
            const int end = std::min(plane + planesAtOnce, s.dims.z);
            // The points asked for lie up to half a voxel in front of their plane.
            const int first = plane == s.firstPlane ? 0 : s.layerBefore(plane - 0.5);
            const int last = std::max(s.layerAfter(end - 0.5), first + 1);
            if (first != present) copyLayer(first - present, 0, s.rays);
            present = first;
            programs.march(s, first, last);
            programs.gather(s, first, last, plane, end);
            deliver(s, plane, end, candidates, sink);
        }
        glUseProgram(0);
        throwOnGlError("measuring visibility");
    }

    void copyLayer(int from, int to, glm::ivec2 rays) {
        glCopyImageSubData(m_depth.name.id(), GL_TEXTURE_3D, 0, 0, 0, from, m_depth.name.id(), GL_TEXTURE_3D, 0, 0, 0,
                           to, rays.x, rays.y, 1);
    }

    void deliver(const Sweep& s, int plane, int end, int candidates, const PlanesSink& sink) {
        const std::size_t count = static_cast<std::size_t>(s.dims.x) * static_cast<std::size_t>(s.dims.y) *
                                  static_cast<std::size_t>(end - plane) * static_cast<std::size_t>(candidates);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, m_visibility.name.id());
        const void* data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(float)),
                                            GL_MAP_READ_BIT);
        throwOnGlError("measuring visibility");
        if (data == nullptr) throw Error("the visibility cannot be read back", "OpenGL", "use --engine cpu");
        const struct Unmap {
            ~Unmap() { glUnmapBuffer(GL_SHADER_STORAGE_BUFFER); }
        } unmap;
        sink({s, plane, end, candidates, {static_cast<const float*>(data), count}});
    }

    VisibilityBudget m_budget;
    VolumeTexture m_volume;
    TableTexture m_table;
    std::map<int, SweepPrograms> m_programs; ///< by number of candidates
    Texture3d m_depth;
    Buffer m_visibility;
};

} // namespace

} // namespace gl

namespace {

constexpr std::uint16_t kNoFeature = 65535;

class GlEngine final : public VisibilityEngine {
public:
    GlEngine(std::shared_ptr<const Volume> volume, Quality quality, const gl::VisibilityBudget& budget)
        : m_volume(std::move(volume)), m_quality(quality), m_grid(makeIntensityGrid(*m_volume)) {
        m_device.emplace([&] { return std::make_unique<gl::Device>(m_grid, budget); });
    }

    std::string name() const override { return "gl"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const Camera& camera, std::span<const TransferFunction> tfs,
                                  const WeightFields* weights, const JobControl& job) override;
    /// The device has no derivative sweep: the cpu engine answers, on the same volume.
    SumsJacobian jacobian(const Camera& camera, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        return makeCpuEngine(m_volume, m_quality)->jacobian(camera, tf, weights, job);
    }
    VisibilityField field(const Camera& camera, const TransferFunction& tf, const JobControl& job) override;

private:
    /// Per code and candidate; candidates beyond the last transfer function are transparent.
    std::vector<float> opticalDepthTables(std::span<const TransferFunction> tfs, int candidates) const;
    std::vector<std::uint16_t> featureOfCodes(const std::vector<Feature>& features) const;

    std::shared_ptr<const Volume> m_volume;
    Quality m_quality;
    IntensityGrid m_grid;
    gl::InContext<gl::Device> m_device;
};

std::vector<float> GlEngine::opticalDepthTables(std::span<const TransferFunction> tfs, int candidates) const {
    const std::size_t codes = static_cast<std::size_t>(m_grid.maxCode) + 1,
                      lanes = static_cast<std::size_t>(candidates);
    std::vector<float> tables(codes * lanes, 0.0f);
    for (std::size_t t = 0; t < tfs.size(); ++t) {
        const TfSampler sampler(tfs[t]);
        for (std::size_t code = 0; code < codes; ++code) {
            const double s = static_cast<double>(code) / m_grid.maxCode;
            tables[code * lanes + t] = static_cast<float>(opticalDepthOfOpacity(sampler.opacity(s)));
        }
    }
    return tables;
}

std::vector<std::uint16_t> GlEngine::featureOfCodes(const std::vector<Feature>& features) const {
    std::vector<std::uint16_t> of(static_cast<std::size_t>(m_grid.maxCode) + 1, kNoFeature);
    for (std::size_t code = 0; code < of.size(); ++code) {
        const int f = featureAt(features, static_cast<double>(code) / m_grid.maxCode);
        if (f >= 0) of[code] = static_cast<std::uint16_t>(f);
    }
    return of;
}

std::vector<FeatureSums> GlEngine::sums(const Camera& camera, std::span<const TransferFunction> tfs,
                                        const WeightFields* weights, const JobControl& job) {
    camera.validate(m_volume->geometry(), "camera");
    if (tfs.empty()) return {};
    const std::vector<Feature>& features = tfs.front().features;
    for (const TransferFunction& tf : tfs)
        if (tf.features != features)
            throw Error("transfer functions of one batch must share their features", "transfer function", "");
    const std::size_t slots = features.size() + 1;
    const auto featureOf = featureOfCodes(features);

    std::vector<FeatureSums> results(tfs.size());
    for (std::size_t firstTf = 0; firstTf < tfs.size(); firstTf += 4) {
        const auto group = tfs.subspan(firstTf, std::min<std::size_t>(4, tfs.size() - firstTf));
        const int candidates = group.size() == 1 ? 1 : 4;
        const auto tables = opticalDepthTables(group, candidates);
        std::vector<std::array<double, 3>> total(slots * static_cast<std::size_t>(candidates));

        const auto add = [&](const gl::Planes& planes) {
            const auto stride = planes.sweep.strides();
            const auto width = static_cast<std::size_t>(planes.sweep.dims.x);
            const auto height = static_cast<std::size_t>(planes.sweep.dims.y);
            const auto lanes = static_cast<std::size_t>(candidates);
            const auto count = static_cast<std::size_t>(planes.end - planes.first);
            std::vector<std::vector<std::array<double, 3>>> partial(count);
            parallelFor(count, [&](std::size_t p) {
                auto& sum = partial[p];
                sum.resize(total.size());
                const float* v = planes.values.data() + p * width * height * lanes;
                for (std::size_t b = 0; b < height; ++b) {
                    std::ptrdiff_t voxel = stride.base + static_cast<std::ptrdiff_t>(b) * stride.b +
                                           (planes.first + static_cast<std::ptrdiff_t>(p)) * stride.c;
                    for (std::size_t a = 0; a < width; ++a, voxel += stride.a, v += lanes) {
                        const auto i = static_cast<std::size_t>(voxel);
                        const std::uint16_t f = featureOf[m_grid.codes[i]];
                        auto* slot = &sum[(f == kNoFeature ? slots - 1 : f) * lanes];
                        const double w0 = weights ? static_cast<double>(weights->brightness(i)) : 0.0;
                        const double w1 = weights ? static_cast<double>(weights->saturation(i)) : 0.0;
                        for (std::size_t lane = 0; lane < lanes; ++lane) {
                            const double x = static_cast<double>(v[lane]);
                            slot[lane][0] += x;
                            slot[lane][1] += x * w0;
                            slot[lane][2] += x * w1;
                        }
                    }
                }
            });
            for (const auto& one : partial) // in order: the same bits for any number of threads
                for (std::size_t i = 0; i < total.size(); ++i)
                    for (std::size_t n = 0; n < 3; ++n) total[i][n] += one[i][n];
        };
        JobControl part = job;
        if (job.progress)
            part.progress = [&](double f) {
                const double groupSize = static_cast<double>(group.size());
                job.progress((static_cast<double>(firstTf) + f * groupSize) / static_cast<double>(tfs.size()));
            };
        m_device.run([&](gl::Device& device) {
            device.sweep(camera, m_volume->geometry(), m_quality, tables, candidates, part, add);
        });

        for (std::size_t lane = 0; lane < group.size(); ++lane) {
            FeatureSums& r = results[firstTf + lane];
            r.visibility.resize(features.size());
            for (auto& w : r.weighted) w.resize(features.size());
            for (std::size_t f = 0; f < slots; ++f) {
                const auto& s = total[f * static_cast<std::size_t>(candidates) + lane];
                r.allVisibility += s[0];
                for (std::size_t n = 0; n < 2; ++n) r.allWeighted[n] += s[n + 1];
                if (f == features.size()) continue;
                r.visibility[f] = s[0];
                for (std::size_t n = 0; n < 2; ++n) r.weighted[n][f] = s[n + 1];
            }
        }
    }
    job.report(1.0);
    return results;
}

VisibilityField GlEngine::field(const Camera& camera, const TransferFunction& tf, const JobControl& job) {
    camera.validate(m_volume->geometry(), "camera");
    VisibilityField result{Grid<float>(m_volume->dims())};
    const auto tables = opticalDepthTables({&tf, 1}, 1);
    const auto store = [&](const gl::Planes& planes) {
        const auto stride = planes.sweep.strides();
        const float* v = planes.values.data();
        for (int c = planes.first; c < planes.end; ++c)
            for (int b = 0; b < planes.sweep.dims.y; ++b)
                for (int a = 0; a < planes.sweep.dims.x; ++a, ++v) // 0 but in the one sweep the voxel belongs to
                    result.values[static_cast<std::size_t>(stride.base + a * stride.a + b * stride.b + c * stride.c)] +=
                        *v;
    };
    m_device.run(
        [&](gl::Device& device) { device.sweep(camera, m_volume->geometry(), m_quality, tables, 1, job, store); });
    job.report(1.0);
    return result;
}

} // namespace

std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return gl::makeGlEngine(std::move(volume), quality, gl::VisibilityBudget{});
}

std::unique_ptr<VisibilityEngine> gl::makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                   const VisibilityBudget& budget) {
    return std::make_unique<GlEngine>(std::move(volume), quality, budget);
}

} // namespace pellucid
