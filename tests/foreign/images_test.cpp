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

/// OME-XML of one image: `attributes` of its pixels, besides their type and size, and the elements in them.
std::string omeImage(const std::string& attributes, const std::string& elements) {
    return "<Image ID=\"Image:0\" Name=\"cells\"><Pixels ID=\"Pixels:0\" Type=\"uint16\" SizeX=\"3\" SizeY=\"2\" " +
           attributes + ">" + elements + "</Pixels></Image>";
}
std::string ome(const std::string& images, const std::string& attributes = "") {
    return "<?xml version=\"1.0\"?><!-- <Pixels SizeZ=\"9\"> is no tag here --><OME " + attributes + ">" + images +
           "</OME>";
}
/// The page that each slice is, as pages() numbers them.
std::vector<int> pagesOf(const Volume& volume) {
    std::vector<int> all;
    for (int z = 0; z < volume.dims().z; ++z)
        all.push_back(static_cast<int>(volume.value(static_cast<std::size_t>(6 * z))) / 100);
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
            CHECK(volume.geometry().lengthUnit == LengthUnit::Micrometre);
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
    CHECK(volume.geometry().lengthUnit == LengthUnit::Micrometre); // which OME means where it names none
    CHECK(volume.value(0) == 200);                                 // slices first, then channels
    CHECK(volume.value(6) == 300);
    // Orders that are none are read as this one.
    for (const char* order : {"XYZZZ", "XYZC", "CTXYZ", ""}) {
        std::string other = description;
        other.replace(other.find("XYZCT"), 5, order);
        source.path = folder.write("b.ome.tif", tiffFile(pages(4, other)));
        CHECK(loadVolume(source).value(6) == 300);
    }
}

TEST_CASE("ImageJ's calibration of values is applied where it is a straight line", "[images]") {
    const TempFolder folder;
    const auto load = [&](const std::string& fields, int format = 1) {
        std::vector<TiffPage> all = pages(2, "ImageJ=1.53t\nimages=2\nslices=2\n" + fields);
        for (TiffPage& page : all) page.format = format;
        return loadVolume(at(folder.write("calibrated.tif", tiffFile(all))));
    };
    // As ImageJ writes signed numbers of 16 bits: 32 768 larger.
    const std::string line = "cf=0\nc0=-32768.0\nc1=1.0\nvunit=Gray Value\n";
    const Volume lowered = load(line);
    CHECK(lowered.value(0) == -32768);
    CHECK(lowered.value(11) == 105 - 32768);
    CHECK(lowered.notices.empty());
    // It reads signed ones as that, too: these are what they are.
    const Volume isSigned = load(line, 2);
    CHECK(isSigned.sampleType() == SampleType::I16);
    CHECK(isSigned.value(11) == 105);
    CHECK(load("cf=0\nc0=10\nc1=0.5\nvunit=OD\n").value(11) == 62.5);
    const Volume clipped = load("cf=0\nc0=-100\nc1=1\nvunit=OD\nzeroclip=true\n");
    CHECK(clipped.value(0) == -100);
    CHECK(hasNotice(clipped, "zeroclip"));
    for (const char* other : {"cf=3\nc0=1\nc1=2\nc2=3\nvunit=OD\n", "cf=21\nvunit=OD\n", "cf=0\nc0=1\nvunit=OD\n",
                              "cf=0\nc0=1\nc1=0\nvunit=OD\n"}) {
        const Volume stored = load(other);
        CHECK(stored.sampleType() == SampleType::U16);
        CHECK(stored.value(11) == 105);
        CHECK(hasNotice(stored, "the stored values are shown"));
    }
    CHECK(load("cf=20\nvunit=Gray Value\n").notices.empty()); // none
}

