// Good files: types, byte orders, geometry, components, and what is written reads back.
#include <algorithm>
#include <array>
#include <clocale>
#include <limits>
#include <numeric>

#include <catch2/catch.hpp>

#include "support/full_disk.h"
#include "support/notices.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
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
std::vector<T> samplesOf(const Volume& volume) {
    const auto& samples = std::get<SampleArray<T>>(volume.samples());
    return {samples.begin(), samples.end()};
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
    source.spacing = GridSpacing{{0.5, 1.5, 2.5}};
    source.path = folder.write("little.bin", little); // any suffix: the layout decides
    CHECK(samplesOf<TestType>(loadVolume(source)) == values);
    source.raw = parseRawLayout(std::string("2,3,4,") + name(type) + ",big");
    source.raw->skipBytes = 7;
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

TEST_CASE("NIfTI-2 says in wider numbers what NIfTI-1 says", "[formats]") {
    const TempFolder folder;
    std::vector<std::uint8_t> values(24);
    std::iota(values.begin(), values.end(), std::uint8_t{3});
    Nifti nifti;
    nifti.slope = 0.5f;
    nifti.intercept = -1;
    nifti.units = 3; // micrometres
    nifti.sformCode = 1;
    nifti.sform = {0, -2, 0, 5, 1, 0, 0, 6, 0, 0, 3, 7};
    const Volume first = load(folder.write("a.nii", nifti.header() + bytesOf(values)));
    const std::string second = nifti.header2() + bytesOf(values);
    std::string other = second;
    for (const auto& [from, size, count] : {std::array<std::size_t, 3>{0, 4, 1},
                                            {12, 2, 2},
                                            {16, 8, 8},
                                            {104, 8, 12},
                                            {344, 4, 2},
                                            {352, 8, 18},
                                            {500, 4, 2}})
        for (std::size_t i = 0; i < count; ++i)
            std::reverse(other.begin() + static_cast<std::ptrdiff_t>(from + i * size),
                         other.begin() + static_cast<std::ptrdiff_t>(from + (i + 1) * size));
    for (const std::string& path :
         {folder.write("b.nii", second), folder.write("b.nii.gz", gzipped(second)), folder.write("c.nii", other)}) {
        INFO(path);
        const Volume volume = load(path);
        CHECK(volume.format == "NIfTI");
        CHECK(volume.dims() == first.dims());
        CHECK(volume.geometry().spacing == first.geometry().spacing);
        CHECK(volume.geometry().origin == first.geometry().origin);
        CHECK(volume.geometry().directions == first.geometry().directions);
        CHECK(volume.geometry().worldAxes == WorldAxes::Patient);
        for (std::size_t i = 0; i < values.size(); ++i) CHECK(volume.value(i) == 0.5 * values[i] - 1);
    }
}

TEST_CASE("NIfTI's data begin behind the header where it gives no offset", "[formats]") {
    const TempFolder folder;
    const std::string data(24, 'd');
    Nifti nifti;
    nifti.voxOffset = 0;
    CHECK(load(folder.write("a.nii", nifti.header() + data)).dataRange() == ValueRange{'d', 'd'});
    CHECK(load(folder.write("b.nii", Nifti{}.header2(0) + data)).dataRange() == ValueRange{'d', 'd'});
}

TEST_CASE("NIfTI in two files: a header, and the data beside it", "[formats]") {
    const TempFolder folder;
    std::vector<std::uint8_t> values(24);
    std::iota(values.begin(), values.end(), std::uint8_t{3});
    Nifti nifti;
    nifti.magic = "ni1";
    nifti.voxOffset = 0;
    const std::string image = folder.write("a.img", bytesOf(values));
    folder.write("b.img.gz", gzipped(bytesOf(values)));
    folder.write("c.img", std::string(16, 'x') + bytesOf(values));
    Nifti later = nifti;
    later.voxOffset = 16;
    for (const std::string& path :
         {folder.write("a.hdr", nifti.header().substr(0, 348)), folder.write("b.hdr.gz", gzipped(nifti.header())),
          folder.write("c.hdr", later.header()), folder.write("c.hdr", Nifti{}.header2(16, "ni2"))}) {
        INFO(path);
        const Volume volume = load(path);
        CHECK(volume.dims() == Int3(2, 3, 4));
        for (std::size_t i = 0; i < values.size(); ++i) CHECK(volume.value(i) == values[i]);
    }
    VolumeSource source;
    source.path = folder.write("a.hdr", nifti.header());
    CHECK(filesOf(source) == std::vector<std::string>{source.path, image}); // no output may be one of these
}

TEST_CASE("the scaling of NIfTI reaches every component, but not colours", "[formats]") {
    // Two voxels (1 x 2 x 1) of c components with the stored values 0, 1, 2, …, scaled to 2 · stored + 10.
    const TempFolder folder;
    Nifti nifti;
    nifti.slope = 2;
    nifti.intercept = 10;
    const auto values = [&](const Nifti& header, const std::string& data, int component) {
        VolumeSource source;
        source.path = folder.write("a.nii", header.header() + data);
        source.component = component;
        const Volume volume = loadVolume(source);
        REQUIRE(volume.size() == 2);
        return std::vector<double>{volume.value(0), volume.value(1)};
    };
    nifti.dim = {3, 1, 2, 1, 1, 1, 1, 1};
    nifti.datatype = 32; // complex: re im re im, both scaled
    const std::string complex = bytesOf(std::vector<float>{0, 1, 2, 3});
    CHECK(values(nifti, complex, 0) == std::vector<double>{10, 14});
    CHECK(values(nifti, complex, 1) == std::vector<double>{12, 16});
    nifti.datatype = 1792;
    CHECK(values(nifti, bytesOf(std::vector<double>{0, 1, 2, 3}), 1) == std::vector<double>{12, 16});
    nifti.datatype = 128; // RGB: NIfTI scales no colours
    CHECK(values(nifti, std::string("\0\1\2\3\4\5", 6), 2) == std::vector<double>{2, 5});
    nifti.datatype = 2304; // RGBA
    CHECK(values(nifti, std::string("\0\1\2\3\4\5\6\7", 8), 3) == std::vector<double>{3, 7});
    // A vector of five dimensions: its components are the slowest axis, so that component c has the values 2c, 2c + 1.
    nifti.dim = {5, 1, 2, 1, 1, 3, 1, 1};
    nifti.intent = 1007;
    nifti.datatype = 4;
    const std::string vector = bytesOf(std::vector<std::int16_t>{0, 1, 2, 3, 4, 5});
    CHECK(values(nifti, vector, 0) == std::vector<double>{10, 12});
    CHECK(values(nifti, vector, 2) == std::vector<double>{18, 20});
    nifti.slope = 0; // no scaling, whatever scl_inter says
    CHECK(values(nifti, vector, 1) == std::vector<double>{2, 3});
    // A symmetric matrix in NIfTI's order xx xy yy xz yz zz; component 2 is xz, entry 3.
    nifti.dim[5] = 6;
    nifti.intent = 1005;
    CHECK(values(nifti, bytesOf(std::vector<std::int16_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), 2) ==
          std::vector<double>{6, 7});
}

TEST_CASE("NIfTI floats that are no numbers are invalid voxels", "[formats]") {
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {3, 2, 2, 1, 1, 1, 1, 1};
    nifti.datatype = 16;
    const std::string data = bytesOf(std::vector<float>{1, NAN, INFINITY, -4});
    for (const float slope : {0.0f, 1.0f, NAN, INFINITY, 0.5f}) {
        CAPTURE(slope);
        nifti.slope = slope;
        nifti.intercept = slope == 0.5f ? 1.0f : 0.0f; // 0.5 · 1 + 1 = 1.5; 0.5 · (−4) + 1 = −1
        const Volume volume = load(folder.write("a.nii", nifti.header() + data));
        CHECK(volume.invalidCount() == 2);
        CHECK(!volume.isValid(1));
        CHECK(!volume.isValid(2));
        CHECK(volume.dataRange() == (slope == 0.5f ? ValueRange{-1, 1.5} : ValueRange{-4, 1}));
    }
    nifti.intercept = 7; // no slope: nothing is added either
    for (const float slope : {0.0f, NAN}) {
        nifti.slope = slope;
        CHECK(load(folder.write("b.nii", nifti.header() + data)).value(0) == 1);
    }
}

TEST_CASE("NIfTI says where the volume lies", "[formats]") {
    // NIfTI's x goes to the right and y to the front, ours to the left and back: both signs change.
    const TempFolder folder;
    Nifti nifti;
    nifti.qform = {0, 0, 1, 10, 20, 30}; // half a turn about z: together with the signs, the grid's own axes
    nifti.sform = {-1, 0, 0, 5, 0, -2, 0, 6, 0, 0, 3, 7};
    const std::string data(24, 'x');
    const auto read = [&] { return load(folder.write("a.nii", nifti.header() + data)); };
    CHECK(read().geometry().origin == Vec3(0, 0, 0));
    nifti.qformCode = 1;
    CHECK(read().geometry().origin == Vec3(-10, -20, 30));
    CHECK(read().notices.size() == 1); // 24 equal voxels, but no turned axes
    for (const std::int16_t code : {std::int16_t{1}, std::int16_t{2}, std::int16_t{4}}) { // whatever it is aligned to
        nifti.sformCode = code;
        CHECK(read().geometry().origin == Vec3(-5, -6, 7));
        REQUIRE(read().notices.size() == 2);
        CHECK_THAT(read().notices[0], Contains("sform and qform place the volume differently"));
    }
    nifti.qform = {0, 0, 1, 5, 6, 7};
    CHECK(read().geometry().origin == Vec3(-5, -6, 7));
    CHECK(read().notices.size() == 1);
    nifti.qformCode = 0;
    nifti.units = 1; // metres
    CHECK(read().geometry().origin == Vec3(-5000, -6000, 7000));
    CHECK(read().geometry().spacing == Vec3(1000, 2000, 3000));
    nifti.units = 2;
    CHECK(read().geometry().directions == Mat3(1));
    CHECK(read().geometry().worldAxes == WorldAxes::Patient);
    nifti.sform[0] = 1; // i goes to the right: against our x
    CHECK(read().geometry().directions[0] == Vec3(-1, 0, 0));
    CHECK(read().geometry().directions[1] == Vec3(0, 1, 0));
    CHECK(read().notices.size() == 1);
    nifti.sform = {-1, 1, 0, 5, 0, -2, 0, 6, 0, 0, 3, 7}; // sheared: j goes (1, −2, 0) to the right and front
    CHECK(glm::length(read().geometry().directions[1] - Vec3(-1, 2, 0) / std::sqrt(5.0)) < 1e-6);
    CHECK(std::abs(read().geometry().spacing.y - std::sqrt(5.0)) < 1e-6); // the length of the map's column
    nifti.sformCode = nifti.qformCode = 0;
    CHECK(read().geometry().worldAxes == WorldAxes::File); // no form at all: the grid's own axes
    CHECK(read().geometry().directions == Mat3(1));
    nifti.sformCode = 1;
    const Volume packed = load(folder.write("b.nii", gzipped(nifti.header() + data))); // .gz left out of the name
    CHECK(packed.dims() == Int3(2, 3, 4));
    CHECK(packed.value(23) == 'x');
}

TEST_CASE("NIfTI's sform counts where qform differs from it, and the volume says so", "[formats]") {
    // A CT whose gantry was tilted by 20°: slices are 3 apart, along an axis that leans 20° from their normal. No
    // quaternion can say that, so qform has the slices at right angles, as pixdim has 3.
    const TempFolder folder;
    const std::string data(24, 'x');
    const double tilt = 20 * 3.14159265358979323846 / 180;
    const auto lean = static_cast<float>(3 * std::sin(tilt)), rise = static_cast<float>(3 * std::cos(tilt));
    Nifti nifti; // spacing 1, 2, 3
    nifti.qformCode = nifti.sformCode = 1;
    nifti.qform = {0, 0, 0, 10, 20, 30};
    nifti.sform = {1, 0, 0, 10, 0, 2, lean, 20, 0, 0, rise, 30};
    const auto read = [&] { return load(folder.write("a.nii", nifti.header() + data)); };
    for (const std::int16_t code : {std::int16_t{1}, std::int16_t{2}, std::int16_t{3}, std::int16_t{4}}) {
        nifti.sformCode = code;
        const Volume tilted = read();
        // Ours are x to the left and y to the back: j goes (0, −1, 0), k (0, −sin 20°, cos 20°).
        CHECK(tilted.geometry().directions[0] == Vec3(-1, 0, 0));
        CHECK(tilted.geometry().directions[1] == Vec3(0, -1, 0));
        CHECK(glm::length(tilted.geometry().directions[2] - Vec3(0, -std::sin(tilt), std::cos(tilt))) < 1e-6);
        CHECK(glm::length(tilted.geometry().spacing - Vec3(1, 2, 3)) < 1e-6);
        // Voxel (0, 0, 2) is at 2·k from (10, 20, 30).
        CHECK(glm::length(tilted.geometry().worldFromVoxel({0, 0, 2}) - Vec3(-10, -20 - 2 * lean, 30 + 2 * rise)) <
              1e-5);
        REQUIRE(tilted.notices.size() == 2);
        CHECK_THAT(tilted.notices[0], Contains("sform and qform place the volume differently"));
    }
    nifti.sformCode = 0; // not set: qform alone, and nothing to tell
    CHECK(read().geometry().directions[2] == Vec3(0, 0, 1));
    CHECK(read().notices.size() == 1);
    nifti.sformCode = 1; // another spacing is a difference, too; rounding is none
    nifti.sform = {1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3.5f, 30};
    CHECK(read().notices.size() == 2);
    CHECK(read().geometry().spacing.z == 3.5);
    nifti.sform = {1, 1e-6f, 0, 10.00001f, 0, 2, -1e-6f, 20, 0, 0, 3.00001f, 30};
    CHECK(read().notices.size() == 1);
    nifti.sform = {1, 1, 0, 10, 2, 2, 0, 20, 0, 0, 3, 30}; // in one plane: of no use
    CHECK_THAT(read().notices[0], Contains("in one plane"));
    CHECK(read().geometry().directions[2] == Vec3(0, 0, 1));
}

TEST_CASE("scaled integers keep their values", "[formats]") {
    // 2²⁴ + 1 and 2²⁴ + 3 are no floats: their scaled values 2·v + 1 = 33 554 435 and 33 554 439 would be one with
    // their neighbours. All that follows is exact in doubles.
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {3, 2, 1, 1, 1, 1, 1, 1};
    const auto scaled = [&](std::int16_t datatype, float slope, float intercept, const std::string& data) {
        nifti.datatype = datatype;
        nifti.slope = slope;
        nifti.intercept = intercept;
        VolumeSource source;
        source.path = folder.write("a.nii", nifti.header() + data);
        Volume volume = loadVolume(source);
        CHECK(contentsOf(source).type == volume.sampleType());
        return volume;
    };
    const Volume signedOnes = scaled(8, 2, 1, bytesOf(std::vector<std::int32_t>{16777217, -16777219}));
    CHECK(samplesOf<double>(signedOnes) == std::vector<double>{33554435, -33554437});
    const Volume unsignedOnes = scaled(768, 0.5f, -1, bytesOf(std::vector<std::uint32_t>{4294967295u, 4294967293u}));
    CHECK(samplesOf<double>(unsignedOnes) == std::vector<double>{2147483646.5, 2147483645.5});
    // 16 bits fit into a float, unless what is added is large: floats near 10⁹ are 64 apart.
    CHECK(samplesOf<float>(scaled(4, 0.5f, -1, bytesOf(std::vector<std::int16_t>{32767, -3}))) ==
          std::vector<float>{16382.5f, -2.5f});
    CHECK(samplesOf<double>(scaled(4, 1, 1e9f, bytesOf(std::vector<std::int16_t>{1, 2}))) ==
          std::vector<double>{1000000001, 1000000002});
    // Of 8 bits and a slope of 1, floats tell 2²⁴ − 2⁸ apart from its neighbours, and no more.
    CHECK(scaled(2, 1, 16776960, "ab").sampleType() == SampleType::F32);
    CHECK(scaled(2, 1, 16776962, "ab").sampleType() == SampleType::F64);
}

TEST_CASE("NRRD says by the ends of its axes how far apart voxels are", "[formats]") {
    const TempFolder folder;
    const auto read = [&](const std::string& fields) {
        return load(folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 3 4\n" + fields +
                                               "encoding: raw\n\nabcdefghijklmnopqrstuvwx"));
    };
    const std::string ends = "axis mins: 0 10 -1\naxis maxs: 1 13 1\n"; // lengths 1, 3, 2
    // Cells, as where nothing is said: 1/2, 3/3, 2/4; the first centre half a cell behind the beginning.
    for (const char* centers : {"", "centers: cell cell ???\n"}) {
        const Volume cells = read(ends + centers);
        CHECK(cells.geometry().spacing == Vec3(0.5, 1, 0.5));
        CHECK(cells.geometry().origin == Vec3(0.25, 10.5, -0.75));
        CHECK(cells.notices.empty());
    }
    // Nodes: one interval less, from the first voxel to the last: 1/1, 3/2, 2/3.
    const Volume nodes = read(ends + "centerings: node node node\n");
    CHECK(nodes.geometry().spacing == Vec3(1, 1.5, 2.0 / 3));
    CHECK(nodes.geometry().origin == Vec3(0, 10, -1));
    // Spacings count before the ends, of each axis that has them.
    CHECK(read(ends + "spacings: nan 1 nan\n").geometry().spacing == Vec3(0.5, 1, 0.5));
    const Volume both = read(ends + "spacings: 0.5 1 2\n");
    CHECK(both.geometry().spacing == Vec3(0.5, 1, 2));
    REQUIRE(both.notices.size() == 1);
    CHECK_THAT(both.notices[0], Contains("differ along axis 2"));
    for (const char* backwards : {"axis mins: 0 0 1\naxis maxs: 1 1 0\n", "axis mins: 0 0 1\naxis maxs: 1 1 1\n"})
        CHECK_THROWS_WITH(read(backwards), Contains("spacing of axis 2") && Contains("positive"));
    // Where directions say it, the ends do not.
    CHECK(read("space dimension: 3\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n" + ends).geometry().spacing ==
          Vec3(2, 3, 4));
}

