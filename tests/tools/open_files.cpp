// Opens files, one after the other in one process, as the command line opens them, and tells what came of each: for
// mutate_headers.py and mutate_foreign.py, with which a build with sanitizers looks at many damaged files in little
// time.
//
//     open_files [--memory GIB]
//
// Standard input has the path of a file or folder in each line; standard output answers each with one line of JSON:
//     {"read": true, "dims": …, "spacing": …, "origin": …, "data_range": …, "invalid": …, "memory_bytes": …, …}
//     {"read": false, "error": "WHAT, WHERE, WHAT TO DO", …}
// and in both "cpu", the seconds of computing of this process and of readers of foreign formats that it waited for, and
// "heap_mib", the most that it had allocated at once for this file (-1 without the address sanitizer). A crash, and a
// finding of a sanitizer, end it: it was the file that has no answer.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <variant>

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "base/memory.h"
#include "volume/series.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/allocator_interface.h>
#endif

using namespace pellucid;
using nlohmann::json;

namespace {

/// The heap as the address sanitizer sees it.
class HeapWatch {
public:
    /// From now on.
    static void begin() {
#ifdef __SANITIZE_ADDRESS__
        static const int s_installed = __sanitizer_install_malloc_and_free_hooks(added, removed);
        static_cast<void>(s_installed);
        s_now = s_most = 0;
#endif
    }
    static double mostMib() {
#ifdef __SANITIZE_ADDRESS__
        return static_cast<double>(s_most.load()) / 1048576.0;
#else
        return -1;
#endif
    }

private:
#ifdef __SANITIZE_ADDRESS__
    static void added(const volatile void*, std::size_t bytes) {
        const auto now = s_now += static_cast<std::int64_t>(bytes);
        for (auto most = s_most.load(); now > most && !s_most.compare_exchange_weak(most, now);) {
        }
    }
    static void removed(const volatile void* at) {
        if (at != nullptr) s_now -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<void*>(at)));
    }
#endif
    static inline std::atomic<std::int64_t> s_now{0}, s_most{0};
};

double secondsOfComputing() {
    double seconds = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        getrusage(who, &used);
        for (const timeval& time : {used.ru_utime, used.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}

/// Every sample, so that the address sanitizer sees where they lie.
double sumOf(const Volume& volume) {
    double sum = 0;
    std::visit(
        [&](const auto& samples) {
            for (std::size_t i = 0; i < volume.size(); ++i) sum += static_cast<double>(samples[i]);
        },
        volume.samples());
    return sum;
}

json vectorOf(const Vec3& v) { return json::array({v.x, v.y, v.z}); }

/// What `info` looks at.
json open(const std::string& path) {
    VolumeSource source;
    source.path = path;
    const SeriesListing listing = listSeries(source);
    const VolumeSource& frame = listing.frames.front().source;
    const Volume volume = loadVolume(frame);
    static volatile double s_sink;
    s_sink = s_sink + sumOf(volume);
    const Int3 dims = volume.dims();
    return {{"read", true},
            {"dims", json::array({dims.x, dims.y, dims.z})},
            {"spacing", vectorOf(volume.geometry().spacing)},
            {"origin", vectorOf(volume.geometry().origin)},
            {"data_range", json::array({volume.dataRange().lo, volume.dataRange().hi})},
            {"invalid", volume.invalidCount()},
            {"memory_bytes", volume.memoryBytes()}};
}

json answerTo(const std::string& path) {
    HeapWatch::begin();
    const double before = secondsOfComputing();
    json answer;
    try {
        answer = open(path);
    } catch (const Error& e) {
        answer = {{"read", false}, {"error", e.what()}};
    } catch (const std::bad_alloc&) {
        answer = {{"read", false}, {"error", "there is not enough memory, " + path}}; // as the program says it
    }
    answer["heap_mib"] = HeapWatch::mostMib();
    answer["cpu"] = secondsOfComputing() - before;
    return answer;
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::string(argv[1]) == "--memory") {
        setMemoryLimit(static_cast<std::uint64_t>(std::atof(argv[2]) * 1073741824.0));
    } else if (argc != 1) {
        std::fprintf(stderr, "usage: open_files [--memory GIB], paths on standard input\n");
        return 2;
    }
    for (std::string path; std::getline(std::cin, path);)
        std::cout << answerTo(path).dump(-1, ' ', false, json::error_handler_t::replace) << std::endl;
}
