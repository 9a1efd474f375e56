// VTK's image data in pieces, of one file or each in its own: read whole, in parts and coarser, and refused in words.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <random>

#include "base/memory.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/series.h"
#include "volume_files.h"
#include "vtk_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

using Place = Style::Place;
using Names = std::vector<std::string>;

/// Points lo … hi, both included, as files give them.
struct Box {
    std::array<int, 3> lo, hi;
    std::string text() const {
        std::string words;
        for (std::size_t a = 0; a < 3; ++a)
            words += (a == 0 ? "" : " ") + std::to_string(lo[a]) + " " + std::to_string(hi[a]);
        return words;
    }
};

/// 7 × 6 × 5 points. The value of the one at (x, y, z) is its number in the image, from 0: see numberOf().
constexpr Box kWhole{{3, -2, 1}, {9, 3, 5}};
constexpr int kPoints = 7 * 6 * 5;
int numberOf(int x, int y, int z) { return x - 3 + 7 * (y + 2) + 42 * (z - 1); }

std::string imageOf(const Box& box) {
    return "WholeExtent=\"" + box.text() + "\" Origin=\"10 20 30\" Spacing=\"1 2 3\"";
}

/// Eight that share the planes x = 6, y = 1 and z = 3; `ghosts` more points beyond those, where the image has them.
std::vector<Box> eightBoxes(int ghosts = 0) {
    const std::array<int, 3> cut{6, 1, 3};
    std::vector<Box> boxes;
    for (std::size_t n = 0; n < 8; ++n) {
        Box box = kWhole;
        for (std::size_t a = 0; a < 3; ++a)
            if ((n >> a & 1) == 0)
                box.hi[a] = std::min(cut[a] + ghosts, kWhole.hi[a]);
            else
                box.lo[a] = std::max(cut[a] - ghosts, kWhole.lo[a]);
        boxes.push_back(box);
    }
    return boxes;
}

constexpr const char* kNumber = "type=\"Int16\" Name=\"number\"";
constexpr const char* kPair = "type=\"Float32\" Name=\"pair\" NumberOfComponents=\"2\"";

/// The part of the image in a box: its numbers, and pairs of the number and half of it.
std::vector<Array> arraysOf(const Style& style, const Box& box) {
    std::vector<std::int16_t> numbers;
    std::vector<float> pairs;
    std::string number, pair;
    for (int z = box.lo[2]; z <= box.hi[2]; ++z)
        for (int y = box.lo[1]; y <= box.hi[1]; ++y)
            for (int x = box.lo[0]; x <= box.hi[0]; ++x) {
                const int value = numberOf(x, y, z);
                numbers.push_back(static_cast<std::int16_t>(value));
                pairs.insert(pairs.end(), {static_cast<float>(value), 0.5f * static_cast<float>(value)});
                number += std::to_string(value) + " ";
                pair += std::to_string(value) + " " + std::to_string(value / 2) + (value % 2 == 0 ? ".0 " : ".5 ");
            }
    return {{kNumber, number, swapped(bytesOf(numbers), 2, style)}, {kPair, pair, swapped(bytesOf(pairs), 4, style)}};
}

std::string fileOf(const Style& style, const Box& box) {
    return vti(style, arraysOf(style, box), "", imageOf(box), box.text());
}

/// One .vti of these pieces.
std::string writeOne(const TempFolder& folder, const Style& style, const std::vector<Box>& boxes) {
    std::vector<Piece> pieces;
    for (const Box& box : boxes) pieces.push_back({box.text(), arraysOf(style, box)});
    return folder.write("one.vti", vtiOfPieces(style, pieces, "", imageOf(kWhole)));
}