TEST_CASE("compressed MetaImage data tell themselves where they end", "[formats]") {
    const TempFolder folder;
    const std::vector<std::uint16_t> values{1, 258, 3, 65535};
    const std::string packed = zlibbed(bytesOf(values));
    const std::string size = std::to_string(packed.size());
    const std::string head = "ObjectType = Image\nNDims = 3\nDimSize = 2 1 2\nElementType = MET_USHORT\n"
                             "CompressedData = True\n";
    const std::string local = head + "ElementDataFile = LOCAL\n" + packed;
    folder.write("data.zraw", packed);
    folder.write("late.zraw", "1234567" + packed);
    const std::string beside = "ElementDataFile = data.zraw\n", late = "ElementDataFile = late.zraw\n";
    // HeaderSize counts from the beginning of the file, here with filling after a shorter header.
    const std::string skipping = head + "HeaderSize = 300\nElementDataFile = LOCAL\n";
    const std::string paths[] = {
        folder.write("a.mha", local),
        folder.write("b.mha", head + "CompressedDataSize = 3\nElementDataFile = LOCAL\n" + packed),
        folder.write("c.mha", head + "CompressedDataSize = " + size + "\nElementDataFile = LOCAL\n" + packed),
        folder.write("d.mha", skipping + std::string(300 - skipping.size(), '.') + packed),
        folder.write("e.mhd", head + beside),
        folder.write("f.mhd", head + "CompressedDataSize = 1\n" + beside),
        folder.write("g.mhd", head + "HeaderSize = 7\n" + late),
        folder.write("h.mhd", head + "HeaderSize = 7\nCompressedDataSize = " + size + "\n" + late),
        folder.write("i.mhd", head + "HeaderSize = -1\nCompressedDataSize = " + size + "\n" + late)};
    for (const std::string& path : paths) {
        CAPTURE(path);
        CHECK(samplesOf<std::uint16_t>(load(path)) == values);
    }
}

