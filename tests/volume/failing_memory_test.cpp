// Memory that runs out while a volume is read, at any allocation. A program of its own: it replaces malloc().
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include <catch2/catch.hpp>

#include "base/parallel.h"
#include "dds_packer.h"
#include "flipped_bits.h"
#include "volume/file_contents.h"
#include "volume/series.h"
#include "volume/volume_writer.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define PELLUCID_OWN_MALLOC 0 // they have one of their own
#else
#define PELLUCID_OWN_MALLOC 1
#endif

namespace {

/// Allocations that are yet to come until one fails; below 0: none will.
std::atomic<std::int64_t> g_left{-1};
std::atomic<std::size_t> g_least{1}; ///< bytes: smaller ones neither count nor fail
std::atomic<bool> g_goesOn{false};   ///< all after the first one fail, too
std::atomic<bool> g_hasFailed{false};
std::atomic<std::int64_t> g_live{0}; ///< allocations that have not been freed

[[maybe_unused]] bool mustFail(std::size_t bytes) {
    if (g_left < 0 || bytes < g_least) return false;
    if (g_left > 0 && --g_left > 0) return false;
    if (!g_goesOn) g_left = -1;
    g_hasFailed = true;
    errno = ENOMEM;
    return true;
}

[[maybe_unused]] void* counted(void* memory) {
    if (memory != nullptr) ++g_live;
    return memory;
}

} // namespace

#if PELLUCID_OWN_MALLOC
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t bytes) { return mustFail(bytes) ? nullptr : counted(__libc_malloc(bytes)); }
void* calloc(std::size_t count, std::size_t bytes) {
    return mustFail(count * bytes) ? nullptr : counted(__libc_calloc(count, bytes));
}
void* realloc(void* old, std::size_t bytes) {
    if (mustFail(bytes)) return nullptr;
    void* const memory = __libc_realloc(old, bytes);
    return old == nullptr ? counted(memory) : memory;
}
void* memalign(std::size_t alignment, std::size_t bytes) {
    return mustFail(bytes) ? nullptr : counted(__libc_memalign(alignment, bytes));
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) { return memalign(alignment, bytes); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
    if (mustFail(bytes)) return ENOMEM;
    *memory = counted(__libc_memalign(alignment, bytes));
    return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
    if (memory != nullptr) --g_live;
    __libc_free(memory);
}
}
#endif

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// While it lives, the n-th allocation of `least` bytes or more fails; or it and all after it.
class FailingMemory {
public:
    FailingMemory(std::int64_t n, std::size_t least, bool goesOn) {
        g_least = least;
        g_goesOn = goesOn;
        g_hasFailed = false;
        g_left = n;
    }
    ~FailingMemory() { g_left = -1; }
    FailingMemory(const FailingMemory&) = delete;
    FailingMemory& operator=(const FailingMemory&) = delete;
};

using Open = std::function<std::optional<Volume>()>;
enum class Ending { Read, InWords, OutOfMemory };

/// As main() and the window's jobs tell them apart; any other exception fails the test.
Ending endingOf(const Open& open, const std::optional<Volume>& sound, const std::function<FailingMemory()>& failing) {
    std::optional<Volume> volume;
    try {
        const FailingMemory memory = failing();
        volume = open();
    } catch (const Error& error) {
        CHECK_FALSE(error.problem().empty());
        return Ending::InWords;
    } catch (const std::bad_alloc&) {
        return Ending::OutOfMemory;
    }
    CHECK(volume.has_value() == sound.has_value());
    if (volume && sound) CHECK(volume->samples() == sound->samples());
    return Ending::Read;
}

/// Lets the first, the second … allocation fail, of `smallest` bytes or more.
void requireToldAlways(const Open& open, std::size_t smallest = 1) {
    open(); // what is made once
    const std::optional<Volume> sound = open();
    constexpr std::int64_t kMost = 200;
    std::size_t failed = 0;
    for (const std::size_t least : {smallest, std::size_t{4096}})
        for (const bool goesOn : {false, true})
            for (std::int64_t n = 1; n <= kMost; ++n) {
                CAPTURE(least, goesOn, n);
                const auto failing = [&] { return FailingMemory(n, least, goesOn); };
                endingOf(open, sound, failing);
                const std::int64_t before = g_live;
                const Ending ending = endingOf(open, sound, failing);
                CHECK(g_live == before); // nothing is left behind
                if (!g_hasFailed) break;
                if (goesOn && least == 1) CHECK(ending != Ending::Read);
                ++failed;
            }
    CHECK(failed > 0);
    const std::optional<Volume> again = open(); // memory is there again
    CHECK(again.has_value() == sound.has_value());
    if (again && sound) CHECK(again->samples() == sound->samples());
}

/// Reads a file as any other, and tells of it.
Open opening(const std::string& path, const std::string& raw = "", int step = 0) {
    VolumeSource source;
    source.path = path;
    source.step = step;
    if (!raw.empty()) source.raw = parseRawLayout(raw);
    return [source] { return std::optional(loadVolume(source)); };
}

bool canFail() {
    if (PELLUCID_OWN_MALLOC) return true;
    WARN("SKIPPED: malloc() is not this program's own");
    return false;
}

} // namespace

