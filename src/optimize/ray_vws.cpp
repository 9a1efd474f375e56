#include "optimize/ray_vws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "optimize/bin_sampler.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr std::size_t kLanes = 8;    // transfer functions that are looked at together
constexpr double kNarrowest = 0.95;  // sine of half the angle under which the sphere around the box may be seen
constexpr float kDark = 1e-5f;       // light that is given up
constexpr double kDerivative = 0.02; // ln of optical depths, for differences
constexpr std::size_t kBlock = 64;   // rays
constexpr int kSome = 6;             // of the rough one every so many rays

using Lanes = std::array<float, kLanes>;

/// Looks at the whole sphere around the box along the same lines of sight; nothing where the eye is too close to it.
std::optional<Camera> aroundAll(const Camera& camera, const Geometry& geometry) {
    Camera all = camera;
    const double radius = geometry.radius();
    if (camera.projection == Projection::Orthographic) {
        const Vec3 forward = camera.forward();
        all.eye = geometry.boxCenter() - 2 * radius * forward;
        all.center = geometry.boxCenter();
        all.height = 2 * radius;
        return all;
    }
    const double distance = glm::length(geometry.boxCenter() - camera.eye);
    if (!(radius < kNarrowest * distance)) return {};
    all.center = geometry.boxCenter();
    all.fovY = 2 * std::asin(radius / distance) * 180 / std::numbers::pi;
    if (glm::length(glm::cross(glm::normalize(all.center - all.eye), glm::normalize(all.up))) < 0.1)
        all.up = camera.trueUp();
    if (glm::length(glm::cross(glm::normalize(all.center - all.eye), glm::normalize(all.up))) < 0.1)
        all.up = camera.right();
    return all;
}

} // namespace

RaySamples::RaySamples(const Volume& volume, const TransferFunction& tf, const View& view, const WeightFields& weights,
                       const JobControl& job, int rays)
    : m_features(tf.features.size()), m_scale{weights.scale(0), weights.scale(1)} {
    const BinFeatures features(tf);
    m_slotOfBin = features.slot;
    const Geometry& geometry = volume.geometry();
    const std::optional<Camera> camera = aroundAll(view.camera, geometry);
    if (!camera) return;
    const double d0 = geometry.d0();
    m_stepInD0 = stepAlongRays(geometry);
    const double step = m_stepInD0 * d0;
    const bool perspective = camera->projection == Projection::Perspective;
    const Vec3 forward = camera->forward();
    const Mat3 worldFromIndex = geometry.worldFromIndex();
    const Int3 dims = volume.dims();

    // First what each step of a ray meets, wherever its voxels are.
    constexpr std::uint16_t kNothing = 0xffff;
    struct Step {
        std::uint32_t weights;         ///< of the voxel that the step lies in
        std::uint16_t step;            ///< its number
        std::uint16_t bin, binOfVoxel; ///< of the intensity there, and of the voxel's; kNothing: cannot be seen
    };
    const auto pixels = static_cast<std::size_t>(rays) * static_cast<std::size_t>(rays);
    std::vector<std::vector<Step>> met(pixels);
    const View around(*camera, view.clipping);
    const auto meet = [&](std::size_t pixel, const PixelRay& r, const auto& sampler) {
        std::uint16_t n = 0;
        for (double t = r.first; t < r.exit; t += step, ++n) {
            const Vec3 at = r.ray.origin + t * r.ray.direction;
            if (!sampler.answersFor(at)) continue;
            Step here{0, n, kNothing, kNothing};
            if (const int bin = sampler.at(at); bin >= 0 && features.keeps(bin))
                here.bin = static_cast<std::uint16_t>(bin);
            const std::size_t index = sampler.indexOf(sampler.nearest(at));
            if (const double s = sampler.intensityOf(index); !std::isnan(s) && features.keeps(binOfIntensity(s))) {
                here.binOfVoxel = static_cast<std::uint16_t>(binOfIntensity(s));
                here.weights = weights.units(index);
            }
            if (here.bin != kNothing || here.binOfVoxel != kNothing) met[pixel].push_back(here);
        }
    };

    // Then how much of the light reaches each voxel.
    struct OfRay {
        std::vector<std::uint16_t> bins;
        std::vector<Met> voxels;
    };
    std::vector<OfRay> all(pixels);
    const auto follow = [&](std::size_t pixel, const PixelRay& r) {
        struct Point {
            double from; ///< t at which a voxel's light is taken
            Met met;
        };
        // Not of the thread: glibc ends the program where memory lacks to note that they are to be freed with it.
        std::vector<double> begins; // of the steps that absorb
        std::vector<Point> points;
        OfRay& here = all[pixel];
        const double slant = glm::dot(r.direction, forward);
        auto next = met[pixel].begin();
        std::uint16_t n = 0;
        for (double t = r.first; t < r.exit && next != met[pixel].end(); t += step, ++n) {
            if (next->step != n) continue;
            const Step& found = *next++;
            if (found.bin != kNothing) {
                here.bins.push_back(found.bin);
                begins.push_back(t - step / 2);
            }
            if (found.binOfVoxel == kNothing) continue;
            const Vec3 at = r.ray.origin + t * r.ray.direction;
            const Int3 voxel = glm::clamp(Int3(glm::round(at)), Int3(0), dims - 1);
            // As far along the ray as the voxel's centre, less the d0/2 in front of it.
            const double center = t + glm::dot(worldFromIndex * (Vec3(voxel) - at), r.direction);
            const double measure = perspective ? t * t * slant * slant * slant : 1;
            points.push_back({center - d0 / 2, {found.weights, static_cast<float>(measure), found.binOfVoxel, 0, 0}});
        }
        for (Point& p : points) {
            const auto after = std::ranges::upper_bound(begins, p.from);
            auto behind = static_cast<std::size_t>(after - begins.begin());
            std::size_t quarters = 0;
            if (behind > 0) { // the last step that has begun may not have ended
                const double part = (p.from - begins[behind - 1]) / step;
                if (part < 1) {
                    quarters = static_cast<std::size_t>(part * 4 + 0.5);
                    if (quarters < 4) --behind;
                    quarters %= 4;
                }
            }
            p.met.behind = static_cast<std::uint16_t>(behind);
            p.met.quarters = static_cast<std::uint16_t>(quarters);
        }
        std::ranges::stable_sort(points, {}, [](const Point& p) { return p.met.behind; });
        for (const Point& p : points) here.voxels.push_back(p.met);
    };
    // A part of the rows at a time: of a volume on several ranks what rays meet goes to all of them.
    const int atOnce = volume.elsewhere() != nullptr ? std::max(1, rays / 12) : rays;
    for (int row = 0; row < rays; row += atOnce) {
        const RayRows rows{row, std::min(rays, row + atOnce)};
        forEachRay(volume, around, rays, rows, step, 2, job, meet);
        shareRays(volume, met);
        forEachRayOf(geometry, around, rays, rows, step, 2, job, follow);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            std::vector<Step>().swap(met[pixel]);
            const OfRay ray = std::exchange(all[pixel], {});
            if (ray.voxels.empty()) continue;
            m_bins.insert(m_bins.end(), ray.bins.begin(), ray.bins.end());
            m_binBegins.push_back(static_cast<std::uint32_t>(m_bins.size()));
            m_voxels.insert(m_voxels.end(), ray.voxels.begin(), ray.voxels.end());
            m_voxelBegins.push_back(static_cast<std::uint32_t>(m_voxels.size()));
        }
    }
}

