#include "base/growing_file.h"

#include <filesystem>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/file_watch.h"
#include "base/write_errors.h"

namespace pellucid {

namespace {

/// A new file is there only when its folder is on the disk, too.
void flushFolderOf(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const int descriptor = uninterrupted(
        [&] { return ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (descriptor < 0) return; // a folder that may be written and not read
    static_cast<void>(uninterrupted([&] { return ::fsync(descriptor); }));
    ::close(descriptor);
}

} // namespace

GrowingFile::GrowingFile(std::string path) : m_path(std::move(path)), m_descriptor(-1) {
    tellOfWriting(m_path);
    m_descriptor = uninterrupted([&] { return ::open(m_path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666); });
    if (m_descriptor < 0) throw cannotWrite(m_path, errno);
    const auto refuse = [&](const FileError& error) {
        ::close(m_descriptor);
        throw error;
    };
    if (uninterrupted([&] { return ::flock(m_descriptor, LOCK_EX | LOCK_NB); }) != 0 && errno == EWOULDBLOCK)
        refuse({"another window or program is writing this file", m_path, "close it first"});
    const off_t end = ::lseek(m_descriptor, 0, SEEK_END);
    if (end < 0) refuse(cannotWrite(m_path, errno));
    m_size = static_cast<std::uint64_t>(end);
    if (m_size == 0) flushFolderOf(m_path);
}

GrowingFile::~GrowingFile() { ::close(m_descriptor); }

void GrowingFile::cut(std::uint64_t size) {
    if (uninterrupted([&] { return ::ftruncate(m_descriptor, static_cast<off_t>(size)); }) != 0)
        throw cannotWrite(m_path, errno);
    m_size = size;
    flushToDisk(m_descriptor, m_path);
}

void GrowingFile::append(std::string_view text) {
    if (m_isTorn) cut(m_size);
    m_isTorn = true;
    try {
        writeAll(m_descriptor, text.data(), text.size(), m_path);
        flushToDisk(m_descriptor, m_path);
        m_isTorn = false;
    } catch (...) {
        m_isTorn = ::ftruncate(m_descriptor, static_cast<off_t>(m_size)) != 0;
        throw;
    }
    m_size += text.size();
}

} // namespace pellucid
