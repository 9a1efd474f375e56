#include "volume/volume_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/excerpt.h"
#include "volume/formats/writer.h"
#include "volume/time_series.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostSaid = 20; ///< notices of frames, which may be thousands

const std::vector<VolumeWriter>& writers() {
    static const std::vector<VolumeWriter> kWriters{nrrdWriter(), metaImageWriter(), niftiWriter(),
                                                    vtiWriter(),  tiffWriter(),      omeZarrWriter()};
    return kWriters;
}

const VolumeWriter& writerFor(const std::string& path) {
    const std::string lower = lowerCase(path);
    std::vector<std::string> known;
    for (const VolumeWriter& writer : writers())
        for (const std::string& suffix : writer.suffixes) {
            if (lower.size() > suffix.size() && lower.ends_with(suffix)) return writer;
            known.push_back(suffix);
        }
    throw UsageError("the suffix names no format that volumes are written in", path,
                     "give one of " + joined(known, " "));
}

std::string voxelsText(std::size_t count) { return std::to_string(count) + (count == 1 ? " voxel is" : " voxels are"); }

/// What is lost of values on the way to another type, over all frames.
struct ValueLosses {
    std::size_t rounded = 0, cut = 0;
    std::size_t invalid = 0;         ///< voxels that are not valid …
    std::optional<double> writtenAs; ///< … and this value in the file, NaN included; empty: what they were
    std::size_t shared = 0;          ///< valid voxels that are that value, too
    std::optional<double> notSaid;   ///< a value that is missing, which the file does not say

    std::vector<std::string> sentences() const {
        std::vector<std::string> all;
        if (rounded > 0) all.push_back(voxelsText(rounded) + " rounded");
        if (cut > 0) all.push_back(voxelsText(cut) + " cut to what the type can hold");
        if (invalid > 0 && writtenAs && std::isnan(*writtenAs))
            all.push_back(voxelsText(invalid) + " without a valid value, and written as NaN");
        else if (invalid > 0 && writtenAs)
            all.push_back(voxelsText(invalid) + " without a valid value, and written as " + exactText(*writtenAs) +
                          (shared > 0 ? ", as " + std::to_string(shared) +
                                            " valid ones are: a type with more values keeps them apart"
                                      : ": open the file with that as missing value"));
        if (notSaid)
            all.push_back("the file does not say that " + exactText(*notSaid) +
                          " is missing: open it with that as missing value");
        return all;
    }
};

/// What voxels that are not valid become in a type of whole numbers: the smallest value that no valid voxel has, among
/// so many; the smallest of all where there is none.
template <class To>
To valueForNone(const Volume& volume, const std::vector<To>& values) {
    constexpr To kLeast = std::numeric_limits<To>::lowest();
    constexpr std::size_t kMost = sizeof(To) == 1 ? 256 : 65536;
    std::vector<bool> isTaken(kMost, false);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto n = static_cast<std::uint64_t>(static_cast<std::int64_t>(values[i]) - std::int64_t{kLeast});
        if (n < kMost && volume.isValid(i)) isTaken[static_cast<std::size_t>(n)] = true;
    }
    const auto free = std::ranges::find(isTaken, false);
    return static_cast<To>(std::int64_t{kLeast} + (free == isTaken.end() ? 0 : free - isTaken.begin()));
}

