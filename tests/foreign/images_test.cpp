// TIFF stacks and folders of pictures through pellucid-tiff-reader and pellucid-image-reader.
#include <catch2/catch.hpp>

#include <array>
#include <cstring>
#include <filesystem>
#include <utility>

#include <zlib.h>

#include "support/dicom_writer.h"
#include "support/notices.h"
#include "support/reader_log.h"
#include "support/temp_folder.h"
#include "support/tiff_writer.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume/series.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

VolumeSource at(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return source;
}

/// Pages of 3 x 2 pixels of 16 bits: 100 n, 100 n + 1, …
std::vector<TiffPage> pages(int count, const std::string& description = "", int pixelsPerUnit = 0) {
    std::vector<TiffPage> all;
    for (int n = 0; n < count; ++n) {
        TiffPage page;
        std::vector<int> values;
        for (int i = 0; i < 6; ++i) values.push_back(100 * n + i);
        page.pixels = words(values);
        if (n == 0) page.description = description;
        page.pixelsPerUnit = pixelsPerUnit;
        all.push_back(page);
    }
    return all;
}

} // namespace

TEST_CASE("pages of a TIFF file are slices", "[images]") {
    const TempFolder folder;
    for (const char* name : {"a.tif", "stack"}) { // the name does not matter
        const Volume volume = loadVolume(at(folder.write(name, tiffFile(pages(4)))));
        CHECK(volume.dims() == Int3(3, 2, 4));
        CHECK(volume.sampleType() == SampleType::U16);
        CHECK(volume.geometry().spacing == Vec3(1));
        CHECK(volume.notices.empty());
        for (int z = 0; z < 4; ++z)
            for (int i = 0; i < 6; ++i) CHECK(volume.value(static_cast<std::size_t>(6 * z + i)) == 100 * z + i);
    }
}

TEST_CASE("numbers of TIFF files keep their type", "[images]") {
    const TempFolder folder;
    const auto load = [&](int bits, int format, const std::string& pixels) {
        TiffPage page;
        page.width = 2;
        page.height = 1;
        page.bits = bits;
        page.format = format;
        page.pixels = pixels;
        return loadVolume(at(folder.write("t.tif", tiffFile({page}))));
    };
    const auto bytesOf = [](auto a, auto b) {
        std::string bytes(2 * sizeof a, '\0');
        std::memcpy(bytes.data(), &a, sizeof a);
        std::memcpy(bytes.data() + sizeof a, &b, sizeof b);
        return bytes;
    };
    const auto check = [&](int bits, int format, auto a, auto b, SampleType type) {
        const Volume volume = load(bits, format, bytesOf(a, b));
        CHECK(volume.sampleType() == type);
        CHECK(volume.value(0) == static_cast<double>(a));
        CHECK(volume.value(1) == static_cast<double>(b));
    };
    check(8, 1, std::uint8_t{3}, std::uint8_t{255}, SampleType::U8);
    check(8, 2, std::int8_t{-3}, std::int8_t{127}, SampleType::I8);
    check(16, 1, std::uint16_t{3}, std::uint16_t{65535}, SampleType::U16);
    check(16, 2, std::int16_t{-300}, std::int16_t{300}, SampleType::I16);
    check(32, 1, std::uint32_t{3}, std::uint32_t{4000000000}, SampleType::U32);
    check(32, 2, std::int32_t{-70000}, std::int32_t{70000}, SampleType::I32);
    check(32, 3, 0.25f, -1e30f, SampleType::F32);
    check(64, 3, 0.1, -1e300, SampleType::F64);
}

TEST_CASE("colours of a TIFF file are components", "[images]") {
    const TempFolder folder;
    TiffPage page;
    page.bits = 8;
    page.samples = 3;
    for (int i = 0; i < 18; ++i) page.pixels += static_cast<char>(10 * i);
    const std::string path = folder.write("rgb.tif", tiffFile({page, page}));
    CHECK(contentsOf(at(path)).components == 3);
    VolumeSource blue = at(path);
    blue.component = 2;
    CHECK(loadVolume(blue).value(7) == 50); // second pixel of the second page: 10 · (3 + 2)
}

