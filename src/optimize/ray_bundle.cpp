#include "optimize/ray_bundle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "render/ray_box.h"
#include "render/trilinear.h"
#include "tf/opacity.h"
#include "volume/noise.h"

namespace pellucid {

namespace {

constexpr int kBins = 1024;        // of intensity
constexpr int kMostSteps = 400;    // along the diagonal of the box
constexpr int kLanes = 8;          // transfer functions that are looked at together
constexpr double kLeastStep = 0.5; // d0
constexpr double kMeets = 0.5;     // d0 of path through a feature
constexpr double kSolid = 0.95, kEmpty = 0.05;

int binOf(double s) { return std::min(static_cast<int>(s * kBins), kBins - 1); }
double intensityOf(int bin) { return (bin + 0.5) / kBins; }

/// Trilinear, of intensities; empty where more than half of it is invalid.
template <class Values>
std::optional<double> intensityAt(const Volume& volume, const Values& values, const Vec3& voxel) {
    const Interpolated met = interpolateValid(
        [&](std::size_t i) { return volume.intensityOfValue(static_cast<double>(values[i])); }, volume.dims(), voxel);
    if (met.validShare < 0.5) return {};
    return std::min(met.value, 1.0);
}

} // namespace

RayBundle::RayBundle(const Volume& volume, const TransferFunction& tf, const View& view, int pixels,
                     const JobControl& job)
    : m_features(tf.features.size()) {
    const TfSampler sampler(tf);
    std::vector<char> kept; // what can be opaque
    for (int bin = 0; bin < kBins; ++bin) {
        const double s = intensityOf(bin);
        const int feature = featureAt(tf.features, s);
        const bool outside = feature < 0;
        m_slotOfBin.push_back(outside ? static_cast<int>(m_features) : feature);
        kept.push_back(outside ? sampler.opacity(s) > 0 : !tf.features[static_cast<std::size_t>(feature)].hidden);
    }
    const Geometry& geometry = volume.geometry();
    const double d0 = geometry.d0();
    m_stepInD0 = std::max(kLeastStep, 2 * geometry.radius() / d0 / kMostSteps);
    const double step = m_stepInD0 * d0;
    const std::vector<VoxelPlane> planes = planesInVoxels(view.clipping, geometry);

    std::vector<std::vector<std::uint16_t>> rows(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
    std::visit(
        [&](const auto& samples) {
            parallelFor(static_cast<std::size_t>(pixels), [&](std::size_t row) {
                job.throwIfStopped();
                for (int column = 0; column < pixels; ++column) {
                    const std::size_t pixel = row * static_cast<std::size_t>(pixels) + static_cast<std::size_t>(column);
                    const Ray ray = inVoxels(
                        pixelRay(view.camera, column + 0.5, static_cast<double>(row) + 0.5, pixels, pixels), geometry);
                    RayInterval inside = intersectBox(ray, geometry);
                    inside.enter = std::max(inside.enter, 0.0);
                    cut(inside, ray, planes);
                    // Each ray begins elsewhere, so that steps of several voxels hit thin things on average as often
                    // as their thickness says.
                    const double first = static_cast<double>(hashOf(column, static_cast<int>(row), 0, 1) % 1024) / 1024;
                    for (double t = inside.enter + first * step; t < inside.exit; t += step)
                        if (const auto s = intensityAt(volume, samples, ray.origin + t * ray.direction))
                            if (const int bin = binOf(*s); kept[static_cast<std::size_t>(bin)])
                                rows[pixel].push_back(static_cast<std::uint16_t>(bin));
                }
            });
        },
        volume.samples());

    m_begins.push_back(0);
    for (const auto& bins : rows) {
        std::vector<int> steps(m_features + 1, 0);
        for (const std::uint16_t bin : bins) ++steps[static_cast<std::size_t>(m_slotOfBin[bin])];
        steps.pop_back(); // of what is in no feature
        const auto met = [&](int n) { return n * m_stepInD0 >= kMeets; };
        if (std::none_of(steps.begin(), steps.end(), met)) continue;
        m_bins.insert(m_bins.end(), bins.begin(), bins.end());
        m_begins.push_back(static_cast<std::uint32_t>(m_bins.size()));
        for (const int n : steps) m_met.push_back(met(n));
    }
}

int RayBundle::raysOf(int feature) const {
    int count = 0;
    for (int r = 0; r < rays(); ++r) count += meets(r, feature);
    return count;
}

std::vector<RayBundle::Appearance> RayBundle::appearances(const std::vector<TransferFunction>& tfs) const {
    std::vector<Appearance> all(tfs.size());
    const auto rayCount = static_cast<std::size_t>(rays());
    for (std::size_t first = 0; first < tfs.size(); first += kLanes) {
        const std::size_t lanes = std::min<std::size_t>(kLanes, tfs.size() - first);
        std::vector<std::array<float, kLanes>> opacity(kBins, std::array<float, kLanes>{});
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const TfSampler sampler(tfs[first + lane]);
            for (int bin = 0; bin < kBins; ++bin)
                opacity[static_cast<std::size_t>(bin)][lane] =
                    static_cast<float>(opacityOfStep(sampler.opacity(intensityOf(bin)), m_stepInD0));
        }
        // A slot per block of rays, added in order: the same bits for any number of threads.
        struct Sums {
            std::vector<std::array<double, kLanes>> features;
            std::array<double, kLanes> alpha{}, translucent{};
        };
        constexpr std::size_t kBlock = 128;
        std::vector<Sums> blocks((rayCount + kBlock - 1) / kBlock);
        parallelFor(blocks.size(), [&](std::size_t b) {
            Sums& sums = blocks[b];
            sums.features.assign(m_features, {});
            std::vector<std::array<float, kLanes>> parts(m_features + 1);
            for (std::size_t ray = b * kBlock; ray < std::min(rayCount, (b + 1) * kBlock); ++ray) {
                parts.assign(m_features + 1, {});
                std::array<float, kLanes> light;
                light.fill(1.0f);
                for (std::uint32_t i = m_begins[ray]; i < m_begins[ray + 1]; ++i) {
                    const auto& a = opacity[m_bins[i]];
                    auto& part = parts[static_cast<std::size_t>(m_slotOfBin[m_bins[i]])];
                    for (std::size_t lane = 0; lane < kLanes; ++lane) {
                        const float v = light[lane] * a[lane];
                        part[lane] += v;
                        light[lane] -= v;
                    }
                }
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    for (std::size_t f = 0; f < m_features; ++f)
                        sums.features[f][lane] += static_cast<double>(parts[f][lane]);
                    const double alpha = 1.0 - static_cast<double>(light[lane]);
                    sums.alpha[lane] += alpha;
                    sums.translucent[lane] += alpha > kEmpty && alpha < kSolid;
                }
            }
        });
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            Appearance& a = all[first + lane];
            a.covers.assign(m_features, 0.0);
            for (const Sums& sums : blocks) {
                for (std::size_t f = 0; f < m_features; ++f) a.covers[f] += sums.features[f][lane];
                a.alpha += sums.alpha[lane];
                a.translucent += sums.translucent[lane];
            }
            a.shares.assign(m_features, 0.0);
            for (std::size_t f = 0; f < m_features; ++f) {
                if (a.alpha > 0) a.shares[f] = a.covers[f] / a.alpha;
                a.covers[f] /= std::max(1, raysOf(static_cast<int>(f)));
            }
            a.alpha /= std::max<double>(1, static_cast<double>(rayCount));
            a.translucent /= std::max<double>(1, static_cast<double>(rayCount));
        }
    }
    return all;
}

} // namespace pellucid
