// Bins of intensity along rays: what ray_bundle and ray_vws have in common.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <vector>

#include <glm/common.hpp>

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

/// Values along rays: of a volume, or of the part of it that is in this process. Places and voxels are the volume's.
template <class Values>
class BinSampler {
public:
    /// `part` has the voxels from `first` on; of a place the process answers that has its nearest voxel in `own`.
    BinSampler(const Volume& part, const Values& values, const Int3& first, const VoxelRegion& own, const Int3& dims)
        : m_volume(part), m_values(values), m_dims(part.dims()), m_first(first), m_own(own), m_last(dims - 1),
          m_lo(part.range().lo), m_perSpan(1 / (part.range().hi - part.range().lo)),
          m_simple(part.invalidCount() == 0 && std::isfinite(m_perSpan) && m_perSpan > 0) {}

    Int3 nearest(const Vec3& place) const { return glm::clamp(Int3(glm::round(place)), Int3(0), m_last); }
    bool answersFor(const Int3& voxel) const {
        return voxel.x >= m_own.lo.x && voxel.y >= m_own.lo.y && voxel.z >= m_own.lo.z && voxel.x < m_own.hi.x &&
               voxel.y < m_own.hi.y && voxel.z < m_own.hi.z;
    }
    /// Of a voxel among those that are here.
    std::size_t indexOf(const Int3& voxel) const {
        return voxelIndex(m_dims, voxel.x - m_first.x, voxel.y - m_first.y, voxel.z - m_first.z);
    }
    double intensityOf(std::size_t index) const {
        return m_volume.intensityOfValue(static_cast<double>(m_values[index]));
    }
    /// Trilinear, of intensities: their bin; −1 where more than half of it is invalid.
    int at(const Vec3& place) const {
        const Vec3 voxel = place - Vec3(m_first);
        if (!m_simple) {
            const Interpolated met = interpolateValid([&](std::size_t i) { return intensityOf(i); }, m_dims, voxel);
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
    Int3 m_dims, m_first;
    VoxelRegion m_own;
    Int3 m_last;
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
    const VoxelsElsewhere* const elsewhere = volume.elsewhere();
    const Volume* const part = elsewhere != nullptr ? volume.here().get() : &volume;
    if (part == nullptr) return;
    const Int3 first = elsewhere != nullptr ? elsewhere->stored().lo : Int3(0);
    const VoxelRegion own = elsewhere != nullptr ? elsewhere->own() : VoxelRegion{Int3(0), volume.dims()};
    std::visit(
        [&](const auto& samples) {
            const BinSampler sampler(*part, samples, first, own, volume.dims());
            forEachRayOf(volume.geometry(), view, side, rows, step, seed, job,
                         [&](std::size_t pixel, const PixelRay& ray) { take(pixel, ray, sampler); });
        },
        part->samples());
}

/// Per pixel what steps of its ray have met, each Item with the number of its `step`, ascending. Of a volume on several
/// ranks: what each has found of its own places becomes what all have found.
template <class Item>
void shareRays(const Volume& volume, std::vector<std::vector<Item>>& rays) {
    static_assert(std::is_trivially_copyable_v<Item>);
    if (volume.elsewhere() == nullptr) return;
    std::vector<std::byte> mine;
    const auto add = [&](const void* data, std::size_t count) {
        const auto* from = static_cast<const std::byte*>(data);
        mine.insert(mine.end(), from, from + count);
    };
    for (std::size_t pixel = 0; pixel < rays.size(); ++pixel) {
        if (rays[pixel].empty()) continue;
        const std::array<std::uint64_t, 2> head{pixel, rays[pixel].size()};
        add(head.data(), sizeof head);
        add(rays[pixel].data(), rays[pixel].size() * sizeof(Item));
    }
    for (auto& ray : rays) ray.clear();
    for (const std::vector<std::byte>& bytes : volume.elsewhere()->gather(mine))
        for (std::size_t at = 0; at < bytes.size();) {
            std::array<std::uint64_t, 2> head;
            std::memcpy(head.data(), bytes.data() + at, sizeof head);
            at += sizeof head;
            std::vector<Item>& ray = rays.at(head[0]);
            const std::size_t before = ray.size();
            ray.resize(before + head[1]);
            std::memcpy(ray.data() + before, bytes.data() + at, head[1] * sizeof(Item));
            at += head[1] * sizeof(Item);
        }
    for (auto& ray : rays) std::ranges::sort(ray, {}, &Item::step);
}

} // namespace pellucid
