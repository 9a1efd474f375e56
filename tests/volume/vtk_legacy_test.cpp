// VTK's legacy files: every type and way of writing, grids, and each way to break them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <numeric>

#include "loaded.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

using Names = std::vector<std::string>;

VolumeSource sourceOf(const std::string& path, const std::string& array = "", int component = 0) {
    VolumeSource source;
    source.path = path;
    source.array = array;
    source.component = component;
    return source;
}

/// As a binary file has them.
template <class T>
std::string bigEndian(std::vector<T> values) {
    if (std::endian::native == std::endian::little)
        for (T& value : values) {
            auto* const bytes = reinterpret_cast<char*>(&value);
            std::reverse(bytes, bytes + sizeof(T));
        }
    return bytesOf(values);
}

template <class T>
std::string words(const std::vector<T>& values) {
    std::string text;
    for (const T& value : values) text += std::to_string(value) + (text.size() % 3 == 0 ? "\n" : " ");
    return text;
}

/// 3 x 2 x 2 points, and as many values as there are.
const std::string kGrid = "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nSPACING 1 2 3\nORIGIN 10 20 30\n";

std::string vtk(bool binary, const std::string& body, const std::string& grid = kGrid) {
    return "# vtk DataFile Version 3.0\na title\n" + std::string(binary ? "BINARY\n" : "ASCII\n") + grid + body;
}

} // namespace

TEMPLATE_TEST_CASE("legacy VTK files read in every type, written out and binary", "[vtk-legacy]", std::int8_t,
                   std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t, float, double) {
    const TempFolder folder;
    std::vector<TestType> values(12);
    std::iota(values.begin(), values.end(), static_cast<TestType>(3));
    values[5] = std::numeric_limits<TestType>::lowest();
    values[6] = std::numeric_limits<TestType>::max();
    if constexpr (std::is_floating_point_v<TestType>) {
        values[5] = static_cast<TestType>(-0.25);
        values[6] = static_cast<TestType>(1024.5);
    }
    Names names;
    if (std::is_same_v<TestType, std::int8_t>) names = {"char", "signed_char"};
    if (std::is_same_v<TestType, std::uint8_t>) names = {"unsigned_char"};
    if (std::is_same_v<TestType, std::int16_t>) names = {"short"};
    if (std::is_same_v<TestType, std::uint16_t>) names = {"unsigned_short"};
    if (std::is_same_v<TestType, std::int32_t>) names = {"int", "vtkIdType"};
    if (std::is_same_v<TestType, std::uint32_t>) names = {"unsigned_int"};
    if (std::is_same_v<TestType, float>) names = {"float"};
    if (std::is_same_v<TestType, double>) names = {"double"};
    for (const std::string& name : names)
        for (const bool binary : {false, true})
            for (const char* table : {"", "LOOKUP_TABLE default\n"}) {
                CAPTURE(name, binary, table);
                const std::string body = "POINT_DATA 12\nSCALARS density " + name + "\n" + table +
                                         (binary ? bigEndian(values) : words(values)) + "\n";
                const Volume volume = loadVolume(sourceOf(folder.write("a.vtk", vtk(binary, body))));
                CHECK(samplesOf<TestType>(volume) == values);
                CHECK(volume.dims() == Int3(3, 2, 2));
                CHECK(volume.geometry().spacing == Vec3(1, 2, 3));
                CHECK(volume.geometry().origin == Vec3(10, 20, 30));
                CHECK(volume.format == "VTK legacy file");
                CHECK(volume.notices.empty());
            }
}

TEST_CASE("64-bit integers of legacy VTK files become doubles", "[vtk-legacy]") {
    const TempFolder folder;
    const std::vector<std::int64_t> values{-3, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, std::int64_t{1} << 50};
    for (const std::string name : {"long", "vtktypeint64"}) {
        const std::string body = "POINT_DATA 12\nSCALARS a " + name + " 1\nLOOKUP_TABLE default\n" + bigEndian(values);
        const Volume volume = loadVolume(sourceOf(folder.write("a.vtk", vtk(true, body))));
        CHECK(samplesOf<double>(volume) == std::vector<double>(values.begin(), values.end()));
    }
}