TEST_CASE("numbers written out have no byte order, and may have several components", "[formats]") {
    const TempFolder folder;
    const std::string nrrd = "NRRD0004\ntype: short\nendian: big\ndimension: 4\nsizes: 2 2 1 1\n"
                             "kinds: vector domain domain domain\nencoding: text\n\n1 -2\n300 4\n";
    const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nElementNumberOfChannels = 2\n"
                             "ElementType = MET_SHORT\nElementByteOrderMSB = True\nBinaryData = False\n"
                             "ElementDataFile = LOCAL\n1 -2\n300 4\n";
    for (const std::string& path : {folder.write("a.nrrd", nrrd), folder.write("a.mha", meta)}) {
        CAPTURE(path);
        VolumeSource source;
        source.path = path;
        CHECK(samplesOf<std::int16_t>(loadVolume(source)) == std::vector<std::int16_t>{1, 300});
        source.component = 1;
        CHECK(samplesOf<std::int16_t>(loadVolume(source)) == std::vector<std::int16_t>{-2, 4});
    }
    const std::string flat = "NRRD0004\nendian: big\ndimension: 1\nsizes: 3\n";
    CHECK(samplesOf<float>(load(folder.write("b.nrrd", flat + "type: float\nencoding: ascii\n\n0.5 nan 3e2"))).back() ==
          300);
    CHECK(load(folder.write("c.nrrd", flat + "type: int64\nencoding: ascii\n\n-1 9007199254740992 3.0")).value(1) ==
          9007199254740992.0);
    // Hexadecimal digits stand for bytes, which have an order: 0x0102 = 258.
    CHECK(samplesOf<std::uint16_t>(
              load(folder.write("d.nrrd", flat + "type: ushort\nencoding: hex\n\n0102\n00fF 0000"))) ==
          std::vector<std::uint16_t>{258, 255, 0});
}