/// A volume in another type. Voxels that are not valid become NaN; where the type has none, a value that no other has.
template <class To>
Volume converted(const Volume& volume, ValueLosses& lost) {
    constexpr double kLeast = static_cast<double>(std::numeric_limits<To>::lowest());
    constexpr double kMost = static_cast<double>(std::numeric_limits<To>::max());
    constexpr bool kIsFloat = std::is_floating_point_v<To>;
    std::vector<To> values(volume.size());
    std::size_t invalid = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!volume.isValid(i)) {
            ++invalid;
            if (kIsFloat) values[i] = std::numeric_limits<To>::quiet_NaN();
            continue;
        }
        const double value = volume.value(i), inRange = std::clamp(value, kLeast, kMost);
        const double kept = std::is_integral_v<To> ? std::round(inRange) : inRange;
        values[i] = static_cast<To>(kept);
        if (inRange != value)
            ++lost.cut;
        else if (static_cast<double>(values[i]) != value)
            ++lost.rounded;
    }
    lost.invalid += invalid;
    if constexpr (kIsFloat) {
        if (volume.missing()) lost.writtenAs = std::numeric_limits<double>::quiet_NaN();
    } else {
        if (!lost.writtenAs) lost.writtenAs = static_cast<double>(valueForNone(volume, values)); // of all frames
        const auto none = static_cast<To>(*lost.writtenAs);
        for (std::size_t i = 0; i < values.size() && invalid > 0; ++i)
            if (!volume.isValid(i)) values[i] = none;
        lost.shared += static_cast<std::size_t>(std::ranges::count(values, none)) - invalid;
    }
    return {volume.geometry(), SampleArray<To>(std::move(values))};
}

Volume inType(const Volume& volume, SampleType type, ValueLosses& lost) {
    switch (type) {
    case SampleType::U8:
        return converted<std::uint8_t>(volume, lost);
    case SampleType::I8:
        return converted<std::int8_t>(volume, lost);
    case SampleType::U16:
        return converted<std::uint16_t>(volume, lost);
    case SampleType::I16:
        return converted<std::int16_t>(volume, lost);
    case SampleType::U32:
        return converted<std::uint32_t>(volume, lost);
    case SampleType::I32:
        return converted<std::int32_t>(volume, lost);
    case SampleType::F32:
        return converted<float>(volume, lost);
    case SampleType::F64:
        break;
    }
    return converted<double>(volume, lost);
}

/// The step from each time to the next, where it is one.
std::optional<StepTimes> evenTimes(const std::vector<double>& times, const std::string& unit) {
    if (times.size() < 2) return {};
    const StepTimes even{times[0], (times.back() - times[0]) / static_cast<double>(times.size() - 1), unit};
    if (!(even.width > 0)) return {};
    for (std::size_t n = 0; n < times.size(); ++n)
        if (std::abs(times[n] - (even.first + static_cast<double>(n) * even.width)) > 1e-6 * even.width) return {};
    return even;
}

/// `frames` are volumes as they are; a part of them is written.
std::vector<std::string> write(FramesToWrite frames, const std::string& path, const WrittenPart& part,
                               const JobControl& job) {
    const VolumeWriter& writer = writerFor(path);
    const Int3 dims = frames.geometry.dims;
    if (part.region)
        for (int a = 0; a < 3; ++a)
            PELLUCID_CHECK(0 <= part.region->lo[a] && part.region->lo[a] < part.region->hi[a] &&
                           part.region->hi[a] <= dims[a]);
    const ExcerptPlan plan = planOf(part.region.value_or(VoxelRegion{Int3(0), dims}), dims, part.coarser);
    frames.geometry = plan.geometryOf(frames.geometry);
    frames.type = part.type.value_or(frames.type);
    std::vector<std::string> lost = writer.losses(frames, path);
    const bool isFloat = frames.type == SampleType::F32 || frames.type == SampleType::F64;
    ValueLosses ofValues;
    std::optional<Volume> cut, other;
    frames.frame = [&, own = std::move(frames.frame)](int n, const JobControl& one) -> const Volume& {
        const Volume& whole = own(n, one);
        const Volume& volume = plan.isWhole() ? whole : cut.emplace(excerptOf(whole, plan, {one.stop, {}}));
        if (volume.sampleType() == frames.type && !(isFloat && volume.missing())) {
            if (volume.missing() && volume.invalidCount() > 0) ofValues.notSaid = volume.missing();
            return volume;
        }
        return other.emplace(inType(volume, frames.type, ofValues));
    };
    writer.write(frames, path, job);
    const std::vector<std::string> more = ofValues.sentences();
    lost.insert(lost.end(), more.begin(), more.end());
    return lost;
}

} // namespace

