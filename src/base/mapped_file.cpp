#include "base/mapped_file.h"

#include <array>
#include <atomic>
#include <cstring>

#if defined(__linux__)
#include <csignal>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace pellucid {

#if defined(__linux__)

namespace {

/// What is mapped, for the handler of a signal: it may take no lock and no memory. One that finds no room here is not
/// named when it fails.
struct Known {
    std::atomic<std::uintptr_t> begin = 0, end = 0;
    std::array<char, 256> name{};
};
std::array<Known, 64> g_known;
struct sigaction g_before; // NOLINT: set once, before it is read

/// Says what has happened; the access that failed is then repeated, and ends the process as it would have.
void onBusError(int signal, siginfo_t* info, void* /*context*/) {
    const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
    for (const Known& known : g_known)
        if (at >= known.begin && at < known.end) {
            const auto write = [](const char* text) {
                if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return; // nobody left to tell
            };
            write("pellucid: a file in use was cut short or cannot be read any more: ");
            write(known.name.data());
            write("\n");
            break;
        }
    sigaction(signal, &g_before, nullptr);
}

void remember(const void* begin, std::size_t bytes, const std::string& path) {
    static const bool handled = [] {
        struct sigaction action {};
        action.sa_sigaction = onBusError;
        action.sa_flags = SA_SIGINFO;
        return sigaction(SIGBUS, &action, &g_before) == 0;
    }();
    if (!handled) return;
    const auto first = reinterpret_cast<std::uintptr_t>(begin);
    for (Known& known : g_known) {
        std::uintptr_t free = 0;
        if (!known.begin.compare_exchange_strong(free, first)) continue;
        known.name.fill('\0');
        path.copy(known.name.data(), known.name.size() - 1);
        known.end = first + bytes;
        return;
    }
}

void forget(const void* begin) {
    const auto first = reinterpret_cast<std::uintptr_t>(begin);
    for (Known& known : g_known)
        if (known.begin == first) {
            known.end = 0;
            known.begin = 0;
        }
}

struct OpenFile {
    int descriptor;
    ~OpenFile() {
        if (descriptor >= 0) close(descriptor); // a mapping needs it no longer
    }
};

} // namespace

std::shared_ptr<const MappedFile> MappedFile::map(const std::string& path, std::uint64_t start, std::uint64_t bytes) {
    const OpenFile file{open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    struct stat status {};
    if (bytes == 0 || file.descriptor < 0 || fstat(file.descriptor, &status) != 0 || !S_ISREG(status.st_mode))
        return {};
    const auto fileBytes = static_cast<std::uint64_t>(status.st_size);
    if (start > fileBytes || bytes > fileBytes - start) return {};
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    const std::uint64_t before = start % page, mapped = before + bytes;
    // Behind the file's last page there is nothing: a page of zeros of our own makes room for the padding.
    const std::size_t region = (mapped + kPadding + 2 * page - 1) / page * page;
    void* const at = mmap(nullptr, region, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) return {};
    std::shared_ptr<MappedFile> made(new MappedFile);
    made->m_region = at;
    made->m_regionBytes = region;
    if (mmap(at, mapped, PROT_READ, MAP_PRIVATE | MAP_FIXED, file.descriptor, static_cast<off_t>(start - before)) ==
        MAP_FAILED)
        return {};
    made->m_data = static_cast<const unsigned char*>(at) + before;
    made->m_size = bytes;
    remember(at, region, path);
    return made;
}

MappedFile::~MappedFile() {
    forget(m_region);
    munmap(m_region, m_regionBytes);
}

#else

std::shared_ptr<const MappedFile> MappedFile::map(const std::string&, std::uint64_t, std::uint64_t) { return {}; }
MappedFile::~MappedFile() = default;

#endif

} // namespace pellucid