TEST_CASE("a component of an NRRD may lie along any axis", "[formats]") {
    // 2 x 2 x 1 voxels of 3 components; the value is 100 · component + 10 · y + x.
    const TempFolder folder;
    const auto value = [](int c, int y, int x) { return static_cast<std::uint8_t>(100 * c + 10 * y + x); };
    std::vector<std::uint8_t> first, middle, last;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            for (int c = 0; c < 3; ++c) first.push_back(value(c, y, x));
    for (int y = 0; y < 2; ++y)
        for (int c = 0; c < 3; ++c)
            for (int x = 0; x < 2; ++x) middle.push_back(value(c, y, x));
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) last.push_back(value(c, y, x));
    const auto file = [&](const char* name, const std::string& fields, const std::vector<std::uint8_t>& data) {
        return folder.write(name, "NRRD0004\ntype: uint8\ndimension: 3\n" + fields + "\nencoding: gzip\n\n" +
                                      gzipped(bytesOf(data)));
    };
    for (const std::string& path :
         {file("a.nrrd", "sizes: 3 2 2\nkinds: vector domain domain", first),
          file("b.nrrd", "sizes: 2 3 2\nkinds: domain list domain", middle),
          file("c.nrrd", "sizes: 2 2 3\nkinds: domain domain RGB-color", last),
          file("d.nrrd", "sizes: 2 2 3\nspace dimension: 2\nspace directions: (1,0) (0,1) none", last)}) {
        VolumeSource source;
        source.path = path;
        for (const int c : {0, 1, 2}) {
            CAPTURE(path, c);
            source.component = c;
            const Volume volume = loadVolume(source);
            CHECK(volume.dims() == Int3(2, 2, 1));
            CHECK(samplesOf<std::uint8_t>(volume) ==
                  std::vector<std::uint8_t>{value(c, 0, 0), value(c, 0, 1), value(c, 1, 0), value(c, 1, 1)});
        }
    }
}