std::vector<std::string> writeVolume(const Volume& volume, const std::string& path, const WrittenPart& part,
                                     const JobControl& job) {
    FramesToWrite one{volume.geometry(), volume.sampleType()};
    one.frame = [&](int, const JobControl&) -> const Volume& { return volume; };
    return write(std::move(one), path, part, job);
}

std::vector<std::string> writeSeries(TimeSeries& series, const std::string& path, const WrittenPart& part,
                                     const JobControl& job, const std::vector<std::string>& told) {
    static_cast<void>(writerFor(path));
    std::shared_ptr<const Volume> frame = series.load(0, job);
    FramesToWrite all{frame->geometry(), frame->sampleType(), series.size()};
    const SeriesListing& listing = series.listing();
    for (const SeriesFrame& one : listing.frames)
        if (listing.hasTimes) all.frameTimes.push_back(one.time);
    std::vector<std::string> lost;
    all.times = evenTimes(all.frameTimes, listing.timeUnit);
    if (!all.times && all.frameTimes.size() > 1 && !lowerCase(path).ends_with(".pvd"))
        lost.emplace_back("frames do not follow each other at one step of time: the file does not say when they are");
    std::set<std::string> said(told.begin(), told.end());
    std::size_t kept = 0;
    all.frame = [&](int n, const JobControl& one) -> const Volume& {
        frame = series.load(n, {one.stop, {}});
        for (const std::string& notice : frame->notices)
            if (said.insert(notice).second && kept++ < kMostSaid)
                lost.push_back("frame " + std::to_string(n) + ": " + notice);
        return *frame;
    };
    const std::vector<std::string> more = write(std::move(all), path, part, job);
    if (kept > kMostSaid) lost.push_back("and " + std::to_string(kept - kMostSaid) + " more of single frames");
    lost.insert(lost.end(), more.begin(), more.end());
    return lost;
}

std::vector<std::string> writtenFiles(const std::string& path, int frames) {
    const VolumeWriter& writer = writerFor(path);
    std::vector<std::string> files{path};
    if (writer.filesBeside != nullptr)
        for (std::string& file : writer.filesBeside(path, frames)) files.push_back(std::move(file));
    return files;
}

void checkVolumeSuffix(const std::string& path) { static_cast<void>(writerFor(path)); }

std::vector<std::pair<std::string, std::string>> writtenVolumePatterns() {
    std::vector<std::pair<std::string, std::string>> patterns;
    for (const VolumeWriter& writer : writers())
        for (const std::string& suffix : writer.suffixes) patterns.emplace_back(writer.name, "*" + suffix);
    return patterns;
}

std::span<const std::byte> sampleBytes(const Volume& volume) {
    std::span<const std::byte> bytes;
    withSamples(volume, [&](const auto& values) {
        bytes = std::as_bytes(std::span(values.data(), voxelCount(volume.dims())));
    });
    return bytes;
}

void writeFrames(OutputFile& out, const FramesToWrite& frames, const JobControl& job) {
    for (int n = 0; n < frames.count; ++n) {
        const JobControl part = frames.part(n, job);
        writePieces(out, sampleBytes(frames.frame(n, part)), part);
    }
}

void writePieces(OutputFile& out, std::span<const std::byte> bytes, const JobControl& job) {
    constexpr std::size_t kPiece = std::size_t{1} << 24;
    for (std::size_t done = 0; done < bytes.size();) {
        job.throwIfStopped();
        const std::size_t piece = std::min(kPiece, bytes.size() - done);
        out.write(bytes.data() + done, piece);
        done += piece;
        job.report(static_cast<double>(done) / static_cast<double>(bytes.size()));
    }
}

} // namespace pellucid
