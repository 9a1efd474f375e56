// The headers of Voreen and Inviwo: .dat and .vvd, and each way to break them.
#include <catch2/catch.hpp>

#include <filesystem>

#include "loaded.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume/outside_files.h"
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

const std::string kVoreen = "ObjectFileName: a.raw\nTaggedFileName: ---\nResolution: 3 2 1\n";
const std::string kInviwo = "RawFile: a.raw\nResolution: 3 2 1\n";
const std::vector<std::int16_t> kValues{1, -2, 3, 4, 5, 300};

/// A description with this element of data and these of MetaData.
std::string vvd(const std::string& raw, const std::string& items = "") {
    return "<?xml version=\"1.0\" ?>\n<VoreenData version=\"1\">\n<Volumes>\n<Volume>\n" + raw + "\n<MetaData>\n" +
           items + "</MetaData>\n</Volume>\n</Volumes>\n</VoreenData>\n";
}
std::string vectorItem(const std::string& name, const std::string& value) {
    return "<MetaItem name=\"" + name + "\" type=\"Vec3MetaData\">\n<value " + value + " />\n</MetaItem>\n";
}
const std::string kRaw = "<RawData filename=\"a.raw\" format=\"int16\" x=\"3\" y=\"2\" z=\"1\" />";

} // namespace

TEST_CASE("headers of Voreen read", "[dat]") {
    const TempFolder folder;
    folder.write("a.raw", bytesOf(kValues));
    const std::string path = folder.write("a.dat", "# a comment\n" + kVoreen +
                                                       "SliceThickness: 1 1.5 2 # mm\nFormat:\tSHORT\nObjectModel: I\n"
                                                       "GridType: EQUIDISTANT\nModality: CT\n");
    const Volume volume = loadVolume(sourceOf(path));
    CHECK(samplesOf<std::int16_t>(volume) == kValues);
    CHECK(volume.dims() == Int3(3, 2, 1));
    CHECK(volume.geometry().spacing == Vec3(1, 1.5, 2));
    CHECK(volume.format == "Voreen or Inviwo header");
    CHECK(volume.notices.empty());
    CHECK(filesOf(sourceOf(path)) == std::vector<std::string>{path, folder.path("a.raw")});
    CHECK_FALSE(mayBeHeaderless(path));
}

TEST_CASE("formats of Voreen and Inviwo are read by either's name", "[dat]") {
    const TempFolder folder;
    folder.write("a.raw", std::string(6 * 4 * 8, '\1'));
    const auto typeOf = [&](const std::string& format, const std::string& more = "") {
        const std::string path = folder.write("a.dat", kInviwo + "Format: " + format + "\n" + more);
        const FileContents contents = contentsOf(sourceOf(path));
        CHECK(loadVolume(sourceOf(path)).sampleType() == contents.type);
        return std::pair(contents.type, contents.components);
    };
    using enum SampleType;
    CHECK(typeOf("UCHAR") == std::pair(U8, 1));
    CHECK(typeOf("CHAR") == std::pair(I8, 1));
    CHECK(typeOf("USHORT") == std::pair(U16, 1));
    CHECK(typeOf("USHORT_12") == std::pair(U16, 1));
    CHECK(typeOf("UINT") == std::pair(U32, 1));
    CHECK(typeOf("INT") == std::pair(I32, 1));
    CHECK(typeOf("FLOAT") == std::pair(F32, 1));
    CHECK(typeOf("DOUBLE") == std::pair(F64, 1));
    CHECK(typeOf("UINT8", "ObjectModel: RGBA\n") == std::pair(U8, 4));
    CHECK(typeOf("FLOAT64") == std::pair(F64, 1));
    CHECK(typeOf("INT64") == std::pair(F64, 1));
    CHECK(typeOf("Vec3FLOAT32") == std::pair(F32, 3));
    CHECK(typeOf("Vec2UINT16") == std::pair(U16, 2));
}

