// Headers whose data lie in several files: lists and numbered names, each file with the same share.
#include <algorithm>
#include <filesystem>
#include <numeric>

#include <catch2/catch.hpp>

#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

using Names = std::vector<std::string>;

VolumeSource sourceOf(const std::string& path, int step = 0, int component = 0) {
    VolumeSource source;
    source.path = path;
    source.step = step;
    source.component = component;
    return source;
}

std::string errorOf(const VolumeSource& source) {
    try {
        loadVolume(source);
    } catch (const FileError& e) {
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
        return e.what();
    }
    return "no error";
}

std::vector<double> valuesOf(const Volume& volume) {
    std::vector<double> values(voxelCount(volume.dims()));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = volume.value(i);
    return values;
}

/// first, first + 1, … `count` of them.
std::vector<double> run(double first, std::size_t count) {
    std::vector<double> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

/// `count` numbers from `first` on as 16-bit values, high byte first: 258 is 1, 2.
std::string big(int first, int count) {
    std::string bytes;
    for (int i = first; i < first + count; ++i) {
        bytes += static_cast<char>(i >> 8);
        bytes += static_cast<char>(i & 255);
    }
    return bytes;
}

std::string textOf(int first, int count) {
    std::string text;
    for (int i = first; i < first + count; ++i) text += std::to_string(i) + "\n";
    return text;
}

std::string hexOf(const std::string& bytes) {
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

/// 2·3·4 values from 250 on, so that both bytes matter.
const std::string kSizes = "type: uint16\nendian: big\ndimension: 3\nsizes: 2 3 4\n";

} // namespace

TEST_CASE("NRRD data lie in a list of files, one slice in each", "[data-files]") {
    const TempFolder folder;
    const std::pair<std::string, std::function<std::string(int, int)>> encodings[] = {
        {"raw", big},
        {"gzip", [](int first, int count) { return gzipped(big(first, count)); }},
        {"hex", [](int first, int count) { return hexOf(big(first, count)); }},
        {"text", textOf}};
    for (const auto& [encoding, encoded] : encodings) {
        CAPTURE(encoding);
        std::string list;
        for (int slice = 0; slice < 4; ++slice) {
            const std::string name = "a slice, " + encoding + std::string(static_cast<std::size_t>(slice), 'x');
            folder.write(name, encoded(250 + 6 * slice, 6));
            list += name + "\n";
        }
        const std::string path =
            folder.write("a.nhdr", "NRRD0004\n" + kSizes + "encoding: " + encoding + "\ndata file: LIST\n" + list);
        CHECK(valuesOf(loadVolume(sourceOf(path))) == run(250, 24));
        VolumeSource part = sourceOf(path);
        part.region = VoxelRegion{{1, 1, 1}, {2, 3, 4}};
        CHECK(valuesOf(loadVolume(part)) == std::vector<double>{259, 261, 265, 267, 271, 273});
        part.region.reset();
        part.downsample = 2; // means of 2·2·2 and, along y, of the one row that is left: (0+1+2+3+6+7+8+9) / 8 = 4.5
        CHECK(valuesOf(loadVolume(part)) == std::vector<double>{255, 258, 267, 270}); // 254.5, 257.5, … are rounded
    }
}

TEST_CASE("lines and bytes are left out of each of several files", "[data-files]") {
    const TempFolder folder;
    const std::string head = "NRRD0005\n" + kSizes, list = "data file: LIST\n0\n1\n2\n3\n";
    for (int slice = 0; slice < 4; ++slice)
        folder.write(std::to_string(slice),
                     std::string(static_cast<std::size_t>(slice), '-') + "\nab" + big(250 + 6 * slice, 6));
    for (const char* skips : {"line skip: 1\nbyte skip: 2\n", "byte skip: -1\n"}) {
        const std::string path = folder.write("a.nhdr", head + "encoding: raw\n" + skips + list);
        CHECK(valuesOf(loadVolume(sourceOf(path))) == run(250, 24));
    }
    for (int slice = 0; slice < 4; ++slice)
        folder.write(std::to_string(slice), "one line\n" + gzipped("abc" + big(250 + 6 * slice, 6)));
    for (const char* skips : {"line skip: 1\nbyte skip: 3\n", "line skip: 1\nbyte skip: -1\n"}) {
        const std::string path = folder.write("a.nhdr", head + "encoding: gzip\n" + skips + list);
        CHECK(valuesOf(loadVolume(sourceOf(path))) == run(250, 24));
    }
}

TEST_CASE("NRRD data lie in numbered files, forwards and backwards, of slices, slabs and rows", "[data-files]") {
    const TempFolder folder;
    for (int slice = 0; slice < 4; ++slice) {
        folder.write("s" + std::to_string(100 + 5 * slice) + ".raw", big(250 + 6 * slice, 6));
        folder.write("below" + std::to_string(-slice) + ".raw", big(250 + 6 * slice, 6));
    }
    for (int slab = 0; slab < 2; ++slab) folder.write("slab-0" + std::to_string(slab), big(250 + 12 * slab, 12));
    for (int row = 0; row < 12; ++row) folder.write("row%" + std::to_string(row), big(250 + 2 * row, 2));
    folder.write("all", big(250, 24));
    folder.write("all1", big(250, 24));
    const auto values = [&](const std::string& files) {
        return valuesOf(loadVolume(
            sourceOf(folder.write("a.nhdr", "NRRD0004\n" + kSizes + "encoding: raw\ndata file: " + files + "\n"))));
    };
    CHECK(values("s%03d.raw 100 115 5") == run(250, 24));
    CHECK(values("s%d.raw 100 119 5 2") == run(250, 24)); // 120 would be the fifth
    CHECK(values("below%d.raw 0 -3 -1") == run(250, 24));
    CHECK(values("slab-%02d 0 1 1 3") == run(250, 24));
    CHECK(values("row%%%d 0 11 1 1") == run(250, 24));
    CHECK(values("all%d 1 1 1 3") == run(250, 24));
    CHECK(values("LIST 3\nall") == run(250, 24));
    CHECK(values("LIST 3\nslab-00\nslab-01\n\n") == run(250, 24));
}

TEST_CASE("of steps in files of their own, only those files are needed that have the step", "[data-files]") {
    const TempFolder folder;
    for (int step = 0; step < 3; ++step) folder.write("t" + std::to_string(step), big(300 + 8 * step, 8));
    const std::string path =
        folder.write("a.nhdr", "NRRD0004\ntype: ushort\nendian: big\ndimension: 4\nsizes: 2 2 2 3\nencoding: raw\n"
                               "data file: t%d 0 2 1\n");
    CHECK(contentsOf(sourceOf(path)).steps == 3);
    for (int step = 0; step < 3; ++step) CHECK(valuesOf(loadVolume(sourceOf(path, step))) == run(300 + 8 * step, 8));
    std::filesystem::remove(folder.path("t0"));
    CHECK(valuesOf(loadVolume(sourceOf(path, 1))) == run(308, 8));
    CHECK_THAT(errorOf(sourceOf(path, 0)), Contains("the data file 't0' that the header names is missing"));
    // Each step in two files, and steps as the fastest axis, which lie in all of them.
    for (int half = 0; half < 6; ++half) folder.write("h" + std::to_string(half), big(300 + 4 * half, 4));
    const std::string head = "NRRD0004\ntype: ushort\nendian: big\ndimension: 4\nencoding: raw\n";
    const std::string halves = folder.write("b.nhdr", head + "sizes: 2 2 2 3\ndata file: h%d 0 5 1 2\n");
    for (int step : {2, 0, 1}) CHECK(valuesOf(loadVolume(sourceOf(halves, step))) == run(300 + 8 * step, 8));
    const std::string between = folder.write("c.nhdr", head + "sizes: 3 2 2 2\nkinds: time domain domain domain\n"
                                                              "data file: h%d 0 5 1 4\n");
    CHECK_THAT(errorOf(sourceOf(between)), Contains("slowest axis of 2 cannot be divided among 6 data files"));
    const std::string mixed = folder.write("d.nhdr", head + "sizes: 3 2 2 2\nkinds: time domain domain domain\n"
                                                            "data file: LIST\ni0\ni1\n");
    folder.write("i0", big(300, 12));
    folder.write("i1", big(312, 12));
    CHECK(valuesOf(loadVolume(sourceOf(mixed, 1))) == std::vector<double>{301, 304, 307, 310, 313, 316, 319, 322});
}

TEST_CASE("components lie in several files, beside each other or apart", "[data-files]") {
    const TempFolder folder;
    folder.write("0", big(300, 8));
    folder.write("1", big(308, 8));
    const std::string head = "NRRD0004\ntype: ushort\nendian: big\ndimension: 4\nencoding: raw\n";
    const std::string apart = folder.write("a.nhdr", head + "sizes: 2 2 2 2\nkinds: domain domain domain 2-vector\n"
                                                            "data file: LIST\n0\n1\n");
    CHECK(valuesOf(loadVolume(sourceOf(apart, 0, 1))) == run(308, 8));
    const std::string beside = folder.write("b.nhdr", head + "sizes: 2 2 2 2\nkinds: 2-vector domain domain domain\n"
                                                             "data file: LIST\n0\n1\n");
    CHECK(valuesOf(loadVolume(sourceOf(beside, 0, 1))) == std::vector<double>{301, 303, 305, 307, 309, 311, 313, 315});
}

TEST_CASE("MetaImage data lie in several files", "[data-files]") {
    const TempFolder folder;
    const std::string head = "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\nElementType = MET_USHORT\n"
                             "BinaryDataByteOrderMSB = True\n";
    std::string names, packed;
    for (int slice = 0; slice < 4; ++slice) {
        folder.write("s" + std::to_string(slice + 7), "head" + big(250 + 6 * slice, 6));
        names += "s" + std::to_string(slice + 7) + "\n";
        folder.write("z" + std::to_string(slice), zlibbed(big(250 + 6 * slice, 6)));
        packed += "z" + std::to_string(slice) + "\r\n";
    }
    folder.write("slab1", "head" + big(250, 12));
    folder.write("slab2", "head" + big(262, 12));
    const auto values = [&](const std::string& text) {
        return valuesOf(loadVolume(sourceOf(folder.write("a.mhd", text))));
    };
    for (const char* skip : {"HeaderSize = 4\n", "HeaderSize = -1\n"}) {
        const std::string file = head + skip + "ElementDataFile = ";
        CHECK(values(file + "LIST\n" + names) == run(250, 24));
        CHECK(values(file + "LIST 2D\n" + names) == run(250, 24));
        CHECK(values(file + "s%d 7 10 1\n") == run(250, 24));
        CHECK(values(file + "s%d 7 10\n") == run(250, 24));
        CHECK(values(file + "s%d 7\n") == run(250, 24));
        CHECK(values(file + "LIST 3D\nslab1\nslab2") == run(250, 24));
    }
    CHECK(values(head + "CompressedData = True\nElementDataFile = LIST\n" + packed) == run(250, 24));
    // Channels are no axis of DimSize.
    const std::string channels =
        folder.write("c.mhd", "NDims = 3\nDimSize = 1 3 4\nElementNumberOfChannels = 2\nElementType = MET_USHORT\n"
                              "BinaryDataByteOrderMSB = True\nHeaderSize = 4\nElementDataFile = s%d 7 10 1\n");
    const std::vector<double> second = valuesOf(loadVolume(sourceOf(channels, 0, 1)));
    for (std::size_t i = 0; i < 12; ++i) CHECK(second[i] == 251 + 2 * static_cast<double>(i));
}

TEST_CASE("all files of a list are files of the volume", "[data-files]") {
    const TempFolder folder;
    const std::string list =
        folder.write("a.nhdr", "NRRD0004\n" + kSizes + "encoding: raw\ndata file: LIST\na\n./b\nc\nd\n");
    CHECK(filesOf(sourceOf(list)) ==
          Names{list, folder.path("a"), folder.path("./b"), folder.path("c"), folder.path("d")});
    const std::string pattern = folder.write("a.mhd", "NDims = 3\nDimSize = 2 3 4\nElementType = MET_USHORT\n"
                                                      "ElementDataFile = s%02d 9 3 -2\n");
    CHECK(filesOf(sourceOf(pattern)) ==
          Names{pattern, folder.path("s09"), folder.path("s07"), folder.path("s05"), folder.path("s03")});
    // A file that is really called so has all data.
    folder.write("LIST", big(250, 24));
    folder.write("s%02d 9 3 -2", big(250, 24));
    CHECK(filesOf(sourceOf(list)) == Names{list, folder.path("LIST")});
    CHECK(filesOf(sourceOf(pattern)) == Names{pattern, folder.path("s%02d 9 3 -2")});
    CHECK(loadVolume(sourceOf(pattern)).dims() == Int3(2, 3, 4));
}

TEST_CASE("lists and patterns of data files that make no sense are refused in words", "[data-files][bad-input]") {
    const TempFolder folder;
    for (int slice = 0; slice < 4; ++slice) folder.write("s" + std::to_string(slice), big(250 + 6 * slice, 6));
    folder.write("short", big(0, 5));
    folder.write("long", big(0, 7));
    folder.write("empty", "");
    const auto error = [&](const std::string& files, const std::string& sizes = kSizes) {
        return errorOf(
            sourceOf(folder.write("a.nhdr", "NRRD0004\n" + sizes + "encoding: raw\ndata file: " + files + "\n")));
    };
    CHECK(error("LIST\ns0\ns1\ns2\ns3") == "no error");
    CHECK_THAT(error("LIST\ns0\ns1\nnone\ns3"), Contains("the data file 'none' that the header names is missing"));
    CHECK_THAT(error("LIST\ns0\ns1\nshort\ns3"), Contains("10 of 12 bytes") && Contains("short"));
    CHECK_THAT(error("LIST\ns0\ns1\nempty\ns3"), Contains("0 of 12 bytes"));
    CHECK_THAT(error("LIST\ns0\ns1\n.\ns3"), Contains("this is a folder"));
    CHECK_THAT(error("LIST\ns0\ns1\ns2"), Contains("names 3 data files, but its sizes need 4"));
    CHECK_THAT(error("LIST 3\ns0\ns1\ns2"), Contains("slowest axis of 4 cannot be divided among 3"));
    CHECK_THAT(error("LIST"), Contains("lists no data files"));
    CHECK_THAT(error("LIST 0\ns0"), Contains("'0' axes"));
    CHECK_THAT(error("LIST 4\ns0"), Contains("'4' axes, but has 3"));
    CHECK_THAT(error("LIST 2 2\ns0"), Contains("behind LIST"));
    CHECK_THAT(error("LIST\n" + std::string(1001, 'n')), Contains("needs") || Contains("need 4"));
    CHECK_THAT(error("SKIPLIST\n0 s0"), Contains("not supported"));
    CHECK_THAT(error("s%d 0 4 1"), Contains("names 5 data files, but its sizes need 4"));
    CHECK_THAT(error("s%d 1 4 1"), Contains("the data file 's4' that the header names is missing"));
    CHECK_THAT(error("s%d 0 3 0"), Contains("from 0 to 3 by steps of 0"));
    CHECK_THAT(error("s%d 3 0 1"), Contains("from 3 to 0 by steps of 1"));
    CHECK_THAT(error("s%s 0 3 1"), Contains("pattern of the data files, 's%s'"));
    CHECK_THAT(error("s%d%d 0 3 1"), Contains("pattern of the data files"));
    CHECK_THAT(error("s%d 0 3 one"), Contains("'one'"));
    CHECK_THAT(error("s%d 0 3 1 2 2"), Contains("too much"));
    CHECK_THAT(error("50%.raw"), Contains("the data file '50%.raw' that the header names is missing"));
    // No table is as long as these numbers say.
    for (const char* numbers : {"s%d 0 4000000000 1", "s%d -9223372036854775807 9223372036854775807 1",
                                "s%d 0 9223372036854775807 1", "s%d 9223372036854775807 -3 -1"})
        CHECK_THAT(error(numbers), Contains("data files"));
    const std::string thin = "type: uint16\nendian: big\ndimension: 3\nsizes: 2 3 2000000000\n";
    CHECK_THAT(error("s%d 1", thin), Contains("too many data files"));
    CHECK_THAT(error("s%d 1 2000000000 1", thin), Contains("too many data files"));
    const Volume more = loadVolume(sourceOf(
        folder.write("b.nhdr", "NRRD0004\n" + kSizes + "encoding: raw\ndata file: LIST\ns0\nlong\ns2\nlong\n")));
    REQUIRE(more.notices.size() == 1);
    CHECK_THAT(more.notices[0], Contains("2 bytes more"));
}
