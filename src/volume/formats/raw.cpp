// Headerless data: the layout comes from the command line or the import dialog.
#include <algorithm>
#include <limits>
#include <memory>

#include "volume/formats/content.h"
#include "volume/formats/deflate_at_once.h"
#include "volume/formats/file_check.h"
#include "volume/formats/inflate_index.h"
#include "volume/formats/reader.h"

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
    const std::int64_t sizes[] = {layout.dims.x, layout.dims.y, layout.dims.z};
    const std::uint64_t bytesPer = bytesPerSample(layout.type);
    return valueCount(path, sizes, bytesPer) * bytesPer;
}

/// The steps that `there` bytes hold, as the layout and source.frames allow; 0: other than whole ones.
int stepsIn(const VolumeSource& source, std::uint64_t there) {
    const std::uint64_t bytes = stepBytes(source), skip = source.raw->skipBytes;
    if (skip >= there || (there - skip) % bytes != 0) return 0;
    const std::uint64_t steps = (there - skip) / bytes;
    if (steps > 1 && !source.frames) return 0;
    return static_cast<int>(std::min<std::uint64_t>(steps, std::numeric_limits<int>::max()));
}

/// The bytes that are laid out: those of the file, or where these are not just one step and it is gzip, what it unpacks
/// to. Packed bytes may happen to be a multiple of a step: then they would be read as several, all of them wrong.
struct RawBytes {
    std::uint64_t stored = 0, count = 0;
    bool isPacked = false;
    std::shared_ptr<InflateIndex>
        index; ///< of gzip that has been unpacked; empty where its end says that it is one step
};

RawBytes rawBytes(const VolumeSource& source, const JobControl& job) {
    RawBytes bytes;
    bytes.stored = bytes.count = readableFileBytes(source.path);
    bytes.isPacked = stepsIn(source, bytes.stored) != 1 && isGzip(source.path);
    if (!bytes.isPacked) return bytes;
    const std::uint64_t step = source.raw->skipBytes + stepBytes(source);
    if (!source.frames && step <= kMostAtOnce && lengthAtEnd(source.path) == step) {
        bytes.count = step;
        return bytes;
    }
    bytes.index = InflateIndex::of(source.path, 0, false);
    bytes.count = bytes.index->requireWhole(job);
    return bytes;
}

} // namespace

int rawSteps(const VolumeSource& source, const JobControl& job) {
    stepBytes(source); // which checks the layout
    return source.frames ? std::max(1, stepsIn(source, rawBytes(source, job).count)) : 1;
}

Volume readRaw(const VolumeSource& source, const JobControl& job) {
    const std::string& path = source.path;
    const RawLayout& layout = *source.raw;
    const std::uint64_t bytes = stepBytes(source);
    if (source.component != 0)
        throw UsageError("headerless data has one component, number 0", path, "leave the component out",
                         Remedy::NoComponent);
    const RawBytes there = rawBytes(source, job);
    const int steps = stepsIn(source, there.count);
    if (steps == 0) {
        std::string claim = dimsText(layout.dims) + " of " + name(layout.type) + " are " + std::to_string(bytes);
        if (layout.skipBytes > 0) claim += " after " + std::to_string(layout.skipBytes) + " skipped";
        const std::string unpacked = there.isPacked ? " that unpack to " + std::to_string(there.count) : std::string();
        throw FileError("the file has " + std::to_string(there.stored) + " bytes" + unpacked + ", but " + claim, path,
                        "correct its layout", Remedy::CorrectRawLayout);
    }
    FileLayout file;
    file.dataPath = path;
    file.encoding = there.isPacked ? Encoding::Deflate : Encoding::Raw;
    file.index = there.index;
    if (there.isPacked && !there.index) file.unchecked = UncheckedBytes{there.count, true};
    (there.isPacked ? file.skip : file.start) = layout.skipBytes;
    file.type = valueType(layout.type);
    file.bigEndian = layout.bigEndian;
    file.axes = {{layout.dims.x}, {layout.dims.y}, {layout.dims.z}, {steps}};
    return readSamples(source, file, job);
}

} // namespace pellucid
