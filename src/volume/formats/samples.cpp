#include "volume/formats/samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "base/zeroed_memory.h"
#include "volume/formats/byte_source.h"
#include "volume/formats/bzip2_bytes.h"
#include "volume/formats/deflate_at_once.h"
#include "volume/formats/file_check.h"
#include "volume/formats/inflate_index.h"
#include "volume/formats/volume_rows.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

/// 64-bit integers have no sample type of their own.
template <class T>
using KeptType = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, double, T>;
/// Whether floats have all scaled values of an integer type and tell them apart: their steps are no longer than those
/// of the values.
template <class T>
bool floatsTellApart(const ValueScaling& scaling) {
    const double step = std::abs(scaling.slope), most = std::ldexp(step, 8 * sizeof(T)) + std::abs(scaling.intercept);
    return most <= std::ldexp(step, std::numeric_limits<float>::digits) &&
           most <= static_cast<double>(std::numeric_limits<float>::max());
}

/// Calls use(Kept{}) with the type that values of T are kept in: their own, or scaled, since scaled integers are no
/// integers, the shortest that keeps them.
template <class T, class Use>
void withKeptType(const std::optional<ValueScaling>& scaling, const Use& use) {
    if (!scaling) return use(KeptType<T>{});
    if constexpr (sizeof(T) < sizeof(float)) {
        if (floatsTellApart<T>(*scaling)) return use(float{});
    } else if constexpr (std::is_same_v<T, float>) {
        return use(float{});
    }
    use(double{});
}

template <class T>
SampleType sampleTypeOf() {
    return static_cast<SampleType>(Samples(SampleArray<T>()).index());
}

/// Says from time to time how far reading has come.
class ReadProgress {
public:
    ReadProgress(const JobControl& job, std::size_t all) : m_job(job), m_all(all) {}
    void add(std::size_t voxels) {
        m_done += voxels;
        if (m_done < m_nextReport) return;
        m_job.throwIfStopped();
        m_job.report(0.1 + 0.8 * static_cast<double>(m_done) / static_cast<double>(m_all));
        m_nextReport = m_done + (1u << 20);
    }

private:
    const JobControl& m_job;
    std::size_t m_all, m_done = 0, m_nextReport = 0;
};

/// Room for so many samples, padded, so that codes of 8 bits need no copy.
template <class Kept>
ZeroedVector<Kept> roomFor(std::size_t voxels) {
    return ZeroedVector<Kept>(voxels + SampleArray<Kept>::kPadding);
}

/// What readSamples() makes a volume of.
struct Collected {
    Samples samples;
    ValueRange range; ///< of the voxels that were read, where the volume has others; lo > hi where it has not
};

/// convert(T) of each voxel's value.
template <class T, class Kept, class Convert>
Collected collect(Values& values, const Selection& selection, const JobControl& job, const Convert& convert) {
    const auto size = [&](int a) { return static_cast<std::uint64_t>(selection.dims[a]); };
    // Voxels follow each other at one stride for as many axes as the file allows.
    std::uint64_t length = size(0), ny = size(1), nz = size(2);
    if (selection.stride[1] == size(0) * selection.stride[0]) {
        length *= std::exchange(ny, 1);
        if (selection.stride[2] == size(1) * selection.stride[1]) length *= std::exchange(nz, 1);
    }
    const std::size_t all = voxelCount(selection.dims);
    auto kept = roomFor<Kept>(all);
    std::size_t done = 0;
    VoxelReader<T> reader(values, selection.stride[0]);
    ReadProgress progress(job, all);
    for (std::uint64_t k = 0; k < nz; ++k)
        for (std::uint64_t j = 0; j < ny; ++j)
            reader.readLine(selection.first + j * selection.stride[1] + k * selection.stride[2], length,
                            [&](const T* piece, std::uint64_t voxels) {
                                for (std::uint64_t v = 0; v < voxels; ++v)
                                    kept[done++] = convert(piece[v * selection.stride[0]]);
                                progress.add(static_cast<std::size_t>(voxels));
                            });
    values.finish();
    return {SampleArray<Kept>(std::move(kept), all), {0, -1}};
}

/// The same where values are kept as the file has them and lie beside each other: nothing stands between file and
/// samples.
template <class T>
Collected collectPlain(Values& values, const Selection& selection, const JobControl& job) {
    const std::size_t all = voxelCount(selection.dims);
    auto kept = roomFor<T>(all);
    values.skip(selection.first);
    ReadProgress progress(job, all);
    constexpr std::size_t kAtOnce = std::size_t{1} << 20;
    for (std::size_t done = 0; done < all;) {
        const std::size_t count = std::min(kAtOnce, all - done);
        values.read(reinterpret_cast<char*>(kept.data() + done), count);
        done += count;
        progress.add(count);
    }
    values.finish();
    return {SampleArray<T>(std::move(kept), all), {0, -1}};
}

