// Good files: types, byte orders, geometry, components, and what is written reads back.
#include <clocale>
#include <limits>
#include <numeric>

#include <catch2/catch.hpp>

#include "support/full_disk.h"
#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

Volume load(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return loadVolume(source);
}

template <class T>
std::vector<T> extremesOf(std::size_t count) {
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(3 * i + 1);
    values.front() = std::numeric_limits<T>::lowest();
    values.back() = std::numeric_limits<T>::max();
    return values;
}

template <class T>
const std::vector<T>& samplesOf(const Volume& volume) {
    return std::get<std::vector<T>>(volume.samples());
}

} // namespace

TEMPLATE_TEST_CASE("a volume of each type reads back from NRRD bit by bit", "[formats]", std::uint8_t, std::int8_t,
                   std::uint16_t, std::int16_t, std::uint32_t, std::int32_t, float, double) {
    const TempFolder folder;
    const Geometry geometry{{5, 4, 3}, {0.1, 1.0 / 3.0, 7.25}, {-10.7, 1e-9, 12345.678}};
    const auto values = extremesOf<TestType>(60);
    writeNrrd(Volume(geometry, values), folder.path("a.nrrd"));
    const Volume read = load(folder.path("a.nrrd"));
    CHECK(samplesOf<TestType>(read) == values);
    CHECK(read.dims() == geometry.dims);
    for (int a = 0; a < 3; ++a) {
        CHECK(read.geometry().spacing[a] == geometry.spacing[a]);
        CHECK(read.geometry().origin[a] == geometry.origin[a]);
    }
    CHECK(read.format == "NRRD");
    CHECK(read.title == "a.nrrd");
    CHECK(read.notices.empty());
    CHECK(folder.fileCount() == 1); // no temporary file stays
}

TEST_CASE("a field of floats is written as NRRD, NaN and infinity included", "[formats]") {
    const TempFolder folder;
    const Geometry geometry{{2, 1, 2}, {1, 2, 3}, {4, 5, 6}};
    const Grid<float> field({2, 1, 2}, {0.5f, std::numeric_limits<float>::quiet_NaN(), -1e-30f, INFINITY});
    writeNrrd(geometry, field, folder.path("f.nrrd"));
    const Volume read = load(folder.path("f.nrrd"));
    CHECK(read.sampleType() == SampleType::F32);
    CHECK(read.value(0) == 0.5);
    CHECK(std::isnan(read.value(1)));
    CHECK(read.value(2) == static_cast<double>(-1e-30f));
    CHECK(std::isinf(read.value(3)));
    CHECK(read.invalidCount() == 2);
    CHECK_THROWS_AS(writeNrrd(geometry, field, folder.path("none/f.nrrd")), FileError);
    CHECK_THROWS_WITH(writeNrrd(geometry, field, "/dev/full"), Contains("No space left"));
    const std::size_t bytes = std::filesystem::file_size(folder.path("f.nrrd")), files = folder.fileCount();
    for (const std::size_t room : {std::size_t{0}, bytes / 2, bytes - 1}) {
        const FullDisk disk(room);
        CHECK_THROWS_AS(writeNrrd(geometry, field, folder.path("g.nrrd")), FileError);
    }
    CHECK(folder.fileCount() == files);
}

TEST_CASE("data larger than the packing buffer reads back", "[formats]") {
    // 4.3 million 32-bit samples, 17 MB: more than one piece of input and many of output.
    const TempFolder folder;
    std::vector<std::uint32_t> values(163 * 163 * 163);
    std::uint32_t state = 1;
    for (std::uint32_t& v : values) v = state = state * 1664525u + 1013904223u;
    writeNrrd(Volume({{163, 163, 163}, {1, 1, 1}, {0, 0, 0}}, values), folder.path("a.nrrd"));
    CHECK(samplesOf<std::uint32_t>(load(folder.path("a.nrrd"))) == values);
}