TEST_CASE("ImageJ says how pages follow each other and how far pixels are apart", "[images]") {
    const TempFolder folder;
    // Two channels, three slices, two steps: pages go by channel, slice, step. 4 pixels in a micrometre.
    const std::string description = "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\nframes=2\nhyperstack=true\n"
                                    "unit=micron\nfinterval=0.5\nspacing=2.5\nloop=false\n";
    const std::string path = folder.write("hyper.tif", tiffFile(pages(12, description, 4)));
    const FileContents contents = contentsOf(at(path));
    CHECK(contents.dims == Int3(3, 2, 3));
    CHECK(contents.components == 2);
    CHECK(contents.steps == 2);
    CHECK(contents.times == std::vector<double>{0, 0.5});
    for (int step = 0; step < 2; ++step)
        for (int channel = 0; channel < 2; ++channel) {
            VolumeSource source = at(path);
            source.step = step;
            source.component = channel;
            const Volume volume = loadVolume(source);
            CHECK(volume.geometry().spacing == Vec3(0.25, 0.25, 2.5));
            for (int z = 0; z < 3; ++z)
                CHECK(volume.value(static_cast<std::size_t>(6 * z)) == 100 * (channel + 2 * (z + 3 * step)));
        }
    const SeriesListing listing = listSeries(at(path));
    CHECK(listing.frames.size() == 2);
    // A file that has other pages than it says shows them all.
    const Volume fewer = loadVolume(at(folder.write("cut.tif", tiffFile(pages(5, description, 4)))));
    CHECK(fewer.dims().z == 5);
    CHECK(hasNotice(fewer, "says that it has 12 pictures, but it has 5"));
}

TEST_CASE("OME-XML says how pages follow each other and how far pixels are apart", "[images]") {
    const TempFolder folder;
    const std::string description =
        "<?xml version=\"1.0\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image ID=\"Image:0\">"
        "<Pixels ID=\"Pixels:0\" DimensionOrder=\"XYZCT\" Type=\"uint16\" SizeX=\"3\" SizeY=\"2\" SizeZ=\"2\" "
        "SizeC=\"2\" "
        "SizeT=\"1\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" PhysicalSizeZ=\"1500\" "
        "PhysicalSizeZUnit=\"nm\"/></Image>"
        "</OME>";
    const std::string path = folder.write("a.ome.tif", tiffFile(pages(4, description)));
    VolumeSource source = at(path);
    source.component = 1;
    const Volume volume = loadVolume(source);
    CHECK(volume.dims() == Int3(3, 2, 2));
    CHECK(volume.geometry().spacing == Vec3(0.5, 0.5, 1.5));
    CHECK(volume.value(0) == 200); // slices first, then channels
    CHECK(volume.value(6) == 300);
    // Orders that are none are read as this one.
    for (const char* order : {"XYZZZ", "XYZC", "CTXYZ", ""}) {
        std::string other = description;
        other.replace(other.find("XYZCT"), 5, order);
        source.path = folder.write("b.ome.tif", tiffFile(pages(4, other)));
        CHECK(loadVolume(source).value(6) == 300);
    }
}

TEST_CASE("a folder of pictures is one volume, in the order in which people count", "[images]") {
    const TempFolder folder;
    fs::create_directory(folder.path("slices"));
    for (const int n : {1, 2, 10})
        folder.write("slices/s" + std::to_string(n) + ".tif", tiffFile({pages(n + 1).back()}));
    folder.write("slices/notes.txt", "Three slices.");
    const SeriesListing listing = listSeries(at(folder.path("slices")));
    REQUIRE(listing.frames.size() == 1);
    const Volume volume = loadVolume(listing.frames[0].source);
    CHECK(volume.dims() == Int3(3, 2, 3));
    CHECK(volume.value(0) == 100);
    CHECK(volume.value(6) == 200);
    CHECK(volume.value(12) == 1000);
    // A picture of another size is named.
    TiffPage other;
    other.width = 1;
    other.height = 1;
    other.pixels = words({1});
    folder.write("slices/s11.tif", tiffFile({other}));
    CHECK_THROWS_WITH(loadVolume(at(folder.path("slices"))), Contains("not alike") && Contains("s11.tif"));
    // Files of several pages are volumes by themselves: frames of a series.
    fs::create_directory(folder.path("frames"));
    for (const char* name : {"frames/t1.tif", "frames/t2.tif"}) folder.write(name, tiffFile(pages(3)));
    CHECK(listSeries(at(folder.path("frames"))).frames.size() == 2);
}

