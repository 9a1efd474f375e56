// How much memory there is, asked before it is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "volume/grid.h"

namespace pellucid {

/// What is done with a volume once it has been read, and the memory that takes beside the volume itself.
struct MemoryUse {
    std::string doing; ///< "measuring"; empty: nothing
    double bytesPerVoxel = 0;
};

/// Beside the volume, per voxel: 2 for intensity codes, 2 for the same in the order of sweeps along x, 4 for the two
/// weights of saliency. Measuring and optimizing store nothing else.
inline constexpr double kMeasureBytesPerVoxel = 8;
/// 4 more for the visibility that is written.
inline constexpr double kFieldsBytesPerVoxel = 12;
/// The reference engine keeps intensities as doubles, and which are valid, in the place of codes: so much more.
inline constexpr double kMoreByReferenceBytesPerVoxel = 5;
/// To look at a volume takes its codes, and which are valid.
inline constexpr double kViewBytesPerVoxel = 3;

/// Memory that this process can still take without swapping or being stopped, bytes: the least of what the system calls
/// available (MemAvailable), what the process's control groups leave, and what its limit on address space leaves
/// (`ulimit -v`). The largest number where none of these is known, as outside Linux. Where setMemoryLimit() has been
/// called: what that leaves, and nothing else is asked.
std::uint64_t availableMemoryBytes();
/// The same, from a tree of files that looks like `root`/proc and `root`/sys, without the limit on address space.
std::uint64_t availableMemoryBytes(const std::filesystem::path& root);

/// What the whole process may use from now on, bytes (--memory); empty: what there is.
void setMemoryLimit(std::optional<std::uint64_t> bytes);

/// Throws FileError where `needed` bytes are not available: "`doing` needs … of memory, … are free, `where`, …".
void requireMemory(const std::string& doing, const std::string& where, std::uint64_t needed);
/// The same for a volume in memory, `use.bytesPerVoxel` per voxel.
void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims);
/// The same for a volume to be read: `reading` bytes at most while it is read, `kept` afterwards, when `use` begins.
void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, std::uint64_t reading,
                   std::uint64_t kept);

} // namespace pellucid
