#include "base/atomic_file.h"

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file_watch.h"
#include "base/joint_file.h"
#include "base/text.h"
#include "base/write_errors.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::mutex g_mutex;

/// Never freed: removeUnfinishedFiles() may be called while the process is ending.
std::set<std::string>& unfinished() {
    static auto* const g_paths = new std::set<std::string>;
    return *g_paths;
}

/// Holds a temporary file's name in the list while it is being written.
class Unfinished {
public:
    explicit Unfinished(std::string path) : m_path(std::move(path)) {
        const std::lock_guard lock(g_mutex);
        unfinished().insert(m_path);
    }
    ~Unfinished() {
        const std::lock_guard lock(g_mutex);
        unfinished().erase(m_path);
    }
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

private:
    std::string m_path;
};

fs::path folderOf(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

/// What status() says of `path`; throws where the system cannot tell, as for a name that is too long.
fs::file_type typeOf(const std::string& path) {
    std::error_code ec;
    const fs::file_type type = fs::status(path, ec).type();
    if (type == fs::file_type::none) throw cannotWrite(path, ec.value());
    return type;
}

/// Devices and pipes (/dev/null, /dev/stdout) cannot be replaced by a file; they take the bytes as they come.
bool isWrittenDirectly(fs::file_type type) {
    return type != fs::file_type::not_found && type != fs::file_type::regular;
}

} // namespace

std::filesystem::path behindLinks(std::filesystem::path path) {
    std::error_code ec;
    for (int links = 0; links < 40 && fs::is_symlink(path, ec); ++links)
        path = path.parent_path() / fs::read_symlink(path, ec); // an absolute one replaces all before it
    return path;
}

FileError cannotWrite(const std::string& path, int error) {
    const std::string what = "cannot write the file (" + std::generic_category().message(error) + ")";
    if (error == ENOSPC || error == EDQUOT) return {what, path, "make room, or choose another place"};
    if (error == EFBIG) return {what, path, "raise the limit on file sizes, or choose another place"};
    if (error == ENAMETOOLONG) return {what, path, "choose a shorter name"};
    return {what, path, "check permissions and space"};
}

void writeAll(int descriptor, const void* data, std::size_t bytes, const std::string& path) {
    const char* from = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = uninterrupted([&] { return ::write(descriptor, from, bytes); });
        if (written < 0) throw cannotWrite(path, errno);
        from += written;
        bytes -= static_cast<std::size_t>(written);
    }
}

void flushToDisk(int descriptor, const std::string& path) {
    if (uninterrupted([&] { return fsync(descriptor); }) != 0 && errno != EINVAL && errno != ENOSYS)
        throw cannotWrite(path, errno);
}

OutputFile::~OutputFile() {
    if (m_descriptor >= 0) ::close(m_descriptor);
}

void OutputFile::write(const void* data, std::size_t bytes) { writeAll(m_descriptor, data, bytes, m_path); }

void OutputFile::close(bool flush) {
    if (flush) flushToDisk(m_descriptor, m_path);
    if (::close(std::exchange(m_descriptor, -1)) != 0 && errno != EINTR) throw cannotWrite(m_path, errno);
}

void requireWritable(const std::string& path) {
    const fs::file_type type = typeOf(path);
    if (type == fs::file_type::directory) throw FileError("a folder has this name", path, "choose another name");
    if (fs::path(path).filename().empty()) throw FileError("this names a folder", path, "name a file in it");
    if (type != fs::file_type::not_found && access(path.c_str(), W_OK) != 0)
        throw FileError("the file is write-protected", path, "choose another name or change its permissions");
    if (isWrittenDirectly(type)) return;
    const fs::path target = behindLinks(path), folder = folderOf(target);
    std::error_code ec;
    if (const fs::file_type place = typeOf(folder.string());
        place != fs::file_type::directory && place != fs::file_type::not_found)
        throw FileError("this is a file, not a folder", folder.string(), "choose another folder");
    if (!fs::is_directory(folder, ec)) throw FileError("the folder does not exist", folder.string(), "create it first");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        throw FileError("the folder is not writable", folder.string(),
                        "choose another folder or change its permissions");
}

namespace {
std::atomic<bool> g_keeps = true;
}

void keepWrittenFiles(bool keep) { g_keeps = keep; }

namespace {

/// Names for new files in the folder of `target`: another one each time.
std::string temporaryBeside(const fs::path& target) {
    static std::atomic<unsigned> s_count = 0; // two threads may write the same file; the last one wins, whole
    return (folderOf(target) / (".pellucid-" + std::to_string(getpid()) + "-" + std::to_string(s_count++) + ".part"))
        .string();
}

/// A file that is replaced hands on its permissions.
void takePermissions(int descriptor, const fs::path& target) {
    struct stat old {};
    if (stat(target.c_str(), &old) == 0) static_cast<void>(fchmod(descriptor, old.st_mode & 0777));
}

} // namespace

