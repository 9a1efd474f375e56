// Headerless data: the layout comes from the command line or the import dialog.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>

#include "volume/formats/file_check.h"
#include "volume/formats/reader.h"
#include "volume/memory_use.h"

namespace pellucid {

namespace {

template <class T>
void swapBytes(std::vector<T>& values) {
    for (T& value : values) {
        auto* bytes = reinterpret_cast<unsigned char*>(&value);
        std::reverse(bytes, bytes + sizeof(T));
    }
}

template <class T>
Samples readSamples(const std::string& path, const RawLayout& layout, std::size_t count, const JobControl& job) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(layout.skipBytes));
    std::vector<T> values(count);
    constexpr std::size_t kPiece = (16u << 20) / sizeof(T);
    for (std::size_t done = 0; done < count; done += kPiece) {
        job.throwIfStopped();
        const std::size_t piece = std::min(kPiece, count - done);
        in.read(reinterpret_cast<char*>(values.data() + done), static_cast<std::streamsize>(piece * sizeof(T)));
        if (!in) throw FileError("the file ended or failed while it was read", path, "check the disk");
        job.report(0.9 * static_cast<double>(done + piece) / static_cast<double>(count));
    }
    if (sizeof(T) > 1 && layout.bigEndian != (std::endian::native == std::endian::big)) swapBytes(values);
    return values;
}

Samples readSamples(const std::string& path, const RawLayout& layout, std::size_t count, const JobControl& job) {
    switch (layout.type) {
    case SampleType::U8:
        return readSamples<std::uint8_t>(path, layout, count, job);
    case SampleType::I8:
        return readSamples<std::int8_t>(path, layout, count, job);
    case SampleType::U16:
        return readSamples<std::uint16_t>(path, layout, count, job);
    case SampleType::I16:
        return readSamples<std::int16_t>(path, layout, count, job);
    case SampleType::U32:
        return readSamples<std::uint32_t>(path, layout, count, job);
    case SampleType::I32:
        return readSamples<std::int32_t>(path, layout, count, job);
    case SampleType::F32:
        return readSamples<float>(path, layout, count, job);
    case SampleType::F64:
        return readSamples<double>(path, layout, count, job);
    }
    PELLUCID_CHECK(false);
}

} // namespace

Volume readRaw(const VolumeSource& source, const JobControl& job) {
    const std::string& path = source.path;
    const RawLayout& layout = *source.raw;
    if (layout.dims.x < 1 || layout.dims.y < 1 || layout.dims.z < 1)
        throw UsageError("a volume has at least one voxel along each axis", path, "correct the layout",
                         Remedy::CorrectRawLayout);
    for (int a = 0; a < 3; ++a)
        if (!(layout.spacing[a] > 0) || !std::isfinite(layout.spacing[a]))
            throw UsageError("the spacing must be positive and finite", path, "correct it", Remedy::GiveSpacing);
    if (source.component != 0)
        throw UsageError("headerless data has one component, number 0", path, "ask for none", Remedy::NoComponent);
    const std::uint64_t fileBytes = readableFileBytes(path);
    const std::uint64_t bytesPer = bytesPerSample(layout.type);
    const std::int64_t sizes[] = {layout.dims.x, layout.dims.y, layout.dims.z};
    const std::uint64_t values = valueCount(path, sizes, bytesPer);
    const std::uint64_t bytes = values * bytesPer;
    if (layout.skipBytes > fileBytes || fileBytes - layout.skipBytes != bytes) {
        std::string claim = std::to_string(sizes[0]) + " x " + std::to_string(sizes[1]) + " x " +
                            std::to_string(sizes[2]) + " of " + name(layout.type) + " are " + std::to_string(bytes);
        if (layout.skipBytes > 0) claim += " after " + std::to_string(layout.skipBytes) + " skipped";
        throw FileError("the file has " + std::to_string(fileBytes) + " bytes, but " + claim, path,
                        "correct its layout", Remedy::CorrectRawLayout);
    }
    requireMemory(source.then, path, layout.dims, bytes, bytes);
    const Geometry geometry{layout.dims, layout.spacing, {0, 0, 0}};
    return Volume(geometry, readSamples(path, layout, static_cast<std::size_t>(values), job), source.missing);
}

} // namespace pellucid
