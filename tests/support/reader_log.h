// A program that reads foreign formats, and what it says on the way.
#pragma once

#include <filesystem>
#include <string>

#include "support/temp_folder.h"
#include "volume/process/reader_process.h"

namespace pellucid::test {

/// While it is there, volumes are read by `program`, one of those beside this one.
class ReaderLog {
public:
    ReaderLog(const TempFolder& folder, const std::string& program) : m_folder(folder) {
        namespace fs = std::filesystem;
        const std::string reader = (fs::read_symlink("/proc/self/exe").parent_path() / program).string();
        // Each line is kept before it is passed on.
        const std::string path = folder.write(
            "reader.sh", "#!/bin/sh\n'" + reader + "' | while IFS= read -r line; do printf '%s\\n' \"$line\" >>'" +
                             folder.path("said") + "'; printf '%s\\n' \"$line\"; done\n");
        fs::permissions(path, fs::perms::owner_all);
        setReaderProgram(path);
    }
    ~ReaderLog() { setReaderProgram({}); }
    ReaderLog(const ReaderLog&) = delete;
    ReaderLog& operator=(const ReaderLog&) = delete;

    void clear() const { std::filesystem::remove(m_folder.path("said")); }
    /// Whether it has said where the values are, so that nobody asks it for them.
    bool namesPlaces() const { return m_folder.read("said").find("\"in_file\"") != std::string::npos; }

private:
    const TempFolder& m_folder;
};

} // namespace pellucid::test