TEMPLATE_TEST_CASE("raw data of each type reads in both byte orders, after skipped bytes", "[formats]", std::uint8_t,
                   std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t, float, double) {
    static_assert(std::endian::native == std::endian::little, "the expected bytes below are made for little-endian");
    const TempFolder folder;
    const auto values = extremesOf<TestType>(24);
    std::string little = bytesOf(values), big = little;
    for (std::size_t i = 0; i < big.size(); i += sizeof(TestType))
        std::reverse(big.begin() + static_cast<std::ptrdiff_t>(i),
                     big.begin() + static_cast<std::ptrdiff_t>(i + sizeof(TestType)));
    const SampleType type = Volume({{1, 1, 1}, {1, 1, 1}, {0, 0, 0}}, std::vector<TestType>(1)).sampleType();
    VolumeSource source;
    source.raw = parseRawLayout(std::string("2,3,4,") + name(type));
    source.raw->spacing = {0.5, 1.5, 2.5};
    source.path = folder.write("little.bin", little); // any suffix: the layout decides
    CHECK(samplesOf<TestType>(loadVolume(source)) == values);
    source.raw = parseRawLayout(std::string("2,3,4,") + name(type) + ",big");
    source.raw->skipBytes = 7;
    source.raw->spacing = {0.5, 1.5, 2.5};
    source.path = folder.write("big.nrrd", "skipped" + big);
    const Volume volume = loadVolume(source);
    CHECK(samplesOf<TestType>(volume) == values);
    CHECK(volume.format == "raw");
    CHECK(volume.geometry().spacing == Vec3(0.5, 1.5, 2.5));
    CHECK(volume.geometry().origin == Vec3(0));
    CHECK(volume.dims() == Int3(2, 3, 4));
}

TEST_CASE("NRRD attached and detached, raw and text, in either byte order", "[formats]") {
    const TempFolder folder;
    const std::string head = "NRRD0004\n# a comment: with a colon\ntype: unsigned short\ndimension: 3\nsizes: 2 1 2\n"
                             "spacings: 0.5 1 2\nkey:=value\n";
    const std::vector<double> expected{1, 258, 3, 65535};
    const std::string big("\0\1\1\2\0\3\xff\xff", 8);
    folder.write("data.bin", "one line\nx" + big);
    const std::string paths[] = {
        folder.write("a.nrrd", head + "endian: big\nencoding: raw\n\n" + big),
        folder.write("b.nrrd", head + "encoding: ascii\n\n1 258\n3 65535\n"),
        folder.write("c.NHDR",
                     head + "endian: big\nencoding: raw\nline skip: 1\nbyte skip: 1\ndata file: ./data.bin\n"),
        folder.write("d.nhdr", head + "endian: big\nencoding: raw\nbyteskip: -1\ndatafile: data.bin\n"),
        folder.write("e.nrrd", "NRRD0001\r\ntype: ushort\r\ndimension: 3\r\nsizes: 2 1 2\r\nspacings: 0.5 1 2\r\n"
                               "endian: big\r\nencoding: raw\r\n\r\n" +
                                   big)};
    for (const std::string& path : paths) {
        CAPTURE(path);
        const Volume volume = load(path);
        for (std::size_t i = 0; i < 4; ++i) CHECK(volume.value(i) == expected[i]);
        CHECK(volume.sampleType() == SampleType::U16);
        CHECK(volume.geometry().spacing == Vec3(0.5, 1, 2));
    }
}

TEST_CASE("MetaImage local, beside, compressed and big-endian", "[formats]") {
    const TempFolder folder;
    const std::string head = "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementType = MET_SHORT\n"
                             "DimSize = 2 1 2\nElementSpacing = 0.5 1 2\nOffset = 1 -2 3\n";
    const std::vector<std::int16_t> values{1, 258, -3, 32767};
    const std::string little = bytesOf(values);
    std::string big = little;
    for (std::size_t i = 0; i < big.size(); i += 2) std::swap(big[i], big[i + 1]);
    folder.write("data.raw", "head" + little);
    const std::string packed = zlibbed(little);
    const std::string paths[] = {
        folder.write("a.mha", head + "ElementDataFile = LOCAL\n" + little),
        folder.write("b.mha", head + "BinaryDataByteOrderMSB = True\nElementDataFile = LOCAL\n" + big),
        folder.write("c.mha", head + "CompressedData = True\nCompressedDataSize = " + std::to_string(packed.size()) +
                                  "\nElementDataFile = LOCAL\n" + packed),
        folder.write("d.mhd", head + "HeaderSize = 4\nElementDataFile = data.raw\n"),
        folder.write("e.mhd", head + "HeaderSize = -1\nElementDataFile = data.raw\n")};
    for (const std::string& path : paths) {
        CAPTURE(path);
        const Volume volume = load(path);
        CHECK(samplesOf<std::int16_t>(volume) == values);
        CHECK(volume.geometry().spacing == Vec3(0.5, 1, 2));
        CHECK(volume.geometry().origin == Vec3(1, -2, 3));
        CHECK(volume.format == "MetaImage");
        CHECK(volume.notices.empty());
    }
}