/// The same of all that a deflate stream has, unpacked in one go straight to the samples; empty where that cannot be.
template <class T>
std::optional<Collected> collectAtOnce(const FileLayout& layout, const Selection& selection, const JobControl& job) {
    const std::uint64_t bytes = layout.skip + voxelCount(selection.dims) * sizeof(T);
    if (!layout.unchecked || layout.unchecked->bytes != bytes || bytes > kMostAtOnce || !layout.parts.empty() ||
        layout.open || layout.encoding != Encoding::Deflate || isInOtherOrder<T>(layout))
        return {};
    const std::size_t voxels = voxelCount(selection.dims);
    auto kept = roomFor<T>(voxels + static_cast<std::size_t>((layout.skip + sizeof(T) - 1) / sizeof(T)));
    auto* const first = reinterpret_cast<char*>(kept.data());
    if (!unpackAtOnce(layout.dataPath, layout.start, layout.zlib, layout.unchecked->toEnd,
                      {first, static_cast<std::size_t>(bytes)}, job))
        return {};
    if (layout.skip > 0) std::memmove(first, first + layout.skip, voxels * sizeof(T));
    return Collected{SampleArray<T>(std::move(kept), voxels), {0, -1}};
}

/// collect() for an excerpt, and for pieces: one layer of it is in the making while the file goes by.
template <class T, class Kept, class Convert>
Collected collectExcerpt(Rows<T>& rows, const ExcerptPlan& plan, std::optional<double> missing, const JobControl& job,
                         const Convert& convert) {
    const Int3 lo = plan.region.lo, size = plan.region.hi - lo;
    auto kept = roomFor<Kept>(voxelCount(plan.dims));
    const auto ofRow = static_cast<std::size_t>(size.x);
    const bool asItIs = plan.factors == Int3(1);
    constexpr bool kAsStored = std::is_same_v<Convert, std::identity>;
    const std::size_t layer = voxelCount({plan.dims.x, plan.dims.y, 1});
    constexpr int kVoxelsAtOnce = 1 << 18;
    const int rowsAtOnce = std::clamp(kVoxelsAtOnce / size.x, 1, size.y);
    const std::size_t atOnce = ofRow * static_cast<std::size_t>(rowsAtOnce);
    std::vector<T> values(kAsStored ? 0 : atOnce);
    std::vector<Kept> converted(asItIs ? 0 : atOnce);
    LayerMeans<Kept> means({size.x, size.y}, plan.factors, missing);
    ReadProgress progress(job, voxelCount(size));
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; j += rowsAtOnce) {
            const int count = std::min(rowsAtOnce, size.y - j);
            const std::size_t voxels = ofRow * static_cast<std::size_t>(count);
            Kept* const to =
                asItIs ? kept.data() + layer * static_cast<std::size_t>(k) + ofRow * static_cast<std::size_t>(j)
                       : converted.data();
            if constexpr (kAsStored) {
                rows.read(lo + Int3(0, j, k), size.x, count, to);
            } else {
                rows.read(lo + Int3(0, j, k), size.x, count, values.data());
                std::transform(values.data(), values.data() + voxels, to, convert);
            }
            for (int row = 0; row < count && !asItIs; ++row)
                means.add(converted.data() + static_cast<std::size_t>(row) * ofRow, j + row);
            progress.add(voxels);
        }
        if (asItIs) continue;
        if (k % plan.factors.z == plan.factors.z - 1 || k == size.z - 1)
            means.takeTo(kept.data() + layer * static_cast<std::size_t>(k / plan.factors.z));
    }
    rows.finish();
    return {SampleArray<Kept>(std::move(kept), voxelCount(plan.dims)), asItIs ? ValueRange{0, -1} : means.range()};
}

/// Where all samples, of a large file, can be used as they lie in it.
template <class T>
bool isMappable(const FileLayout& layout, const Selection& selection) {
    return layout.encoding == Encoding::Raw && !layout.open && layout.parts.empty() && layout.pieces.empty() &&
           !isInOtherOrder<T>(layout) && !layout.scaling && isGapless(selection) &&
           (layout.start + selection.first * sizeof(T)) % sizeof(T) == 0 &&
           voxelCount(selection.dims) * sizeof(T) >= kMapBytes;
}

