// Headerless data: the layout comes from the command line or the import dialog.
#include <algorithm>
#include <limits>

#include "volume/formats/file_check.h"
#include "volume/formats/reader.h"
#include "volume/formats/samples.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

ValueType valueType(SampleType type) {
    switch (type) {
    case SampleType::U8:
        return ValueType::U8;
    case SampleType::I8:
        return ValueType::I8;
    case SampleType::U16:
        return ValueType::U16;
    case SampleType::I16:
        return ValueType::I16;
    case SampleType::U32:
        return ValueType::U32;
    case SampleType::I32:
        return ValueType::I32;
    case SampleType::F32:
        return ValueType::F32;
    case SampleType::F64:
        return ValueType::F64;
    }
    PELLUCID_CHECK(false);
}

/// Bytes of one step, by a layout that makes sense. Throws UsageError, FileError.
std::uint64_t stepBytes(const VolumeSource& source) {
    const std::string& path = source.path;
    const RawLayout& layout = *source.raw;
    if (layout.dims.x < 1 || layout.dims.y < 1 || layout.dims.z < 1)
        throw UsageError("a volume has at least one voxel along each axis", path, "correct the layout",
                         Remedy::CorrectRawLayout);
    if (const std::string wrong = geometryProblem(layout.spacing, Vec3(0)); !wrong.empty())
        throw UsageError(wrong, path, "correct it", Remedy::GiveSpacing);
    const std::int64_t sizes[] = {layout.dims.x, layout.dims.y, layout.dims.z};
    const std::uint64_t bytesPer = bytesPerSample(layout.type);
    return valueCount(path, sizes, bytesPer) * bytesPer;
}

} // namespace

int rawSteps(const VolumeSource& source) {
    const std::uint64_t bytes = stepBytes(source), skip = source.raw->skipBytes;
    if (!source.frames) return 1;
    const std::uint64_t fileBytes = readableFileBytes(source.path);
    if (skip >= fileBytes || (fileBytes - skip) % bytes != 0) return 1;
    return static_cast<int>(std::min<std::uint64_t>((fileBytes - skip) / bytes, std::numeric_limits<int>::max()));
}

Volume readRaw(const VolumeSource& source, const JobControl& job) {
    const std::string& path = source.path;
    const RawLayout& layout = *source.raw;
    const std::uint64_t bytes = stepBytes(source);
    if (source.component != 0)
        throw UsageError("headerless data has one component, number 0", path, "ask for none", Remedy::NoComponent);
    const std::uint64_t fileBytes = readableFileBytes(path);
    const std::int64_t sizes[] = {layout.dims.x, layout.dims.y, layout.dims.z};
    const int steps = rawSteps(source);
    if (steps == 1 && (layout.skipBytes > fileBytes || fileBytes - layout.skipBytes != bytes)) {
        std::string claim = std::to_string(sizes[0]) + " x " + std::to_string(sizes[1]) + " x " +
                            std::to_string(sizes[2]) + " of " + name(layout.type) + " are " + std::to_string(bytes);
        if (layout.skipBytes > 0) claim += " after " + std::to_string(layout.skipBytes) + " skipped";
        throw FileError("the file has " + std::to_string(fileBytes) + " bytes, but " + claim, path,
                        "correct its layout", Remedy::CorrectRawLayout);
    }
    FileLayout file;
    file.dataPath = path;
    file.start = layout.skipBytes;
    file.type = valueType(layout.type);
    file.bigEndian = layout.bigEndian;
    for (const std::int64_t size : sizes) file.axes.push_back({size});
    if (steps > 1) file.axes.push_back({steps});
    file.spacing = layout.spacing;
    return readSamples(source, file, job);
}

} // namespace pellucid