TEST_CASE("pixels that stand in a TIFF file as they are are read there, without the library", "[images]") {
    const TempFolder folder;
    const ReaderLog log(folder, "pellucid-tiff-reader");
    // The volume, and whether the reader has said where its values are.
    const auto load = [&](const std::string& bytes, int step = 0) {
        log.clear();
        VolumeSource source = at(folder.write("a.tif", bytes));
        source.step = step;
        Volume volume = loadVolume(source);
        return std::pair{std::move(volume), log.namesPlaces()};
    };
    const auto isRight = [](const Volume& volume, int first = 0) {
        bool right = volume.dims() == Int3(3, 2, 4);
        for (int z = 0; right && z < 4; ++z)
            for (int i = 0; i < 6; ++i)
                right &= volume.value(static_cast<std::size_t>(6 * z + i)) == 100 * (z + first) + i;
        return right;
    };
    SECTION("in strips of one row or of all, one page behind the other") {
        for (const int rows : {0, 1}) {
            const auto [volume, isInFile] = load(tiffFile(pages(4), {false, true, rows}));
            CHECK(isInFile);
            CHECK(isRight(volume));
        }
    }
    SECTION("in the other order of bytes") {
        std::vector<TiffPage> swapped = pages(4);
        for (TiffPage& page : swapped)
            for (std::size_t i = 0; i < page.pixels.size(); i += 2) std::swap(page.pixels[i], page.pixels[i + 1]);
        const auto [volume, isInFile] = load(tiffFile(swapped, {true, true}));
        CHECK(isInFile);
        CHECK(isRight(volume));
        const auto [apart, isThere] = load(tiffFile(swapped, {true, false}));
        CHECK(isThere);
        CHECK(isRight(apart));
    }
    SECTION("of a step and of a region") {
        const std::string steps = "ImageJ=1.53t\nimages=8\nslices=4\nframes=2\nhyperstack=true\n";
        const std::string bytes = tiffFile(pages(8, steps), {false, true});
        const auto [volume, isInFile] = load(bytes, 1);
        CHECK(isInFile);
        CHECK(isRight(volume, 4));
        VolumeSource part = at(folder.path("a.tif"));
        part.step = 1;
        part.region = VoxelRegion{{1, 1, 2}, {3, 2, 4}};
        const Volume region = loadVolume(part);
        CHECK(region.dims() == Int3(2, 1, 2));
        CHECK(region.value(0) == 604); // page 4 + 2, pixel 3 + 1
        CHECK(region.value(3) == 705);
    }
    SECTION("between directories") {
        const auto [volume, isInFile] = load(tiffFile(pages(4)));
        CHECK(isInFile);
        CHECK(isRight(volume));
        VolumeSource part = at(folder.path("a.tif"));
        part.region = VoxelRegion{{1, 0, 1}, {3, 2, 4}};
        CHECK(loadVolume(part).value(5) == 202); // page 2, pixel 2
        part.region.reset();
        part.downsample = 2;
        CHECK(loadVolume(part).dims() == Int3(2, 1, 2));
    }
    SECTION("channels are components, whether they follow slices or take turns with them") {
        for (const bool inTurn : {false, true}) {
            const std::string order = inTurn ? "XYCZT" : "XYZCT";
            const std::string words =
                "<?xml version=\"1.0\"?><OME><Image ID=\"Image:0\"><Pixels ID=\"Pixels:0\" DimensionOrder=\"" + order +
                "\" Type=\"uint16\" SizeX=\"3\" SizeY=\"2\" SizeZ=\"2\" SizeC=\"2\" SizeT=\"1\"><TiffData/>"
                "</Pixels></Image></OME>";
            const std::string bytes = tiffFile(pages(4, words), {false, true});
            CHECK(load(bytes).second);
            VolumeSource second = at(folder.path("a.tif"));
            second.component = 1;
            const Volume volume = loadVolume(second);
            CHECK(volume.value(0) == (inTurn ? 100 : 200));
            CHECK(volume.value(6) == 300);
        }
    }
    SECTION("of a large stack of ImageJ, which has a directory of its first page alone") {
        const std::string words = "ImageJ=1.53t\nimages=4\nslices=4\n";
        const auto [volume, isInFile] = load(tiffFile(pages(4, words), {.pixelsTogether = true, .oneDirectory = true}));
        CHECK(isInFile);
        CHECK(isRight(volume));
        CHECK(volume.notices.empty());
        const std::string turns = "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\nhyperstack=true\n";
        CHECK(load(tiffFile(pages(4, turns), {.pixelsTogether = true, .oneDirectory = true})).second);
        VolumeSource second = at(folder.path("a.tif"));
        second.component = 1;
        const Volume channel = loadVolume(second);
        CHECK(channel.dims() == Int3(3, 2, 2));
        CHECK(channel.value(0) == 100);
        CHECK(channel.value(11) == 305);
        // Fewer than it says.
        const std::string more = "ImageJ=1.53t\nimages=400\nslices=400\n";
        const Volume cut = load(tiffFile(pages(3, more), {.pixelsTogether = true, .oneDirectory = true})).first;
        CHECK(cut.dims().z == 1);
        CHECK(hasNotice(cut, "says that it has 400 pictures, but it has 1"));
    }
    SECTION("not where they are packed") {
        std::vector<TiffPage> packed = pages(1);
        std::array<unsigned char, 64> room{};
        uLongf count = room.size();
        REQUIRE(compress(room.data(), &count, reinterpret_cast<const unsigned char*>(packed[0].pixels.data()),
                         packed[0].pixels.size()) == Z_OK);
        packed[0].pixels.assign(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(count));
        packed[0].compression = 8;
        const auto [volume, isInFile] = load(tiffFile(packed, {false, true}));
        CHECK_FALSE(isInFile);
        CHECK(volume.value(5) == 5);
    }
    SECTION("what a reader says of the place is held against the file") {
        const std::string path = folder.write("a.tif", tiffFile(pages(4), {false, true}));
        const auto say = [&](const std::string& start) {
            folder.write("reader.sh",
                         "#!/bin/sh\nread line; echo '{\"layout\":{\"axes\":[{\"size\":3,\"components\":false,\"time\":"
                         "false},{\"size\":8,\"components\":false,\"time\":false}],\"type\":2,\"spacing\":[1,1,1],"
                         "\"origin\":[0,0,0],\"directions\":[[1,0,0],[0,1,0],[0,0,1]],\"patient\":false,\"array\":\"\","
                         "\"layers_at_once\":1,\"notices\":[],\"in_file\":{\"starts\":[" +
                             start + "],\"big_endian\":false}}}'; sleep 100\n");
        };
        say("8");
        CHECK(loadVolume(at(path)).value(23) == 305);  // nobody asks the reader for it
        say(std::to_string(fs::file_size(path) - 47)); // of the 48 bytes
        CHECK_THROWS_WITH(loadVolume(at(path)), Contains("the data has 47 of 48 bytes"));
        say(std::to_string(fs::file_size(path) + 1));
        CHECK_THROWS_WITH(loadVolume(at(path)), Contains("behind the end of the file"));
        say("-1");
        CHECK_THROWS_AS(loadVolume(at(path)), Error);
    }
}