TEST_CASE("legacy VTK files have arrays of many kinds", "[vtk-legacy]") {
    const TempFolder folder;
    for (const bool binary : {false, true}) {
        CAPTURE(binary);
        const auto floats = [&](std::size_t count, float first) {
            std::vector<float> values(count);
            std::iota(values.begin(), values.end(), first);
            return (binary ? bigEndian(values) : words(values)) + "\n";
        };
        const std::string colours = binary ? std::string("abcdefghijklmnopqrstuvwx") + "\n" : floats(24, 0);
        const std::string table = binary ? "abcdefgh\n" : "0 0 0 1 1 1 1 1\n";
        const std::string bits = binary ? "\x12\x30\n" : "0 1 0 1 0 1 0 1 0 1 0 1\n";
        const std::string text = vtk(
            binary, "FIELD FieldData 1\nTIME 1 1 float\n" + floats(1, 7) + "CELL_DATA 2\nSCALARS of_cells float\n" +
                        floats(2, 50) + "point_data 12\nVECTORS flow%20a float\n" + floats(36, 100) +
                        "METADATA\nCOMPONENT_NAMES\nX\nY\n\nSCALARS two float 2\nLOOKUP_TABLE colours\n" +
                        floats(24, 200) + "LOOKUP_TABLE colours 2\n" + table + "NORMALS n float\n" + floats(36, 300) +
                        "TENSORS t float\n" + floats(108, 400) + "COLOR_SCALARS c%%20d 2\n" + colours +
                        "SCALARS mask bit\nLOOKUP_TABLE default\n" + bits + "FIELD FieldData 3\nof_cells 1 12 float\n" +
                        floats(12, 600) + "METADATA\nINFORMATION 0\n\nother 2 5 float\n" + floats(10, 700) +
                        "last 3 12 float\n" + floats(36, 800));
        const std::string path = folder.write("a.vtk", text);
        const FileContents contents = contentsOf(sourceOf(path));
        CHECK(contents.arrays ==
              Names{"flow a", "two", "n", "t", "c d", "mask", "of_cells", "last", "of_cells (cells)"});
        CHECK(contents.array == "two"); // the first scalars
        CHECK(contents.components == 2);
        CHECK(contents.times == std::vector<double>{7});
        const auto first = [&](const std::string& array, int component) {
            return loadVolume(sourceOf(path, array, component)).value(0);
        };
        CHECK(first("flow a", 2) == 102);
        CHECK(first("two", 1) == 201);
        CHECK(first("n", 1) == 301);
        CHECK(first("t", 8) == 408);
        CHECK(first("c d", 1) == (binary ? 'b' : 255)); // 1 is the brightest
        CHECK(first("of_cells", 0) == 600);
        CHECK(first("last", 2) == 802);
        CHECK_THAT(errorOf(sourceOf(path, "mask")), Contains("'bit' of 'mask' is not supported"));
        CHECK_THROWS_WITH(loadVolume(sourceOf(path, "none")), Contains("no array 'none'") && Contains("flow a, two"));

        const Volume cells = loadVolume(sourceOf(path, "of_cells (cells)"));
        CHECK(cells.dims() == Int3(2, 1, 1));
        CHECK(cells.geometry().origin == Vec3(10.5, 21, 31.5)); // the middle of the first cell
        CHECK(samplesOf<float>(cells) == std::vector<float>{50, 51});
        REQUIRE(cells.notices.size() == 1);
        CHECK_THAT(cells.notices[0], Contains("those of cells"));
    }
}