TEST_CASE("memory that runs out while a packed volume is read is told", "[failing-memory]") {
    if (!canFail()) return;
    setThreadCount(1);
    const TempFolder folder;
    for (const PackedFile& file : packedFiles(14)) {
        if (!file.header.empty()) continue;
        CAPTURE(file.format);
        requireToldAlways(opening(folder.write("a" + file.suffix, file.bytes), file.raw, file.steps - 1));
    }
    const std::string voxels(24, 'v');
    requireToldAlways(opening(folder.write("a.pvm", dds("PVM\n2 3 4\n1\n" + voxels, 2, 3))));
}

TEST_CASE("memory that runs out while a volume of each format is read is told", "[failing-memory]") {
    if (!canFail()) return;
    setThreadCount(1);
    const TempFolder folder;
    Geometry geometry;
    geometry.dims = {4, 3, 2};
    std::vector<float> values(24);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    const Volume volume(geometry, SampleArray<float>(std::move(values)));
    for (const char* name : {"a.nrrd", "a.mha", "a.mhd", "a.nii", "a.nii.gz", "a.vti"}) {
        CAPTURE(name);
        writeVolume(volume, folder.path(name));
        requireToldAlways(opening(folder.path(name)));
    }
    const std::string numbers = "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24\n";
    const std::string grid =
        "DATASET STRUCTURED_POINTS\nDIMENSIONS 4 3 2\nSPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 24\n";
    requireToldAlways(opening(folder.write("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\n" + grid +
                                                        "SCALARS s int 1\nLOOKUP_TABLE default\n" + numbers)));
    requireToldAlways(
        opening(folder.write("b.vtk", "# vtk DataFile Version 3.0\nt\nBINARY\n" + grid +
                                          "SCALARS s unsigned_char 1\nLOOKUP_TABLE default\n" + std::string(24, 'v'))));
    requireToldAlways(opening(folder.write("a.raw", std::string(48, 'v')), "4,3,2,i16,big"));
    folder.write("a.dat", "RawFile: a.raw\nResolution: 4 3 2\nFormat: UINT16\n");
    requireToldAlways(opening(folder.path("a.dat")));
    requireToldAlways(opening(folder.write(
        "a.vvd", "<?xml version=\"1.0\" ?><VoreenData version=\"1\"><Volumes><Volume><RawData filename=\"a.raw\" "
                 "format=\"uint16\" x=\"4\" y=\"3\" z=\"2\"/></Volume></Volumes></VoreenData>")));
    requireToldAlways(opening(folder.write("a.nhdr", "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 4 3 2\n"
                                                     "endian: little\nencoding: raw\ndata file: a.raw\n")));
    requireToldAlways(opening(
        folder.write("a.mrml", "<MRML><Volume name=\"v\" storageNodeRef=\"s\"/><VolumeArchetypeStorage id=\"s\" "
                               "fileName=\"a.nrrd\"/></MRML>")));
}

TEST_CASE("memory that runs out while a volume in several VTK files is read is told", "[failing-memory]") {
    if (!canFail()) return;
    setThreadCount(1);
    const TempFolder folder;
    const std::string image = "WholeExtent=\"0 3 0 2 0 1\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
    const std::string type = "type=\"UInt8\" Name=\"v\"", left = "0 1 0 2 0 1", right = "1 3 0 2 0 1";
    const Style style{Style::Place::Raw};
    folder.write("left.vti", vti(style, {{type, "", std::string(12, 'v')}}, "", image, left));
    folder.write("right.vti", vti(style, {{type, "", std::string(18, 'v')}}, "", image, right));
    folder.write("a.pvti", pvti(image, {type}, {{left, "left.vti"}, {right, "right.vti"}}));
    requireToldAlways(opening(folder.path("a.pvti")));
    const std::string whole = "WholeExtent=\"0 1 0 2 0 1\"";
    folder.write("one.vti", vti(style, {{type, "", std::string(12, 'v')}}, "", whole, left));
    requireToldAlways(
        opening(folder.write("a.pvd", "<?xml version=\"1.0\"?><VTKFile type=\"Collection\" version=\"0.1\"><Collection>"
                                      "<DataSet timestep=\"0\" file=\"one.vti\"/></Collection></VTKFile>")));
}

TEST_CASE("memory that runs out while a series is listed and a frame of it is read is told", "[failing-memory]") {
    if (!canFail()) return;
    setThreadCount(1);
    const TempFolder folder;
    for (const char* name : {"f1.raw", "f2.raw", "f3.raw"}) folder.write(name, std::string(24, name[1]));
    VolumeSource source;
    source.path = folder.path("f%d.raw");
    source.raw = parseRawLayout("2,3,4,u8");
    // libstdc++ 12 ends the program where it cannot copy the few bytes of a path while it lists a folder.
    constexpr std::size_t kMoreThanPath = 512;
    requireToldAlways([&] { return std::optional(loadVolume(listSeries(source).frames.at(1).source)); }, kMoreThanPath);
    const auto described = [&] {
        contentsOf(listSeries(source).frames.at(2).source);
        return std::optional<Volume>();
    };
    requireToldAlways(described, kMoreThanPath);
}
