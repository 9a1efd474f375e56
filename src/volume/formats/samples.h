// From what a header says to a volume: the part that all formats share. No format library takes part, so that our own
// code checks each byte of a file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "volume/excerpt.h"
#include "volume/file_contents.h"
#include "volume/formats/file_check.h"
#include "volume/loader.h"
#include "volume/step_times.h"

namespace pellucid {

/// One number in a file.
enum class ValueType { U8, I8, U16, I16, U32, I32, U64, I64, F32, F64 };
std::uint64_t bytesPerValue(ValueType type);
/// Calls use(T{}) with the type that a value has in the file.
template <class Use>
auto withType(ValueType type, const Use& use) {
    using Value = std::variant<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                               std::uint64_t, std::int64_t, float, double>;
    static constexpr Value kZeros[] = {std::uint8_t{},  std::int8_t{},  std::uint16_t{}, std::int16_t{},
                                       std::uint32_t{}, std::int32_t{}, std::uint64_t{}, std::int64_t{},
                                       float{},         double{}};
    return std::visit(use, kZeros[static_cast<std::size_t>(type)]);
}

/// One axis of a file's array.
struct FileAxis {
    std::int64_t size = 1;
    bool components = false; ///< along it lie the components of a voxel, not places or times; one axis at most
    bool time = false;       ///< along it lie time steps, as along every axis behind the third in space
};

/// value = slope · stored + intercept, both finite.
struct ValueScaling {
    double slope = 1, intercept = 0;
    bool operator==(const ValueScaling&) const = default;
};

class InflateIndex;

/// Bytes of unpacked data that are found sound, or not, when they are read.
struct UncheckedBytes {
    std::uint64_t bytes = 0; ///< as many from the first one on, > 0
    bool toEnd = false;      ///< they are all that there is: headerless files
};

/// Where values are, and how they are stored.
struct StoredValues {
    std::string dataPath; ///< the file that holds them
    Encoding encoding = Encoding::Raw;
    bool zlib = false;       ///< Deflate: a zlib stream may stand there, too
    std::uint64_t start = 0; ///< the encoded data begin here, bytes of the file
    std::uint64_t skip = 0;  ///< the first value begins here, bytes of the decoded data (Deflate, Bzip2)
    ValueType type = ValueType::U8;
    bool bigEndian = false; ///< no matter for Text
    /// Where given: the bytes of the values, in place of `encoding`, `start` and `skip` (raw to those who ask).
    std::function<std::unique_ptr<ByteSource>(const JobControl&)> open;
    std::shared_ptr<InflateIndex> index;     ///< of Deflate with several steps: where to read on
    std::optional<UncheckedBytes> unchecked; ///< Deflate without index, Bzip2; empty: they have been checked
};

/// A box of a volume that is stored by itself: x fastest, all components of a voxel beside each other.
struct FilePiece {
    VoxelRegion region;  ///< the voxels of the volume that are taken from it, all of which it has
    Int3 first{0, 0, 0}; ///< the voxel of the volume that its values begin with; may lie outside
    Int3 dims{1, 1, 1};  ///< voxels that it has
    StoredValues values;
};

/// What a header says.
struct FileLayout : StoredValues {
    std::vector<FileAxis> axes;      ///< fastest first; 1 to 17
    std::vector<int> componentOrder; ///< component n is entry componentOrder[n] of its axis; empty: entry n
    Vec3 spacing{1, 1, 1}, origin{0, 0, 0};
    Mat3 directions{1}; ///< unit columns: where the axes of the grid point
    WorldAxes worldAxes = WorldAxes::File;
    LengthUnit lengthUnit = LengthUnit::Unknown; ///< of spacing and origin
    std::optional<ValueScaling> scaling;
    std::optional<StepTimes> times; ///< of steps along one axis
    /// Where given: the values are in these, one after the other, as many in each.
    std::vector<StoredValues> parts;
    /// Where given: the values are in these, which together have all voxels that are asked for; of a voxel that several
    /// have, the last one's. They have the type of the layout; its axes are one of components, or none, and x, y, z.
    std::vector<FilePiece> pieces;
    /// Where given: what is taken of these values, its region in voxels of this layout, as has been settled. Its
    /// excerpt tells which part of which data that is.
    std::optional<ExcerptPlan> plan;
    std::string array;               ///< name of the array that this is, where the file names its arrays
    std::vector<std::string> arrays; ///< of these, all names
    std::vector<std::string> notices;
};

/// The unit vector of a direction in a header. Within 1e-6 of an axis of the world it is that axis, since headers round
/// their numbers. Zero, and so refused later, where it is not a direction.
Vec3 cleanDirection(const Vec3& direction);

/// Number of values along all axes together, which fits into 2^63 bytes. Throws FileError at `path`.
std::uint64_t valuesIn(const FileLayout& layout, const std::string& path);

/// How many values have to be gone through to read `step`: those of all steps up to it where steps follow each other,
/// otherwise all.
std::uint64_t valuesUpTo(const FileLayout& layout, int step);

/// Throws FileError unless the data file holds `wanted` values, `stored` bytes of it beginning at layout.start. Numbers
/// written out are read without keeping them. Compressed data are left to be checked as they are read
/// (layout.unchecked), unless the header claims much more memory than there is reason to believe; where they have
/// several steps, layout.index is made, and no byte is checked twice as long as the file stays the same. Bytes left
/// over become a notice. `toDo` advises what to check.
void requireData(FileLayout& layout, std::uint64_t stored, std::uint64_t wanted, const char* toDo,
                 const JobControl& job);

/// The unpacked bytes of `stored`, which is Deflate or Bzip2, from its beginning. `job` must outlive them.
std::unique_ptr<UnpackedBytes> unpackedBytes(const StoredValues& stored, const JobControl& job);

/// What the layout says that can be chosen of.
FileContents contentsOf(const FileLayout& layout);

/// Volumes of this many bytes or more are mapped (MappedFile) rather than read, where the file has all their samples as
/// memory would: raw, in this machine's byte order, unscaled. Smaller files are read, so that they may change while
/// they are in use; so are regions, which then lie in large pages of memory.
inline constexpr std::uint64_t kMapBytes = 16u << 20;

/// Reads component source.component of time step source.step, after requireData(); what is still wrong is a FileError.
/// Throws UsageError for a component, a step or an array that is not there.
Volume readSamples(const VolumeSource& source, const FileLayout& layout, const JobControl& job);

} // namespace pellucid