TEST_CASE("header lines of any length are read", "[formats]") {
    const TempFolder folder;
    const std::string lengthy(100'000, 'x');
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 1\n";
    for (const std::string& line : {"# " + lengthy, lengthy + ":=" + lengthy, "content: " + lengthy, lengthy + ": 1"})
        CHECK(load(folder.write("a.nrrd", head + line + "\nsizes: 2\nencoding: raw\n\nab")).value(1) == 'b');
    const std::string meta = "ObjectType = Image\nNDims = 1\nDimSize = 2\nElementType = MET_UCHAR\n";
    for (const std::string& line : {"Comment = " + lengthy, lengthy + " = 1", "Modality = " + lengthy})
        CHECK(load(folder.write("a.mha", meta + line + "\nElementDataFile = LOCAL\nab")).value(1) == 'b');
}

TEST_CASE("bytes and lines before NRRD data are left out", "[formats]") {
    const TempFolder folder;
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 2\n";
    CHECK(load(folder.write("a.nrrd", head + "encoding: gzip\nbyte skip: 3\n\n" + gzipped("123ab"))).value(0) == 'a');
    CHECK(load(folder.write("b.nrrd", head + "encoding: gzip\nbyte skip: -1\n\n" + gzipped("12345ab"))).value(0) ==
          'a');
    CHECK(load(folder.write("c.nrrd", head + "encoding: gzip\nline skip: 1\n\nxyz\n" + gzipped("ab"))).value(0) == 'a');
    CHECK(load(folder.write("d.nrrd", head + "encoding: text\nline skip: 1\nbyte skip: 2\n\nxyz\nqq7 8")).value(0) ==
          7);
    CHECK(load(folder.write("e.nrrd", head + "encoding: hex\nbyte skip: 1\n\nx6162")).value(0) == 'a');
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

TEST_CASE("MetaImage and NRRD say where the axes point", "[formats]") {
    const TempFolder folder;
    const Volume turned = load(folder.write(
        "a.mha", "ObjectType = Image\nNDims = 3\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\nElementSpacing = 1 2 3\n"
                 "DimSize = 2 1 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nab"));
    CHECK(turned.notices.empty());
    CHECK(turned.geometry().spacing == Vec3(1, 2, 3));
    // Row n of the matrix is axis n: i points along y, j against x.
    CHECK(turned.geometry().directions == Mat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)));
    CHECK(turned.geometry().worldAxes == WorldAxes::File); // nobody speaks of a patient
    CHECK(turned.geometry().worldFromVoxel({1, 1, 0}) == Vec3(-2, 1, 0));
    CHECK(turned.value(0) == 'a');
    const auto nrrd = [&](const std::string& space, const std::string& units) {
        return load(folder.write("b.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nspace: " + space +
                                               "\nsizes: 2 1 1\nspace directions: (0,2,0) (1,0,0) (0,0,3)\n" + units +
                                               "space origin: (1,2,3)\nencoding: raw\n\nab"))
            .geometry();
    };
    CHECK(nrrd("left-posterior-superior", "").directions == Mat3(Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)));
    const Geometry ras = nrrd("RAS", "space units: \"m\" \"m\" \"m\"\n");
    CHECK(ras.worldAxes == WorldAxes::Patient);
    CHECK(ras.directions == Mat3(Vec3(0, -1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1))); // x and y are the other way round
    CHECK(ras.origin == Vec3(-1000, -2000, 3000));
    CHECK(ras.spacing == Vec3(2000, 1000, 3000));
    CHECK(nrrd("3D-right-handed", "").worldAxes == WorldAxes::File);
    CHECK(nrrd("3D-right-handed", "").directions[0] == Vec3(0, 1, 0));
    // What is written says the same.
    writeNrrd(Volume(ras, std::vector<std::uint8_t>{1, 2}), folder.path("c.nrrd"));
    const Geometry again = load(folder.path("c.nrrd")).geometry();
    CHECK(again.directions == ras.directions);
    CHECK(again.worldAxes == WorldAxes::Patient);
    CHECK(again.origin == ras.origin);
}

