// Output files that are whole or absent: write beside the target, then rename.
#pragma once

#include <functional>
#include <string>

namespace pellucid {

/// Calls write(temporaryPath), a path in the same folder with the same suffix, then renames it to `path`. On any
/// exception the temporary file is removed and the exception goes on. Throws FileError where the folder is missing or
/// not writable. A symbolic link is followed; a device or pipe is written directly.
void writeAtomically(const std::string& path, const std::function<void(const std::string& temporaryPath)>& write);
void writeTextAtomically(const std::string& path, const std::string& text);
std::string readText(const std::string& path); ///< throws FileError

/// Removes the temporary files of the writeAtomically() calls in progress, for a process that is about to end without
/// unwinding (Ctrl-C inside a library). Callable from any thread.
void removeUnfinishedFiles() noexcept;

} // namespace pellucid