TEST_CASE("distances and times of ImageJ are converted to one unit", "[images]") {
    const TempFolder folder;
    const auto load = [&](const std::string& fields) { // 4 pixels in a unit
        return loadVolume(
            at(folder.write("units.tif", tiffFile(pages(2, "ImageJ=1.53t\nimages=2\nslices=2\n" + fields, 4)))));
    };
    const Volume down = load("unit=um\nspacing=-3.0\n");
    CHECK(down.geometry().spacing == Vec3(0.25, 0.25, 3));
    CHECK(down.notices.empty());
    CHECK(load("unit=\\u00B5m\nyunit=mm\nzunit=nm\nspacing=500\n").geometry().spacing == Vec3(0.25, 250, 0.5));
    const Volume strange = load("unit=micron\nzunit=furlong\nspacing=2\n");
    CHECK(strange.geometry().spacing == Vec3(0.25, 0.25, 2));
    CHECK(strange.geometry().lengthUnit == LengthUnit::Unknown);
    CHECK(hasNotice(strange, "'furlong'"));
    const Volume without = load("unit=um\n"); // ImageJ writes no spacing of 1
    CHECK(without.geometry().spacing == Vec3(0.25, 0.25, 1));
    CHECK(hasNotice(without, "how far slices are apart"));
    const std::string steps = "ImageJ=1.53t\nimages=2\nframes=2\nfinterval=250\ntunit=";
    CHECK(contentsOf(at(folder.write("ms.tif", tiffFile(pages(2, steps + "ms\n"))))).times ==
          std::vector<double>{0, 0.25});
    const std::string moons = folder.write("moons.tif", tiffFile(pages(2, steps + "moons\n")));
    CHECK(contentsOf(at(moons)).times.empty());
    CHECK(hasNotice(loadVolume(at(moons)), "'moons'"));
}