TEST_CASE("NIfTI plain and compressed, its slope applied", "[formats]") {
    const TempFolder folder;
    std::vector<std::uint8_t> values(24);
    std::iota(values.begin(), values.end(), std::uint8_t{0});
    Nifti nifti;
    for (const std::string& path : {folder.write("a.nii", nifti.header() + bytesOf(values)),
                                    folder.write("a.nii.gz", gzipped(nifti.header() + bytesOf(values)))}) {
        const Volume volume = load(path);
        CHECK(samplesOf<std::uint8_t>(volume) == values);
        CHECK(volume.dims() == Int3(2, 3, 4));
        CHECK(volume.geometry().spacing == Vec3(1, 2, 3));
        CHECK(volume.format == "NIfTI");
    }
    nifti.slope = 0.5f;
    nifti.intercept = -1;
    const Volume scaled = load(folder.write("b.nii", nifti.header() + bytesOf(values)));
    CHECK(scaled.value(0) == -1.0);
    CHECK(scaled.value(23) == 10.5); // 0.5 · 23 − 1
}

TEST_CASE("numbers have a point in every locale", "[formats]") {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    const char* comma = nullptr;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "es_ES.UTF-8"})
        if (comma == nullptr) comma = std::setlocale(LC_NUMERIC, name);
    if (comma == nullptr) WARN("no locale with a decimal comma is installed: only the plain one is tested");
    const TempFolder folder;
    writeNrrd(Volume({{1, 1, 1}, {0.25, 0.5, 1.5}, {-0.75, 0, 0}}, std::vector<float>{1.5f}), folder.path("a.nrrd"));
    folder.write("b.mha", "ObjectType = Image\nNDims = 3\nDimSize = 1 1 1\nElementSpacing = 0.25 0.5 1.5\n"
                          "Offset = -0.75 0 0\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nx");
    for (const char* name : {"a.nrrd", "b.mha"}) {
        const Geometry geometry = load(folder.path(name)).geometry();
        CHECK(geometry.spacing == Vec3(0.25, 0.5, 1.5));
        CHECK(geometry.origin == Vec3(-0.75, 0, 0));
    }
    std::setlocale(LC_NUMERIC, before.c_str());
}

TEST_CASE("axis directions are not applied, and the volume says so", "[formats]") {
    const TempFolder folder;
    const Volume turned = load(folder.write(
        "a.mha", "ObjectType = Image\nNDims = 3\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\nElementSpacing = 1 2 3\n"
                 "DimSize = 2 1 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nab"));
    REQUIRE(turned.notices.size() == 1);
    CHECK_THAT(turned.notices[0], Contains("directions of the axes"));
    CHECK(turned.geometry().spacing == Vec3(1, 2, 3));
    CHECK(turned.value(0) == 'a');
}

TEST_CASE("one component of several, the first of several time steps", "[formats]") {
    const TempFolder folder;
    VolumeSource source;
    source.path = folder.write("a.mha", "ObjectType = Image\nNDims = 3\nElementNumberOfChannels = 3\nDimSize = 2 1 1\n"
                                        "ElementType = MET_UCHAR\nElementDataFile = LOCAL\nRGBrgb");
    for (const auto& [component, expected] : {std::pair{0, "Rr"}, std::pair{2, "Bb"}}) {
        source.component = component;
        const Volume volume = loadVolume(source);
        CHECK(samplesOf<std::uint8_t>(volume) == std::vector<std::uint8_t>{static_cast<std::uint8_t>(expected[0]),
                                                                           static_cast<std::uint8_t>(expected[1])});
        REQUIRE(volume.notices.size() == 1);
        CHECK_THAT(volume.notices[0], Contains("of 3"));
    }
    for (const int none : {3, -1}) {
        source.component = none;
        CHECK_THROWS_WITH(loadVolume(source), Contains("no component") && Contains("0 to 2"));
    }
    const Volume series =
        load(folder.write("s.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 1 1 3\nencoding: raw\n\nabcdef"));
    CHECK(series.dims() == Int3(2, 1, 1));
    CHECK(samplesOf<std::uint8_t>(series) == std::vector<std::uint8_t>{'a', 'b'});
    REQUIRE(series.notices.size() == 1);
    CHECK_THAT(series.notices[0], Contains("the first of 3 time steps"));
}

