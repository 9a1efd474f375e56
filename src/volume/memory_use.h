// What is done with a volume once it is there, and the memory that this takes.
#pragma once

#include <cstdint>
#include <string>

#include "volume/grid.h"

namespace pellucid {

/// What is done with a volume once it has been read, and the memory that takes beside the volume itself.
struct MemoryUse {
    std::string doing; ///< "measuring"; empty: nothing
    double bytesPerVoxel = 0;
};

/// Throws FileError where a volume in memory leaves no room for `use`: "`doing` NX x NY x NZ voxels needs …".
void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims);
/// The same for a volume to be read: `reading` bytes at most while it is read, `kept` afterwards, when `use` begins.
void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, std::uint64_t reading,
                   std::uint64_t kept);

} // namespace pellucid
