// What the system says where a file cannot be written, for those in this folder who write files.
#pragma once

#include <cerrno>
#include <string>

#include "base/error.h"

namespace pellucid {

/// Calls a function of the system again where a signal came between.
template <class Call>
auto uninterrupted(const Call& call) {
    for (;;)
        if (const auto result = call(); result >= 0 || errno != EINTR) return result;
}

/// `error`: errno.
FileError cannotWrite(const std::string& path, int error);

/// Writes all of it. Throws FileError.
void writeAll(int descriptor, const void* data, std::size_t bytes, const std::string& path);
/// Brings what was written to the disk: some file systems take every byte and tell only here that there was no room.
/// Throws FileError.
void flushToDisk(int descriptor, const std::string& path);

} // namespace pellucid