TEST_CASE("colours of legacy VTK files are bytes, also where they are written out", "[vtk-legacy]") {
    const TempFolder folder;
    // n / 255 as VTK writes it, 12 points of two components; and numbers that are no colours.
    std::string text, bytes;
    std::vector<std::uint8_t> expected;
    for (int n = 0; n < 24; ++n) {
        const int value = n * 11;
        char word[16];
        std::snprintf(word, sizeof word, "%.6g ", value / 255.0);
        text += word;
        bytes += static_cast<char>(value);
        if (n % 2 == 1) expected.push_back(static_cast<std::uint8_t>(value));
    }
    const std::string head = "POINT_DATA 12\nCOLOR_SCALARS c 2\n";
    for (const bool binary : {false, true}) {
        CAPTURE(binary);
        const std::string path = folder.write("a.vtk", vtk(binary, head + (binary ? bytes : text) + "\n"));
        CHECK(contentsOf(sourceOf(path)).type == SampleType::U8);
        CHECK(samplesOf<std::uint8_t>(loadVolume(sourceOf(path, "c", 1))) == expected);
        VolumeSource part = sourceOf(path, "c", 1);
        part.region = VoxelRegion{{1, 0, 0}, {2, 1, 1}};
        CHECK(loadVolume(part).value(0) == expected[1]);
    }
    const std::string one = "POINT_DATA 12\nCOLOR_SCALARS c 1\n";
    const Volume beyond =
        loadVolume(sourceOf(folder.write("b.vtk", vtk(false, one + "-1 0 1 2 0.5 0.5 0.5 0.5 0.5 0.5 0.5 0.5\n"))));
    CHECK(beyond.value(0) == 0);
    CHECK(beyond.value(3) == 255);
    CHECK(beyond.value(4) == 128); // 127.5 + 0.5
    CHECK_THAT(errorOf(sourceOf(folder.write("d.vtk", vtk(false, one + "0 0 0 0 0 0 0 0 0 0 0 x\n")))),
               Contains("'x' where a number belongs"));
}

TEST_CASE("cells of a flat legacy VTK image lie in its plane", "[vtk-legacy]") {
    const TempFolder folder;
    const std::string grid = "DATASET structured_points\nORIGIN 0 0 5\nASPECT_RATIO 2 2 2\nDIMENSIONS 3 2 1\n";
    const Volume volume =
        loadVolume(sourceOf(folder.write("a.vtk", vtk(false, "CELL_DATA 2\nSCALARS a int\n1 2\n", grid))));
    CHECK(volume.dims() == Int3(2, 1, 1));
    CHECK(volume.geometry().origin == Vec3(1, 1, 5));
}

TEST_CASE("legacy VTK files say where their image begins", "[vtk-legacy]") {
    const TempFolder folder;
    const std::string grid = "DATASET STRUCTURED_POINTS\nEXTENT 2 3 -1 0 0 0\nORIGIN 1 1 1\nSPACING 2 3 4\n";
    const Volume volume =
        loadVolume(sourceOf(folder.write("a.vtk", vtk(false, "POINT_DATA 4\nSCALARS a int\n1 2 3 4\n", grid))));
    CHECK(volume.dims() == Int3(2, 2, 1));
    CHECK(volume.geometry().origin == Vec3(5, -2, 1));
}

TEST_CASE("rectilinear grids of VTK are read where they are regular", "[vtk-legacy]") {
    const TempFolder folder;
    const std::string data = "POINT_DATA 3\nSCALARS a int\n";
    const std::vector<std::int32_t> values{1, 2, 3};
    const auto written = [&](bool binary, const std::vector<double>& x) {
        const std::string one = binary ? bigEndian(std::vector<float>{4}) + "\n" : "4\n";
        const auto count = std::to_string(x.size());
        const std::string grid = "DATASET RECTILINEAR_GRID\nDIMENSIONS 3 1 1\nX_COORDINATES " + count + " double\n" +
                                 (binary ? bigEndian(x) + "\n" : words(x)) + "\nY_COORDINATES 1 float\n" + one +
                                 "Z_COORDINATES 1 float\n" + one;
        return folder.write("a.vtk", vtk(binary, data + (binary ? bigEndian(values) : words(values)), grid));
    };
    for (const bool binary : {false, true}) {
        CAPTURE(binary);
        const Volume volume = loadVolume(sourceOf(written(binary, {0.5, 2.0, 3.5})));
        CHECK(samplesOf<std::int32_t>(volume) == values);
        CHECK(volume.geometry().spacing == Vec3(1.5, 1, 1));
        CHECK(volume.geometry().origin == Vec3(0.5, 4, 4));
        CHECK_THAT(errorOf(sourceOf(written(binary, {0, 1, 3}))),
                   Contains("X_COORDINATES are not evenly spaced: number 1 is 1, not 1.5"));
        CHECK_THAT(errorOf(sourceOf(written(binary, {3, 2, 1}))), Contains("X_COORDINATES do not increase"));
        CHECK_THAT(errorOf(sourceOf(written(binary, {1, 2}))), Contains("there are 2 X_COORDINATES"));
    }
}