TEST_CASE("a picture and a line open as flat volumes", "[formats]") {
    const TempFolder folder;
    CHECK(load(folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 3\nencoding: raw\n\nabcdef"))
              .dims() == Int3(2, 3, 1));
    CHECK(
        load(folder.write("b.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 6\nencoding: raw\n\nabcdef")).dims() ==
        Int3(6, 1, 1));
}

TEST_CASE("64-bit integers become doubles, and the volume says so", "[formats]") {
    const TempFolder folder;
    const std::vector<std::int64_t> values{-1, 1'000'000'000'000};
    const Volume volume =
        load(folder.write("a.nrrd", "NRRD0004\ntype: int64\ndimension: 3\nsizes: 2 1 1\nendian: little\n"
                                    "encoding: raw\n\n" +
                                        bytesOf(values)));
    CHECK(samplesOf<double>(volume) == std::vector<double>{-1, 1e12});
    REQUIRE(volume.notices.size() == 1);
    CHECK_THAT(volume.notices[0], Contains("64-bit"));
}

TEST_CASE("the missing value of the source is invalid, in floats too", "[formats]") {
    const TempFolder folder;
    VolumeSource source;
    source.missing = -999.9; // not a float: the file holds the float beside it
    source.raw = parseRawLayout("2,2,1,f32");
    source.path = folder.write("a.raw", bytesOf(std::vector<float>{1, -999.9f, 3, NAN}));
    const Volume volume = loadVolume(source);
    CHECK(volume.invalidCount() == 2);
    CHECK(volume.dataRange() == ValueRange{1, 3});
    CHECK(!volume.isValid(1));
    CHECK(std::isnan(volume.intensity(1)));
    source.path = "sample:disks";
    source.raw.reset();
    source.missing = 42;
    const Volume disks = loadVolume(source);
    CHECK(disks.invalidCount() > 0);
    CHECK(disks.range() == ValueRange{0, 252});
}

TEST_CASE("constant volumes and volumes without a valid voxel open and say what they are", "[formats]") {
    const TempFolder folder;
    VolumeSource source;
    source.raw = parseRawLayout("2,2,1,u8");
    source.path = folder.write("a.raw", "\7\7\7\7");
    const Volume constant = loadVolume(source);
    CHECK(constant.notices == std::vector<std::string>{"all voxels have the value 7"});
    CHECK(constant.intensity(0) == 0.0);
    source.missing = 7;
    CHECK(loadVolume(source).notices == std::vector<std::string>{"no voxel has a valid value"});
    source.missing.reset();
    source.raw = parseRawLayout("2,2,1,f32");
    source.path = folder.write("n.raw", bytesOf(std::vector<float>(4, NAN)));
    const Volume nan = loadVolume(source);
    CHECK(nan.notices == std::vector<std::string>{"no voxel has a valid value"});
    CHECK(!nan.hasValidVoxels());
    CHECK(nan.dataRange() == ValueRange{0, 0});
    source.path = folder.write("m.raw", bytesOf(std::vector<float>{NAN, -0.5f, -0.5f, NAN}));
    CHECK(loadVolume(source).notices == std::vector<std::string>{"all valid voxels have the value -0.5"});
}

TEST_CASE("the window of the source is applied", "[formats]") {
    VolumeSource source;
    source.path = "sample:shells";
    source.range = ValueRange{10, 20};
    source.sampleSize = 16;
    const Volume volume = loadVolume(source);
    CHECK(volume.range() == ValueRange{10, 20});
    CHECK(volume.dims() == Int3(16));
    CHECK(volume.format == "sample");
    source.range = ValueRange{20, 10};
    CHECK_THROWS_AS(loadVolume(source), UsageError);
}

TEST_CASE("loading stops when it is asked to", "[formats]") {
    std::stop_source stop;
    stop.request_stop();
    VolumeSource source;
    source.path = "sample:knee";
    CHECK_THROWS_AS(loadVolume(source, {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("file dialogs get every suffix", "[formats]") {
    CHECK(volumeFilePatterns() == std::vector<std::string>{"*.nrrd", "*.nhdr", "*.mhd", "*.mha", "*.nii", "*.nii.gz"});
}

TEST_CASE("the files of a volume are the one named and the one with its data", "[volume]") {
    const TempFolder folder;
    using Paths = std::vector<std::string>;
    const auto files = [](const std::string& path, std::optional<RawLayout> raw = {}) {
        VolumeSource source;
        source.path = path;
        source.raw = raw;
        return filesOf(source);
    };
    const std::string nhdr = folder.write("a.nhdr", "NRRD0004\ntype: uchar\ndata file: ./a.raw\n\n");
    const std::string mhd = folder.write("a.mhd", "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                                  "ElementDataFile = /elsewhere/a.raw\n");
    const std::string nrrd = folder.write("a.nrrd", "NRRD0004\ntype: uchar\n\n");
    CHECK(files(nhdr) == Paths{nhdr, folder.path("./a.raw")});
    CHECK(files(nhdr, RawLayout{}) == Paths{nhdr});
    CHECK(files(mhd) == Paths{mhd, "/elsewhere/a.raw"});
    CHECK(files(nrrd) == Paths{nrrd, nrrd});
    CHECK(files("missing.nrrd") == Paths{"missing.nrrd"});
    CHECK(files("a.unknown") == Paths{"a.unknown"});
    CHECK(files("sample:knee").empty());
}