TEST_CASE("what is wrong with a TIFF file is told", "[images]") {
    const TempFolder folder;
    const std::string whole = tiffFile(pages(3));
    CHECK_THROWS_WITH(loadVolume(at(folder.write("cut.tif", whole.substr(0, 20)))), Contains("cut.tif"));
    CHECK_THROWS_WITH(loadVolume(at(folder.write("text.tif", "Dear reader"))), Contains("not a TIFF image but text"));
    // The pixels of the last page lie beyond the end of the file.
    std::vector<TiffPage> broken = pages(2);
    broken[1].height = 2000;
    CHECK_THROWS_AS(loadVolume(at(folder.write("broken.tif", tiffFile({broken[1]})))), FileError);
    VolumeSource named = at(folder.write("a.tif", whole));
    named.array = "x";
    CHECK_THROWS_AS(loadVolume(named), UsageError);
}

TEST_CASE("a flipped bit in a deflated TIFF file is refused or leaves the voxels as they are", "[images]") {
    const TempFolder folder;
    std::vector<unsigned char> values(64 * 64);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<unsigned char>(i * i / 97);
    uLongf bytes = compressBound(values.size());
    std::vector<unsigned char> packed(bytes);
    REQUIRE(compress(packed.data(), &bytes, values.data(), values.size()) == Z_OK);
    TiffPage page;
    page.width = page.height = 64;
    page.bits = 8;
    page.compression = 8;
    page.pixels.assign(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(bytes));
    const std::string whole = tiffFile({page});
    const std::size_t first = whole.find(page.pixels);
    const Volume sound = loadVolume(at(folder.write("sound.tif", whole)));
    CHECK(sound.value(4095) == values[4095]);
    for (std::size_t bit = 0; bit < 60; ++bit) {
        std::string damaged = whole;
        const std::size_t at_ = first + bit * 7919 % bytes;
        damaged[at_] = static_cast<char>(damaged[at_] ^ (1 << bit % 8));
        CAPTURE(at_ - first, bit % 8);
        try {
            const Volume read = loadVolume(at(folder.write("damaged.tif", damaged)));
            CHECK(read.samples() == sound.samples());
        } catch (const FileError& error) {
            CHECK_THAT(error.what(), Contains("damaged.tif"));
        }
    }
}
