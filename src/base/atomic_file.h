// Output files that are whole or absent: write beside the target, then rename. Input files that are texts.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// A file while it is being written. What write() has taken has reached the system, or FileError was thrown: a full
/// disk is told at once.
class OutputFile {
public:
    void write(const void* data, std::size_t bytes);
    void write(std::string_view text) { write(text.data(), text.size()); }

    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

private:
    friend void writeAtomically(const std::string& path, const std::function<void(OutputFile&)>& write);
    friend class OutputFolder;
    OutputFile(int descriptor, std::string path) : m_descriptor(descriptor), m_path(std::move(path)) {}
    ~OutputFile();
    void close(bool flushToDisk);

    int m_descriptor; ///< −1: closed
    std::string m_path;
};

/// Calls write() with a new file in the folder of `path`, brings its bytes to the disk, and renames it to `path`. On
/// any exception the new file is removed, what was at `path` stays as it was, and the exception goes on. Throws
/// FileError where the folder is missing, where anything cannot be written, and for a file that is write-protected. A
/// file that is replaced hands on its permissions. A symbolic link is followed; a device or pipe is written directly.
void writeAtomically(const std::string& path, const std::function<void(OutputFile&)>& write);
void writeBytesAtomically(const std::string& path, std::span<const unsigned char> bytes);
void writeTextAtomically(const std::string& path, std::string_view text);

/// A folder while it is being written. Several threads may write different files of it.
class OutputFolder {
public:
    /// `name`: a path in the folder, whose folders are made. Throws FileError.
    void write(const std::string& name, std::string_view bytes);

private:
    friend void writeFolderAtomically(const std::string& path,
                                      const std::function<bool(const std::string&)>& mayReplace,
                                      const std::function<void(OutputFolder&)>& write);
    std::string m_temporary, m_path;
};

/// writeAtomically() for a folder. Throws FileError, too, where something has this name already, unless it is a folder
/// of which `mayReplace` says that it may go: all that is in it is lost then, once the new one is whole.
void writeFolderAtomically(const std::string& path, const std::function<bool(const std::string&)>& mayReplace,
                           const std::function<void(OutputFolder&)>& write);

/// Of several processes that do the same one keeps what they write; the others make sure that it could be written, and
/// throw their bytes away. At first a process keeps it.
void keepWrittenFiles(bool keep);

/// Where a link leads, so that it stays a link; what it leads to need not exist.
std::filesystem::path behindLinks(std::filesystem::path path);

/// Throws FileError, as far as that can be told beforehand, where writeAtomically() would.
void requireWritable(const std::string& path);

/// The text in a file or pipe. Throws FileError, also where it has more than `mostBytes`: some devices never end.
std::string readText(const std::string& path, std::size_t mostBytes = std::size_t{1} << 24);

/// Removes the temporary files of the writeAtomically() calls in progress, for a process that is about to end without
/// unwinding (Ctrl-C inside a library). Callable from any thread.
void removeUnfinishedFiles() noexcept;

} // namespace pellucid
