// A file that grows by a piece at a time, each of which is on the disk before the next thing happens.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pellucid {

/// Open for appending; no other GrowingFile, of this process or another, has the same file meanwhile.
class GrowingFile {
public:
    /// Opens the file, or makes it in a folder that is there. Throws FileError, also where another has it.
    explicit GrowingFile(std::string path);
    ~GrowingFile();
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    const std::string& path() const { return m_path; }
    std::uint64_t size() const { return m_size; } ///< bytes that are in it
    /// Takes away what lies behind the first `size` bytes. Throws FileError.
    void cut(std::uint64_t size);
    /// Returns when `text` is on the disk. Throws FileError where it is not: then the file is as it was before, as far
    /// as the system lets it.
    void append(std::string_view text);

private:
    std::string m_path;
    int m_descriptor;
    std::uint64_t m_size = 0; ///< of whole pieces
    bool m_isTorn = false;    ///< a piece of which a part may lie behind them, to be cut before the next
};

} // namespace pellucid