TEST_CASE("pages of OME-TIFF are the pictures that TiffData says", "[images]") {
    const TempFolder folder;
    const auto load = [&](int count, const std::string& text, int component = 0, int step = 0) {
        VolumeSource source = at(folder.write("a.ome.tif", tiffFile(pages(count, text))));
        source.component = component;
        source.step = step;
        return loadVolume(source);
    };
    const auto data = [](int page, int z, int c, int t, const std::string& rest = "/>") {
        return "<TiffData IFD=\"" + std::to_string(page) + "\" FirstZ=\"" + std::to_string(z) + "\" FirstC=\"" +
               std::to_string(c) + "\" FirstT='" + std::to_string(t) + "'" + rest;
    };
    const std::string stack = "DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\"";
    const std::string places = "DimensionOrder=\"XYZCT\" SizeZ=\"2\" SizeC=\"2\" SizeT=\"2\"";
    SECTION("in any order") {
        const Volume turned = load(3, ome(omeImage(stack, data(2, 0, 0, 0) + data(1, 1, 0, 0) + data(0, 2, 0, 0))));
        CHECK(pagesOf(turned) == std::vector{2, 1, 0});
        CHECK(turned.notices.empty());
        // Steps stand in the file from the last to the first, each with its slices, then its channels.
        const std::string text =
            ome(omeImage(places, data(0, 0, 0, 1, " PlaneCount=\"4\"/>") + data(4, 0, 0, 0, " PlaneCount=\"4\"/>")));
        CHECK(pagesOf(load(8, text, 1, 0)) == std::vector{6, 7});
        CHECK(pagesOf(load(8, text, 0, 1)) == std::vector{0, 1});
        const std::string names = ome("<OME:Image><OME:Pixels SizeZ=\"2\"><OME:TiffData IFD=\"1\"/><OME:TiffData "
                                      "IFD=\"0\" FirstZ=\"1\"/></OME:Pixels></OME:Image>");
        CHECK(pagesOf(load(2, names)) == std::vector{1, 0});
    }
    SECTION("with units in XML's own letters") {
        const std::string sized = stack + " PhysicalSizeX=\"500\" PhysicalSizeXUnit=\"nm\" PhysicalSizeY=\"500\" "
                                          "PhysicalSizeYUnit=\"nm\" PhysicalSizeZ=\"2\" PhysicalSizeZUnit=\"&#181;m\"";
        const Volume micro = load(3, ome(omeImage(sized, "")));
        CHECK(micro.geometry().spacing.z == Approx(4 * micro.geometry().spacing.x)); // 2 µm and 500 nm
    }
    SECTION("not more and not twice") {
        const Volume fewer = load(2, ome(omeImage(stack, "<TiffData IFD=\"0\" PlaneCount=\"3\"/>")));
        CHECK(pagesOf(fewer) == std::vector{0, 1});
        CHECK(hasNotice(fewer, "says that it has 3 pictures, but it has 2"));
        const Volume more = load(5, ome(omeImage(stack, "<TiffData IFD=\"1\" PlaneCount=\"3\"/>")));
        CHECK(pagesOf(more) == std::vector{1, 2, 3});
        CHECK(hasNotice(more, "2 pages do not belong to this image"));
        const Volume twice = load(4, ome(omeImage(stack, "<TiffData IFD=\"1\" PlaneCount=\"3\"/>" + data(0, 0, 0, 0))));
        CHECK(pagesOf(twice) == std::vector{1, 2, 3});
        CHECK(hasNotice(twice, "several pages for the same picture"));
        CHECK_THROWS_WITH(load(2, ome(omeImage(stack, data(7, 0, 0, 0)))),
                          Contains("names pages that it does not have"));
    }
    SECTION("of the first image") {
        const std::string first = omeImage(stack, "<TiffData IFD=\"0\" PlaneCount=\"3\"/>");
        const Volume one = load(6, ome(first + omeImage(stack, "<TiffData IFD=\"3\" PlaneCount=\"3\"/>")));
        CHECK(pagesOf(one) == std::vector{0, 1, 2});
        CHECK(hasNotice(one, "image 1 of 2, 'cells', is shown"));
        // A name is cut to 40 bytes, which are 13 of these letters and one byte.
        std::string longer = first, name;
        for (int i = 0; i < 14; ++i) name += "細";
        longer.replace(longer.find("cells"), 5, name);
        const Volume named = load(6, ome(longer + omeImage(stack, "<TiffData IFD=\"3\" PlaneCount=\"3\"/>")));
        CHECK(hasNotice(named, "image 1 of 2, '" + name.substr(0, 39) + "…', is shown"));
        const Volume last = load(6, ome(omeImage(stack, "<TiffData IFD=\"3\" PlaneCount=\"3\"/>") + first));
        CHECK(pagesOf(last) == std::vector{3, 4, 5});
        CHECK(pagesOf(load(6, ome(omeImage(stack, "") + omeImage(stack, "")))) == std::vector{0, 1, 2});
    }
    SECTION("of the image that is chosen") {
        // Of 3 and 2 slices, 5 and 7 nm wide: pages 0 to 2, and 3 and 4. The third is in another file.
        const auto image = [&](const std::string& name, const std::string& pixels, const std::string& elements) {
            std::string text = omeImage(pixels, elements);
            return text.replace(text.find("cells"), 5, name);
        };
        const std::string text =
            ome(image("A &amp; B", stack + " PhysicalSizeX=\"5\" PhysicalSizeY=\"5\" PhysicalSizeZ=\"5\"",
                      "<TiffData IFD=\"0\" PlaneCount=\"3\"/>") +
                image("", "SizeZ=\"2\" SizeT=\"1\" PhysicalSizeX=\"7\" PhysicalSizeY=\"7\" PhysicalSizeZ=\"9\"",
                      "<TiffData IFD=\"3\" PlaneCount=\"2\"/>") +
                image("A &amp; B", "SizeZ=\"1\" SizeC=\"2\"",
                      "<TiffData IFD=\"0\"><UUID FileName=\"b.ome.tif\">urn:uuid:b</UUID></TiffData>"));
        VolumeSource source = at(folder.write("a.ome.tif", tiffFile(pages(5, text))));
        CHECK(mayHoldSeveral(source.path));
        const FileContents contents = contentsOf(source);
        CHECK(contents.arrays == std::vector<std::string>{"A & B", "image 2", "A & B (2)"});
        CHECK(contents.array == "A & B");
        CHECK(contents.details ==
              std::vector<std::string>{"3 × 2 × 3, u16", "3 × 2 × 2, u16", "3 × 2 × 1, u16, 2 channels, in b.ome.tif"});
        for (const char* wanted : {"image 2", "2"}) {
            source.array = wanted;
            const Volume second = loadVolume(source);
            CHECK(pagesOf(second) == std::vector{3, 4});
            CHECK(second.geometry().spacing == Vec3(7, 7, 9));
            CHECK(second.notices.empty());
            CHECK(loadMiddleSlice(source).value(0) == 400);
            CHECK(contentsOf(source).array == "image 2");
        }
        source.array = "A & B";
        CHECK(pagesOf(loadVolume(source)) == std::vector{0, 1, 2});
        source.array = "C";
        CHECK_THROWS_WITH(loadVolume(source), Contains("no image 'C'") && Contains("'A & B', 'image 2', 'A & B (2)'"));
        source.array = "A & B (2)";
        CHECK_THROWS_WITH(loadVolume(source), Contains("is not in this file") && Contains("open b.ome.tif"));
        // The first image that is in this file is opened, not the pages of this file as the first one.
        const auto in = [&](const std::string& name, int slices, const std::string& file) {
            return image(name, "SizeZ=\"" + std::to_string(slices) + "\"",
                         "<TiffData><UUID FileName=\"" + file + "\">urn:uuid:" + file + "</UUID></TiffData>");
        };
        const Volume own = load(2, ome(in("one", 3, "b.ome.tif") + in("two", 2, "a.ome.tif")));
        CHECK(pagesOf(own) == std::vector{0, 1});
        CHECK(hasNotice(own, "image 2 of 2, 'two', is shown"));
        // Under another name it may be either.
        const Volume either = load(2, ome(in("one", 3, "b.ome.tif") + in("two", 2, "c.ome.tif")));
        CHECK(pagesOf(either) == std::vector{0, 1});
        CHECK(hasNotice(either, "other files (b.ome.tif, c.ome.tif) but not one of this name"));
        // Which pages the second image has is not said.
        source = at(folder.write("a.ome.tif", tiffFile(pages(6, ome(omeImage(stack, "") + omeImage(stack, ""))))));
        source.array = "2";
        CHECK_THROWS_WITH(loadVolume(source), Contains("does not say which pages are those of image 2 of 2"));
        // One image has a name, too; others have none.
        source = at(folder.write("a.ome.tif", tiffFile(pages(3, ome(omeImage(stack, ""))))));
        CHECK(contentsOf(source).arrays.empty());
        source.array = "cells";
        CHECK(pagesOf(loadVolume(source)) == std::vector{0, 1, 2});
        source = at(folder.write("a.tif", tiffFile(pages(3))));
        source.array = "cells";
        CHECK_THROWS_WITH(loadVolume(source), Contains("pictures have no names"));
    }
    SECTION("where others are in other files") {
        const auto in = [](const std::string& file, const std::string& uuid) {
            return "><UUID FileName=\"" + file + "\">" + uuid + "</UUID></TiffData>";
        };
        // A file for each slice.
        std::string slices;
        for (int z = 0; z < 3; ++z) slices += data(0, z, 0, 0, in("abc"[z] + std::string(".ome.tif"), ""));
        const Volume slice = load(1, ome(omeImage(stack, slices)));
        CHECK(slice.dims() == Int3(3, 2, 1));
        CHECK(hasNotice(slice, "2 of 3 pictures are in other files and are not shown: b.ome.tif, c.ome.tif"));
        // A file for each step, of which the second is this one: its slices and channels are what they are.
        const std::string steps = "<TiffData FirstT=\"0\"" + in("t0.ome.tif", "urn:uuid:0") + "<TiffData FirstT=\"1\"" +
                                  in("t1.ome.tif", "urn:uuid:1");
        const Volume step = load(4, ome(omeImage(places, steps), "UUID=\"urn:uuid:1\""), 1);
        CHECK(pagesOf(step) == std::vector{2, 3});
        CHECK(hasNotice(step, "4 of 8 pictures are in other files and are not shown: t0.ome.tif"));
        // Every second slice: they are twice as far apart.
        const std::string far = "DimensionOrder=\"XYZCT\" SizeZ=\"4\" PhysicalSizeX=\"1\" PhysicalSizeY=\"1\" "
                                "PhysicalSizeZ=\"1.5\"";
        const Volume even =
            load(2, ome(omeImage(far, data(0, 0, 0, 0) + data(1, 2, 0, 0) +
                                          data(0, 1, 0, 0, " PlaneCount=\"1\"" + in("b.ome.tif", "2")) +
                                          data(1, 3, 0, 0, " PlaneCount=\"1\"" + in("b.ome.tif", "2")))));
        CHECK(pagesOf(even) == std::vector{0, 1});
        CHECK(even.geometry().spacing == Vec3(1, 1, 3));
        // All are in one file, which has got another name.
        const Volume renamed = load(3, ome(omeImage(stack, "<TiffData" + in("old.ome.tif", "urn:uuid:1"))));
        CHECK(pagesOf(renamed) == std::vector{0, 1, 2});
        CHECK(renamed.notices.empty());
        // Which of several is this one nobody knows.
        const std::string others = data(0, 0, 0, 0, in("x.ome.tif", "1")) + data(0, 1, 0, 0, in("y.ome.tif", "2"));
        const Volume unknown = load(2, ome(omeImage(stack, others)));
        CHECK(pagesOf(unknown) == std::vector{0, 1});
        CHECK(hasNotice(unknown, "other files (x.ome.tif, y.ome.tif)"));
        const Volume apart = load(2, ome("<BinaryOnly MetadataFile=\"all.companion.ome\" UUID=\"urn:uuid:1\"/>"));
        CHECK(hasNotice(apart, "'all.companion.ome'"));
    }
}

