// A part of a file as memory, without reading it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace pellucid {

/// Bytes of a file, read-only. The system reads pages when they are first looked at, and lets go of them when memory is
/// wanted elsewhere: a mapping takes address space, no memory.
///
/// The file stays the same file when its name is removed or given to another. What another program writes *into* it may
/// be seen here or not. Where it is cut short meanwhile the missing pages cannot be read: the process ends by SIGBUS,
/// after a line on standard error that names the file.
class MappedFile {
public:
    /// Bytes of zeros, at least, that may be read behind the last one.
    static constexpr std::size_t kPadding = 64;

    /// `bytes` > 0 from byte `start` on. Null where the file has fewer, or where the system maps no files or refuses:
    /// read it then.
    static std::shared_ptr<const MappedFile> map(const std::string& path, std::uint64_t start, std::uint64_t bytes);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    const unsigned char* data() const noexcept { return m_data; }
    std::size_t size() const noexcept { return m_size; }

private:
    MappedFile() = default;
    void* m_region = nullptr;
    std::size_t m_regionBytes = 0, m_size = 0;
    const unsigned char* m_data = nullptr;
};

} // namespace pellucid
