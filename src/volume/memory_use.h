// What is done with a volume once it is there, and the memory that this takes.
#pragma once

#include <cstdint>
#include <string>

#include "volume/volume.h"

namespace pellucid {

/// What is done with a volume once it has been read, and the memory that takes beside the volume itself.
struct MemoryUse {
    std::string doing; ///< "measuring"; empty: nothing
    double bytesPerVoxel = 0;
    double leanBytesPerVoxel = 0; ///< the same of volumes that isLean(); at most bytesPerVoxel
    int reach = 0; ///< voxels along each axis, around each voxel, that it looks at; what ranks keep around their blocks
};

/// Large volumes of few different values are worked on in less memory: kLeanVoxels or more, of 8-bit samples.
inline constexpr std::size_t kLeanVoxels = std::size_t{3} << 27; // three times 512³
bool isLean(const Int3& dims, SampleType type);

/// Bytes that `use` of a volume takes.
std::uint64_t bytesOf(const MemoryUse& use, const Int3& dims, SampleType type);

/// Of the part of a volume that is in this process, which is as lean as the whole.
MemoryUse ofPartHere(MemoryUse use, const Volume& volume);

/// Throws FileError where a volume in memory leaves no room for `use`: "`doing` NX x NY x NZ voxels needs …".
void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, SampleType type);
/// The same for a volume to be read: `reading` bytes at most while it is read, `kept` afterwards, when `use` begins.
void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, SampleType type,
                   std::uint64_t reading, std::uint64_t kept);

} // namespace pellucid
