#include "volume/excerpt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include <glm/common.hpp>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "volume/loader.h"
#include "volume/volume_part.h"
#include "volume/voxel_loops.h"

namespace pellucid {

ExcerptPlan planOf(const VoxelRegion& region, const Int3& full, int factor) {
    ExcerptPlan plan;
    plan.region = region;
    const Int3 size = region.hi - region.lo;
    plan.factors = glm::min(Int3(factor), size);
    plan.dims = (size - 1) / plan.factors + 1;
    plan.excerpt = {full, region, factor, false};
    return plan;
}

PlaceInData placeInData(const Volume& volume) {
    if (!volume.excerpt) return {};
    const Excerpt& part = *volume.excerpt;
    const Vec3 factors(planOf(part.region, part.fullDims, part.factor).factors);
    return {Vec3(part.region.lo) + 0.5 * (factors - 1.0), factors};
}

Geometry ExcerptPlan::geometryOf(const Geometry& full) const {
    Geometry geometry = full;
    geometry.dims = dims;
    geometry.spacing = full.spacing * Vec3(factors);
    if (referenceLength > 0) geometry.referenceLength = referenceLength;
    geometry.origin = full.worldFromVoxel(Vec3(region.lo) + 0.5 * Vec3(factors - 1));
    return geometry;
}

std::vector<std::string> ExcerptPlan::notices() const {
    std::vector<std::string> all;
    const Int3 size = excerpt.region.hi - excerpt.region.lo;
    if (excerpt.forMemory)
        all.push_back("downsampled by " + std::to_string(excerpt.factor) + " to " + dimsText(dims) + " voxels: all " +
                      dimsText(size) + " need " + describeBytes(neededAtFull) + " of memory, " +
                      describeBytes(available) + " are free; a region of them can be opened at full resolution");
    else if (excerpt.factor > 1)
        all.push_back("downsampled by " + std::to_string(excerpt.factor) + " to " + dimsText(dims) + " of " +
                      dimsText(size) + " voxels");
    if (size != excerpt.fullDims)
        all.push_back("a region of " + dimsText(size) + " of " + dimsText(excerpt.fullDims) + " voxels is shown");
    return all;
}

ExcerptPlan planExcerpt(const VolumeSource& source, const Int3& full, SampleType type, bool inFile) {
    const VoxelRegion region = source.region.value_or(VoxelRegion{Int3(0), full});
    for (int a = 0; a < 3; ++a)
        if (region.lo[a] < 0 || region.lo[a] >= region.hi[a] || region.hi[a] > full[a])
            throw UsageError("the region " + std::to_string(region.lo[a]) + ":" + std::to_string(region.hi[a]) +
                                 " along " + "xyz"[a] + " does not lie in " + dimsText(full) + " voxels",
                             source.path, "give 0 <= first < end <= the number of voxels, along each axis");
    if (source.downsample < 0) throw UsageError("the downsampling factor is negative", source.path, "give 1 or more");
    // Samples in their file take no memory, but are of use only where all of them have room at a time.
    const auto samplesOf = [&](const ExcerptPlan& plan) { return voxelCount(plan.dims) * bytesPerSample(type); };
    const auto keptOf = [&](const ExcerptPlan& plan) { return inFile && plan.isWhole() ? 0 : samplesOf(plan); };
    const auto needOf = [&](const ExcerptPlan& plan) {
        return std::max(samplesOf(plan), keptOf(plan) + bytesOf(source.then, plan.dims, type));
    };

    ExcerptPlan plan = planOf(region, full, std::max(1, source.downsample));
    const std::uint64_t needed = needOf(plan), available = availableMemoryBytes();
    if (source.downsample == 0 && needed > available) {
        const Int3 size = region.hi - region.lo;
        const int most = std::max({size.x, size.y, size.z});
        for (int factor = 2; factor <= most; ++factor) {
            ExcerptPlan coarser = planOf(region, full, factor);
            if (needOf(coarser) > available) continue;
            coarser.excerpt.forMemory = true;
            coarser.neededAtFull = needed;
            coarser.available = available;
            return coarser;
        }
    }
    requireMemory(source.then, source.path, plan.dims, type, samplesOf(plan), keptOf(plan));
    if (plan.isWhole()) plan.excerpt.factor = 1; // of one voxel
    return plan;
}

template <class T>
LayerMeans<T>::LayerMeans(const glm::ivec2& size, const Int3& factors, std::optional<double> missing)
    : m_size(size), m_layer((size - 1) / glm::ivec2(factors) + 1), m_factors(factors),
      m_sums(static_cast<std::size_t>(m_layer.x) * static_cast<std::size_t>(m_layer.y)),
      m_counts(m_sums.size()), m_range{std::numeric_limits<double>::infinity(),
                                       -std::numeric_limits<double>::infinity()} {
    // A value that no sample can have is missing nowhere.
    if (missing && (!std::is_integral_v<T> || (*missing >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
                                               *missing <= static_cast<double>(std::numeric_limits<T>::max()) &&
                                               *missing == std::floor(*missing))))
        m_missing = static_cast<T>(*missing);
}

template <class T>
void LayerMeans<T>::add(const T* row, int j) {
    const std::size_t first = static_cast<std::size_t>(m_layer.x) * static_cast<std::size_t>(j / m_factors.y);
    for (int x = 0, i = 0; i < m_layer.x; ++i) {
        const int end = std::min(x + m_factors.x, m_size.x);
        double sum = 0;
        std::uint32_t count = 0;
        for (; x < end; ++x) {
            if (m_missing && row[x] == *m_missing) continue;
            const auto value = static_cast<double>(row[x]);
            if constexpr (!std::is_integral_v<T>)
                if (!std::isfinite(value)) continue;
            sum += value;
            ++count;
            m_range.lo = std::min(m_range.lo, value);
            m_range.hi = std::max(m_range.hi, value);
        }
        m_sums[first + static_cast<std::size_t>(i)] += sum;
        m_counts[first + static_cast<std::size_t>(i)] += count;
    }
}

template <class T>
T LayerMeans<T>::meanOf(double sum, std::uint32_t count) const {
    constexpr T kHighest = std::numeric_limits<T>::max(), kLowest = std::numeric_limits<T>::lowest();
    if (count == 0) { // integers are invalid only where they are missing
        if constexpr (!std::is_integral_v<T>)
            if (!m_missing) return std::numeric_limits<T>::quiet_NaN();
        return *m_missing;
    }
    const double mean = sum / count;
    if constexpr (std::is_integral_v<T>) {
        const T value = static_cast<T>(std::floor(mean + 0.5)); // between two values of T
        if (!m_missing || value != *m_missing) return value;
        // It is valid: the neighbour on its own side.
        const bool above = mean >= static_cast<double>(value) ? value < kHighest : value == kLowest;
        return static_cast<T>(above ? value + 1 : value - 1);
    } else {
        const T value = static_cast<T>(std::clamp(mean, static_cast<double>(kLowest), static_cast<double>(kHighest)));
        if (!m_missing || value != *m_missing) return value;
        return std::nextafter(value, mean >= static_cast<double>(value) ? kHighest : kLowest);
    }
}

template <class T>
void LayerMeans<T>::takeTo(T* layer) {
    for (std::size_t i = 0; i < m_sums.size(); ++i) {
        layer[i] = meanOf(m_sums[i], m_counts[i]);
        m_sums[i] = 0;
        m_counts[i] = 0;
    }
}

template class LayerMeans<std::uint8_t>;
template class LayerMeans<std::int8_t>;
template class LayerMeans<std::uint16_t>;
template class LayerMeans<std::int16_t>;
template class LayerMeans<std::uint32_t>;
template class LayerMeans<std::int32_t>;
template class LayerMeans<float>;
template class LayerMeans<double>;

Volume excerptOf(const Volume& whole, const ExcerptPlan& plan, const JobControl& job) {
    const Int3 full = whole.dims(), first = plan.region.lo, size = plan.region.hi - first;
    Samples samples = withSamples(whole, [&](const auto& values) -> Samples {
        using T = typename std::decay_t<decltype(values)>::value_type;
        std::vector<T> kept(voxelCount(plan.dims));
        const std::size_t layer = layerSize(plan.dims);
        parallelFor(static_cast<std::size_t>(plan.dims.z), [&](std::size_t k) {
            job.throwIfStopped();
            LayerMeans<T> means({size.x, size.y}, plan.factors, whole.missing());
            const int z0 = static_cast<int>(k) * plan.factors.z, z1 = std::min(z0 + plan.factors.z, size.z);
            for (int z = z0; z < z1; ++z)
                for (int y = 0; y < size.y; ++y) {
                    const Int3 at = first + Int3(0, y, z);
                    means.add(values.data() + voxelIndex(full, at.x, at.y, at.z), y);
                }
            means.takeTo(kept.data() + k * layer);
        });
        return kept;
    });
    Volume volume(plan.geometryOf(whole.geometry()), std::move(samples), whole.missing());
    volume.title = whole.title;
    volume.format = whole.format;
    volume.excerpt = plan.excerpt;
    volume.notices = plan.notices();
    volume.notices.insert(volume.notices.end(), whole.notices.begin(), whole.notices.end());
    return throughWindowOf(std::move(volume), whole.range());
}

namespace {

/// Means of a volume on several ranks: each adds what it has of every voxel's sum.
Samples meansOfBlocks(const Volume& whole, const ExcerptPlan& plan) {
    const std::size_t count = voxelCount(plan.dims);
    std::vector<double> found(2 * count, 0.0); // sums, then how many
    const VolumePart part = partHere(whole);
    const auto add = [&](const auto& values) {
        part.forOwnRows(0, part.ownLayers(), [&](const Int3& row, std::size_t first, int voxels) {
            for (int x = 0; x < voxels; ++x) {
                const auto value = static_cast<double>(values[first + static_cast<std::size_t>(x)]);
                if (!std::isfinite(value) || (whole.missing() && value == *whole.missing())) continue;
                const Int3 to = (row + Int3(x, 0, 0)) / plan.factors;
                const std::size_t n = voxelIndex(plan.dims, to.x, to.y, to.z);
                found[n] += value;
                ++found[count + n];
            }
        });
    };
    if (part.volume != nullptr) withSamples(*part.volume, add);
    whole.elsewhere()->sum(found);
    const auto means = [&]<class T>(T) -> Samples {
        const LayerMeans<T> mean({1, 1}, Int3(1), whole.missing());
        std::vector<T> values(count);
        for (std::size_t n = 0; n < count; ++n)
            values[n] = mean.meanOf(found[n], static_cast<std::uint32_t>(found[count + n]));
        return values;
    };
    switch (whole.sampleType()) {
    case SampleType::U8:
        return means(std::uint8_t{});
    case SampleType::I8:
        return means(std::int8_t{});
    case SampleType::U16:
        return means(std::uint16_t{});
    case SampleType::I16:
        return means(std::int16_t{});
    case SampleType::U32:
        return means(std::uint32_t{});
    case SampleType::I32:
        return means(std::int32_t{});
    case SampleType::F32:
        return means(float{});
    default:
        return means(double{});
    }
}

} // namespace

Volume coarserCopy(const Volume& whole, int factor) {
    ExcerptPlan plan = planOf({Int3(0), whole.dims()}, whole.dims(), factor);
    plan.referenceLength = whole.geometry().d0();
    if (whole.elsewhere() == nullptr) return excerptOf(whole, plan);
    Volume copy(plan.geometryOf(whole.geometry()), meansOfBlocks(whole, plan), whole.missing());
    copy.title = whole.title;
    copy.format = whole.format;
    return throughWindowOf(std::move(copy), whole.range());
}

VoxelColors coarserColors(const VoxelColors& colors, int factor) {
    PELLUCID_CHECK(factor >= 1);
    const Int3 n = colors.dims, step = glm::min(Int3(factor), n), d = (n - 1) / step + 1;
    VoxelColors coarse{d, std::vector<std::uint32_t>(voxelCount(d))};
    forEachPlace(d, {}, [&](const Int3& place, std::size_t out) {
        const Int3 lo = place * step, hi = glm::min(lo + step, n);
        std::array<std::uint32_t, 3> sum{};
        std::uint32_t count = 0;
        for (int k = lo.z; k < hi.z; ++k)
            for (int j = lo.y; j < hi.y; ++j)
                for (int i = lo.x; i < hi.x; ++i, ++count) {
                    const std::uint32_t c = colors.rgba[voxelIndex(n, i, j, k)];
                    for (std::size_t a = 0; a < 3; ++a) sum[a] += c >> (8 * a) & 255u;
                }
        const auto mean = [&](std::size_t a) { return static_cast<std::uint8_t>((sum[a] + count / 2) / count); };
        coarse.rgba[out] = VoxelColors::pack(mean(0), mean(1), mean(2));
    });
    return coarse;
}

VoxelRegion regionBetween(const Volume& volume, const Vec3& lo, const Vec3& hi) {
    const Excerpt e = volume.excerpt.value_or(Excerpt{volume.dims(), VoxelRegion{Int3(0), volume.dims()}, 1, false});
    const Int3 size = e.region.hi - e.region.lo, factors = glm::min(Int3(e.factor), size);
    constexpr double kRounding = 1e-6; // voxels: fractions of a border are not exact
    VoxelRegion region;
    for (int a = 0; a < 3; ++a) {
        const double box = static_cast<double>(volume.dims()[a]) * factors[a];
        const int first = std::clamp(static_cast<int>(std::floor(lo[a] * box + kRounding)), 0, size[a] - 1);
        const int end = std::clamp(static_cast<int>(std::ceil(hi[a] * box - kRounding)), first + 1, size[a]);
        region.lo[a] = e.region.lo[a] + first;
        region.hi[a] = e.region.lo[a] + end;
    }
    return region;
}

Volume throughWindowOf(Volume volume, const ValueRange& dataRange) {
    const bool isWindow = dataRange.lo < dataRange.hi && volume.hasValidVoxels();
    return isWindow && !(volume.range() == dataRange) ? volume.withRange(dataRange) : volume;
}

} // namespace pellucid
