#include "base/atomic_file.h"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>

#include <unistd.h>

#include "base/error.h"

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

} // namespace

void writeAtomically(const std::string& path, const std::function<void(const std::string&)>& write) {
    fs::path target(path);
    std::error_code ec;
    if (fs::is_directory(target, ec)) throw FileError("a folder has this name", path, "choose another name");
    // A link stays a link: what it points to is replaced.
    if (fs::is_symlink(target, ec)) {
        const fs::path real = fs::weakly_canonical(target, ec);
        if (!ec) target = real;
    }
    // A device or a pipe (/dev/null, /dev/stdout) cannot be replaced by a file; it takes the bytes as they come.
    if (fs::exists(target, ec) && !fs::is_regular_file(target, ec)) return write(target.string());

    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ec)) throw FileError("the folder does not exist", folder.string(), "create it first");
    static std::atomic<unsigned> s_count = 0; // two threads may write the same file; the last one wins, whole
    std::string name(".");
    name += target.stem().string() + ".part" + std::to_string(getpid()) + "-" + std::to_string(s_count++);
    const fs::path temporary = folder / (name + target.extension().string());
    const Unfinished entry(temporary.string());
    try {
        write(temporary.string());
        fs::rename(temporary, target, ec);
        if (ec) throw FileError("cannot write the file (" + ec.message() + ")", path, "check permissions and space");
    } catch (...) {
        fs::remove(temporary, ec);
        throw;
    }
}

void writeTextAtomically(const std::string& path, const std::string& text) {
    writeAtomically(path, [&](const std::string& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out << text;
        out.close();
        if (!out) throw FileError("cannot write the file", path, "check permissions and space");
    });
}

std::string readText(const std::string& path) {
    std::error_code ec;
    if (!fs::exists(path, ec)) throw FileError("no such file", path, "check the name");
    if (fs::is_directory(path, ec)) throw FileError("this is a folder, not a file", path, "name a file in it");
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw FileError("cannot read the file", path, "check permissions");
    return text.str();
}

void removeUnfinishedFiles() noexcept {
    const std::lock_guard lock(g_mutex);
    for (const std::string& path : unfinished()) ::unlink(path.c_str());
}

} // namespace pellucid
