// docs/method.md, "Visibility", written out: for each voxel one straight line toward the eye, double precision, steps
// of at most d0/16.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "base/check.h"
#include "base/parallel.h"
#include "render/ray_box.h"
#include "render/trilinear.h"
#include "render/visibility.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr double kDark = 40; ///< optical depth from which on T < 5e-18: nothing behind is seen

class ReferenceEngine final : public VisibilityEngine {
public:
    ReferenceEngine(std::shared_ptr<const Volume> volume, int stepsPerD0)
        : m_volume(std::move(volume)), m_intensity(m_volume->dims()), m_stepsPerD0(stepsPerD0) {
        PELLUCID_CHECK(stepsPerD0 >= 1);
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

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        std::vector<FeatureSums> all;
        for (const TransferFunction& tf : tfs) {
            PELLUCID_CHECK(tf.features == tfs[0].features);
            const TfSampler sampler(tf);
            const Lines lines = linesOf(view);
            Parts parts(slices(), emptySums(tf.features.size()));
            forEachVoxel(view, job, [&](const Voxel& voxel) {
                const double v = visibility(lines, sampler, voxel);
                const auto [lb, ls] = weightsAt(weights, voxel.index);
                addVoxel(parts[voxel.slice], featureAt(tf.features, voxel.intensity), v, lb, ls);
            });
            all.push_back(total(parts));
        }
        return all;
    }

    /// Inside feature j ∂α/∂x_j is the shape that x_j scales; so ∂τ/∂x_j = shape/(1 − α), but 0 where the cap holds τ.
    /// From v = α·T: ∂v/∂x_j = ∂α/∂x_j·T − v·∫∂τ/∂x_j. The same samples as in sums(), so that it is its derivative.
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        const std::size_t features = tf.features.size();
        const TfSampler sampler(tf), shapes(withFullPeaks(tf));
        const Lines lines = linesOf(view);
        Parts parts(slices(), emptySums(features));
        std::vector<Parts> partsByOpacity(features, parts);
        forEachVoxel(view, job, [&](const Voxel& voxel) {
            const int feature = featureAt(tf.features, voxel.intensity);
            const double alpha = sampler.opacity(voxel.intensity);
            const double shape = feature < 0 ? 0.0 : shapes.opacity(voxel.intensity);
            if (alpha == 0 && shape == 0) return;
            double depth = 0;
            std::vector<double> depthByOpacity(features, 0.0);
            forEachSample(lines, voxel.centre, [&](double s, double steps) {
                const double a = sampler.opacity(s);
                depth += steps * opticalDepthOfOpacity(a);
                const int f = featureAt(tf.features, s);
                if (f >= 0 && a < kMaxOpacity)
                    depthByOpacity[static_cast<std::size_t>(f)] += steps * shapes.opacity(s) / (1 - a);
                return depth <= kDark;
            });
            const double transmittance = std::exp(-depth), v = alpha * transmittance;
            const auto [lb, ls] = weightsAt(weights, voxel.index);
            addVoxel(parts[voxel.slice], feature, v, lb, ls);
            for (std::size_t j = 0; j < features; ++j) {
                const double own = static_cast<int>(j) == feature ? shape * transmittance : 0.0;
                addVoxel(partsByOpacity[j][voxel.slice], feature, own - v * depthByOpacity[j], lb, ls);
            }
        });
        SumsJacobian result{total(parts), {}};
        for (const Parts& p : partsByOpacity) result.byOpacity.push_back(total(p));
        return result;
    }

    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        const TfSampler sampler(tf);
        const Lines lines = linesOf(view);
        VisibilityField field{Grid<float>(m_volume->dims())};
        forEachVoxel(view, job, [&](const Voxel& voxel) {
            field.values[voxel.index] = static_cast<float>(visibility(lines, sampler, voxel));
        });
        return field;
    }

