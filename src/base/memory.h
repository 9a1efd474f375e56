// How much memory there is, asked before it is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace pellucid {

/// Memory that this process can still take without swapping or being stopped, bytes: the least of what the system calls
/// available (MemAvailable), what the process's control groups leave, and what its limit on address space leaves
/// (`ulimit -v`). The largest number where none of these is known, as outside Linux. Where setMemoryLimit() has been
/// called: what that leaves, and nothing else is asked.
std::uint64_t availableMemoryBytes();
/// The same, from a tree of files that looks like `root`/proc and `root`/sys, without the limit on address space.
std::uint64_t availableMemoryBytes(const std::filesystem::path& root);

/// Memory that this process has taken, files that it has mapped left out, bytes; 0 where that is not known, as outside
/// Linux.
std::uint64_t usedMemoryBytes();

/// What the whole process may use from now on, bytes, files that it has mapped left out; empty: what there is.
void setMemoryLimit(std::optional<std::uint64_t> bytes);

/// Throws FileError where `needed` bytes are not available: "`doing` needs … of memory, … are free, `where`, …".
void requireMemory(const std::string& doing, const std::string& where, std::uint64_t needed);

} // namespace pellucid
