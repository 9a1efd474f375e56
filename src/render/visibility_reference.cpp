// MEASURES §4 written out: for each voxel one straight line toward the eye, double precision, steps of at most d0/16.
#include <atomic>
#include <cmath>

#include "render/ray_box.h"
#include "render/trilinear.h"
#include "render/visibility.h"
#include "tf/opacity.h"
#include "volume/parallel.h"

namespace pellucid {

namespace {

constexpr double kStepsPerD0 = 16;
constexpr double kDark = 40; ///< optical depth from which on T < 5e-18: nothing behind is seen

class ReferenceEngine final : public VisibilityEngine {
public:
    explicit ReferenceEngine(std::shared_ptr<const Volume> volume)
        : m_volume(std::move(volume)), m_intensity(m_volume->dims()) {
        if (m_volume->invalidCount() > 0) m_valid.assign(m_volume->size(), 1);
        for (std::size_t i = 0; i < m_volume->size(); ++i) {
            const double s = m_volume->intensity(i);
            if (std::isnan(s))
                m_valid[i] = 0;
            else
                m_intensity[i] = s;
        }
    }

    std::string name() const override { return "reference"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const Camera& camera, std::span<const TransferFunction> tfs,
                                  const WeightFields* weights, const JobControl& job) override {
        std::vector<FeatureSums> all;
        for (const TransferFunction& tf : tfs)
            all.push_back(sumsOfField(*m_volume, tfs[0].features, field(camera, tf, job).values, weights));
        return all;
    }

    SumsJacobian jacobian(const Camera&, const TransferFunction&, const WeightFields*, const JobControl&) override {
        throw Error("the reference engine has no derivatives yet", "", "");
    }

    VisibilityField field(const Camera& camera, const TransferFunction& tf, const JobControl& job) override {
        const Geometry& geometry = m_volume->geometry();
        camera.validate(geometry, "camera");
        const TfSampler sampler(tf);
        VisibilityField field{Grid<float>(geometry.dims)};
        const auto slices = static_cast<std::size_t>(geometry.dims.z);
        std::atomic<std::size_t> done = 0;
        parallelFor(slices, [&](std::size_t k) {
            for (int j = 0; j < geometry.dims.y; ++j) {
                job.throwIfStopped();
                for (int i = 0; i < geometry.dims.x; ++i) {
                    const std::size_t at = field.values.index(i, j, static_cast<int>(k));
                    if (!m_valid.empty() && !m_valid[at]) continue;
                    const double alpha = sampler.opacity(m_intensity[at]);
                    if (alpha == 0) continue;
                    const Vec3 centre = geometry.worldFromVoxel(Vec3(i, j, static_cast<double>(k)));
                    field.values[at] =
                        static_cast<float>(alpha * std::exp(-opticalDepthBefore(camera, sampler, centre)));
                }
            }
            job.report(static_cast<double>(++done) / static_cast<double>(slices));
        });
        return field;
    }

private:
    /// ∫τ from d0/2 in front of `centre` to where the line toward the eye leaves the box, or meets the eye.
    double opticalDepthBefore(const Camera& camera, const TfSampler& sampler, const Vec3& centre) const {
        const Geometry& g = m_volume->geometry();
        const double d0 = g.d0();
        const Ray ray{centre, camera.towardEye(centre)};
        double end = intersectBox(ray, g.boxMin(), g.boxMax()).exit;
        if (camera.projection == Projection::Perspective) end = std::min(end, glm::length(camera.eye - centre));
        const double length = end - d0 / 2;
        if (!(length > 0)) return 0;
        const int steps = static_cast<int>(std::ceil(length / d0 * kStepsPerD0));
        const double step = length / steps;
        double depth = 0; // in units of one step
        for (int n = 0; n < steps; ++n) {
            const Vec3 p = ray.origin + ray.direction * (d0 / 2 + (n + 0.5) * step);
            const Interpolated s = interpolate(m_intensity, m_valid, g.voxelFromWorld(p));
            if (s.validShare == 0) continue;
            depth += s.validShare * opticalDepthOfOpacity(sampler.opacity(s.value));
            if (depth * step / d0 > kDark) break;
        }
        return depth * step / d0;
    }

    std::shared_ptr<const Volume> m_volume;
    Grid<double> m_intensity;
    std::vector<std::uint8_t> m_valid; ///< empty where all are
};

} // namespace

std::unique_ptr<VisibilityEngine> makeReferenceEngine(std::shared_ptr<const Volume> volume) {
    return std::make_unique<ReferenceEngine>(std::move(volume));
}

} // namespace pellucid
