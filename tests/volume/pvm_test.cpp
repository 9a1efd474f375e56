// PVM, plain and packed as DDS, and each way to break it. The packer here is written from the format's description;
// real files are read in real_files_test.cpp.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

#include "dds_packer.h"
#include "loaded.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

VolumeSource sourceOf(const std::string& path, int component = 0) {
    VolumeSource source;
    source.path = path;
    source.component = component;
    return source;
}

std::string voxels(std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(i < 100 ? i * 37 : i < 300 ? 7 : i * i / 3);
    return bytes;
}

} // namespace

TEST_CASE("PVM reads in its three versions", "[pvm]") {
    const TempFolder folder;
    const std::string data = "abcdefghijkl";
    const std::vector<std::uint8_t> values(data.begin(), data.end());
    const auto read = [&](const std::string& text) { return loadVolume(sourceOf(folder.write("a.pvm", text))); };
    const Volume first = read("PVM\n3 2 2\n1\n" + data);
    CHECK(samplesOf<std::uint8_t>(first) == values);
    CHECK(first.dims() == Int3(3, 2, 2));
    CHECK(first.geometry().spacing == Vec3(1, 1, 1));
    CHECK(first.format == "PVM");
    CHECK(first.notices.empty());
    const Volume second = read("PVM2\n# a comment\n3 2 2\n1 1.5 2\n1\n" + data);
    CHECK(samplesOf<std::uint8_t>(second) == values);
    CHECK(second.geometry().spacing == Vec3(1, 1.5, 2));
    using namespace std::string_literals;
    const Volume third = read("PVM3\n3 2 2\n1 1 1.4\n1\n" + data + "a lobster\0by someone\0\0\0"s);
    CHECK(samplesOf<std::uint8_t>(third) == values);
    CHECK(third.notices.empty());
    CHECK_THAT(read("PVM\n3 2 1\n1\n" + data).notices.at(0), Contains("6 bytes more"));
}

TEST_CASE("two bytes of a PVM voxel are one value, the high one first, and three are a colour", "[pvm]") {
    const TempFolder folder;
    using namespace std::string_literals;
    const std::string path = folder.write("a.pvm", "PVM\n2 1 1\n2\n\x01\x02\xff\x00"s);
    CHECK(samplesOf<std::uint16_t>(loadVolume(sourceOf(path))) == std::vector<std::uint16_t>{0x102, 0xff00});
    const std::string colours = folder.write("b.pvm", "PVM\n2 1 1\n3\nabcdef");
    CHECK(samplesOf<std::uint8_t>(loadVolume(sourceOf(colours, 2))) == std::vector<std::uint8_t>{'c', 'f'});
    CHECK(contentsOf(sourceOf(colours)).components == 3);
    CHECK(contentsOf(sourceOf(folder.write("c.pvm", "PVM\n1 1 1\n4\nabcd"))).components == 4);
}

TEST_CASE("PVM packed as DDS reads back", "[pvm]") {
    const TempFolder folder;
    const std::string data = voxels(40 * 30 * 20);
    const std::string header = "PVM2\n40 30 20\n1 2 3\n1\n";
    for (const bool inBlocks : {false, true})
        for (const std::size_t planes : {1u, 2u, 3u, 4u})
            for (const std::size_t strip : {1u, 2u, 40u, 65536u}) {
                CAPTURE(inBlocks, planes, strip);
                const std::string path = folder.write("a.pvm", dds(header + data, planes, strip, inBlocks));
                const Volume volume = loadVolume(sourceOf(path));
                const std::vector<std::uint8_t> read = samplesOf<std::uint8_t>(volume);
                REQUIRE(read.size() == data.size());
                CHECK(std::equal(read.begin(), read.end(), data.begin(),
                                 [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }));
                CHECK(volume.geometry().spacing == Vec3(1, 2, 3));
                CHECK(contentsOf(sourceOf(path)).dims == Int3(40, 30, 20));
            }
    // A region goes past what lies before it.
    VolumeSource part = sourceOf(folder.write("a.pvm", dds(header + data, 1, 40)));
    part.region = VoxelRegion{{3, 4, 17}, {5, 5, 18}};
    const std::size_t at = 3 + 40 * (4 + 30 * 17);
    CHECK(samplesOf<std::uint8_t>(loadVolume(part)) ==
          std::vector<std::uint8_t>{static_cast<std::uint8_t>(data[at]), static_cast<std::uint8_t>(data[at + 1])});
}

