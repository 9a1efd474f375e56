// Headerless data: the layout comes from the command line or the import dialog.
#include <algorithm>
#include <limits>

#include "volume/formats/reader.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

ValueType valueType(SampleType type) {
    constexpr ValueType kTypes[] = {ValueType::U8,  ValueType::I8,  ValueType::U16, ValueType::I16,
                                    ValueType::U32, ValueType::I32, ValueType::F32, ValueType::F64};
    return kTypes[static_cast<std::size_t>(type)];
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
        throw UsageError("headerless data has one component, number 0", path, "leave the component out",
                         Remedy::NoComponent);
    const std::uint64_t fileBytes = readableFileBytes(path);
    const int steps = rawSteps(source);
    if (steps == 1 && (layout.skipBytes > fileBytes || fileBytes - layout.skipBytes != bytes)) {
        std::string claim = dimsText(layout.dims) + " of " + name(layout.type) + " are " + std::to_string(bytes);
        if (layout.skipBytes > 0) claim += " after " + std::to_string(layout.skipBytes) + " skipped";
        throw FileError("the file has " + std::to_string(fileBytes) + " bytes, but " + claim, path,
                        "correct its layout", Remedy::CorrectRawLayout);
    }
    FileLayout file;
    file.dataPath = path;
    file.start = layout.skipBytes;
    file.type = valueType(layout.type);
    file.bigEndian = layout.bigEndian;
    file.axes = {{layout.dims.x}, {layout.dims.y}, {layout.dims.z}, {steps}};
    file.spacing = layout.spacing;
    return readSamples(source, file, job);
}

} // namespace pellucid