TEST_CASE("times and distances of OME-XML are converted, and what is not known is said", "[images]") {
    const TempFolder folder;
    const auto file = [&](const std::string& attributes) {
        return at(folder.write("a.ome.tif", tiffFile(pages(2, ome(omeImage(attributes, ""))))));
    };
    for (const auto& [unit, seconds] : {std::pair{"", 3.0},
                                        {"TimeIncrementUnit=\"s\"", 3.0},
                                        {"TimeIncrementUnit=\"ms\"", 0.003},
                                        {"TimeIncrementUnit=\"µs\"", 3e-6},
                                        {"TimeIncrementUnit=\"min\"", 180.0},
                                        {"TimeIncrementUnit=\"h\"", 10800.0}}) {
        const FileContents contents =
            contentsOf(file("SizeZ=\"1\" SizeT=\"2\" TimeIncrement=\"3\" " + std::string(unit)));
        REQUIRE(contents.times.size() == 2);
        CHECK(contents.times[1] == Approx(seconds));
        CHECK(contents.timeUnit == "s");
    }
    // All in the unit of x.
    const std::string stack = "SizeZ=\"2\" PhysicalSizeXUnit=\"nm\" PhysicalSizeX=\"65\" ";
    const Volume flat = loadVolume(file(stack + "PhysicalSizeYUnit=\"nm\" PhysicalSizeY=\"65\""));
    CHECK(flat.geometry().spacing == Vec3(65, 65, 65));
    CHECK(hasNotice(flat, "how far voxels are apart along z"));
    const Volume full = loadVolume(file(stack + "PhysicalSizeY=\"0.5\" PhysicalSizeZ=\"2\"")); // micrometres
    CHECK(full.geometry().spacing == Vec3(65, 500, 2000));
    CHECK(full.geometry().lengthUnit == LengthUnit::Nanometre);
    CHECK(full.notices.empty());
    const Volume pixels = loadVolume(file(stack + "PhysicalSizeY=\"65\" PhysicalSizeYUnit=\"nm\" PhysicalSizeZ=\"2\" "
                                                  "PhysicalSizeZUnit=\"pixel\""));
    CHECK(pixels.geometry().spacing == Vec3(65, 65, 2));
    CHECK(hasNotice(pixels, "'pixel'"));
}