/// The samples as they lie in the file; empty where the system refuses.
template <class T>
std::optional<Samples> mapped(const FileLayout& layout, const Selection& selection, const JobControl& job) {
    auto file = MappedFile::map(layout.dataPath, layout.start + selection.first * sizeof(T),
                                voxelCount(selection.dims) * sizeof(T));
    if (!file) return {};
    // Looked at once from end to end, so that a slow disk can be waited for, or not.
    constexpr std::size_t kPage = 4096;
    ReadProgress progress(job, file->size());
    volatile unsigned char looked = 0;
    for (std::size_t i = 0; i < file->size(); i += kPage) {
        looked = file->data()[i];
        progress.add(kPage);
    }
    static_cast<void>(looked);
    return SampleArray<T>(std::move(file));
}

template <class T, class Kept>
Collected readAs(const FileLayout& layout, const Selection& selection, const ExcerptPlan& plan,
                 const VolumeSource& source, const JobControl& job) {
    if constexpr (std::is_same_v<T, Kept>)
        if (plan.isWhole() && isMappable<T>(layout, selection))
            if (auto samples = mapped<T>(layout, selection, job)) return {std::move(*samples), {0, -1}};
    if (plan.isWhole()) { // it was not planned for memory where it was to be mapped
        const std::uint64_t bytes = voxelCount(plan.dims) * sizeof(Kept);
        requireMemory(source.then, source.path, plan.dims, sampleTypeOf<Kept>(), bytes, bytes);
    }
    const bool byRows = !plan.isWhole() || !layout.pieces.empty();
    if constexpr (std::is_same_v<T, Kept>)
        if (!byRows && !layout.scaling && isGapless(selection)) {
            if (auto all = collectAtOnce<T>(layout, selection, job)) return std::move(*all);
            return collectPlain<T>(*openValues<T>(layout, Wanted::All, job), selection, job);
        }
    const auto read = [&](const auto& convert) {
        return byRows
                   ? collectExcerpt<T, Kept>(*openRows<T>(layout, selection, job), plan, source.missing, job, convert)
                   : collect<T, Kept>(*openValues<T>(layout, Wanted::All, job), selection, job, convert);
    };
    if constexpr (std::is_same_v<T, Kept>)
        if (!layout.scaling) return read(std::identity());
    if (!layout.scaling) return read([](T value) { return static_cast<Kept>(value); });
    bool isBeyond = false;
    Collected scaled = read([scaling = *layout.scaling, &isBeyond](T value) {
        const double exact = scaling.slope * static_cast<double>(value) + scaling.intercept;
        isBeyond |=
            std::isfinite(static_cast<double>(value)) && !(std::abs(exact) <= double{std::numeric_limits<Kept>::max()});
        return isBeyond ? Kept{0} : static_cast<Kept>(exact);
    });
    if (isBeyond)
        throw FileError("some values, scaled as the header says, are larger than samples of this type can be",
                        source.path, "correct the scaling in the header");
    return scaled;
}

/// Whether packed data may be unpacked into as much memory as the header claims before it has been checked: not much,
/// or what the stream says itself, or what such data usually unpacks to.
bool isBelievable(const StoredValues& values, std::uint64_t stored, std::uint64_t bytes) {
    constexpr std::uint64_t kLittle = 256u << 20, kUsual = 8;
    return bytes <= kLittle || bytes / kUsual <= stored ||
           (values.encoding == Encoding::Deflate && lengthAtEnd(values.dataPath) == bytes % (std::uint64_t{1} << 32));
}

} // namespace

std::uint64_t bytesPerValue(ValueType type) {
    return withType(type, [](auto zero) { return static_cast<std::uint64_t>(sizeof zero); });
}

std::uint64_t valuesIn(const FileLayout& layout, const std::string& path) {
    std::vector<std::int64_t> sizes;
    for (const FileAxis& axis : layout.axes) sizes.push_back(axis.size);
    return valueCount(path, sizes, sizeof(double));
}

std::uint64_t valuesUpTo(const FileLayout& layout, int step) {
    const Selection selection = selectionOf(layout, 0, 0);
    const std::uint64_t all = valuesIn(layout, layout.dataPath);
    if (!selection.stepsAreApart) return all;
    return all / selection.steps *
           std::min<std::uint64_t>(static_cast<std::uint64_t>(std::max(step, 0)) + 1, selection.steps);
}