TEST_CASE("legacy VTK files that are something else, or damaged, are refused in words", "[vtk-legacy][bad-input]") {
    const TempFolder folder;
    const auto errorOfText = [&](const std::string& text) { return errorOf(sourceOf(folder.write("a.vtk", text))); };
    const auto errorOfBody = [&](const std::string& body, const std::string& grid = kGrid) {
        return errorOfText(vtk(false, body, grid));
    };
    const std::string data = "POINT_DATA 12\nSCALARS a int\n1 2 3 4 5 6 7 8 9 10 11 12\n";
    CHECK(errorOfBody(data) == "no error");
    CHECK_THAT(errorOfText("some other text"), Contains("this is not a VTK file but text"));
    CHECK_THAT(errorOfText("# vtk DataFile Version 3.0\nt\nUTF-8\n"), Contains("neither ASCII nor BINARY"));
    for (const char* other : {"POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID"})
        CHECK_THAT(errorOfBody("", std::string("DATASET ") + other + "\n"), Contains("holds '" + std::string(other)));
    CHECK_THAT(errorOfBody("", "DATASET STRUCTURED_POINTS\n"), Contains("no DIMENSIONS"));
    CHECK_THAT(errorOfBody(""), Contains("no values for points"));
    CHECK_THAT(errorOfBody(data, ""), Contains("before any DATASET"));
    CHECK_THAT(errorOfBody(data, "DATASET STRUCTURED_POINTS\n"), Contains("before DIMENSIONS"));
    CHECK_THAT(errorOfBody(data, "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 x 2\n"), Contains("there is 'x'"));
    CHECK_THAT(errorOfBody(data, "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 0 2\n"), Contains("at least 1"));
    CHECK_THAT(errorOfBody(data, "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 2000000000 2000000000\n"),
               Contains("more than any memory"));
    CHECK_THAT(errorOfBody(data, kGrid + "SPACING 1 0 1\n"), Contains("spacing of axis 1 is '0'"));
    CHECK_THAT(errorOfBody("POINT_DATA 11\n"), Contains("POINT_DATA 11") && Contains("have 12"));
    CHECK_THAT(errorOfBody("CELL_DATA 12\n"), Contains("CELL_DATA 12") && Contains("have 2"));
    CHECK_THAT(errorOfBody("SCALARS a int\n"), Contains("before POINT_DATA"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSCALARS a string\n1\n"), Contains("'string' of 'a' is not supported"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSCALARS a int x\n"), Contains("there is 'x'"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSCALARS a int -1\n1"), Contains("has -1 components"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSCALARS a int\n1 2 3 4 5 6\n"), Contains("12 values"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSCALARS a int\n1 2 3 four 5 6 7 8 9 10 11 12\n"),
               Contains("there is 'four'"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSCALARS a short\n1 2 3 70000 5 6 7 8 9 10 11 12\n"),
               Contains("does not fit"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nSURPRISE a int\n"), Contains("keyword 'surprise' is not known"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nFIELD f 1\na 1 9000000000000000000 int\n1\n"), Contains("more values than"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nFIELD f 1\na 99999999999 12 int\n1\n"), Contains("99999999999 components"));
    CHECK_THAT(errorOfBody("POINT_DATA 12\nFIELD f 9000000000000000000\n"), Contains("the file ends where"));
    CHECK_THAT(errorOfText(vtk(true, "POINT_DATA 12\nSCALARS a int\n" + std::string(47, 'x'))),
               Contains("47 of 48 bytes"));
    // A huge grid that the file does not hold: refused before anything is allocated.
    CHECK_THAT(errorOfBody("POINT_DATA 1000000000000\nSCALARS a double\n1\n",
                           "DATASET STRUCTURED_POINTS\nDIMENSIONS 10000 10000 10000\n"),
               Contains("more values than"));
    CHECK_THAT(
        errorOfText("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\n" + std::string(5000, 'x')),
        Contains("more than 4096 characters"));
    // Cut off anywhere: an error, or all values.
    const std::string whole = vtk(false, data);
    for (std::size_t length = 0; length + 4 < whole.size(); length += 3)
        CHECK(errorOfText(whole.substr(0, length)) != "no error");
}