std::vector<FeatureSums> RaySamples::sums(const std::vector<TransferFunction>& tfs, int every,
                                          const JobControl& job) const {
    const auto stride = static_cast<std::size_t>(every);
    const std::size_t rayCount = (rays() + stride - 1) / stride;
    constexpr std::size_t bins = kIntensityBins;
    std::vector<FeatureSums> all;
    for (std::size_t first = 0; first < tfs.size(); first += kLanes) {
        const std::size_t lanes = std::min(kLanes, tfs.size() - first);
        std::vector<Lanes> opacity(bins, Lanes{}), passed(5 * bins, Lanes{}); // passed[q · bins + bin]: q quarters
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const TfSampler sampler(tfs[first + lane]);
            for (std::size_t bin = 0; bin < bins; ++bin) {
                const double alpha = sampler.opacity(intensityOfBin(static_cast<int>(bin)));
                opacity[bin][lane] = static_cast<float>(std::min(alpha, kMaxOpacity));
                const double quarter = 1 - opacityOfStep(alpha, m_stepInD0 / 4);
                for (std::size_t q = 0; q <= 4; ++q)
                    passed[q * bins + bin][lane] = static_cast<float>(std::pow(quarter, static_cast<double>(q)));
            }
        }
        struct Sums {
            std::vector<std::array<double, kLanes>> weighted[2]; ///< per slot
        };
        // A slot per block of rays, added in order: the same bits for any number of threads.
        std::vector<Sums> blocks((rayCount + kBlock - 1) / kBlock);
        parallelFor(blocks.size(), [&](std::size_t b) {
            job.throwIfStopped();
            for (auto& sums : blocks[b].weighted) sums.assign(m_features + 1, {});
            std::vector<Lanes> brightness(m_features + 1), saturation(m_features + 1);
            for (std::size_t n = b * kBlock; n < std::min(rayCount, (b + 1) * kBlock); ++n) {
                const std::size_t ray = n * stride;
                brightness.assign(m_features + 1, {});
                saturation.assign(m_features + 1, {});
                Lanes light;
                light.fill(1.0f);
                std::uint32_t v = m_voxelBegins[ray];
                const std::uint32_t voxelsEnd = m_voxelBegins[ray + 1], binsBegin = m_binBegins[ray],
                                    binsEnd = m_binBegins[ray + 1];
                for (std::uint32_t i = binsBegin; v < voxelsEnd; ++i) {
                    for (; v < voxelsEnd && m_voxels[v].behind == i - binsBegin; ++v) {
                        const Met& met = m_voxels[v];
                        const std::size_t behind = met.quarters > 0 ? met.quarters * bins + m_bins[i] : 0;
                        const float bright = met.measure * static_cast<float>(met.weights & 0xffffu),
                                    saturated = met.measure * static_cast<float>(met.weights >> 16);
                        const auto slot = static_cast<std::size_t>(m_slotOfBin[met.bin]);
                        for (std::size_t lane = 0; lane < kLanes; ++lane) {
                            const float seen = light[lane] * opacity[met.bin][lane] * passed[behind][lane];
                            brightness[slot][lane] += seen * bright;
                            saturation[slot][lane] += seen * saturated;
                        }
                    }
                    if (i == binsEnd) break;
                    float most = 0;
                    for (std::size_t lane = 0; lane < kLanes; ++lane) {
                        light[lane] *= passed[4 * bins + m_bins[i]][lane];
                        most = std::max(most, light[lane]);
                    }
                    if (most < kDark) break;
                }
                for (std::size_t slot = 0; slot <= m_features; ++slot)
                    for (std::size_t lane = 0; lane < kLanes; ++lane) {
                        blocks[b].weighted[0][slot][lane] += static_cast<double>(brightness[slot][lane]);
                        blocks[b].weighted[1][slot][lane] += static_cast<double>(saturation[slot][lane]);
                    }
            }
        });
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            FeatureSums& sums = all.emplace_back(emptySums(m_features));
            for (const Sums& block : blocks)
                for (std::size_t a = 0; a < 2; ++a)
                    for (std::size_t slot = 0; slot <= m_features; ++slot) {
                        const double value = m_scale[a] * block.weighted[a][slot][lane];
                        if (slot < m_features) sums.weighted[a][slot] += value;
                        sums.allWeighted[a] += value;
                    }
        }
    }
    return all;
}

