// Opens files, one after the other in one process, as the command line opens them, and tells what came of each: for
// mutate_headers.py and mutate_foreign.py, with which a build with sanitizers looks at many damaged files in little
// time.
//
//     open_files [--memory GIB]
//
// See answer_paths.h for what goes in and out; of a file that is read "dims", "spacing", "origin", "data_range",
// "invalid" and "memory_bytes".
#include <cstdio>
#include <cstdlib>
#include <string>
#include <variant>

#include "answer_paths.h"
#include "base/memory.h"
#include "volume/series.h"

using namespace pellucid;
using nlohmann::json;

namespace {

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
    return {{"dims", json::array({dims.x, dims.y, dims.z})},
            {"spacing", vectorOf(volume.geometry().spacing)},
            {"origin", vectorOf(volume.geometry().origin)},
            {"data_range", json::array({volume.dataRange().lo, volume.dataRange().hi})},
            {"invalid", volume.invalidCount()},
            {"memory_bytes", volume.memoryBytes()}};
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::string(argv[1]) == "--memory") {
        setMemoryLimit(static_cast<std::uint64_t>(std::atof(argv[2]) * 1073741824.0));
    } else if (argc != 1) {
        std::fprintf(stderr, "usage: open_files [--memory GIB], paths on standard input\n");
        return 2;
    }
    test::answerAll(open);
}
