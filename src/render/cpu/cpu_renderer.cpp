// A ray per pixel: the emission-absorption integral (docs/method.md, "The picture") over segments on which the
// intensity goes linearly from one end to the other. What a segment absorbs and emits then is exact, by running
// integrals over the transfer function, so that thin tents and steps leave no bands.
#include <atomic>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "render/image_renderer.h"
#include "render/ray_box.h"
#include "render/trilinear.h"
#include "tf/tf_table.h"
#include "volume/intensity_grid.h"

namespace pellucid {

namespace {

constexpr int kTableSize = 4096;
constexpr double kDark = 1e-4; ///< transmittance below which a ray ends: a fortieth of an 8-bit level

// Light from the eye; the same numbers stand in shaders/include/shading.glsl.
constexpr double kAmbient = 0.35, kDiffuse = 0.65, kSpecular = 0.25, kShininess = 24;

/// Means over an interval of intensity: optical depth per d0, and colour weighted by it.
class SegmentTable {
public:
    SegmentTable(const TransferFunction& tf, const Feature* only) : m_entries(kTableSize), m_integrals(kTableSize) {
        const TfTable table = makeTfTable(tf, kTableSize);
        for (std::size_t i = 0; i < m_entries.size(); ++i) {
            const bool drawn = !only || only->contains(static_cast<double>(i) / (kTableSize - 1));
            const double tau = drawn ? static_cast<double>(table.opticalDepth[i]) : 0.0;
            const auto& c = table.rgba[i];
            m_entries[i] = glm::dvec4(tau * Vec3(c[0], c[1], c[2]), tau);
            if (i > 0) m_integrals[i] = m_integrals[i - 1] + 0.5 * (m_entries[i - 1] + m_entries[i]);
        }
    }

    /// Mean of (τ·rgb, τ) while the intensity goes linearly from `s0` to `s1`, each in [0,1].
    glm::dvec4 mean(double s0, double s1) const {
        const double low = std::min(s0, s1) * (kTableSize - 1), high = std::max(s0, s1) * (kTableSize - 1);
        if (high - low < 1e-3) return m_entries[static_cast<std::size_t>((low + high) / 2 + 0.5)];
        return (integralTo(high) - integralTo(low)) / (high - low);
    }

private:
    glm::dvec4 integralTo(double entry) const {
        const auto i = std::min(static_cast<std::size_t>(entry), m_entries.size() - 2);
        const double f = entry - static_cast<double>(i);
        return m_integrals[i] + f * (m_entries[i] + 0.5 * f * (m_entries[i + 1] - m_entries[i]));
    }
    std::vector<glm::dvec4> m_entries, m_integrals; ///< (τ·rgb, τ); integrals from entry 0
};

class CpuRenderer final : public ImageRenderer {
public:
    explicit CpuRenderer(std::shared_ptr<const Volume> volume)
        : m_volume(std::move(volume)), m_shared(sharedIntensityGrid(*m_volume)), m_grid(*m_shared) {}

    std::string name() const override { return "cpu"; }

    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        settings.validate();
        camera.validate(m_volume->geometry(), "camera");
        const SegmentTable table(tf, settings.featureAlone(tf));

        Image image(settings.width, settings.height);
        std::atomic<int> done = 0;
        parallelFor(static_cast<std::size_t>(settings.height), [&](std::size_t row) {
            job.throwIfStopped();
            const int y = static_cast<int>(row);
            for (int x = 0; x < settings.width; ++x) {
                const Ray ray = pixelRay(camera, x + 0.5, y + 0.5, settings.width, settings.height);
                store(image.pixel(x, y), trace(ray, camera, table, settings), settings);
            }
            job.report(static_cast<double>(++done) / settings.height);
        });
        return image;
    }

private:
    struct Light {
        Vec3 rgb{0, 0, 0}; ///< premultiplied
        double transmittance = 1;
    };

    Light trace(const Ray& ray, const Camera& camera, const SegmentTable& table, const RenderSettings& settings) const {
        const Geometry& g = m_volume->geometry();
        const Ray voxelRay = inVoxels(ray, g);
        RayInterval t = intersectBox(voxelRay, g);
        cut(t, voxelRay, planesInVoxels(settings.clipping, g));
        if (camera.projection == Projection::Perspective) t.enter = std::max(t.enter, 0.0);
        Light light;
        if (t.empty()) return light;
        const int steps = std::max(1, static_cast<int>(std::ceil((t.exit - t.enter) / (settings.stepInD0 * g.d0()))));
        const double step = (t.exit - t.enter) / steps;
        const double stepInD0 = step / g.d0();
        const auto voxelAt = [&](double n) { return voxelRay.origin + voxelRay.direction * (t.enter + n * step); };
        Interpolated from = interpolate(m_grid.codes, m_grid.valid, voxelAt(0));
        for (int n = 1; n <= steps && light.transmittance > kDark; ++n) {
            const Interpolated to = interpolate(m_grid.codes, m_grid.valid, voxelAt(n));
            const Interpolated last = std::exchange(from, to);
            const double share = 0.5 * (last.validShare + to.validShare);
            if (share == 0) continue;
            const double s0 = (last.validShare > 0 ? last : to).value / m_grid.maxCode,
                         s1 = (to.validShare > 0 ? to : last).value / m_grid.maxCode;
            const glm::dvec4 mean = table.mean(s0, s1);
            if (mean.w <= 0) continue;
            const double alpha = -std::expm1(-mean.w * share * stepInD0);
            Vec3 color = Vec3(mean) / mean.w;
            if (settings.light.on) color = shaded(color, voxelAt(n - 0.5), ray.direction);
            light.rgb += light.transmittance * alpha * color;
            light.transmittance *= 1 - alpha;
        }
        return light;
    }

    Vec3 shaded(const Vec3& color, const Vec3& at, const Vec3& view) const {
        Vec3 gradient(0);
        for (int a = 0; a < 3; ++a) {
            Vec3 step(0);
            step[a] = 1;
            const Interpolated ahead = interpolate(m_grid.codes, m_grid.valid, at + step),
                               behind = interpolate(m_grid.codes, m_grid.valid, at - step);
            gradient[a] = (ahead.value - behind.value) / 2;
        }
        gradient = glm::transpose(m_volume->geometry().indexFromWorld()) * gradient;
        const double length = glm::length(gradient);
        if (length * m_volume->geometry().d0() < 1e-6 * m_grid.maxCode)
            return color; // inside a homogeneous region there is no surface to light
        const double cosine = std::abs(glm::dot(gradient / length, view));
        const Vec3 lit = color * (kAmbient + kDiffuse * cosine) + Vec3(kSpecular * std::pow(cosine, kShininess));
        return glm::min(lit, Vec3(1));
    }

    static void store(float* pixel, const Light& light, const RenderSettings& settings) {
        double alpha = 1 - light.transmittance;
        Vec3 rgb = light.rgb;
        if (settings.background) {
            rgb += light.transmittance * Vec3(settings.background->r, settings.background->g, settings.background->b);
            alpha = 1;
        } else if (alpha > 0) {
            rgb /= alpha;
        }
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(rgb[c]);
        pixel[3] = static_cast<float>(alpha);
    }

    std::shared_ptr<const Volume> m_volume;
    std::shared_ptr<const IntensityGrid> m_shared;
    const IntensityGrid& m_grid;
};

} // namespace

std::unique_ptr<ImageRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume) {
    return std::make_unique<CpuRenderer>(std::move(volume));
}

} // namespace pellucid
