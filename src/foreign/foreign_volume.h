// A volume in files that a library reads: what pellucid-reader asks of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/job.h"
#include "volume/process/reader_messages.h"

namespace pellucid {

/// Called before a file of so many bytes is looked at.
using BeforeFile = std::function<void(std::uint64_t bytes)>;

/// Values that stand in a file as read() gives them, without gaps, but for the order of their bytes.
struct PlainValues {
    std::uint64_t start = 0; ///< bytes of the file
    bool bigEndian = false;
};

class ForeignVolume {
public:
    virtual ~ForeignVolume() = default;
    virtual FileContents contents() const = 0;
    virtual std::vector<std::string> files() const = 0;  ///< that hold its pixels
    virtual ReaderLayout layout(int step) const = 0;     ///< throws UsageError where there is no such step
    virtual std::uint64_t largestImageBytes() const = 0; ///< of what one of its files unpacks to
    /// Writes a box of a step as layout() says, which lies in its level. Throws FileError for a file that cannot be
    /// unpacked; Cancelled.
    virtual void read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
                      const JobControl& job) const = 0;
};

/// What `path` holds, as the program that has this linked can read it. `wanted`: a name among contents().arrays; empty:
/// what is largest. Throws Error.
std::unique_ptr<ForeignVolume> openForeign(const std::string& path, const std::string& wanted,
                                           const BeforeFile& before);

/// What has to be readable to open a path: the folder that its files are in.
std::string folderToRead(const std::string& path);
/// Copies the voxels of a box that lie in a slice: `slice` has `size` voxels of `bytesPerVoxel` bytes each. Returns
/// what of `to` is left.
std::span<std::byte> copyFromSlice(std::span<const std::byte> slice, const glm::ivec2& size, std::size_t bytesPerVoxel,
                                   const VoxelRegion& region, std::span<std::byte> to);
/// The bytes of numbers of `width` bytes in the other order.
void swapBytes(std::span<std::byte> bytes, std::size_t width);
/// Of a file; 0 where it is not there.
std::uint64_t bytesOfFile(const std::string& path);

} // namespace pellucid