/// A .pvti and its pieces a/0.vti, a/1.vti, …
std::string writeMany(const TempFolder& folder, const Style& style, const std::vector<Box>& boxes) {
    std::filesystem::create_directories(folder.path("a"));
    std::vector<std::pair<std::string, std::string>> pieces;
    for (const Box& box : boxes) {
        const std::string name = "a/" + std::to_string(pieces.size()) + ".vti";
        folder.write(name, fileOf(style, box));
        pieces.emplace_back(box.text(), name);
    }
    return folder.write("a.pvti", pvti(imageOf(kWhole), {kNumber, kPair}, pieces));
}

VolumeSource sourceOf(const std::string& path, const std::string& array = "") {
    VolumeSource source;
    source.path = path;
    source.array = array;
    return source;
}

std::vector<double> valuesOf(const Volume& volume) {
    std::vector<double> values(volume.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = volume.value(i);
    return values;
}

/// 0, 1, 2, …, times `factor`.
std::vector<double> numbers(double factor = 1) {
    std::vector<double> values(kPoints);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = factor * static_cast<double>(i);
    return values;
}

FileError errorOf(const VolumeSource& source) {
    try {
        loadVolume(source);
    } catch (const FileError& e) {
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
        return e;
    }
    return {"no error", "", ""};
}

} // namespace