TEST_CASE("colours of OME-TIFF are no pages", "[images]") {
    const TempFolder folder;
    std::vector<TiffPage> all;
    for (int n = 0; n < 4; ++n) {
        TiffPage page;
        page.bits = 8;
        page.samples = 3;
        for (int i = 0; i < 18; ++i) page.pixels += static_cast<char>(50 * n + i);
        all.push_back(page);
    }
    for (const char* data : {"", "<TiffData IFD=\"0\" PlaneCount=\"4\"/>"}) {
        all[0].description = ome(omeImage("DimensionOrder=\"XYCZT\" SizeZ=\"2\" SizeC=\"3\" SizeT=\"2\"",
                                          "<Channel ID=\"c\" SamplesPerPixel=\"3\"/>" + std::string(data)));
        VolumeSource source = at(folder.write("rgb.ome.tif", tiffFile(all)));
        const FileContents contents = contentsOf(source);
        CHECK(contents.dims == Int3(3, 2, 2));
        CHECK(contents.components == 3);
        CHECK(contents.steps == 2);
        source.step = 1;
        source.component = 2;
        const Volume blue = loadVolume(source);
        CHECK(blue.value(6) == 152); // page 3, the third sample
        CHECK(blue.notices == std::vector<std::string>{"component 2 of 3 is shown"});
    }
}