private:
    using Parts = std::vector<FeatureSums>; ///< one per slice, so that the order of addition is fixed

    struct Voxel {
        std::size_t slice, index;
        double intensity;
        Vec3 centre; ///< voxel coordinates
    };

    std::size_t slices() const { return static_cast<std::size_t>(m_volume->dims().z); }

    static FeatureSums total(const Parts& parts) {
        FeatureSums sums = parts[0];
        for (std::size_t k = 1; k < parts.size(); ++k) add(sums, parts[k]);
        return sums;
    }

    static std::array<double, 2> weightsAt(const WeightFields* weights, std::size_t i) {
        if (!weights) return {0, 0};
        return {weights->brightness(i), weights->saturation(i)};
    }

    /// What the lines toward the eye need to know, in voxel coordinates.
    struct Lines {
        const Camera& camera;
        VoxelClipping clipping;
        Mat3 worldFromIndex, indexFromWorld;
        Vec3 eye;
    };
    Lines linesOf(const View& view) const {
        const Geometry& g = m_volume->geometry();
        return {view.camera, clippingInVoxels(view.clipping, g), g.worldFromIndex(), g.indexFromWorld(),
                g.voxelFromWorld(view.camera.eye)};
    }

    /// body(voxel) for each valid voxel that is not clipped away; slices on different threads.
    template <class Body>
    void forEachVoxel(const View& view, const JobControl& job, const Body& body) const {
        const Geometry& geometry = m_volume->geometry();
        view.camera.validate(geometry, "camera");
        view.clipping.validate();
        const std::vector<VoxelPlane> planes = planesInVoxels(view.clipping, geometry);
        std::atomic<std::size_t> done = 0;
        parallelFor(slices(), [&](std::size_t k) {
            for (int j = 0; j < geometry.dims.y; ++j) {
                job.throwIfStopped();
                for (int i = 0; i < geometry.dims.x; ++i) {
                    const std::size_t at = m_intensity.index(i, j, static_cast<int>(k));
                    const Vec3 centre(i, j, static_cast<double>(k));
                    if ((!m_valid.empty() && !m_valid[at]) || !keeps(planes, centre)) continue;
                    body(Voxel{k, at, m_intensity[at], centre});
                }
            }
            job.report(static_cast<double>(++done) / static_cast<double>(slices()));
        });
    }

    /// v = T·α of one voxel.
    double visibility(const Lines& lines, const TfSampler& sampler, const Voxel& voxel) const {
        const double alpha = sampler.opacity(voxel.intensity);
        if (alpha == 0) return 0;
        double depth = 0;
        forEachSample(lines, voxel.centre, [&](double s, double steps) {
            depth += steps * opticalDepthOfOpacity(sampler.opacity(s));
            return depth <= kDark;
        });
        return alpha * std::exp(-depth);
    }

    /// take(s, d) for each sample from d0/2 in front of `centre` to where the line toward the eye leaves the box or
    /// meets a clip plane or the eye: s the intensity, d the path that it stands for in units of d0; what is faint
    /// counts as FaintRest says. Until take() says false. What is left of the volume is convex, and so is what is not
    /// faint: a line that has left it does not come back.
    template <class Take>
    void forEachSample(const Lines& lines, const Vec3& centre, const Take& take) const {
        const double d0 = m_volume->geometry().d0();
        Ray ray{centre, {}}; // in voxel coordinates, t the length in the world
        double end = std::numeric_limits<double>::infinity();
        if (lines.camera.projection == Projection::Orthographic) {
            ray.direction = lines.indexFromWorld * -lines.camera.forward();
        } else {
            end = glm::length(lines.worldFromIndex * (lines.eye - centre));
            ray.direction = (lines.eye - centre) / end;
        }
        RayInterval left = intersectBox(ray, m_volume->geometry());
        cut(left, ray, lines.clipping.cut);
        RayInterval clear = left;
        cut(clear, ray, lines.clipping.faint);
        const double length = std::min(end, left.exit) - d0 / 2;
        if (!(length > 0)) return;
        const int steps = static_cast<int>(std::ceil(length / d0 * m_stepsPerD0));
        const double step = length / steps;
        for (int n = 0; n < steps; ++n) {
            const double from = d0 / 2 + n * step;
            const Interpolated s = interpolate(m_intensity, m_valid, ray.origin + ray.direction * (from + 0.5 * step));
            const double within = std::clamp((clear.exit - from) / step, 0.0, 1.0);
            const double path = s.validShare * step / d0 * thinned(lines.clipping.density, within);
            if (s.validShare > 0 && !take(s.value, path)) return;
        }
    }

    std::shared_ptr<const Volume> m_volume;
    Grid<double> m_intensity;
    std::vector<std::uint8_t> m_valid; ///< empty where all are
    int m_stepsPerD0;
};

} // namespace

std::unique_ptr<VisibilityEngine> makeReferenceEngine(std::shared_ptr<const Volume> volume, int stepsPerD0) {
    return std::make_unique<ReferenceEngine>(std::move(volume), stepsPerD0);
}

} // namespace pellucid