void writeAtomically(const std::string& path, const std::function<void(OutputFile&)>& write) {
    requireWritable(path);
    tellOfWriting(path);
    if (!g_keeps || isWrittenDirectly(typeOf(path))) {
        const char* const where = g_keeps ? path.c_str() : "/dev/null";
        OutputFile file(uninterrupted([&] { return open(where, O_WRONLY | O_CLOEXEC); }), path);
        if (file.m_descriptor < 0) throw cannotWrite(path, errno);
        write(file);
        return file.close(false);
    }
    const fs::path target = behindLinks(path);
    for (;;) {
        const std::string temporary = temporaryBeside(target);
        const Unfinished entry(temporary);
        const int descriptor =
            uninterrupted([&] { return open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
        if (descriptor < 0 && errno == EEXIST) continue; // left by a process of this number that was killed
        OutputFile file(descriptor, path);
        if (descriptor < 0) throw cannotWrite(path, errno);
        try {
            takePermissions(descriptor, target);
            write(file);
            file.close(true);
            if (std::rename(temporary.c_str(), target.c_str()) != 0) throw cannotWrite(path, errno);
        } catch (...) {
            ::unlink(temporary.c_str());
            throw;
        }
        return;
    }
}

void OutputFolder::write(const std::string& name, std::string_view bytes) {
    const fs::path file = fs::path(m_temporary) / name;
    std::error_code ec;
    fs::create_directories(file.parent_path(), ec);
    if (ec) throw cannotWrite(m_path, ec.value());
    OutputFile out(uninterrupted([&] { return open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }),
                   m_path);
    if (out.m_descriptor < 0) throw cannotWrite(m_path, errno);
    out.write(bytes);
    out.close(false);
}

namespace {

/// Gives a whole folder its name; one that has it is removed. 0, or what went wrong.
int putInPlace(const std::string& folder, const std::string& target, bool replaces) {
    if (!replaces) return std::rename(folder.c_str(), target.c_str()) == 0 ? 0 : errno;
    std::string old = folder;
#ifdef RENAME_EXCHANGE
    const bool areExchanged = renameat2(AT_FDCWD, folder.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0;
#else
    const bool areExchanged = false;
#endif
    if (!areExchanged) { // not every file system does that
        old = temporaryBeside(target);
        if (std::rename(target.c_str(), old.c_str()) != 0) return errno;
        if (std::rename(folder.c_str(), target.c_str()) != 0) {
            const int error = errno;
            static_cast<void>(std::rename(old.c_str(), target.c_str()));
            return error;
        }
    }
    std::error_code ec;
    fs::remove_all(old, ec);
    return 0;
}

} // namespace

void writeFolderAtomically(const std::string& path, const std::function<bool(const std::string&)>& mayReplace,
                           const std::function<void(OutputFolder&)>& write) {
    fs::path target = path;
    if (target.filename().empty()) target = target.parent_path(); // "name/"
    target = behindLinks(target);
    const bool replaces = typeOf(target.string()) == fs::file_type::directory && mayReplace(target.string());
    if (!replaces) {
        requireWritable(target.string());
        if (typeOf(target.string()) != fs::file_type::not_found)
            throw FileError("a file has this name", target.string(), "choose another name");
    } else if (access(folderOf(target).c_str(), W_OK | X_OK) != 0) {
        throw FileError("the folder is not writable", folderOf(target).string(),
                        "choose another folder or change its permissions");
    }
    tellOfWriting(target.string());
    OutputFolder folder;
    folder.m_path = target.string();
    std::optional<Unfinished> entry;
    for (bool isNew = false; !isNew;) { // one of this name was left by a process of this number that was killed
        folder.m_temporary = temporaryBeside(target);
        entry.emplace(folder.m_temporary);
        std::error_code ec;
        isNew = fs::create_directory(folder.m_temporary, ec);
        if (ec) throw cannotWrite(folder.m_path, ec.value());
    }
    try {
        write(folder);
        // All of it is on the disk before it has its name.
        const int descriptor = uninterrupted([&] { return open(folder.m_temporary.c_str(), O_RDONLY | O_CLOEXEC); });
        const int failure = descriptor < 0 || syncfs(descriptor) != 0 ? errno : 0;
        if (descriptor >= 0) ::close(descriptor);
        if (failure != 0) throw cannotWrite(folder.m_path, failure);
        if (!g_keeps) return static_cast<void>(fs::remove_all(folder.m_temporary));
        if (const int error = putInPlace(folder.m_temporary, target.string(), replaces); error != 0)
            throw cannotWrite(folder.m_path, error);
    } catch (...) {
        std::error_code ec;
        fs::remove_all(folder.m_temporary, ec);
        throw;
    }
}

JointFile::~JointFile() {
    if (m_descriptor >= 0) ::close(m_descriptor);
}

void JointFile::writeAt(std::uint64_t offset, const void* data, std::size_t bytes) {
    const char* from = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written =
            uninterrupted([&] { return pwrite(m_descriptor, from, bytes, static_cast<off_t>(offset)); });
        if (written < 0) throw cannotWrite(m_path, errno);
        from += written;
        offset += static_cast<std::uint64_t>(written);
        bytes -= static_cast<std::size_t>(written);
    }
}

void writeJointly(const std::string& path, std::uint64_t bytes, const GatherBytes& gather,
                  const std::function<void(JointFile&)>& write) {
    requireWritable(path);
    tellOfWriting(path);
    if (isWrittenDirectly(typeOf(path)))
        throw FileError("several processes cannot write this together", path, "name a file");
    const fs::path target = behindLinks(path);
    const bool makes = g_keeps;
    JointFile file(path);
    std::string temporary;
    std::optional<Unfinished> entry; // where there is a file to remove
    try {
        if (makes) {
            do { // one of this name was left by a process that was killed, or is another machine's
                temporary = temporaryBeside(target);
                file.m_descriptor = uninterrupted(
                    [&] { return open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
            } while (file.m_descriptor < 0 && errno == EEXIST);
            if (file.m_descriptor < 0) throw cannotWrite(path, errno);
            entry.emplace(temporary);
            takePermissions(file.m_descriptor, target);
            // That there is no room is known before any process writes, where the disk can tell.
            if (const int error =
                    posix_fallocate(file.m_descriptor, 0, static_cast<off_t>(std::max<std::uint64_t>(1, bytes)));
                error != 0 && error != EOPNOTSUPP && error != EINVAL)
                throw cannotWrite(path, error);
            if (ftruncate(file.m_descriptor, static_cast<off_t>(bytes)) != 0) throw cannotWrite(path, errno);
        }
        for (const auto& name : gather(std::as_bytes(std::span(temporary))))
            if (!makes && !name.empty()) temporary.assign(reinterpret_cast<const char*>(name.data()), name.size());
        if (!makes) {
            file.m_descriptor = uninterrupted([&] { return open(temporary.c_str(), O_WRONLY | O_CLOEXEC); });
            if (file.m_descriptor < 0)
                throw FileError("this process cannot write the file that another one has made (" +
                                    std::generic_category().message(errno) + ")",
                                path, "name a folder that all processes see");
        }
        write(file);
        flushToDisk(file.m_descriptor, path);
        if (::close(std::exchange(file.m_descriptor, -1)) != 0 && errno != EINTR) throw cannotWrite(path, errno);
        gather({}); // all are done
        if (makes && std::rename(temporary.c_str(), target.c_str()) != 0) throw cannotWrite(path, errno);
    } catch (...) {
        if (entry) ::unlink(temporary.c_str());
        throw;
    }
    gather({}); // it is there for all
}

void writeBytesAtomically(const std::string& path, std::span<const unsigned char> bytes) {
    writeAtomically(path, [&](OutputFile& file) { file.write(bytes.data(), bytes.size()); });
}

void writeTextAtomically(const std::string& path, std::string_view text) {
    writeAtomically(path, [&](OutputFile& file) { file.write(text); });
}

std::string readText(const std::string& path, std::size_t mostBytes) {
    tellOfReading(path);
    const auto cannotRead = [&](int error) {
        if (error == ENOENT || error == ENOTDIR) return FileError("no such file", path, "check the name");
        if (error == EISDIR) return FileError("this is a folder, not a file", path, "name a file in it");
        return FileError("cannot read the file (" + std::generic_category().message(error) + ")", path,
                         "check its name and permissions");
    };
    const struct Descriptor {
        int number;
        ~Descriptor() {
            if (number >= 0) ::close(number);
        }
    } file{uninterrupted([&] { return open(path.c_str(), O_RDONLY | O_CLOEXEC); })};
    if (file.number < 0) throw cannotRead(errno);
    std::string text;
    constexpr std::size_t kPiece = std::size_t{1} << 16;
    for (std::size_t size = 0;;) {
        text.resize(size + kPiece);
        const ssize_t got = uninterrupted([&] { return read(file.number, text.data() + size, kPiece); });
        if (got < 0) throw cannotRead(errno);
        size += static_cast<std::size_t>(got);
        if (size > mostBytes)
            throw FileError("it has more than " + describeBytes(mostBytes), path, "give a smaller file");
        text.resize(size);
        if (got == 0) return text;
    }
}

void removeUnfinishedFiles() noexcept {
    const std::lock_guard lock(g_mutex);
    for (const std::string& path : unfinished())
        if (::unlink(path.c_str()) != 0 && errno == EISDIR) {
            std::error_code ec;
            fs::remove_all(path, ec);
        }
}

} // namespace pellucid