TEST_CASE("pixels of one bit are 0 and 1", "[images]") {
    const TempFolder folder;
    TiffPage page;
    page.width = 10;
    page.height = 2;
    page.bits = 1;
    page.pixels = "\xa0\x40\x01\x80"; // 1010000001, 0000000110
    for (const int rows : {0, 1}) {
        const Volume mask = loadVolume(at(folder.write("mask.tif", tiffFile({page, page}, {.rowsPerStrip = rows}))));
        CHECK(mask.sampleType() == SampleType::U8);
        CHECK(mask.dims() == Int3(10, 2, 2));
        std::string bits;
        for (std::size_t i = 0; i < 40; ++i) bits += mask.value(i) == 1 ? '1' : mask.value(i) == 0 ? '0' : '?';
        CHECK(bits == "10100000010000000110"
                      "10100000010000000110");
        CHECK(mask.notices.empty());
    }
    // Beside pages of bytes they are of another kind.
    TiffPage bytes;
    bytes.width = 10;
    bytes.bits = 8;
    bytes.pixels = std::string(20, '\2');
    CHECK(
        hasNotice(loadVolume(at(folder.write("both.tif", tiffFile({bytes, page})))), "1 page of another size or type"));
}

TEST_CASE("pictures that are meant to be shown another way say so", "[images]") {
    const TempFolder folder;
    const auto load = [&](int photometric, int orientation) {
        std::vector<TiffPage> all = pages(2);
        for (TiffPage& page : all) {
            page.photometric = photometric;
            page.orientation = orientation;
        }
        Volume volume = loadVolume(at(folder.write("a.tif", tiffFile(all))));
        CHECK(pagesOf(volume) == std::vector{0, 1}); // as stored
        CHECK(volume.value(5) == 5);
        return volume;
    };
    CHECK(load(1, 1).notices.empty());
    CHECK(hasNotice(load(0, 1), "MINISWHITE"));
    CHECK(hasNotice(load(1, 4), "mirrored from top to bottom (Orientation 4)"));
    CHECK(hasNotice(load(1, 6), "turned by 90° clockwise (Orientation 6)"));
    CHECK(load(1, 8).notices.size() == 1); // not once for each page
}

