// How long loadVolume() takes of files that the system's cache holds, against what has to be done at least: of raw data
// a copy in memory, of gzip what libdeflate takes, of formats that libraries read the same in this process. Told as
// ratios of medians, both measured in turn: of time, and of computing, the reader's included, which a busy machine
// changes less.
//
//     opening_time_tiff [--raw LAYOUT] [--rounds N] FILE...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <libdeflate.h>

#include "base/mapped_file.h"
#include "base/stopwatch.h"
#include "base/zeroed_memory.h"
#include "computing_time.h"
#include "foreign/foreign_volume.h"
#include "volume/loader.h"

using namespace pellucid;

namespace {

volatile char g_seen; ///< so that no compiler leaves a copy out

struct Least {
    std::string what;
    std::function<void()> run;
};

std::shared_ptr<const MappedFile> mapped(const std::string& path) {
    auto file = MappedFile::map(path, 0, bytesOfFile(path));
    if (!file) throw FileError("it cannot be mapped", path, "choose another file");
    return file;
}

Least copyOf(const std::string& path) {
    return {"memcpy", [file = mapped(path)] {
                const auto copy = std::make_unique_for_overwrite<char[]>(file->size());
                std::memcpy(copy.get(), file->data(), file->size());
                g_seen = copy[file->size() / 2];
            }};
}

/// Of the gzip stream behind an empty line, as in NRRD, or of the whole file.
Least inflated(const std::string& path, std::size_t bytes) {
    const auto file = mapped(path);
    const std::string head(reinterpret_cast<const char*>(file->data()), std::min<std::size_t>(file->size(), 4096));
    const std::size_t blank = head.find("\n\n"), start = head.starts_with("NRRD") ? blank + 2 : 0;
    return {"libdeflate", [file, start, bytes] {
                const auto to = std::make_unique_for_overwrite<char[]>(bytes);
                libdeflate_decompressor* const decompressor = libdeflate_alloc_decompressor();
                std::size_t made = 0;
                const auto result = libdeflate_gzip_decompress(decompressor, file->data() + start, file->size() - start,
                                                               to.get(), bytes, &made);
                libdeflate_free_decompressor(decompressor);
                if (result != LIBDEFLATE_SUCCESS) throw Error("libdeflate does not unpack it", "", "");
            }};
}

/// With what every volume needs, its range.
Least inProcess(const std::string& path) {
    return {"in process", [path] {
                const auto before = [](std::uint64_t) {};
                const auto volume = openForeign(path, {}, before);
                const ReaderLayout layout = volume->layout(0);
                ReaderBox box;
                box.region = {Int3(0), dimsOf(layout, 0)};
                withType(layout.layout.type, [&](auto zero) {
                    using Value = decltype(zero);
                    ZeroedVector<Value> values(bytesOf(box, layout, path) / sizeof(Value));
                    volume->read(0, box, std::as_writable_bytes(std::span(values)), before, {});
                    if constexpr (std::is_floating_point_v<Value> || sizeof(Value) < 8) {
                        const Volume made({box.region.hi}, SampleArray<Value>(std::move(values)));
                        g_seen = made.range().hi > 0 ? 1 : 0;
                    }
                });
            }};
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

/// Of each round.
struct Times {
    std::vector<double> clock, computing;
    template <class Work>
    void measure(const Work& work) {
        const double before = secondsOfComputing();
        const Stopwatch watch;
        work();
        clock.push_back(watch.seconds());
        computing.push_back(secondsOfComputing() - before);
    }
};

void compare(const VolumeSource& source, int rounds) {
    const Volume first = loadVolume(source);
    const std::string& path = source.path;
    const std::size_t bytes = first.size() * bytesPerSample(first.sampleType());
    const bool isGzip = path.ends_with(".gz") || first.format == "NRRD";
    const Least least = first.format == "raw" && !isGzip ? copyOf(path)
                        : isGzip                         ? inflated(path, bytes + (path.ends_with(".nii.gz") ? 352 : 0))
                                                         : inProcess(path);
    Times whole, part;
    for (int n = 0; n < rounds; ++n) {
        whole.measure([&] { static_cast<void>(loadVolume(source)); });
        part.measure(least.run);
    }
    std::printf("%s: %.1f MB in %.3f s, %s %.3f s, ratio %.2f; of computing %.3f s and %.3f s, ratio %.2f\n",
                path.c_str(), 1e-6 * static_cast<double>(bytes), median(whole.clock), least.what.c_str(),
                median(part.clock), median(whole.clock) / median(part.clock), median(whole.computing),
                median(part.computing), median(whole.computing) / median(part.computing));
}

} // namespace

int main(int argc, char** argv) {
    VolumeSource source;
    source.downsample = 1; // of a file with coarser copies, all voxels
    int rounds = 7;
    try {
        for (int n = 1; n < argc; ++n) {
            const std::string word = argv[n];
            if (word == "--raw" && n + 1 < argc) {
                source.raw = parseRawLayout(argv[++n]);
            } else if (word == "--rounds" && n + 1 < argc) {
                rounds = std::atoi(argv[++n]);
            } else {
                source.path = word;
                compare(source, std::max(rounds, 1));
                source.raw.reset();
            }
        }
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
