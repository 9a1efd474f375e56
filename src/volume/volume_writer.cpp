#include "volume/volume_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/formats/writer.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

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

/// A volume in another type. Voxels that are not valid become NaN; where the type has none, its smallest value.
template <class To>
Volume converted(const Volume& volume, std::vector<std::string>& notices) {
    constexpr double kLeast = static_cast<double>(std::numeric_limits<To>::lowest());
    constexpr double kMost = static_cast<double>(std::numeric_limits<To>::max());
    std::vector<To> values(volume.size());
    std::size_t rounded = 0, cut = 0, invalid = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!volume.isValid(i)) {
            ++invalid;
            values[i] =
                std::is_floating_point_v<To> ? std::numeric_limits<To>::quiet_NaN() : std::numeric_limits<To>::lowest();
            continue;
        }
        const double value = volume.value(i), inRange = std::clamp(value, kLeast, kMost);
        const double kept = std::is_integral_v<To> ? std::round(inRange) : inRange;
        values[i] = static_cast<To>(kept);
        if (inRange != value)
            ++cut;
        else if (static_cast<double>(values[i]) != value)
            ++rounded;
    }
    if (rounded > 0) notices.push_back(voxelsText(rounded) + " rounded");
    if (cut > 0) notices.push_back(voxelsText(cut) + " cut to what the type can hold");
    if (invalid > 0 && std::is_integral_v<To>)
        notices.push_back(voxelsText(invalid) + " without a valid value, and written as " + plainText(kLeast) +
                          ": open the file with that as missing value");
    if (invalid > 0 && std::is_floating_point_v<To> && volume.missing())
        notices.push_back(voxelsText(invalid) + " without a valid value, and written as NaN");
    return {volume.geometry(), SampleArray<To>(std::move(values))};
}

Volume inType(const Volume& volume, SampleType type, std::vector<std::string>& notices) {
    switch (type) {
    case SampleType::U8:
        return converted<std::uint8_t>(volume, notices);
    case SampleType::I8:
        return converted<std::int8_t>(volume, notices);
    case SampleType::U16:
        return converted<std::uint16_t>(volume, notices);
    case SampleType::I16:
        return converted<std::int16_t>(volume, notices);
    case SampleType::U32:
        return converted<std::uint32_t>(volume, notices);
    case SampleType::I32:
        return converted<std::int32_t>(volume, notices);
    case SampleType::F32:
        return converted<float>(volume, notices);
    case SampleType::F64:
        break;
    }
    return converted<double>(volume, notices);
}

} // namespace

std::vector<std::string> writeVolume(const Volume& volume, const std::string& path, std::optional<SampleType> type,
                                     const JobControl& job) {
    const VolumeWriter& writer = writerFor(path);
    std::vector<std::string> notices = writer.losses(volume.geometry());
    const SampleType wanted = type.value_or(volume.sampleType());
    const bool isFloat = wanted == SampleType::F32 || wanted == SampleType::F64;
    if (wanted != volume.sampleType() || (isFloat && volume.missing())) {
        const Volume other = inType(volume, wanted, notices);
        writer.write(other, path, job);
    } else {
        if (volume.missing() && volume.invalidCount() > 0)
            notices.push_back("the file does not say that " + plainText(*volume.missing()) +
                              " is missing: open it with that as missing value");
        writer.write(volume, path, job);
    }
    return notices;
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
