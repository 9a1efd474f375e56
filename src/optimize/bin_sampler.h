// Bins of intensity along rays: what ray_bundle and ray_vws have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/job.h"
#include "base/parallel.h"
#include "render/ray_box.h"
#include "render/trilinear.h"
#include "render/view.h"
#include "tf/transfer_function.h"
#include "volume/noise.h"
#include "volume/volume.h"

namespace pellucid {

inline constexpr int kIntensityBins = 1024;

inline double intensityOfBin(int bin) { return (bin + 0.5) / kIntensityBins; }
inline int binOfIntensity(double s) { return std::min(static_cast<int>(s * kIntensityBins), kIntensityBins - 1); }

/// Length of a ray's steps, d0: ½, and longer where the diagonal of the box would have more than 400 of them.
inline double stepAlongRays(const Geometry& geometry) {
    constexpr int kMost = 400;
    return std::max(0.5, 2 * geometry.radius() / geometry.d0() / kMost);
}

/// What the bins of a transfer function's features are, whatever their opacities.
struct BinFeatures {
    std::vector<int> slot;  ///< of each bin its feature; as many as there are features where it is in none
    std::vector<char> kept; ///< whether something can be opaque there: hidden features cannot

    explicit BinFeatures(const TransferFunction& tf) {
        const TfSampler opacities(tf);
        for (int bin = 0; bin < kIntensityBins; ++bin) {
            const double s = intensityOfBin(bin);
            const int feature = featureAt(tf.features, s);
            slot.push_back(feature < 0 ? static_cast<int>(tf.features.size()) : feature);
            kept.push_back(feature < 0 ? opacities.opacity(s) > 0
                                       : !tf.features[static_cast<std::size_t>(feature)].hidden);
        }
    }
    bool keeps(int bin) const { return kept[static_cast<std::size_t>(bin)] != 0; }
};

/// Trilinear, of intensities: their bin; −1 where more than half of it is invalid.
template <class Values>
class BinSampler {
public:
    BinSampler(const Volume& volume, const Values& values)
        : m_volume(volume), m_values(values), m_dims(volume.dims()), m_lo(volume.range().lo),
          m_perSpan(1 / (volume.range().hi - volume.range().lo)),
          m_simple(volume.invalidCount() == 0 && std::isfinite(m_perSpan) && m_perSpan > 0) {}

    int at(const Vec3& voxel) const {
        if (!m_simple) {
            const Interpolated met = interpolateValid(
                [&](std::size_t i) { return m_volume.intensityOfValue(static_cast<double>(m_values[i])); }, m_dims,
                voxel);
            return met.validShare < 0.5 ? -1 : binOfIntensity(met.value);
        }
        const auto intensity = [&](std::size_t i) {
            return std::clamp((static_cast<double>(m_values[i]) - m_lo) * m_perSpan, 0.0, 1.0);
        };
        return binOfIntensity(interpolateAll(intensity, TrilinearCell(m_dims, voxel)));
    }

private:
    const Volume& m_volume;
    const Values& m_values;
    Int3 m_dims;
    double m_lo, m_perSpan;
    bool m_simple; ///< all are valid, and the range is one that can be divided by
};

/// A ray of a picture on its way through what is left of a volume; t is the length in the world.
struct PixelRay {
    Vec3 direction;     ///< world, unit vector
    Ray ray;            ///< voxels
    double first, exit; ///< t of the first step, and where it leaves
};

/// Calls take(pixel, ray, sampler, samples) for the rays through a picture of `side` × `side` pixels that meet
/// anything; rows on different threads. Each ray begins elsewhere, by `seed`, so that steps of several voxels hit thin
/// things on average as often as their thickness says. Throws Cancelled.
template <class Take>
void forEachRay(const Volume& volume, const View& view, int side, double step, int seed, const JobControl& job,
                const Take& take) {
    const Geometry& geometry = volume.geometry();
    const std::vector<VoxelPlane> planes = planesInVoxels(view.clipping, geometry);
    const auto follow = [&](const auto& samples) {
        const BinSampler sampler(volume, samples);
        parallelFor(static_cast<std::size_t>(side), [&](std::size_t row) {
            job.throwIfStopped();
            const int y = static_cast<int>(row);
            for (int x = 0; x < side; ++x) {
                const Ray world = pixelRay(view.camera, x + 0.5, y + 0.5, side, side);
                const Ray ray = inVoxels(world, geometry);
                RayInterval inside = intersectBox(ray, geometry);
                inside.enter = std::max(inside.enter, 0.0);
                cut(inside, ray, planes);
                if (inside.empty()) continue;
                const double begin = static_cast<double>(hashOf(x, y, 0, seed) % 1024) / 1024;
                take(row * static_cast<std::size_t>(side) + static_cast<std::size_t>(x),
                     PixelRay{world.direction, ray, inside.enter + begin * step, inside.exit}, sampler, samples);
            }
        });
    };
    std::visit(follow, volume.samples());
}

} // namespace pellucid