TEST_CASE("headers of Inviwo say where the volume lies", "[dat]") {
    // The rows of BasisVector make a matrix whose columns are the edges: (0, 4, 0), (−3, 0, 0) and (0, 0, 5). Voxels
    // are (0, 4/3, 0), (−1.5, 0, 0) and (0, 0, 5); the first centre is half of each behind the corner.
    const TempFolder folder;
    folder.write("a.raw", "xx" + std::string("\0\1\xff\xfe\0\3\0\4\0\5\1\x2c", 12));
    const std::string basis = "BasisVector1: 0 -3 0\nBasisVector2: 4 0 0\nBasisVector3: 0 0 5\n";
    const std::string head =
        kInviwo + "Format: INT16\nByteOffset: 2\nByteOrder: BigEndian\nDataRange: 0 4095\nUnit: mm\n";
    const Volume volume = loadVolume(sourceOf(folder.write("a.dat", head + basis + "Offset: 10 20 30\n")));
    CHECK(samplesOf<std::int16_t>(volume) == kValues);
    CHECK(volume.geometry().directions[0] == Vec3(0, 1, 0));
    CHECK(volume.geometry().directions[1] == Vec3(-1, 0, 0));
    CHECK(volume.geometry().spacing.x == Approx(4.0 / 3));
    CHECK(volume.geometry().spacing.y == 1.5);
    CHECK(volume.geometry().origin.x == Approx(10 - 0.75));
    CHECK(volume.geometry().origin.y == Approx(20 + 2.0 / 3));
    CHECK(volume.geometry().origin.z == Approx(32.5));
    const Volume centred = loadVolume(sourceOf(folder.write("a.dat", head + basis)));
    CHECK(centred.geometry().origin.x == Approx(1.5 - 0.75));
    const Volume moved = loadVolume(sourceOf(
        folder.write("a.dat", head + "Spacing: 1 1 1\nOffset: 0 0 0\nWorldVector1: 2 0 0 7\nWorldVector2: 0 2 0 0\n"
                                     "WorldVector3: 0 0 2 0\nWorldVector4: 0 0 0 1\n")));
    CHECK(moved.geometry().spacing == Vec3(2, 2, 2));
    CHECK(moved.geometry().origin == Vec3(8, 1, 1));
    // What is stored from 0 to 100 means −1 to 1.
    const Volume scaled = loadVolume(sourceOf(folder.write(
        "a.dat",
        kInviwo + "Format: INT16\nByteOffset: 2\nByteOrder: BigEndian\nDataRange: 0 100\nValueRange: -1 1\n")));
    CHECK(scaled.value(0) == Approx(-0.98));
}

TEST_CASE("headers of Inviwo and Voreen may have time steps", "[dat]") {
    const TempFolder folder;
    folder.write("a.raw", "abcdefghijkl");
    for (const char* name : {"Sequences", "NumFrames"}) {
        VolumeSource source = sourceOf(folder.write("a.dat", kInviwo + "Format: UINT8\n" + name + ": 2\n"));
        CHECK(contentsOf(source).steps == 2);
        source.step = 1;
        CHECK(samplesOf<std::uint8_t>(loadVolume(source)) == std::vector<std::uint8_t>{'g', 'h', 'i', 'j', 'k', 'l'});
    }
}

