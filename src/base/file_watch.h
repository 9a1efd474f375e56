// Who reads and writes which files, for a program that must not write over what it reads.
#pragma once

#include <functional>
#include <string>

namespace pellucid {

/// Called with a name as it was given, from any thread, before that file is opened. What they throw goes on to whoever
/// wanted to read or write.
struct FileWatch {
    std::function<void(const std::string&path)> beforeReading, beforeWriting;
};

/// In the place of whoever watched before; a program calls it once, before it has threads. Nobody watches at first.
void watchFiles(FileWatch watch);

/// For those who open a file: readText(), writeAtomically() and readableFileBytes() do, so that their callers need not.
void tellOfReading(const std::string& path);
void tellOfWriting(const std::string& path);

} // namespace pellucid