void requireData(FileLayout& layout, std::uint64_t stored, std::uint64_t wanted, const char* toDo,
                 const JobControl& job) {
    const std::uint64_t bytesPer = bytesPerValue(layout.type), bytes = layout.skip + wanted * bytesPer;
    const std::uint64_t all = valuesIn(layout, layout.dataPath) * bytesPer;
    requireStored(layout.dataPath, layout.encoding, wanted, bytesPer, stored, toDo);
    if (layout.encoding == Encoding::Text) {
        requireNumbers(layout.dataPath, layout.start, wanted, job);
    } else if (layout.encoding == Encoding::Bzip2 ||
               (layout.encoding == Encoding::Deflate && selectionOf(layout, 0, 0).steps == 1)) {
        if (isBelievable(layout, stored, bytes))
            layout.unchecked = UncheckedBytes{bytes};
        else
            requireSound(*unpackedBytes(layout, job), bytes, layout.dataPath);
    } else if (layout.encoding == Encoding::Deflate) {
        layout.index = InflateIndex::of(layout.dataPath, layout.start, layout.zlib);
        layout.index->require(bytes, job);
    } else if (layout.encoding == Encoding::Raw && stored > all) {
        layout.notices.push_back("the data has " + std::to_string(stored - all) + " bytes more than the header says");
    }
}

std::unique_ptr<UnpackedBytes> unpackedBytes(const StoredValues& stored, const JobControl& job) {
    if (stored.encoding == Encoding::Bzip2) return std::make_unique<Bunzipped>(stored.dataPath, stored.start, job);
    return std::make_unique<InflatedBytes>(stored.dataPath, stored.start, stored.zlib, job);
}

FileContents contentsOf(const FileLayout& layout) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    const Selection selection = selectionOf(layout, 0, 0);
    FileContents contents;
    contents.dims = selection.dims;
    withType(layout.type, [&](auto zero) {
        using T = decltype(zero);
        withKeptType<T>(layout.scaling, [&](auto kept) { contents.type = sampleTypeOf<decltype(kept)>(); });
    });
    contents.components = static_cast<int>(std::min(selection.components, kMost));
    contents.steps = static_cast<int>(std::min(selection.steps, kMost));
    contents.array = layout.array;
    contents.arrays = layout.arrays;
    if (!layout.times) return contents;
    contents.timeUnit = layout.times->unit;
    constexpr int kMostTimes = 1'000'000; // a damaged header may claim any number
    for (int step = 0; step < contents.steps && contents.steps <= kMostTimes; ++step)
        contents.times.push_back(layout.times->first + step * layout.times->width);
    return contents;
}

Vec3 cleanDirection(const Vec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0) || !std::isfinite(length)) return Vec3(0);
    Vec3 unit = direction / length;
    for (int a = 0; a < 3; ++a) {
        Vec3 axis(0);
        axis[a] = std::copysign(1.0, unit[a]);
        if (glm::length(unit - axis) < 1e-6) return axis;
    }
    return unit;
}

Volume readSamples(const VolumeSource& source, const FileLayout& layout, const JobControl& job) {
    const std::string& path = source.path;
    const Selection selection = selectionOf(layout, source.component, source.step);
    const Geometry geometry{selection.dims,    layout.spacing,   layout.origin,
                            layout.directions, layout.worldAxes, layout.lengthUnit};
    if (const std::string wrong = geometryProblem(geometry.spacing, geometry.origin); !wrong.empty())
        throw FileError(wrong, path, "correct the header, or write it in another unit");
    if (!(std::abs(glm::determinant(geometry.directions)) > 1e-6))
        throw FileError("the directions of the axes lie in one plane", path, "correct the header");
    requireIndex("component", source.component, selection.components, path);
    requireIndex("time step", source.step, selection.steps, path);
    if (!source.array.empty() && layout.array != source.array)
        throw UsageError("there is no array " + inQuotes(source.array), path,
                         "the file does not name its arrays: leave the name out");

    std::vector<std::string> notices = layout.notices;
    if (selection.components > 1)
        notices.push_back("component " + std::to_string(source.component) + " of " +
                          std::to_string(selection.components) + " is shown");

    job.report(0.1);
    job.throwIfStopped();
    Collected read;
    ExcerptPlan plan;
    withType(layout.type, [&](auto zero) {
        using T = decltype(zero);
        const auto readTo = [&](auto keptZero) {
            using Kept = decltype(keptZero);
            const bool inFile = std::is_same_v<T, Kept> && isMappable<T>(layout, selection);
            plan = layout.plan ? *layout.plan : planExcerpt(source, selection.dims, sampleTypeOf<Kept>(), inFile);
            read = readAs<T, Kept>(layout, selection, plan, source, job);
        };
        if (std::is_integral_v<T> && sizeof(T) == 8) notices.emplace_back("64-bit integers are kept as 64-bit floats");
        withKeptType<T>(layout.scaling, readTo);
    });
    job.report(0.9);
    Volume volume(plan.geometryOf(geometry), std::move(read.samples), source.missing);
    if (!plan.isWhole()) {
        volume = throughWindowOf(std::move(volume), read.range);
        volume.excerpt = plan.excerpt;
        const auto more = plan.notices();
        notices.insert(notices.begin(), more.begin(), more.end());
    }
    volume.notices = std::move(notices);
    return volume;
}

} // namespace pellucid
