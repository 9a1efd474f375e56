// Bins of intensity along rays: what ray_bundle and ray_vws have in common.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <glm/common.hpp>

#include "base/byte_stream.h"
#include "base/job.h"
#include "base/parallel.h"
#include "render/ray_box.h"
#include "render/trilinear.h"
#include "render/view.h"
#include "tf/transfer_function.h"
#include "volume/noise.h"
#include "volume/volume_part.h"

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

/// Values along rays: of a volume, or of the part of it that is in this process. Places and voxels are the volume's.
template <class Values>
class BinSampler {
public:
    /// `values` are those of `part`, of a volume of `dims` voxels; of a place the process answers that has its nearest
    /// voxel.
    BinSampler(const VolumePart& part, const Values& values, const Int3& dims)
        : m_part(part), m_values(values), m_last(dims - 1), m_isAll(part.volume->dims() == dims),
          m_lo(part.volume->range().lo), m_perSpan(1 / (part.volume->range().hi - part.volume->range().lo)),
          m_simple(part.volume->invalidCount() == 0 && std::isfinite(m_perSpan) && m_perSpan > 0) {}

    Int3 nearest(const Vec3& place) const { return glm::clamp(Int3(glm::round(place)), Int3(0), m_last); }
    bool answersFor(const Vec3& place) const { return m_isAll || m_part.owns(nearest(place)); }
    std::size_t indexOf(const Int3& voxel) const { return m_part.indexOf(voxel); }
    double intensityOf(std::size_t index) const {
        return m_part.volume->intensityOfValue(static_cast<double>(m_values[index]));
    }
    /// Trilinear, of intensities: their bin; −1 where more than half of it is invalid.
    int at(const Vec3& place) const {
        const Vec3 voxel = place - Vec3(m_part.first);
        const Int3& dims = m_part.volume->dims();
        if (!m_simple) {
            const Interpolated met = interpolateValid([&](std::size_t i) { return intensityOf(i); }, dims, voxel);
            return met.validShare < 0.5 ? -1 : binOfIntensity(met.value);
        }
        const auto intensity = [&](std::size_t i) {
            return std::clamp((static_cast<double>(m_values[i]) - m_lo) * m_perSpan, 0.0, 1.0);
        };
        return binOfIntensity(interpolateAll(intensity, TrilinearCell(dims, voxel)));
    }

private:
    VolumePart m_part;
    const Values& m_values;
    Int3 m_last;  ///< voxel of the volume
    bool m_isAll; ///< the part is the whole
    double m_lo, m_perSpan;
    bool m_simple; ///< all are valid, and the range is one that can be divided by
};

/// A ray of a picture on its way through what is left of a volume; t is the length in the world.
struct PixelRay {
    Vec3 direction;     ///< world, unit vector
    Ray ray;            ///< voxels
    double first, exit; ///< t of the first step, and where it leaves
};

/// Rows of a picture.
struct RayRows {
    int first = 0, end = 0;
};

/// Calls take(pixel, ray) for the rays through these rows of a picture of `side` × `side` pixels that meet anything;
/// rows on different threads. Each ray begins elsewhere, by `seed`, so that steps of several voxels hit thin things on
/// average as often as their thickness says. Throws Cancelled.
template <class Take>
void forEachRayOf(const Geometry& geometry, const View& view, int side, const RayRows& rows, double step, int seed,
                  const JobControl& job, const Take& take) {
    const std::vector<VoxelPlane> planes = planesInVoxels(view.clipping, geometry);
    parallelFor(static_cast<std::size_t>(rows.end - rows.first), [&](std::size_t n) {
        job.throwIfStopped();
        const int y = rows.first + static_cast<int>(n);
        const auto row = static_cast<std::size_t>(y);
        for (int x = 0; x < side; ++x) {
            const Ray world = pixelRay(view.camera, x + 0.5, y + 0.5, side, side);
            const Ray ray = inVoxels(world, geometry);
            RayInterval inside = intersectBox(ray, geometry);
            inside.enter = std::max(inside.enter, 0.0);
            cut(inside, ray, planes);
            if (inside.empty()) continue;
            const double begin = static_cast<double>(hashOf(x, y, 0, seed) % 1024) / 1024;
            take(row * static_cast<std::size_t>(side) + static_cast<std::size_t>(x),
                 PixelRay{world.direction, ray, inside.enter + begin * step, inside.exit});
        }
    });
}

/// The same with a sampler: take(pixel, ray, sampler). Of a volume on several ranks each is called for all rays, and
/// the sampler tells which places along them are its own; shareRays() then brings together what they have found.
template <class Take>
void forEachRay(const Volume& volume, const View& view, int side, const RayRows& rows, double step, int seed,
                const JobControl& job, const Take& take) {
    const VolumePart part = partHere(volume);
    if (part.volume == nullptr) return;
    std::visit(
        [&](const auto& samples) {
            const BinSampler sampler(part, samples, volume.dims());
            forEachRayOf(volume.geometry(), view, side, rows, step, seed, job,
                         [&](std::size_t pixel, const PixelRay& ray) { take(pixel, ray, sampler); });
        },
        part.volume->samples());
}

/// Per pixel what steps of its ray have met, each Item with the number of its `step`, ascending. Of a volume on several
/// ranks: what each has found of its own places becomes what all have found.
template <class Item>
void shareRays(const Volume& volume, std::vector<std::vector<Item>>& rays) {
    if (volume.elsewhere() == nullptr) return;
    std::vector<std::byte> mine;
    for (std::size_t pixel = 0; pixel < rays.size(); ++pixel) {
        if (rays[pixel].empty()) continue;
        appendBytes(mine, std::array<std::uint64_t, 2>{pixel, rays[pixel].size()});
        appendBytes(mine, std::span<const Item>(rays[pixel]));
    }
    for (auto& ray : rays) ray.clear();
    for (const std::vector<std::byte>& bytes : volume.elsewhere()->gather(mine))
        for (ByteReader reader(bytes); !reader.atEnd();) {
            const auto [pixel, count] = reader.take<std::array<std::uint64_t, 2>>();
            std::vector<Item>& ray = rays.at(pixel);
            ray.resize(ray.size() + count);
            reader.take(std::span<Item>(ray).last(count));
        }
    for (auto& ray : rays) std::ranges::sort(ray, {}, &Item::step);
}

} // namespace pellucid
