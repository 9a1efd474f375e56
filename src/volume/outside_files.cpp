#include "volume/outside_files.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <set>

#include "base/error.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

/// What the user allows; opening goes on in several threads.
struct Allowed {
    std::mutex mutex;
    bool everything = false;
    std::set<fs::path> headers;
};

Allowed& allowed() {
    static Allowed all;
    return all;
}

fs::path absolute(const std::string& path) {
    std::error_code ec;
    const fs::path whole = fs::absolute(path, ec);
    return (ec ? fs::path(path) : whole).lexically_normal();
}

/// Whether a path stays in the folder that it begins in.
bool staysInside(const fs::path& named) {
    const fs::path normal = named.lexically_normal();
    return !normal.is_absolute() && (normal.empty() || *normal.begin() != "..");
}

} // namespace

void allowOutsideFiles() {
    const std::scoped_lock lock(allowed().mutex);
    allowed().everything = true;
}

void allowOutsideFiles(const std::string& header) {
    const std::scoped_lock lock(allowed().mutex);
    allowed().headers.insert(absolute(header));
}

void requireInside(const std::string& header, const std::string& named) {
    if (staysInside(named)) return;
    const fs::path folder = absolute(header).parent_path(), file = absolute(named);
    const bool isInIt = fs::path(named).is_absolute() && staysInside(file.lexically_relative(folder));
    if (isInIt) return;
    {
        const std::scoped_lock lock(allowed().mutex);
        if (allowed().everything || allowed().headers.contains(absolute(header))) return;
    }
    throw FileError("this file names another one outside its own folder, " + inQuotes(named.substr(0, 200)), header,
                    "put the data beside it", Remedy::AllowOutside);
}

} // namespace pellucid