TEST_CASE("a header that wrongly calls its voxels colours is read as the data are", "[dat]") {
    const TempFolder folder;
    folder.write("a.raw", "abcdef");
    const Volume volume = loadVolume(sourceOf(folder.write("a.dat", kVoreen + "Format: UCHAR\nObjectModel: RGB\n")));
    CHECK(samplesOf<std::uint8_t>(volume) == std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e', 'f'});
    REQUIRE(volume.notices.size() == 1);
    CHECK_THAT(volume.notices[0], Contains("3 components"));
}

TEST_CASE("descriptions of Voreen read", "[dat]") {
    const TempFolder folder;
    folder.write("a.raw", bytesOf(kValues));
    const std::string path =
        folder.write("a.vvd", vvd(kRaw, vectorItem("Offset", "x=\"-1\" y=\"2\" z=\"3\"") +
                                            vectorItem("Spacing", "x=\"0.5\" y=\"1\" z=\"2\"") +
                                            "<MetaItem name=\"Timestep\" type=\"FloatMetaData\" value=\"2.5\" />\n"));
    const Volume volume = loadVolume(sourceOf(path));
    CHECK(samplesOf<std::int16_t>(volume) == kValues);
    CHECK(volume.geometry().spacing == Vec3(0.5, 1, 2));
    CHECK(volume.geometry().origin == Vec3(-1, 2, 3));
    CHECK(volume.format == "Voreen volume");
    CHECK(contentsOf(sourceOf(path)).times == std::vector<double>{2.5});
    CHECK(filesOf(sourceOf(path)) == std::vector<std::string>{path, folder.path("a.raw")});

    const auto mapped = [&](const std::string& scale, const std::string& offset) {
        return loadVolume(sourceOf(folder.write(
            "a.vvd",
            vvd(kRaw, "<MetaItem name=\"RealWorldMapping\" type=\"RealWorldMappingMetaData\">\n<value scale=\"" +
                          scale + "\" offset=\"" + offset + "\" unit=\"HU\" />\n</MetaItem>\n"))));
    };
    CHECK(samplesOf<std::int16_t>(mapped("32767", "0")) == kValues); // back to what is stored
    CHECK(mapped("65534", "-5").value(0) == Approx(2 * 1 - 5));

    const std::string turned =
        "<MetaItem name=\"Transformation\" type=\"Mat4MetaData\">\n"
        "<value.row0 x=\"0\" y=\"-1\" z=\"0\" w=\"7\" />\n<value.row1 x=\"1\" y=\"0\" z=\"0\" w=\"0\" />\n"
        "<value.row2 x=\"0\" y=\"0\" z=\"1\" w=\"0\" />\n<value.row3 x=\"0\" y=\"0\" z=\"0\" w=\"1\" />\n"
        "</MetaItem>\n";
    const Volume other = loadVolume(sourceOf(folder.write("a.vvd", vvd(kRaw, turned))));
    CHECK(other.geometry().directions[0] == Vec3(0, 1, 0));
    CHECK(other.geometry().directions[1] == Vec3(-1, 0, 0));
    CHECK(other.geometry().origin == Vec3(7, 0, 0));

    // As newer versions name the file, and of several components.
    const std::string listed =
        "<RawData format=\"Vector2(uint8)\" x=\"3\" y=\"2\" z=\"1\"><Paths noPathSet=\"false\"><paths>"
        "<item value=\"a.raw\" /></paths></Paths></RawData>";
    CHECK(contentsOf(sourceOf(folder.write("a.vvd", vvd(listed)))).components == 2);
    CHECK(samplesOf<std::uint8_t>(loadVolume(sourceOf(folder.path("a.vvd"), 1)))[5] == 1);
}

TEST_CASE("a description of several volumes offers each", "[dat]") {
    const TempFolder folder;
    folder.write("a.raw", bytesOf(kValues));
    folder.write("b.raw", "ab");
    std::string text = vvd(kRaw);
    text.replace(text.find("</Volumes>"), 10,
                 "<Volume><RawData filename=\"b.raw\" format=\"uint8\" x=\"2\" y=\"1\" z=\"1\" /></Volume></Volumes>");
    VolumeSource source = sourceOf(folder.write("a.vvd", text));
    CHECK(contentsOf(source).arrays == std::vector<std::string>{"a.raw", "b.raw"});
    CHECK_THAT(loadVolume(source).notices.at(0), Contains("of 2 is shown"));
    source.array = "b.raw";
    CHECK(samplesOf<std::uint8_t>(loadVolume(source)) == std::vector<std::uint8_t>{'a', 'b'});
}

TEST_CASE("headers of Voreen and Inviwo that are damaged are refused in words", "[dat][bad-input]") {
    const TempFolder folder;
    folder.write("a.raw", bytesOf(kValues));
    const auto errorOfDat = [&](const std::string& text) { return errorOf(sourceOf(folder.write("a.dat", text))); };
    CHECK(errorOfDat(kVoreen + "Format: SHORT\n") == "no error");
    CHECK_THAT(errorOfDat("some text"), Contains("headerless data needs its layout"));
    CHECK_THAT(errorOfDat(bytesOf(kValues)), Contains("headerless data needs its layout"));
    CHECK_THAT(errorOfDat("ObjectFileName: a.raw\nFormat: SHORT\n"), Contains("no resolution"));
    CHECK_THAT(errorOfDat(kVoreen), Contains("no format"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: FLOAT16\n"), Contains("'FLOAT16' is not supported"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nObjectModel: TENSOR_UP\n"), Contains("'TENSOR_UP'"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: INT\n"), Contains("12 of 24 bytes"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nByteOffset: 1\n"), Contains("11 of 12 bytes"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nByteOffset: -1\n"), Contains("negative"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nByteOffset: 9000000000000000000\n"), Contains("0 of 12 bytes"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nNumFrames: 0\n"), Contains("at least 1"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nByteOrder: middle\n"), Contains("'middle' is not known"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nSliceThickness: 1 0 1\n"), Contains("spacing of axis 1"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nSliceThickness: 1 1\n"), Contains("2 of 3 numbers"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nBasisVector1: 1 0 0\n"), Contains("but not all"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nWorldVector4: 0 0 1 1\n"), Contains("perspective"));
    CHECK_THAT(errorOfDat(kVoreen + "Format: SHORT\nDataRange: 1 1\nValueRange: 0 1\n"), Contains("is empty"));
    CHECK_THAT(errorOfDat("ObjectFileName: b.raw\nResolution: 1 1 1\nFormat: UCHAR\n"), Contains("is missing"));
    CHECK_THAT(errorOfDat("ObjectFileName: a.raw\nResolution: 3 2\nFormat: UCHAR\n"), Contains("2 sizes"));
    CHECK_THAT(errorOfDat("ObjectFileName: a.raw\nResolution: 2000000000 2000000000 2000000000\nFormat: UCHAR\n"),
               Contains("more than any memory"));
    CHECK_THAT(errorOfDat("DatFile: b.dat\n"), Contains("names other .dat files"));
    for (const char* outside : {"/etc/passwd", "../a.raw"})
        CHECK_THAT(errorOfDat(std::string("RawFile: ") + outside + "\nResolution: 1 1 1\nFormat: UINT8\n"),
                   Contains("outside") || Contains("folder"));

    const auto errorOfVvd = [&](const std::string& text) { return errorOf(sourceOf(folder.write("a.vvd", text))); };
    CHECK(errorOfVvd(vvd(kRaw)) == "no error");
    CHECK_THAT(errorOfVvd("<html/>"), Contains("not a volume description of Voreen"));
    CHECK_THAT(errorOfVvd("<VoreenData version=\"1\"></VoreenData>"), Contains("describes no volume"));
    CHECK_THAT(errorOfVvd(vvd("<RawData filename=\"a.raw\" format=\"half\" x=\"3\" y=\"2\" z=\"1\" />")),
               Contains("'half' is not supported"));
    CHECK_THAT(errorOfVvd(vvd("<RawData filename=\"a.raw\" format=\"int16\" x=\"3\" y=\"b\" z=\"1\" />")),
               Contains("'b', not a whole number"));
    CHECK_THAT(errorOfVvd(vvd("<RawData filename=\"a.raw\" format=\"int16\" x=\"3\" y=\"3\" z=\"1\" />")),
               Contains("12 of 18 bytes"));
    CHECK_THAT(errorOfVvd(vvd("<RawData format=\"int16\" x=\"3\" y=\"3\" z=\"1\" />")), Contains("names no file"));
    CHECK_THAT(errorOfVvd(vvd("<OctreeData />")), Contains("'OctreeData' is not supported"));
    CHECK_THAT(errorOfVvd(vvd(kRaw, vectorItem("Spacing", "x=\"1\" y=\"-1\" z=\"1\""))), Contains("spacing of axis 1"));
    CHECK_THAT(errorOfVvd(vvd(kRaw, vectorItem("Spacing", "x=\"1\" y=\"one\" z=\"1\""))),
               Contains("'one', not a number"));
    CHECK_THAT(errorOfVvd(vvd("<RawData filename=\"/etc/passwd\" format=\"uint8\" x=\"1\" y=\"1\" z=\"1\" />")),
               Contains("outside") || Contains("folder"));
}