TEST_CASE("a picture that is missing in a folder is named", "[images]") {
    const TempFolder folder;
    fs::create_directory(folder.path("slices"));
    for (const char* name : {"slices/img001.tif", "slices/img002.tif", "slices/img004.tif"})
        folder.write(name, tiffFile({pages(1).back()}));
    CHECK(hasNotice(loadVolume(at(folder.path("slices"))),
                    "1 picture is missing between the numbered ones (img003.tif)"));
    folder.write("slices/img003.tif", tiffFile({pages(1).back()}));
    CHECK(loadVolume(at(folder.path("slices"))).notices.empty());
    folder.write("slices/img900.tif", tiffFile({pages(1).back()}));
    CHECK(hasNotice(loadVolume(at(folder.path("slices"))), "895 pictures are missing between the numbered ones:"));
}

TEST_CASE("pictures of a folder are as far apart as they say", "[images]") {
    const auto load = [](const std::vector<std::pair<std::string, int>>& files,
                         const std::optional<GridSpacing>& spacing = {}) {
        const TempFolder folder;
        fs::create_directory(folder.path("slices"));
        for (std::size_t n = 0; n < files.size(); ++n)
            folder.write("slices/s" + std::to_string(n) + ".tif", tiffFile(pages(1, files[n].first, files[n].second)));
        VolumeSource source = at(folder.path("slices"));
        source.spacing = spacing;
        return loadVolume(source);
    };
    const std::string imageJ = "ImageJ=1.53t\nunit=micron\n";
    // 4 pixels to a micrometre.
    const Volume all = load({{imageJ + "spacing=1.5\n", 4}, {imageJ + "spacing=1.5\n", 4}});
    CHECK(all.geometry().spacing == Vec3(0.25, 0.25, 1.5));
    CHECK(all.notices.empty());
    const Volume open = load({{imageJ, 4}, {imageJ, 4}});
    CHECK(open.geometry().spacing == Vec3(0.25, 0.25, 1));
    CHECK(hasNotice(open, "do not say how far slices are apart: 1 is taken"));
    const Volume told = load({{imageJ, 4}, {imageJ, 4}}, GridSpacing{{0.25, 0.25, 2}});
    CHECK(told.geometry().spacing == Vec3(0.25, 0.25, 2));
    CHECK(told.notices.empty());
    for (const auto& other : {std::pair(imageJ, 5), std::pair(std::string(), 4)}) {
        const Volume differ = load({{imageJ, 4}, {imageJ, 4}, other});
        CHECK(differ.geometry().spacing == Vec3(0.25, 0.25, 1));
        CHECK(hasNotice(differ, "s2.tif says another distance between pixels than s0.tif"));
    }
    const Volume apart = load({{imageJ + "spacing=2\n", 4}, {imageJ + "spacing=3\n", 4}});
    CHECK(apart.geometry().spacing == Vec3(0.25, 0.25, 2));
    CHECK(hasNotice(apart, "s1.tif says another distance"));
    // 4 pixels to a millimetre, and 4000 to a metre.
    CHECK(hasNotice(load({{imageJ, 4}, {"ImageJ=1.53t\nunit=mm\n", 4}}), "s1.tif says another distance"));
    CHECK_FALSE(
        hasNotice(load({{"ImageJ=1.53t\nunit=mm\n", 4}, {"ImageJ=1.53t\nunit=m\n", 4000}}), "distance between pixels"));
    // Resolution alone is that of a print.
    CHECK(load({{"", 72}, {"", 72}}).geometry().spacing == Vec3(1));
    // Values of 0.5 v + 10, where all files say so.
    const std::string calibrated = imageJ + "spacing=2\ncf=0\nc0=10\nc1=0.5\n";
    const Volume plain = load({{imageJ + "spacing=2\n", 4}, {imageJ + "spacing=2\n", 4}});
    const Volume scaled = load({{calibrated, 4}, {calibrated, 4}});
    for (std::size_t i = 0; i < voxelCount(plain.dims()); ++i) CHECK(scaled.value(i) == 0.5 * plain.value(i) + 10);
    const Volume mixed = load({{calibrated, 4}, {imageJ + "spacing=2\n", 4}});
    CHECK(mixed.value(1) == plain.value(1));
    CHECK(hasNotice(mixed, "s1.tif has another calibration of values than s0.tif: the stored values are shown"));
    const auto omeText = [](const std::string& z) {
        return ome(
            omeImage("SizeZ=\"1\" PhysicalSizeX=\"500\" PhysicalSizeXUnit=\"nm\" PhysicalSizeY=\"0.25\"" + z, ""));
    };
    // 500 nm, 0.25 µm and 2 µm.
    const std::string known = omeText(" PhysicalSizeZ=\"2\"");
    const Volume micro = load({{known, 0}, {known, 0}});
    CHECK(micro.geometry().lengthUnit == LengthUnit::Nanometre);
    CHECK(micro.geometry().spacing.x == 500);
    CHECK(micro.geometry().spacing.y == Approx(250));
    CHECK(micro.geometry().spacing.z == Approx(2000));
    CHECK(micro.notices.empty());
    const Volume flat = load({{omeText(""), 0}, {omeText(""), 0}});
    CHECK(flat.geometry().spacing.z == 1);
    CHECK(hasNotice(flat, "1 is taken"));
}