TEST_CASE("one component of several, one of several time steps", "[formats]") {
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
    VolumeSource series;
    series.path =
        folder.write("s.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 1 1 3\nencoding: raw\n\nabcdef");
    for (int step = 0; step < 3; ++step) {
        series.step = step;
        const Volume volume = loadVolume(series);
        CHECK(volume.dims() == Int3(2, 1, 1));
        const auto first = static_cast<std::uint8_t>('a' + 2 * step);
        CHECK(samplesOf<std::uint8_t>(volume) ==
              std::vector<std::uint8_t>{first, static_cast<std::uint8_t>(first + 1)});
        CHECK(volume.notices.empty());
    }
    for (const int none : {3, -1}) {
        series.step = none;
        CHECK_THROWS_WITH(loadVolume(series), Contains("no time step") && Contains("0 to 2"));
    }
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
    CHECK(volumeFilePatterns() ==
          std::vector<std::string>{"*.nrrd",   "*.nhdr", "*.mhd",    "*.mha", "*.nii",  "*.nii.gz", "*.hdr",
                                   "*.hdr.gz", "*.img",  "*.img.gz", "*.vti", "*.pvti", "*.pvd",    "*.vtk",
                                   "*.pvm",    "*.dat",  "*.vvd",    "*.tif", "*.tiff", "*.dcm",    "*.dicom",
                                   "*.ima",    "*.h5",   "*.hdf5",   "*.hdf", "*.he5",  "*.mat",    "*.nc",
                                   "*.nc4",    "*.cdf",  "*.netcdf", "*.mrml"});
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
                                                  "ElementDataFile = data/a.raw\n");
    const std::string nrrd = folder.write("a.nrrd", "NRRD0004\ntype: uchar\n\n");
    CHECK(files(nhdr) == Paths{nhdr, folder.path("./a.raw")});
    CHECK(files(nhdr, RawLayout{}) == Paths{nhdr});
    CHECK(files(mhd) == Paths{mhd, folder.path("data/a.raw")});
    CHECK(files(nrrd) == Paths{nrrd, nrrd});
    CHECK(files("missing.nrrd") == Paths{"missing.nrrd"});
    CHECK(files("a.unknown") == Paths{"a.unknown"});
    CHECK(files("sample:knee").empty());
}