RayVws::RayVws(std::shared_ptr<const RaySamples> samples, const TransferFunction& base, const VwsOptions& options,
               int every)
    : m_samples(std::move(samples)), m_base(base), m_options(options), m_every(every) {}

std::vector<std::vector<double>> RayVws::evaluate(std::span<const std::vector<double>> candidates,
                                                  const JobControl& job) const {
    std::vector<TransferFunction> tfs;
    for (const auto& x : candidates) tfs.push_back(withFeatureOpacities(m_base, x));
    std::vector<std::vector<double>> all;
    for (const FeatureSums& sums : m_samples->sums(tfs, m_every, job)) all.push_back(vwsOf(sums, m_options));
    return all;
}

VwsFunction::Linear RayVws::jacobian(const std::vector<double>& x, const JobControl& job) const {
    const std::size_t n = x.size();
    std::vector<std::vector<double>> points{x};
    for (std::size_t j = 0; j < n; ++j) {
        const double depth = opticalDepthOfOpacity(x[j]);
        points.push_back(x);
        points.back()[j] = depth > 0 ? -std::expm1(-depth * std::exp(x[j] < 0.5 ? kDerivative : -kDerivative)) : 1e-6;
    }
    const auto vws = evaluate(points, job);
    Linear linear{vws[0], std::vector<std::vector<double>>(n, std::vector<double>(n, 0.0))};
    for (std::size_t j = 0; j < n; ++j) {
        const double change = points[j + 1][j] - x[j];
        for (std::size_t i = 0; change != 0 && i < n; ++i)
            linear.derivative[i][j] = (vws[j + 1][i] - vws[0][i]) / change;
    }
    return linear;
}

VwsEstimates rayEstimates(std::shared_ptr<const RaySamples> samples, const TransferFunction& base,
                          const VwsOptions& options) {
    VwsEstimates all;
    if (samples->empty()) return all;
    for (const int every : {1, kSome}) all.push_back(std::make_shared<RayVws>(samples, base, options, every));
    return all;
}

} // namespace pellucid