TEST_CASE("planes of large DDS data lie in blocks, or beside each other as a whole", "[pvm]") {
    const TempFolder folder;
    const std::size_t count = (std::size_t{1} << 24) + 5000; // values of two bytes: a block and a part of one
    std::string data(2 * count, '\0');
    for (std::size_t i = 0; i < data.size(); i += 1001) data[i] = static_cast<char>(i / 1001);
    const std::string header = "PVM\n" + std::to_string(count / 8) + " 4 2\n2\n";
    for (const bool inBlocks : {false, true}) {
        const Volume volume = loadVolume(sourceOf(folder.write("a.pvm", dds(header + data, 2, 1, inBlocks))));
        const auto& samples = std::get<SampleArray<std::uint16_t>>(volume.samples());
        bool same = samples.size() == count / 8 * 8;
        for (std::size_t i = 0; same && i < samples.size(); ++i)
            same = samples[i] ==
                   (static_cast<unsigned char>(data[2 * i]) << 8 | static_cast<unsigned char>(data[2 * i + 1]));
        CHECK(same);
    }
}

TEST_CASE("PVM files that are damaged are refused in words", "[pvm][bad-input]") {
    const TempFolder folder;
    const auto errorOfText = [&](const std::string& text) { return errorOf(sourceOf(folder.write("a.pvm", text))); };
    CHECK(errorOfText("PVM\n2 1 1\n1\nab") == "no error");
    CHECK_THAT(errorOfText("something else"), Contains("this is not a PVM file but text"));
    CHECK_THAT(errorOfText("PVM\n2 1 1"), Contains("the header ends before"));
    CHECK_THAT(errorOfText("PVM\n2 1\n1\nab"), Contains("'2 1' where three sizes"));
    CHECK_THAT(errorOfText("PVM\n2 x 1\n1\nab"), Contains("'x' where a size"));
    CHECK_THAT(errorOfText("PVM\n2 0 1\n1\nab"), Contains("at least 1"));
    CHECK_THAT(errorOfText("PVM2\n2 1 1\n1 0 1\n1\nab"), Contains("spacing of axis 1 is '0'"));
    CHECK_THAT(errorOfText("PVM\n2 1 1\n5\nab"), Contains("5 components, not 1 to 4"));
    CHECK_THAT(errorOfText("PVM\n2 1 1\n1\na"), Contains("1 of 2 bytes"));
    CHECK_THAT(errorOfText("PVM\n2000000000 2000000000 2000000000\n1\na"), Contains("more than any memory"));
    CHECK_THAT(errorOfText("PVM\n2000000 2000000 1\n1\na"), Contains("1 of 4000000000000 bytes"));
    const std::string packed = dds("PVM\n2 1 1\n1\nab");
    CHECK(errorOfText(packed) == "no error");
    CHECK_THAT(errorOfText(dds("PVM\n2000000 2000000 1\n1\nab")), Contains("of compressed data cannot hold"));
    CHECK_THAT(errorOfText(dds("PVM\n2 2 1\n1\nab")), Contains("2 of 4 bytes"));
    CHECK_THAT(errorOfText(dds("something else")), Contains("this is not a PVM file but text"));
    // The last byte has nothing but the mark of the end, which may be missing.
    CHECK(errorOfText(packed.substr(0, packed.size() - 1)) == "no error");
    for (std::size_t length = 1; length + 2 < packed.size(); ++length)
        CHECK(errorOfText(packed.substr(0, length)) != "no error");
    const std::string many = dds("PVM\n50 10 1\n1\n" + voxels(500));
    CHECK_THAT(errorOfText(many.substr(0, many.size() - 20)), Contains("within a run"));
}