TEST_CASE("image data in pieces read in every encoding", "[vtk][pieces]") {
    const TempFolder folder;
    for (const Place place : {Place::Ascii, Place::Inline, Place::Raw, Place::Base64})
        for (int bits = 0; bits < 8; ++bits) {
            const Style style{place, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
            CAPTURE(static_cast<int>(place), style.compressed, style.bigEndian, style.wide);
            for (const std::string& path :
                 {writeOne(folder, style, eightBoxes()), writeMany(folder, style, eightBoxes())}) {
                CAPTURE(path);
                const Volume volume = loadVolume(sourceOf(path));
                CHECK(valuesOf(volume) == numbers());
                CHECK(volume.sampleType() == SampleType::I16);
                CHECK(volume.dims() == Int3(7, 6, 5));
                CHECK(volume.geometry().spacing == Vec3(1, 2, 3));
                CHECK(volume.geometry().origin == Vec3(10 + 3, 20 - 2 * 2, 30 + 3)); // of the point (3, −2, 1)
                CHECK(volume.notices == Names{"array 'number' of 2 is shown"});
                CHECK(volume.format == (path.ends_with(".pvti") ? "VTK image data in pieces" : "VTK image data"));
                VolumeSource pair = sourceOf(path, "pair");
                pair.component = 1;
                CHECK(valuesOf(loadVolume(pair)) == numbers(0.5));
                const FileContents contents = contentsOf(pair);
                CHECK(contents.arrays == Names{"number", "pair"});
                CHECK(contents.components == 2);
                CHECK(contents.type == SampleType::F32);
                CHECK(contents.dims == Int3(7, 6, 5));
            }
        }
}

TEST_CASE("pieces that overlap by ghost levels, or have more than the header says of them", "[vtk][pieces]") {
    const TempFolder folder;
    const Style style{Place::Raw, true, false, false};
    for (const int ghosts : {1, 2}) {
        CAPTURE(ghosts);
        CHECK(valuesOf(loadVolume(sourceOf(writeOne(folder, style, eightBoxes(ghosts))))) == numbers());
        CHECK(valuesOf(loadVolume(sourceOf(writeMany(folder, style, eightBoxes(ghosts))))) == numbers());
        std::vector<std::pair<std::string, std::string>> pieces;
        for (std::size_t n = 0; n < 8; ++n)
            pieces.emplace_back(eightBoxes()[n].text(), "a/" + std::to_string(n) + ".vti");
        const std::string path = folder.write("b.pvti", pvti(imageOf(kWhole), {kNumber, kPair}, pieces));
        CHECK(valuesOf(loadVolume(sourceOf(path))) == numbers());
    }
    // A piece in several pieces; pieces without points, of ranks that have none, whose files need not be there.
    writeOne(folder, style, eightBoxes());
    const std::string path = folder.write(
        "c.pvti", pvti(imageOf(kWhole), {kNumber},
                       {{"0 -1 0 -1 0 -1", ""}, {kWhole.text(), "one.vti"}, {"3 9 -2 3 5 4", "none.vti"}}));
    CHECK(valuesOf(loadVolume(sourceOf(path))) == numbers());
    // One piece that is all of it.
    folder.write("whole.vti", fileOf(style, kWhole));
    CHECK(valuesOf(loadVolume(sourceOf(
              folder.write("d.pvti", pvti(imageOf(kWhole), {kNumber}, {{kWhole.text(), "whole.vti"}}))))) == numbers());
    // Of what two pieces say of a point, the last one counts.
    Piece first{kWhole.text(), arraysOf(style, kWhole)}, second = first;
    second.arrays[0].data = std::string(second.arrays[0].data.size(), '\0');
    const std::string zeros = folder.write("e.vti", vtiOfPieces(style, {first, second}, "", imageOf(kWhole)));
    CHECK(loadVolume(sourceOf(zeros)).dataRange() == ValueRange{0, 0});
}

TEST_CASE("regions and coarser copies of pieces are those of one file", "[vtk][pieces]") {
    const TempFolder folder;
    std::mt19937 random(3);
    for (const bool compressed : {false, true})
        for (const Place place : {Place::Ascii, Place::Raw, Place::Inline}) {
            const Style style{place, compressed, false, false};
            const std::string whole = folder.write("whole.vti", fileOf(style, kWhole));
            const std::array<std::string, 2> paths{writeOne(folder, style, eightBoxes(compressed ? 1 : 0)),
                                                   writeMany(folder, style, eightBoxes(compressed ? 1 : 0))};
            for (int n = 0; n < 40; ++n) {
                VolumeSource source = sourceOf(whole, n % 2 == 0 ? "number" : "pair");
                source.component = n % 4 == 1 ? 1 : 0;
                source.downsample = 1 + n % 3;
                VoxelRegion region;
                for (int a = 0; a < 3; ++a) {
                    const int size = std::array{7, 6, 5}[static_cast<std::size_t>(a)];
                    region.lo[a] = static_cast<int>(random() % static_cast<unsigned>(size));
                    region.hi[a] =
                        region.lo[a] + 1 + static_cast<int>(random() % static_cast<unsigned>(size - region.lo[a]));
                }
                if (n > 2) source.region = region;
                const Volume expected = loadVolume(source);
                for (const std::string& path : paths) {
                    CAPTURE(path, n, region.lo.x, region.lo.y, region.lo.z, region.hi.x, region.hi.y, region.hi.z);
                    source.path = path;
                    const Volume volume = loadVolume(source);
                    CHECK(volume.samples() == expected.samples());
                    CHECK(volume.geometry().origin == expected.geometry().origin);
                    CHECK(volume.geometry().spacing == expected.geometry().spacing);
                    CHECK(volume.range() == expected.range());
                    CHECK(volume.notices == expected.notices);
                }
            }
        }
}

TEST_CASE("of pieces only those are looked at that have voxels of what is asked for", "[vtk][pieces]") {
    // Voxels (0 … 2)³ are the points x 3 … 5, y −2 … 0, z 1 … 3, of which the first piece has all, and the fifth,
    // behind the plane z = 3, some. The first two layers are of the first alone.
    const TempFolder folder;
    const Style style{Place::Raw, true, false, false};
    const std::string many = writeMany(folder, style, eightBoxes());
    for (int n = 1; n < 8; ++n) std::filesystem::remove(folder.path("a/" + std::to_string(n) + ".vti"));
    VolumeSource source = sourceOf(many, "number");
    source.region = VoxelRegion{Int3(0), Int3(3, 3, 2)};
    const std::vector<double> values{0, 1, 2, 7, 8, 9, 14, 15, 16, 42, 43, 44, 49, 50, 51, 56, 57, 58};
    CHECK(valuesOf(loadVolume(source)) == values);
    source.region->hi.z = 3;
    CHECK_THAT(errorOf(source).what(), Contains("4.vti"));

    // Text of other pieces is not looked at, either.
    std::vector<Piece> pieces;
    for (const Box& box : eightBoxes()) pieces.push_back({box.text(), arraysOf({}, box)});
    for (std::size_t n = 1; n < 8; ++n) pieces[n].arrays[0].ascii = "none";
    source.path = folder.write("text.vti", vtiOfPieces({}, pieces, "", imageOf(kWhole)));
    source.region->hi.z = 2;
    CHECK(valuesOf(loadVolume(source)) == values);
    source.region.reset();
    CHECK_THAT(errorOf(source).what(), Contains("'none' where a number belongs"));
}

TEST_CASE("a region of pieces takes the memory of the region", "[vtk][pieces]") {
    // 210 points need 21 GB; the 12 of 3 × 2 × 2 need 1.2 GB; there are 3 GB less what the program takes.
    struct LimitedMemory {
        explicit LimitedMemory(std::uint64_t bytes) { setMemoryLimit(bytes); }
        ~LimitedMemory() { setMemoryLimit({}); }
    } const limit(3'000'000'000);
    const TempFolder folder;
    VolumeSource source = sourceOf(writeMany(folder, {}, eightBoxes()));
    source.then = {"measuring", 1e8};
    source.downsample = 1;
    CHECK_THROWS_WITH(loadVolume(source), Contains("measuring 7 x 6 x 5 voxels needs 21 GB"));
    source.region = VoxelRegion{Int3(2), Int3(5, 4, 4)};
    CHECK(loadVolume(source).dims() == Int3(3, 2, 2));
    source.region.reset();
    source.downsample = 0; // 4 × 3 × 3 need 3.6 GB, 3 × 2 × 2 of a third
    CHECK(loadVolume(source).dims() == Int3(3, 2, 2));
}

TEST_CASE("more pieces than can be open at a time", "[vtk][pieces]") {
    // 700 pieces, 350 above each other and two from front to back, that share their planes: each has 2 × 2 × 2 points.
    // The value of a point is 3·y + z.
    const TempFolder folder;
    std::filesystem::create_directories(folder.path("p"));
    std::vector<std::pair<std::string, std::string>> pieces;
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 350; ++y) {
            const std::string extent = "0 1 " + std::to_string(y) + " " + std::to_string(y + 1) + " " +
                                       std::to_string(z) + " " + std::to_string(z + 1);
            std::string text;
            for (int k = z; k <= z + 1; ++k)
                for (int j = y; j <= y + 1; ++j)
                    for (int i = 0; i < 2; ++i) text += std::to_string(3 * j + k) + " ";
            const std::string name = "p/" + std::to_string(pieces.size()) + ".vti";
            folder.write(
                name, vti({}, {{"type=\"Int32\" Name=\"a\"", text, ""}}, "", "WholeExtent=\"" + extent + "\"", extent));
            pieces.emplace_back(extent, name);
        }
    const Volume volume = loadVolume(
        sourceOf(folder.write("a.pvti", pvti("WholeExtent=\"0 1 0 350 0 2\"", {"type=\"Int32\" Name=\"a\""}, pieces))));
    bool same = true;
    for (int k = 0; k <= 2; ++k)
        for (int j = 0; j <= 350; ++j)
            for (int i = 0; i < 2; ++i) same &= volume.value(voxelIndex(volume.dims(), i, j, k)) == 3 * j + k;
    CHECK(same);
}

TEST_CASE("reading pieces tells how far it is, and can be stopped", "[vtk][pieces]") {
    const TempFolder folder;
    const std::string path = writeMany(folder, {}, eightBoxes());
    std::vector<double> told;
    loadVolume(sourceOf(path), {{}, [&](double fraction) { told.push_back(fraction); }});
    REQUIRE(!told.empty());
    CHECK(std::ranges::is_sorted(told));
    CHECK(told.back() == 1);
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(loadVolume(sourceOf(path), {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("faults of pieces are told with the file that has them", "[vtk][pieces][bad-input]") {
    const TempFolder folder;
    const Style style{Place::Raw, false, false, false};
    // Two pieces that share the plane x = 6.
    const Box left{{3, -2, 1}, {6, 3, 5}}, right{{6, -2, 1}, {9, 3, 5}};
    const std::string leftText = left.text(), rightText = right.text();
    folder.write("left.vti", fileOf(style, left));
    folder.write("right.vti", fileOf(style, right));
    const auto opened = [&](const std::string& extent, const std::string& name) {
        return sourceOf(
            folder.write("a.pvti", pvti(imageOf(kWhole), {kNumber, kPair}, {{leftText, "left.vti"}, {extent, name}})));
    };
    const auto refused = [&](const std::string& extent, const std::string& name) {
        const FileError e = errorOf(opened(extent, name));
        CHECK(e.where() == folder.path(name));
        CHECK(!e.whatToDo().empty());
        return e.problem();
    };
    /// A piece that is written otherwise.
    const auto otherwise = [&](const std::string& bytes) {
        folder.write("other.vti", bytes);
        return refused(rightText, "other.vti");
    };
    CHECK(valuesOf(loadVolume(opened(rightText, "right.vti"))) == numbers());
    CHECK_THAT(refused(rightText, "gone.vti"), Contains("missing") && Contains("'a.pvti'"));
    CHECK_THAT(refused("6 10 -2 3 1 5", "right.vti"),
               Contains("6 10 -2 3 1 5") && Contains("beyond") && Contains("3 9 -2 3 1 5"));
    CHECK_THAT(refused("6 9 -2 3 0 5", "right.vti"), Contains("beyond"));
    // The file has fewer points than the header says: x = 5, the last before its own, is where none is.
    CHECK_THAT(refused("5 9 -2 3 1 5", "right.vti"), Contains("no piece has the point 5 -2 1"));
    CHECK_THAT(otherwise(""), Contains("empty"));
    CHECK_THAT(otherwise("P5"), Contains("not a VTK XML file"));
    CHECK_THAT(otherwise(pvti(imageOf(right), {kNumber}, {})), Contains("PImageData"));
    std::vector<Array> arrays = arraysOf(style, right);
    const auto with = [&](const std::vector<Array>& all) { return vti(style, all, "", imageOf(right), rightText); };
    CHECK_THAT(otherwise(with({arrays[1]})), Contains("no array 'number'"));
    arrays[0].attributes = "type=\"UInt16\" Name=\"number\"";
    CHECK_THAT(otherwise(with(arrays)), Contains("'UInt16'") && Contains("'Int16'"));
    arrays[0].attributes = "type=\"Int16\" Name=\"number\" NumberOfComponents=\"3\"";
    CHECK_THAT(otherwise(with(arrays)), Contains("3 components") && Contains("of the image 1"));
    // What a file of its own is checked for: 4·6·5 points of 2 bytes.
    arrays = arraysOf(style, right);
    arrays[0].data.pop_back();
    CHECK_THAT(otherwise(with(arrays)), Contains("239 bytes, but its extent and type need 240"));
    const std::string good = fileOf(style, right);
    CHECK_THAT(otherwise(good.substr(0, good.find("\n  _") + 50)), Contains("of 240 bytes"));
    CHECK_THAT(otherwise(good.substr(0, good.find("   <PointData"))), Contains("ends within"));
    std::string damaged = fileOf({Place::Raw, true, false, false}, right);
    damaged[damaged.find("\n  _") + 4 + 4 * (3 + 24) + 20] ^= 0x55; // behind a header of 24 blocks of 10 bytes
    CHECK_THAT(otherwise(damaged), Contains("damaged"));

    // What no piece has is told with the file that names them.
    const auto ofHeader = [&](const std::string& text) {
        const FileError e = errorOf(sourceOf(folder.write("b.pvti", text)));
        CHECK(e.where() == folder.path("b.pvti"));
        CHECK(!e.whatToDo().empty());
        return e.problem();
    };
    const std::string image = imageOf(kWhole);
    CHECK_THAT(ofHeader(pvti(image, {kNumber}, {{leftText, "left.vti"}, {"7 9 -2 3 2 5", "right.vti"}})),
               Contains("no piece has the point 7 -2 1 of the extent 3 9 -2 3 1 5"));
    CHECK_THAT(ofHeader(pvti(image, {kNumber}, {})), Contains("no piece has the point 3 -2 1"));
    CHECK_THAT(ofHeader(pvti(image, {}, {{leftText, "left.vti"}})), Contains("no values for points, nor for cells"));
    CHECK_THAT(ofHeader(pvti(image, {"type=\"String\" Name=\"number\""}, {{kWhole.text(), "left.vti"}})),
               Contains("String"));
    CHECK_THAT(ofHeader(pvti("WholeExtent=\"3 9 -2 3\"", {kNumber}, {})), Contains("six whole numbers"));
    CHECK_THAT(ofHeader(pvti("WholeExtent=\"3 2 -2 3 1 5\"", {kNumber}, {})), Contains("at least 1"));
    CHECK_THAT(ofHeader("<VTKFile type=\"PPolyData\"/>"), Contains("not PImageData"));
    CHECK_THAT(ofHeader("<VTKFile type=\"PImageData\"/>"), Contains("no PImageData"));
    for (const std::string& source :
         {std::string("../left.vti"), std::string("a/../../left.vti"), std::string("/left.vti"), std::string("..")}) {
        CAPTURE(source);
        CHECK_THAT(ofHeader(pvti(image, {kNumber}, {{leftText, source}})), Contains("outside its own folder"));
    }
    CHECK_THAT(ofHeader(pvti(image, {kNumber}, {{leftText, ""}})), Contains("names no file"));
    CHECK_THAT(ofHeader(pvti(image, {kNumber}, {{leftText, std::string(2000, 'a')}})), Contains("too long"));
    CHECK(errorOf(sourceOf(folder.write(
                      "c.pvti", pvti(image, {kNumber}, {{leftText, "./a/../left.vti"}, {rightText, "right.vti"}}))))
              .problem() == "no error");

    // In one file each fault is told with the number of its piece.
    const auto ofOne = [&](std::vector<Piece> pieces) {
        const FileError e = errorOf(sourceOf(folder.write("one.vti", vtiOfPieces(style, pieces, "", image))));
        CHECK((e.where() == folder.path("one.vti") || e.problem() == "no error"));
        return e.problem();
    };
    const Piece a{leftText, arraysOf(style, left)}, b{rightText, arraysOf(style, right)};
    CHECK(ofOne({a, b}) == "no error");
    CHECK_THAT(ofOne({a}), Contains("no piece has the point 7 -2 1"));
    CHECK_THAT(ofOne({a, {rightText, {b.arrays[1]}}}), Contains("piece 2 of 2 has no array 'number'"));
    CHECK_THAT(ofOne({a, {"6 10 -2 3 1 5", b.arrays}}), Contains("beyond"));
    CHECK_THAT(ofOne({a, {"6 9 -2 3 1", b.arrays}}), Contains("six whole numbers"));
    Piece other = b;
    other.arrays[0].attributes = "type=\"UInt16\" Name=\"number\"";
    CHECK_THAT(ofOne({a, other}), Contains("of piece 2 of 2 is 'UInt16', that of the image 'Int16'"));
    other.arrays[0].attributes = "type=\"Int16\" Name=\"number\" NumberOfComponents=\"2\"";
    CHECK_THAT(ofOne({a, other}), Contains("2 components"));
}

TEST_CASE("pieces that lie in a great disorder are refused rather than counted for hours", "[vtk][pieces][bad-input]") {
    // 2000 rods along each of the axes, at odd places only, so that they never touch: what they leave of the image
    // falls into very many boxes.
    const TempFolder folder;
    std::vector<std::pair<std::string, std::string>> pieces;
    for (int axis = 0; axis < 3; ++axis)
        for (int n = 0; n < 2000; ++n) {
            std::array<int, 3> lo{}, hi{};
            for (int a = 0, shift = 0; a < 3; ++a) {
                const auto at = static_cast<std::size_t>(a);
                hi[at] = 999;
                if (a != axis) lo[at] = hi[at] = shift++ == 0 ? 1 + n % 45 * 20 + axis : 1 + n / 45 * 20 + axis;
            }
            pieces.emplace_back(Box{lo, hi}.text(), "none.vti");
        }
    CHECK_THAT(
        errorOf(sourceOf(folder.write("a.pvti", pvti("WholeExtent=\"0 999 0 999 0 999\"", {kNumber}, pieces)))).what(),
        Contains("disorder"));
}

TEST_CASE("files of pieces in series, in folders and in collections", "[vtk][pieces]") {
    const TempFolder folder;
    // Two frames of two points in two pieces, which overlap in none; at 0.5 and 1.5.
    for (int frame = 0; frame < 2; ++frame) {
        const std::string stem = "f" + std::to_string(frame);
        for (int n = 0; n < 2; ++n) {
            const std::string x = std::to_string(n), extent = x + " " + x + " 0 0 0 0";
            folder.write(stem + "_" + x + ".vti",
                         vti({}, {{"type=\"UInt8\" Name=\"v\"", std::to_string(10 * frame + n), ""}}, "",
                             "WholeExtent=\"" + extent + "\" Direction=\"0 -1 0 1 0 0 0 0 1\"", extent));
        }
        std::string text = pvti("WholeExtent=\"0 1 0 0 0 0\"", {"type=\"UInt8\" Name=\"v\""},
                                {{"0 0 0 0 0 0", stem + "_0.vti"}, {"1 1 0 0 0 0", stem + "_1.vti"}});
        text.insert(text.find("  <PPointData"), "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" "
                                                "NumberOfTuples=\"1\" format=\"ascii\">" +
                                                    std::to_string(frame) + ".5</DataArray></FieldData>");
        folder.write(stem + ".pvti", text);
    }
    for (const std::string& path : {folder.path("."), folder.path("f%d.pvti"), folder.path("f*")}) {
        CAPTURE(path);
        const SeriesListing listing = listSeries(sourceOf(path));
        REQUIRE(listing.frames.size() == 2);
        CHECK(listing.notices.empty());
        CHECK(listing.label(1) == "t = 1.5");
        CHECK(valuesOf(loadVolume(listing.frames[1].source)) == std::vector<double>{10, 11});
    }
    CHECK(filesOf(sourceOf(folder.path("f1.pvti"))) ==
          Names{folder.path("f1.pvti"), folder.path("f1_0.vti"), folder.path("f1_1.vti")});
    // Where the header does not say where axes point, its pieces do: i along +y.
    CHECK(loadVolume(sourceOf(folder.path("f0.pvti"))).geometry().directions[0] == Vec3(0, 1, 0));
    const std::string collection =
        folder.write("all.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"3\" file=\"f0.pvti\"/>"
                                "<DataSet timestep=\"4\" file=\"f1.pvti\"/></Collection></VTKFile>");
    const SeriesListing listing = listSeries(sourceOf(collection));
    REQUIRE(listing.frames.size() == 2);
    CHECK(listing.label(1) == "t = 4");
    CHECK(valuesOf(loadVolume(listing.frames[0].source)) == std::vector<double>{0, 1});
    CHECK(filesOf(sourceOf(collection)).size() == 7); // itself, two headers, four pieces
    // Images of other names stay what they are.
    folder.write("g.vti", vti({}, {{"type=\"UInt8\" Name=\"v\"", "1 2 3 4 5 6", ""}}));
    std::filesystem::remove(collection);
    CHECK(listSeries(sourceOf(folder.path("."))).notices ==
          Names{"1 file of another suffix than *.pvti was passed over: g.vti"});
}