TEST_CASE("a picture alone is refused as one slice", "[images]") {
    const TempFolder folder;
    const std::string png = folder.write("slice.png", "\x89PNG\r\n\x1a\n and what follows");
    CHECK_THROWS_WITH(loadVolume(at(png)), Contains("one slice, not a volume") && Contains("folder"));
    CHECK_FALSE(mayBeHeaderless(png));
    CHECK(mayBeHeaderless(folder.write("numbers.png", std::string(64, '\7'))));
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
            folder.write(
                "reader.sh",
                "#!/bin/sh\nread line; echo '{\"layout\":{\"axes\":[{\"size\":3,\"components\":false,\"time\":"
                "false},{\"size\":8,\"components\":false,\"time\":false}],\"type\":2,\"spacing\":[1,1,1],"
                "\"origin\":[0,0,0],\"directions\":[[1,0,0],[0,1,0],[0,0,1]],\"patient\":false,\"length_unit\":\"\","
                "\"array\":\"\",\"layers_at_once\":1,\"notices\":[],\"in_file\":{\"starts\":[" +
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
    // Numbers that are not read, by what they are; a page of several slices.
    const auto ofNumbers = [&](int bits, int format, int depth = 0) {
        TiffPage page;
        page.bits = bits;
        page.format = format;
        page.depth = depth;
        page.pixels = std::string(48, '\0');
        return at(folder.write("numbers.tif", tiffFile({page})));
    };
    CHECK_THROWS_WITH(loadVolume(ofNumbers(16, 3)), Contains("16-bit floating-point") && Contains("32-bit"));
    CHECK_THROWS_WITH(loadVolume(ofNumbers(64, 6)), Contains("complex"));
    CHECK_THROWS_WITH(loadVolume(ofNumbers(12, 1)), Contains("12-bit integers") && Contains("8, 16 or 32"));
    CHECK_THROWS_WITH(loadVolume(ofNumbers(16, 1, 6)), Contains("several slices (ImageDepth 6"));
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
