#include <catch2/catch.hpp>

#include "base/error.h"
#include "base/memory.h"
#include "support/temp_folder.h"
#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

struct LimitedMemory {
    explicit LimitedMemory(std::uint64_t bytes) { setMemoryLimit(bytes); }
    ~LimitedMemory() { setMemoryLimit({}); }
};

std::string problemOf(const MemoryUse& use, const Int3& dims, std::uint64_t reading, std::uint64_t kept) {
    try {
        requireMemory(use, "a.nrrd", dims, SampleType::U16, reading, kept);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

} // namespace

TEST_CASE("what memory will not do for is refused, and the message says why", "[memory]") {
    const LimitedMemory limit(std::uint64_t{20} << 30);
    // 1000³ voxels at 12 bytes and the volume itself: 13 GB; 2000³: 104 GB.
    CHECK(problemOf({"measuring", 12}, {1000, 1000, 1000}, 1'000'000'000, 1'000'000'000).empty());
    const std::string measuring = problemOf({"measuring", 12}, {2000, 2000, 2000}, 8'000'000'000, 8'000'000'000);
    CHECK_THAT(measuring, Contains("reading and measuring 2000 x 2000 x 2000 voxels needs 104 GB of memory") &&
                              Contains("GB are free: the program itself takes ") &&
                              Contains(" allowed, a.nrrd, allow more,"));
    // Reading takes more than what follows.
    CHECK_THAT(problemOf({"showing", 2}, {2000, 2000, 2000}, 64'000'000'000, 8'000'000'000),
               Contains("reading 2000 x 2000 x 2000 voxels needs 64 GB"));
    CHECK_THAT(problemOf({}, {2000, 2000, 2000}, 64'000'000'000, 64'000'000'000), Contains("reading 2000 x 2000"));
    CHECK_THROWS_WITH(requireMemory({"measuring", 12}, "disks", Int3(2000), SampleType::U16),
                      Contains("measuring 2000 x 2000 x 2000 voxels needs 96 GB") && Contains("disks"));
    CHECK_NOTHROW(requireMemory({"measuring", 12}, "disks", Int3(1000), SampleType::U16));
}

TEST_CASE("volumes are refused before they are read, for what would be done with them", "[memory]") {
    const TempFolder folder;
    VolumeSource raw;
    raw.path = folder.write("a.raw", std::string(1'000'000, 'x'));
    raw.raw = parseRawLayout("100,100,100,u8");
    VolumeSource nrrd;
    nrrd.path = folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 100 100 100\nencoding: raw\n\n" +
                                           std::string(1'000'000, 'x'));
    VolumeSource sample;
    sample.path = "sample:disks";
    sample.sampleSize = 100;
    for (VolumeSource source : {raw, nrrd, sample}) {
        CAPTURE(source.path);
        CHECK(loadVolume(source).size() == 1'000'000);
        source.downsample = 1;
        source.then = {"measuring", 12};
        CHECK(loadVolume(source).size() == 1'000'000);
        source.then.bytesPerVoxel = 1e9; // 1 PB
        CHECK_THROWS_WITH(loadVolume(source), Contains("reading and measuring 100 x 100 x 100 voxels needs 1 PB"));
    }
}
