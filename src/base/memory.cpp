#include "base/memory.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/text.h"

#if defined(__linux__)
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

std::atomic<std::uint64_t> g_limit = kUnknown;

/// Limits may be counted from above as well as from below: nothing is left of one that is exceeded.
std::uint64_t left(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

/// The number in a file that holds one; empty for "max" and where there is no such file.
std::optional<std::uint64_t> numberIn(const fs::path& path) {
    std::ifstream in(path);
    std::string text;
    std::int64_t value = 0;
    if (!(in >> text) || !parseNumber(text, value) || value < 0) return {};
    return static_cast<std::uint64_t>(value);
}

/// The number behind `name` in a file of names and numbers; 0 where there is none.
std::uint64_t numberBehind(const fs::path& path, const std::string& name) {
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        const std::vector<std::string> words = splitWords(line);
        std::int64_t value = 0;
        if (words.size() >= 2 && words[0] == name && parseNumber(words[1], value) && value >= 0)
            return static_cast<std::uint64_t>(value);
    }
    return 0;
}

struct GroupFiles {
    const char *limit, *used, *reclaimable;
};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "inactive_file"};

/// What one control group leaves. Cached files count as used there, but go where memory is needed.
std::uint64_t leftByGroup(const fs::path& folder, const GroupFiles& files) {
    const auto limit = numberIn(folder / files.limit), used = numberIn(folder / files.used);
    if (!limit || !used) return kUnknown;
    return left(*limit, left(*used, numberBehind(folder / "memory.stat", files.reclaimable)));
}

/// The group and all that it lies in. In a container the mounted tree may begin at the process's own group, whatever
/// path the system tells.
std::uint64_t leftByGroups(const fs::path& mounted, const std::string& group, const GroupFiles& files) {
    std::uint64_t least = leftByGroup(mounted, files);
    fs::path folder = mounted;
    for (const fs::path& part : fs::path(group).relative_path()) {
        folder /= part;
        least = std::min(least, leftByGroup(folder, files));
    }
    return least;
}

/// Pages of the process: all that are mapped, and those in memory that are not files, which the system can drop.
struct Pages {
    std::uint64_t mapped = 0, taken = 0;
};
Pages pagesOfThisProcess() {
    std::uint64_t mapped = 0, resident = 0, files = 0;
    std::ifstream in("/proc/self/statm");
    if (!(in >> mapped >> resident >> files)) return {};
    return {mapped, left(resident, files)};
}

std::uint64_t pageBytes() {
#if defined(__linux__)
    return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
#else
    return 4096;
#endif
}

} // namespace

std::uint64_t availableMemoryBytes(const fs::path& root) {
    std::uint64_t least = kUnknown;
    if (const std::uint64_t kibibytes = numberBehind(root / "proc/meminfo", "MemAvailable:"); kibibytes > 0)
        least = kibibytes * 1024;
    std::ifstream groups(root / "proc/self/cgroup"); // lines of number:controllers:path
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const std::string path = line.substr(second + 1);
        if (controllers == ",,")
            least = std::min(least, leftByGroups(root / "sys/fs/cgroup", path, kVersion2));
        else if (controllers.find(",memory,") != std::string::npos)
            least = std::min(least, leftByGroups(root / "sys/fs/cgroup/memory", path, kVersion1));
    }
    return least;
}

std::uint64_t availableMemoryBytes() {
    if (const std::uint64_t limit = g_limit; limit != kUnknown) return left(limit, usedMemoryBytes());
    std::uint64_t least = availableMemoryBytes(fs::path("/"));
#if defined(__linux__)
    rlimit space{};
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
        least = std::min<std::uint64_t>(least, left(space.rlim_cur, pagesOfThisProcess().mapped * pageBytes()));
#endif
    return least;
}

std::uint64_t usedMemoryBytes() { return pagesOfThisProcess().taken * pageBytes(); }

void setMemoryLimit(std::optional<std::uint64_t> bytes) { g_limit = bytes.value_or(kUnknown); }

void requireMemory(const std::string& doing, const std::string& where, std::uint64_t needed) {
    const std::uint64_t available = availableMemoryBytes();
    if (needed <= available) return;
    const std::string needs = doing + " needs " + describeBytes(needed) + " of memory, ";
    const std::uint64_t limit = g_limit;
    if (limit == kUnknown)
        throw FileError(needs + describeBytes(available) + " are free", where,
                        "close other programs, use a larger machine or a smaller volume");
    const std::uint64_t taken = usedMemoryBytes();
    throw FileError(needs + describeBytes(available) + " are free: the program itself takes " + describeBytes(taken) +
                        " of the " + describeBytes(limit) + " allowed",
                    where, "allow more, or use a smaller volume", Remedy::AllowMoreMemory);
}

} // namespace pellucid
