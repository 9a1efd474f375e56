// VTK's XML image data and collections: good files in each encoding, and each way to break them.
#include <catch2/catch.hpp>

#include <filesystem>

#include "loaded.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/series.h"
#include "volume_files.h"
#include "vtk_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

using Names = std::vector<std::string>;

const std::vector<float> kDensity{1, -2, 3.5, 1e-20f, 5, 6};
const std::vector<std::int16_t> kFlow{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, -12};

std::vector<Array> twoArrays(const Style& style) {
    return {{"type=\"Float32\" Name=\"a &amp; b\"", "1 -2 3.5 1e-20\n5 6", swapped(bytesOf(kDensity), 4, style)},
            {"type=\"Int16\" Name=\"flow\" NumberOfComponents=\"2\"", "1 2 3 4 5 6 7 8 9 10 11 -12",
             swapped(bytesOf(kFlow), 2, style)}};
}

VolumeSource sourceOf(const std::string& path, const std::string& array = "") {
    VolumeSource source;
    source.path = path;
    source.array = array;
    return source;
}

} // namespace

TEST_CASE("image data of VTK reads in every encoding", "[vtk]") {
    const TempFolder folder;
    using Place = Style::Place;
    for (const Place place : {Place::Ascii, Place::Inline, Place::Raw, Place::Base64})
        for (int bits = 0; bits < 8; ++bits) {
            const Style style{place, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
            CAPTURE(static_cast<int>(place), style.compressed, style.bigEndian, style.wide);
            const std::string path = folder.write("a.vti", vti(style, twoArrays(style)));
            const Volume density = loadVolume(sourceOf(path));
            CHECK(samplesOf<float>(density) == kDensity);
            CHECK(density.dims() == Int3(2, 3, 1));
            CHECK(density.format == "VTK image data");
            REQUIRE(density.notices.size() == 1);
            CHECK_THAT(density.notices[0], Contains("a & b") && Contains("of 2"));
            VolumeSource flow = sourceOf(path, "flow");
            CHECK(samplesOf<std::int16_t>(loadVolume(flow)) == std::vector<std::int16_t>{1, 3, 5, 7, 9, 11});
            flow.component = 1;
            CHECK(samplesOf<std::int16_t>(loadVolume(flow)) == std::vector<std::int16_t>{2, 4, 6, 8, 10, -12});
            const FileContents contents = contentsOf(sourceOf(path, "flow"));
            CHECK(contents.arrays == Names{"a & b", "flow"});
            CHECK(contents.components == 2);
            CHECK(contents.type == SampleType::I16);
            CHECK(contents.dims == Int3(2, 3, 1));
            CHECK(contents.times.empty());
        }
}

TEST_CASE("a header that is in base64 apart from its data reads, too", "[vtk]") {
    const TempFolder folder;
    const Style style{Style::Place::Inline, false, false, false};
    std::string text = vti(style, {{"type=\"UInt8\" Name=\"a\"", "", "abcdef"}});
    const std::string whole = base64(number(style, 6) + "abcdef");
    text.replace(text.find(whole), whole.size(), base64(number(style, 6)) + base64("abcdef"));
    CHECK(samplesOf<std::uint8_t>(loadVolume(sourceOf(folder.write("a.vti", text)))) ==
          std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e', 'f'});
}

TEST_CASE("the active scalars of a VTK file come first", "[vtk]") {
    const TempFolder folder;
    const Style style;
    const std::string path = folder.write("a.vti", vti(style, twoArrays(style), " Scalars=\"flow\""));
    CHECK(loadVolume(sourceOf(path)).sampleType() == SampleType::I16);
    CHECK(loadVolume(sourceOf(path, "a & b")).sampleType() == SampleType::F32);
    CHECK_THROWS_WITH(loadVolume(sourceOf(path, "none")), Contains("no array 'none'") && Contains("a & b, flow"));
    CHECK_THROWS_WITH(loadVolume(sourceOf(folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\n"
                                                                 "encoding: raw\n\nx"),
                                          "flow")),
                      Contains("no array 'flow'"));
}

TEST_CASE("place and directions of a VTK image", "[vtk]") {
    // Axis i points along +y, j along −x (the columns of Direction). The extent begins at voxel (1, −2, 0): its centre
    // is origin + 1·2·(0,1,0) − 2·3·(−1,0,0) = (10 + 6, 20 + 2, 30).
    const TempFolder folder;
    const Volume volume = loadVolume(sourceOf(folder.write(
        "a.vti",
        vti({}, {{"type=\"UInt8\" Name=\"a\"", "1 2 3 4 5 6", ""}}, "",
            "WholeExtent=\"1 2 -2 0 0 0\" Origin=\"10 20 30\" Spacing=\"2 3 4\" Direction=\"0 -1 0 1 0 0 0 0 1\"",
            "1 2 -2 0 0 0"))));
    CHECK(volume.geometry().spacing == Vec3(2, 3, 4));
    CHECK(volume.geometry().origin == Vec3(16, 22, 30));
    CHECK(volume.geometry().directions[0] == Vec3(0, 1, 0));
    CHECK(volume.geometry().directions[1] == Vec3(-1, 0, 0));
    CHECK(volume.geometry().directions[2] == Vec3(0, 0, 1));
}

TEST_CASE("VTK files that are something else are refused in words", "[vtk][bad-input]") {
    const TempFolder folder;
    const std::vector<Array> one{{"type=\"UInt8\" Name=\"a\"", "1 2 3 4 5 6", "abcdef"}};
    const std::string good = vti({}, one);
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        REQUIRE(text.find(from) != std::string::npos);
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
        return errorOf(sourceOf(folder.write("a.vti", text)));
    };
    CHECK(changed("UInt8", "UInt8") == "no error");
    CHECK_THAT(changed("type=\"ImageData\"", "type=\"UnstructuredGrid\""), Contains("UnstructuredGrid"));
    CHECK_THAT(changed("PointData", "CellDatum"), Contains("no values for points"));
    CHECK_THAT(changed("Extent=\"0", "Extent=\"-9223372036854775808"), Contains("not six whole numbers"));
    CHECK_THAT(
        errorOf(sourceOf(folder.write(
            "c.vti",
            "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\"><Piece><CellData>"
            "<DataArray type=\"UInt8\" format=\"ascii\">1</DataArray></CellData></Piece></ImageData></VTKFile>"))),
        Contains("no error"));
    CHECK_THAT(changed("LittleEndian", "MiddleEndian"), Contains("MiddleEndian"));
    CHECK_THAT(changed("LittleEndian\"", "LittleEndian\" header_type=\"UInt16\""), Contains("UInt16"));
    CHECK_THAT(changed("LittleEndian\"", "LittleEndian\" compressor=\"vtkOtherDataCompressor\""), Contains("vtkOther"));
    CHECK_THAT(changed("UInt8", "String"), Contains("String"));
    CHECK_THAT(changed("\"ascii\"", "\"verse\""), Contains("verse"));
    CHECK_THAT(changed("format=\"ascii\"", "format=\"appended\" offset=\"0\""), Contains("no appended data"));
    CHECK_THAT(changed("format=\"ascii\"", "format=\"appended\" offset=\"-1\""), Contains("negative"));
    CHECK_THAT(changed("<Piece Extent=\"0 1 0 2 0 0\">", "<Piece Extent=\"0 1 0 1 0 0\">"),
               Contains("no piece has the point 0 2 0 of the extent 0 1 0 2 0 0"));
    CHECK_THAT(changed("  <Piece", "<Piece/>  <Piece"), Contains("piece 1 of 2 has no array 'a'"));
    CHECK_THAT(changed("0 1 0 2 0 0", "0 1 0 2 0"), Contains("six whole numbers"));
    CHECK_THAT(changed("Spacing=\"1 1 1\"", "Spacing=\"1 0 1\""),
               Contains("spacing of axis 1 is 0, it must be positive"));
    CHECK_THAT(changed("Spacing=\"1 1 1\"", "Spacing=\"1 nan 1\""), Contains("Spacing"));
    CHECK_THAT(changed("Spacing=\"1 1 1\"", "Spacing=\"1 1\""), Contains("2 numbers, not 3"));
    CHECK_THAT(changed("Origin=\"0 0 0\"", "Direction=\"1 0 0 1 0 0 0 0 1\""), Contains("in one plane"));
    CHECK_THAT(changed(" Name=\"a\"", " Name=\"a\" NumberOfComponents=\"0\""), Contains("at least 1"));
    CHECK_THAT(changed("0 1 0 2 0 0", "0 9999 0 9999 0 9999"), Contains("cannot hold"));
    CHECK_THAT(changed("0 1 0 2 0 0", "0 2147483646 0 2147483646 0 2147483646"), Contains("more than any memory"));
    CHECK_THAT(changed("0 1 0 2 0 0", "1 0 0 2 0 0"), Contains("at least 1"));
    // Text and tags.
    CHECK_THAT(changed("1 2 3 4 5 6", "1 2 3 4 5"), Contains("5 of 6 values"));
    CHECK_THAT(changed("1 2 3 4 5 6", "1 2 three 4 5 6"), Contains("three"));
    CHECK_THAT(changed("1 2 3 4 5 6", "1 2 3 4 5 256"), Contains("does not fit"));
    CHECK_THAT(changed("</Piece>", "</Place>"), Contains("closes an element that is not open"));
    CHECK_THAT(changed("</VTKFile>", ""), Contains("ends within"));
    CHECK_THAT(changed(" Name=\"a\"", " Name=a"), Contains("has no value"));
    CHECK_THAT(changed(" Name=\"a\"", " Name=\"a"), Contains("not valid XML"));
    CHECK_THAT(changed(" Name=\"a\"", " Name=\"" + std::string(70'000, 'a') + "\""), Contains("too long"));
    CHECK_THAT(changed("<PointData>", "<!-- <PointData>"), Contains("comment does not end"));
    CHECK_THAT(changed("?xml version=\"1.0\"?", ""), Contains("has no name"));
    CHECK_THAT(errorOf(sourceOf(folder.write("e.vti", ""))), Contains("is empty"));
    CHECK_THAT(errorOf(sourceOf(folder.write("p.vti", "\x89PNG..."))), Contains("a PNG image"));
    CHECK_THAT(errorOf(sourceOf(folder.write("h.vti", "<html></html>"))), Contains("html"));
}

TEST_CASE("VTK data that are cut off or damaged are refused before anything is allocated", "[vtk][bad-input]") {
    const TempFolder folder;
    using Place = Style::Place;
    const std::string values(6000, 'x');
    const std::string image = "WholeExtent=\"0 9 0 19 0 29\"", extent = "0 9 0 19 0 29"; // 10·20·30
    const auto file = [&](const Style& style, const std::string& data) {
        return vti(style, {{"type=\"UInt8\" Name=\"a\"", "", data}}, "", image, extent);
    };
    for (const Place place : {Place::Inline, Place::Raw, Place::Base64})
        for (const bool compressed : {false, true}) {
            const Style style{place, compressed, false, true};
            CAPTURE(static_cast<int>(place), compressed);
            const std::string good = file(style, values);
            CHECK(errorOf(sourceOf(folder.write("a.vti", good))) == "no error");
            CHECK_THAT(errorOf(sourceOf(folder.write("a.vti", file(style, values.substr(1))))),
                       Contains("5999 bytes, but its extent and type need 6000"));
            // Cut off in the middle of the data: of inline data the element does not end.
            std::string cut = good.substr(0, good.size() / 2);
            CHECK(errorOf(sourceOf(folder.write("a.vti", cut))) != "no error");
            const std::string begin = place == Place::Inline ? "\"binary\">" : "_";
            CHECK(errorOf(sourceOf(folder.write("a.vti", good.substr(0, good.rfind(begin) + begin.size() + 3)))) !=
                  "no error");
            if (place == Place::Inline) {
                cut += "</DataArray></PointData></Piece></ImageData></VTKFile>";
                CHECK_THAT(errorOf(sourceOf(folder.write("a.vti", cut))),
                           Contains(compressed ? "after" : "of 6000 bytes"));
            }
            if (!compressed) continue;
            // One byte in the middle of a block, digit or not.
            std::string damaged = good;
            damaged[good.size() * 3 / 4] ^= place == Place::Raw ? 0x55 : 3;
            CHECK(errorOf(sourceOf(folder.write("a.vti", damaged))) != "no error");
        }
    // Headers that claim what no file holds: 2^62 blocks, blocks of 2^62 bytes, a last block that is longer.
    const Style raw{Place::Raw, true, false, true};
    const std::string good = file(raw, values);
    const std::size_t header = good.rfind("_" + number(raw, 600)) + 1;
    for (const auto& [at, claim] : {std::pair{0, std::uint64_t{1} << 62},
                                    {8, std::uint64_t{1} << 62},
                                    {16, 11u},
                                    {24, std::uint64_t{1} << 62},
                                    {0, 0u}}) {
        std::string claims = good;
        claims.replace(header + static_cast<std::size_t>(at), 8, number(raw, claim));
        CAPTURE(at, claim);
        CHECK(errorOf(sourceOf(folder.write("a.vti", claims))) != "no error");
    }
    // More blocks of 10 bytes than 6000 are cut into: refused before there is a table of them.
    std::string many = good;
    many.replace(header, 8, number(raw, 700));
    CHECK_THAT(errorOf(sourceOf(folder.write("a.vti", many))), Contains("makes no sense"));
}

TEST_CASE("entities of XML have an end nearby, or are none", "[vtk]") {
    const TempFolder folder;
    const auto nameOf = [&](const std::string& written) {
        const std::string attributes = "type=\"UInt8\" Name=\"" + written + "\"";
        return contentsOf(sourceOf(folder.write("a.vti", vti({}, {{attributes, "1 2 3 4 5 6", "abcdef"}})))).arrays;
    };
    CHECK(nameOf("a &amp; b &#x10fffd;") == std::vector<std::string>{"a & b \xf4\x8f\xbf\xbd"});
    CHECK(nameOf("&amp b; &123456789amp;") == std::vector<std::string>{"&amp b; &123456789amp;"});
    const std::string flood(60'000, '&');
    CHECK(nameOf(flood + ";") == std::vector<std::string>{flood + ";"});
}

TEST_CASE("time of a VTK image", "[vtk]") {
    const TempFolder folder;
    const auto at = [&](const std::string& name, const std::string& time) {
        std::string text = vti({}, {{"type=\"UInt8\" Name=\"a\"", "1 2 3 4 5 6", ""}});
        text.insert(text.find("  <Piece"),
                    "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                    "format=\"ascii\">" +
                        time + "</DataArray></FieldData>");
        return folder.write(name, text);
    };
    at("f1.vti", "0.5");
    at("f2.vti", "0.75");
    const SeriesListing listing = listSeries(sourceOf(folder.path("f*.vti")));
    REQUIRE(listing.frames.size() == 2);
    CHECK(listing.hasTimes);
    CHECK(listing.label(1) == "t = 0.75");
    at("f2.vti", "soon"); // no time: no times
    CHECK_FALSE(listSeries(sourceOf(folder.path("f*.vti"))).hasTimes);
}

TEST_CASE("a collection lists its files by time", "[vtk]") {
    const TempFolder folder;
    for (const char letter : {'a', 'b', 'c'})
        folder.write(std::string("f_") + letter + ".vti",
                     vti({}, {{"type=\"UInt8\" Name=\"v\"", std::to_string(int(letter)) + " 2 3 4 5 6", ""}}));
    const auto collection = [](const std::string& sets) {
        return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" + sets +
               "</Collection>\n</VTKFile>\n";
    };
    const std::string path = folder.write(
        "all.pvd",
        collection("<DataSet timestep=\"10\" group=\"\" part=\"0\" file=\"f_b.vti\"/>\n"
                   "<DataSet timestep=\"2.5\" group=\"\" part=\"0\" file=\"f_a.vti\"/>\n"
                   "<DataSet timestep=\"11\" file='gone.vti'/><DataSet timestep=\"12\" file=\"./f_c.vti\"/>"));
    const SeriesListing listing = listSeries(sourceOf(path));
    REQUIRE(listing.frames.size() == 4);
    CHECK(listing.title == "all.pvd");
    CHECK(listing.label(0) == "t = 2.5");
    CHECK(loadVolume(listing.frames[0].source).value(0) == 'a');
    CHECK(loadVolume(listing.frames[1].source).value(0) == 'b');
    CHECK(loadVolume(listing.frames[3].source).value(0) == 'c');
    CHECK_THROWS_WITH(loadVolume(listing.frames[2].source), Contains("no such file") && Contains("gone.vti"));
    CHECK(contentsOf(sourceOf(path)).arrays == Names{"v"});
    CHECK(filesOf(sourceOf(path)).size() == 5);                       // itself and the four
    CHECK(listSeries(sourceOf(folder.path("."))).title == "all.pvd"); // it knows the times of the files beside it
    // Numbered characters, as other writers give them: grün ü €.vti
    folder.write("gr\u00fcn \u00fc \u20ac.vti", vti({}, {{"type=\"UInt8\" Name=\"v\"", "100 2 3 4 5 6", ""}}));
    const SeriesListing odd =
        listSeries(sourceOf(folder.write("odd.pvd", collection("<DataSet file=\"gr&#252;n &#xfc; &#x20AC;.vti\"/>"))));
    CHECK(loadVolume(odd.frames[0].source).value(0) == 'd');

    const auto refused = [&](const std::string& text) { return errorOf(sourceOf(folder.write("b.pvd", text))); };
    CHECK_THAT(refused(collection("")), Contains("names no files"));
    CHECK_THAT(refused(collection("<DataSet timestep=\"1\"/>")), Contains("names no file"));
    CHECK_THAT(refused(collection("<DataSet timestep=\"x\" file=\"f_a.vti\"/>")), Contains("is not a number"));
    CHECK_THAT(refused(collection("<DataSet file=\"b.pvd\"/>")), Contains("another collection"));
    CHECK_THAT(refused(collection("<DataSet timestep=\"1\" part=\"0\" file=\"f_a.vti\"/>"
                                  "<DataSet timestep=\"1\" part=\"1\" file=\"f_b.vti\"/>")),
               Contains("same time step"));
    CHECK_THAT(refused("<VTKFile type=\"Collection\"><Collection><DataSet file=\"f_a.vti\"/>"),
               Contains("ends within"));
    CHECK_THAT(refused("<VTKFile type=\"PolyData\"/>"), Contains("not Collection"));
}

TEST_CASE("image data of VTK packed by LZ4 and LZMA read", "[vtk]") {
    const TempFolder folder;
    using Place = Style::Place;
    std::vector<std::int32_t> values(4000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(i * i % 1000 + i / 7);
    const std::string image = "WholeExtent=\"0 19 0 19 0 9\"", extent = "0 19 0 19 0 9";
    for (const auto packer : {Style::Packer::Lz4, Style::Packer::Lzma})
        for (const Place place : {Place::Inline, Place::Raw, Place::Base64})
            for (const std::size_t block : {72u, 4000u, 16000u, 99999u}) {
                const Style style{place, true, block == 72, block != 72, block, packer};
                CAPTURE(static_cast<int>(packer), static_cast<int>(place), block);
                const std::string path = folder.write(
                    "a.vti", vti(style, {{"type=\"Int32\" Name=\"a\"", "", swapped(bytesOf(values), 4, style)}}, "",
                                 image, extent));
                CHECK(samplesOf<std::int32_t>(loadVolume(sourceOf(path))) == values);
                VolumeSource part = sourceOf(path);
                part.region = VoxelRegion{{3, 4, 8}, {5, 5, 9}};
                CHECK(samplesOf<std::int32_t>(loadVolume(part)) ==
                      std::vector<std::int32_t>{values[3283], values[3284]});
            }
}

TEST_CASE("damaged blocks of LZ4 and LZMA are refused", "[vtk][bad-input]") {
    const TempFolder folder;
    const std::string values(6000, 'x');
    const auto file = [&](const Style& style, const std::string& data) {
        return vti(style, {{"type=\"UInt8\" Name=\"a\"", "", data}}, "", "WholeExtent=\"0 5999 0 0 0 0\"",
                   "0 5999 0 0 0 0");
    };
    for (const auto packer : {Style::Packer::Lz4, Style::Packer::Lzma}) {
        CAPTURE(static_cast<int>(packer));
        const Style style{Style::Place::Raw, true, false, true, 1000, packer};
        const auto errorOfBytes = [&](const std::string& bytes) {
            return errorOf(sourceOf(folder.write("a.vti", bytes)));
        };
        const std::string good = file(style, values);
        CHECK(errorOfBytes(good) == "no error");
        CHECK_THAT(errorOfBytes(file(style, values.substr(1))), Contains("5999 bytes") && Contains("6000"));
        const std::size_t begin = good.find('_', good.find("<AppendedData")) + 1,
                          data = begin + 9 * 8; // three sizes, and one of each block
        CHECK_THAT(errorOfBytes(good.substr(0, data + 3)), Contains("longer than the file"));
        std::string other = good;
        // LZ4 has no checksum: what can be found is a copy from before the beginning.
        other[data + 2] = static_cast<char>(0xff);
        CHECK_THAT(errorOfBytes(other), Contains("damaged") || Contains("ends"));
        other = good;
        other[begin + 8 + 5] = 1; // blocks of more than any that LZ4 may have
        CHECK(errorOfBytes(other) != "no error");
    }
    // One block that claims to be large.
    const Style style{Style::Place::Raw, true, false, true, std::size_t{1} << 40, Style::Packer::Lz4};
    std::string large = vti(style, {{"type=\"UInt8\" Name=\"a\"", "", std::string(2000000, 'y')}}, "",
                            "WholeExtent=\"0 399999999 0 0 0 0\"", "0 399999999 0 0 0 0");
    const std::size_t begin = large.find('_', large.find("<AppendedData")) + 1;
    large.replace(begin + 8, 16, number(style, 400000000) + number(style, 0));
    large.resize(large.size() + 2000000);
    const std::string line = errorOf(sourceOf(folder.write("a.vti", large)));
    CHECK_THAT(line, Contains("a compressed block of the array has 400.00 MB") || Contains("400 MB"));
}

TEST_CASE("values of cells of a VTK image lie between its points", "[vtk]") {
    const TempFolder folder;
    const std::string image = "WholeExtent=\"1 3 0 2 0 0\" Origin=\"10 20 30\" Spacing=\"2 3 4\"",
                      extent = "1 3 0 2 0 0";
    const Array points{"type=\"UInt8\" Name=\"a\"", "1 2 3 4 5 6 7 8 9", "abcdefghi"},
        cells{"type=\"Int16\" Name=\"a\"", "1 2 3 -4", bytesOf(std::vector<std::int16_t>{1, 2, 3, -4})},
        more{"type=\"UInt8\" Name=\"b\" NumberOfComponents=\"2\"", "1 2 3 4 5 6 7 8", "ABCDEFGH"};
    for (const auto place : {Style::Place::Ascii, Style::Place::Inline, Style::Place::Raw, Style::Place::Base64}) {
        Style style;
        style.place = place;
        const std::string both =
            folder.write("both.vti", vtiOfPieces(style, {{extent, {points}, {cells, more}}}, "", image));
        CHECK(contentsOf(sourceOf(both)).arrays == Names{"a", "a (cells)", "b"});
        CHECK(contentsOf(sourceOf(both)).dims == Int3(3, 3, 1));
        CHECK(loadVolume(sourceOf(both)).dims() == Int3(3, 3, 1));
        const Volume volume = loadVolume(sourceOf(both, "a (cells)"));
        CHECK(volume.dims() == Int3(2, 2, 1));
        CHECK(samplesOf<std::int16_t>(volume) == std::vector<std::int16_t>{1, 2, 3, -4});
        // The extent begins at 1, so that the first point is at 12, 20, 30.
        CHECK(volume.geometry().origin == Vec3(13, 21.5, 30));
        CHECK(volume.geometry().spacing == Vec3(2, 3, 4));
        CHECK_THAT(volume.notices.at(0), Contains("those of cells"));
        VolumeSource second = sourceOf(both, "b");
        second.component = 1;
        CHECK(contentsOf(second).dims == Int3(2, 2, 1));
        CHECK(loadVolume(second).value(3) == (place == Style::Place::Ascii ? 8 : 'H'));
        const std::string only = folder.write("only.vti", vtiOfPieces(style, {{extent, {}, {cells}}}, "", image));
        CHECK(contentsOf(sourceOf(only)).array == "a");
        CHECK(loadVolume(sourceOf(only)).dims() == Int3(2, 2, 1));
    }
}

TEST_CASE("cells of an image in pieces come from the piece that has them", "[vtk]") {
    const TempFolder folder;
    // Points 0 … 4 along x; pieces share the point 2, no cell.
    const std::string image = "WholeExtent=\"0 4 0 1 0 1\" Spacing=\"1 1 1\"";
    const auto piece = [&](const std::string& extent, const std::string& values) {
        return Piece{extent, {}, {{"type=\"UInt8\" Name=\"c\"", values, ""}}};
    };
    const Piece left = piece("0 2 0 1 0 1", "1 2"), right = piece("2 4 0 1 0 1", "3 4"),
                thin = piece("2 2 0 1 0 1", "");
    const std::vector<std::uint8_t> all{1, 2, 3, 4};
    const std::string one = folder.write("one.vti", vtiOfPieces({}, {left, thin, right}, "", image));
    CHECK(samplesOf<std::uint8_t>(loadVolume(sourceOf(one))) == all);
    for (const auto& [name, part] : {std::pair{"left.vti", left}, {"right.vti", right}})
        folder.write(name, vtiOfPieces({}, {part}, "", "WholeExtent=\"" + part.extent + "\""));
    const auto header = [&](const std::string& rightExtent) {
        return folder.write("whole.pvti", pvti(image, {}, {{left.extent, "left.vti"}, {rightExtent, "right.vti"}}, "",
                                               {"type=\"UInt8\" Name=\"c\""}));
    };
    const Volume volume = loadVolume(sourceOf(header(right.extent)));
    CHECK(samplesOf<std::uint8_t>(volume) == all);
    CHECK(volume.geometry().origin == Vec3(0.5, 0.5, 0.5));
    VolumeSource part = sourceOf(header(right.extent));
    part.region = VoxelRegion{{2, 0, 0}, {4, 1, 1}};
    CHECK(samplesOf<std::uint8_t>(loadVolume(part)) == std::vector<std::uint8_t>{3, 4});
    CHECK_THAT(errorOf(sourceOf(header("3 4 0 1 0 1"))), Contains("no piece has"));
}