TEST_CASE("headers say in which unit lengths are", "[formats]") {
    const TempFolder folder;
    const auto nrrd = [&](const std::string& units) {
        return folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                                      "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,4)\n"
                                      "space origin: (1,0,3)\nspace units: " +
                                          units + "\n\n01234567");
    };
    CHECK(load(nrrd(R"("cm" "cm" "cm")")).geometry().spacing == Vec3(20, 20, 40));
    CHECK(load(nrrd("um um um")).geometry().origin == Vec3(1e-3, 0, 3e-3)); // without quotes
    for (const char* units : {R"("microns" "microns" "microns")", "\"\u00b5m\" \"um\" \"Micrometer\"",
                              "\"micrometre\" \"micrometres\" \"\u03bcm\""}) {
        INFO(units);
        CHECK(load(nrrd(units)).geometry().spacing == Vec3(2e-3, 2e-3, 4e-3));
    }
    CHECK(load(nrrd(R"("in" "inch" "inches")")).geometry().spacing == Vec3(2 * 25.4, 2 * 25.4, 4 * 25.4));
    CHECK(load(nrrd(R"("meters" "m" "metre")")).geometry().spacing == Vec3(2000, 2000, 4000));
    CHECK(load(nrrd(R"("mm" "mm" "mm")")).notices.empty());
    const Volume furlong = load(nrrd(R"("furlong" "furlong" "furlong")"));
    CHECK(furlong.geometry().spacing == Vec3(2, 2, 4));
    CHECK(hasNotice(furlong, "the unit of length 'furlong' is not known: millimetres are assumed"));
    CHECK_THROWS_WITH(load(nrrd(R"("mm" "mm" "cm")")), Contains("different units, 'mm' and 'cm'"));
    CHECK_THROWS_WITH(load(nrrd(R"("mm" "mm" "furlong")")), Contains("different units, 'mm' and 'furlong'"));
    // Where no patient is, lengths stay in their unit, of which there must be one.
    const auto plain = [&](const std::string& fields) {
        return folder.write("b.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n" + fields +
                                          "\n\n01234567");
    };
    for (const std::string space : {"space dimension: 3", "space: 3D-right-handed"}) {
        INFO(space);
        const std::string grid = space + "\nspace directions: (2,0,0) (0,2,0) (0,0,4)\nspace units: ";
        const Volume inMicrons = load(plain(grid + R"("um" "microns" "um")"));
        CHECK(inMicrons.geometry().spacing == Vec3(2, 2, 4));
        CHECK(inMicrons.geometry().lengthUnit == LengthUnit::Micrometre);
        CHECK_THROWS_WITH(load(plain(grid + R"("mm" "mm" "cm")")), Contains("different units, 'mm' and 'cm'"));
    }
    CHECK_THROWS_WITH(load(plain(R"(spacings: 2 2 4
units: "mm" "mm" "cm")")),
                      Contains("different units, 'mm' and 'cm'"));
    const Volume mixed = load(plain(R"(spacings: 2 2 4
units: "mm" "mm" "s")"));
    CHECK(mixed.geometry().spacing == Vec3(2, 2, 4));
    CHECK(mixed.geometry().lengthUnit == LengthUnit::Unknown);
    CHECK(hasNotice(mixed, "different units, 'mm' and 's': their numbers are taken as they are"));
    CHECK(load(plain("spacings: 2 2 4\nunits: \"um\" \"\" \"???\"")).notices.empty());
    const auto mha = [&](const std::string& fields) {
        return folder.write("a.mha", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                     "ElementSpacing = 2 2 4\nOffset = 1 0 3\n" +
                                         fields + "ElementDataFile = LOCAL\n01234567");
    };
    const Volume micro = load(mha("AnatomicalOrientation = RAI\nDistanceUnits = um\n"));
    CHECK(micro.geometry().spacing == Vec3(2e-3, 2e-3, 4e-3));
    CHECK(micro.geometry().origin == Vec3(1e-3, 0, 3e-3));
    const Volume ofNobody = load(mha("DistanceUnits = um\n"));
    CHECK(ofNobody.geometry().spacing == Vec3(2, 2, 4));
    CHECK(ofNobody.geometry().lengthUnit == LengthUnit::Micrometre);
    CHECK(ofNobody.notices.empty());
    CHECK(load(mha("DistanceUnits = mm\n")).notices.empty());
    CHECK(load(mha("DistanceUnits = ?\n")).geometry().spacing == Vec3(2, 2, 4));
    for (const char* anatomy : {"", "AnatomicalOrientation = RAI\n"})
        CHECK_THROWS_WITH(load(mha(anatomy + std::string("DistanceUnits = furlong\n"))), Contains("furlong"));
}

TEST_CASE("MetaImage says what the stored numbers mean", "[formats]") {
    const TempFolder folder;
    const auto mha = [&](const std::string& fields) {
        return load(folder.write("a.mha", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n" +
                                              fields + "ElementDataFile = LOCAL\n01234567"));
    };
    const Volume scaled = mha("ElementToIntensityFunctionSlope = 0.5\nElementToIntensityFunctionOffset = -3\n");
    CHECK(scaled.value(0) == 0.5 * '0' - 3);
    CHECK(scaled.value(7) == 0.5 * '7' - 3);
    CHECK(hasNotice(scaled, "values are 0.5 x what the file stores - 3"));
    CHECK(mha("ElementToIntensityFunctionOffset = 2\n").value(1) == '1' + 2);
    const Volume same = mha("ElementToIntensityFunctionSlope = 1\nElementToIntensityFunctionOffset = 0\n");
    CHECK(same.sampleType() == SampleType::U8);
    CHECK(same.notices.empty());
    const Volume none = mha("ElementToIntensityFunctionSlope = 0\n");
    CHECK(none.value(7) == '7');
    CHECK(hasNotice(none, "would make all values the same"));
    CHECK_THROWS_WITH(mha("ElementToIntensityFunctionSlope = inf\n"), Contains("ElementToIntensityFunctionSlope"));
}

TEST_CASE("names of data files may look like lists", "[formats]") {
    const TempFolder folder;
    for (const std::string name : {"LISTEN.raw", "50%.raw", "LIST", "a %d 1"}) {
        INFO(name);
        folder.write(name, "01234567");
        const std::string header = folder.write(
            "a.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: " + name + "\n");
        CHECK(load(header).dataRange() == ValueRange{'0', '7'});
    }
}

TEST_CASE("a measurement frame is told of where a voxel has components", "[formats]") {
    const TempFolder folder;
    const auto notices = [&](const std::string& sizes, const std::string& frame) {
        return load(folder.write("a.nrrd",
                                 "NRRD0004\ntype: uint8\ndimension: 4\nsizes: " + sizes +
                                     "\nkinds: vector domain domain domain\nencoding: raw\nspace dimension: 3\n"
                                     "space directions: none (1,0,0) (0,1,0) (0,0,1)\nmeasurement frame: " +
                                     frame + "\n\n01234567"))
            .notices;
    };
    const auto tells = [](const std::vector<std::string>& all) {
        return std::ranges::any_of(all, [](const std::string& n) { return n.find("measurement frame") != n.npos; });
    };
    CHECK(tells(notices("2 2 2 1", "(0,1,0) (1,0,0) (0,0,1)")));
    CHECK_FALSE(tells(notices("2 2 2 1", "(1, 0, 0) (0,1,0)  (0,0,1)")));
}

TEST_CASE("text has whole numbers where samples are whole, and numbers near 0", "[formats]") {
    const TempFolder folder;
    const auto text = [&](const std::string& type, const std::string& data) {
        return folder.write("a.nrrd", "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 2 1 2\nencoding: ascii\n\n" +
                                          data + "\n");
    };
    const Volume whole = load(text("uchar", "5 4\n3.0 1e2"));
    CHECK(samplesOf<std::uint8_t>(whole) == std::vector<std::uint8_t>{5, 4, 3, 100});
    CHECK_THROWS_WITH(load(text("uchar", "5 1.7 3 2")), Contains("'1.7' does not fit"));
    const Volume tiny = load(text("double", "1e-400 -1E-400 0.5 1"));
    CHECK(samplesOf<double>(tiny) == std::vector<double>{0, 0, 0.5, 1});
    CHECK_THROWS_WITH(load(text("double", "1e400 1 2 3")), Contains("'1e400'"));
}

TEST_CASE("scaled values that floats do not hold are doubles, or refused", "[formats]") {
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {3, 2, 1, 1, 1, 1, 1, 1};
    nifti.slope = 3e38f;
    const Volume wide = load(folder.write("a.nii", nifti.header() + std::string("\1\2", 2)));
    CHECK(wide.sampleType() == SampleType::F64);
    CHECK(wide.value(1) == Approx(6e38));
    nifti.datatype = 16; // floats stay floats
    nifti.bitpix = 32;
    nifti.slope = 2;
    const auto floats = [&](float second) {
        return folder.write("b.nii", nifti.header() + bytesOf(std::vector<float>{1, second}));
    };
    CHECK(load(floats(4)).value(1) == 8);
    CHECK(load(floats(std::numeric_limits<float>::infinity())).invalidCount() == 1);
    CHECK_THROWS_WITH(load(floats(3e38f)), Contains("scaled as the header says"));
}
