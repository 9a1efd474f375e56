// DICOM through pellucid-reader, against values that are derived here from what the files are made of.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <locale>
#include <sstream>

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <gdcmJPEGCodec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

#include "support/dicom_writer.h"
#include "support/notices.h"
#include "support/orientations.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume/process/reader_process.h"
#include "volume/series.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

VolumeSource at(const std::string& path, const std::string& series = "") {
    VolumeSource source;
    source.path = path;
    source.array = series;
    return source;
}

/// A slice `n` of a stack along z, 1.5 mm apart; its voxels are 100 n, 100 n + 1, …
DicomSlice sliceAt(int n, double distance = 1.5) {
    DicomSlice slice;
    slice.number = n + 1;
    slice.position = "-10\\-20\\" + std::to_string(distance * n);
    std::vector<int> values;
    for (int i = 0; i < 6; ++i) values.push_back(100 * n + i);
    slice.pixels = words(values);
    return slice;
}

void writeStack(const TempFolder& folder, const std::string& name, int count) {
    fs::create_directory(folder.path(name));
    // Names in another order than the slices lie.
    for (int n = 0; n < count; ++n)
        folder.write(name + "/IM" + std::to_string((n * 7) % 10) + std::to_string(n), dicomFile(sliceAt(n)));
}

using Syntax = gdcm::TransferSyntax;

constexpr int kPackedColumns = 40, kPackedRows = 33;

/// The slice of the tests of packed pixels. Numbers of `bits` bits, all over what these hold, or up and down smoothly.
struct PackedCase {
    std::uint16_t bits, isSigned;
    std::vector<int> values;
    DicomSlice slice;
};
PackedCase packedCase(std::uint16_t bits, std::uint16_t isSigned, bool isSmooth = false, int frames = 1) {
    PackedCase made{bits, isSigned, {}, {}};
    const int all = 1 << bits;
    for (int f = 0; f < frames; ++f)
        for (int y = 0; y < kPackedRows; ++y)
            for (int x = 0; x < kPackedColumns; ++x) {
                const int smooth = 20 + 3 * x + 2 * y, wild = (7919 * x + 331 * y * y + 1000 * f) % all;
                made.values.push_back((isSmooth ? smooth : wild) - (isSigned == 1 ? all / 2 : 0));
            }
    made.values.front() = isSigned == 1 ? -all / 2 : 0; // the ends
    made.values.back() = isSigned == 1 ? all / 2 - 1 : all - 1;
    DicomSlice& slice = made.slice;
    slice.columns = kPackedColumns;
    slice.rows = kPackedRows;
    slice.bitsAllocated = slice.bitsStored = bits;
    slice.isSigned = isSigned;
    if (frames > 1) slice.more.text(0x0028, 0x0008, "IS", std::to_string(frames));
    slice.more.text(0x0018, 0x0050, "DS", "1.5");                       // thickness
    slice.more.text(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.2"); // CT: GDCM writes no file that does not say
    slice.pixels = words(made.values);
    if (bits == 8) {
        slice.pixels.clear();
        for (const int value : made.values) slice.pixels += static_cast<char>(value);
    }
    return made;
}

/// Packs the pixels of a file, by GDCM, and hands them to `use` with the file that they are from.
void repack(const std::string& from, Syntax::TSType syntax,
            const std::function<void(gdcm::ImageReader&, const gdcm::Image&)>& use) {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::ImageReader reader;
    reader.SetFileName(from.c_str());
    REQUIRE(reader.Read());
    gdcm::ImageChangeTransferSyntax change;
    gdcm::JPEGCodec lossy;
    lossy.SetLossless(false);
    lossy.SetQuality(95);
    if (syntax == Syntax::JPEGBaselineProcess1) change.SetUserCodec(&lossy);
    change.SetTransferSyntax(syntax);
    change.SetInput(reader.GetImage());
    REQUIRE(change.Change());
    use(reader, dynamic_cast<const gdcm::Image&>(change.GetOutput()));
}

void writePacked(const std::string& from, const std::string& to, Syntax::TSType syntax) {
    repack(from, syntax, [&](gdcm::ImageReader& reader, const gdcm::Image& image) {
        gdcm::ImageWriter writer;
        writer.SetFile(reader.GetFile());
        writer.SetImage(image);
        writer.SetFileName(to.c_str());
        REQUIRE(writer.Write());
    });
}

/// The packed bytes of the pictures of a file, one by one.
std::vector<std::string> packedPictures(const std::string& from, Syntax::TSType syntax) {
    std::vector<std::string> pictures;
    repack(from, syntax, [&](gdcm::ImageReader&, const gdcm::Image& image) {
        const gdcm::SequenceOfFragments* packed = image.GetDataElement().GetSequenceOfFragments();
        REQUIRE(packed != nullptr);
        for (std::size_t i = 0; i < packed->GetNumberOfFragments(); ++i) {
            const gdcm::ByteValue* bytes = packed->GetFragment(i).GetByteValue();
            pictures.emplace_back(bytes->GetPointer(), bytes->GetLength());
            if (pictures.back().size() % 2 != 0) pictures.back() += '\0';
        }
    });
    return pictures;
}

std::string syntaxName(Syntax::TSType syntax) { return Syntax::GetTSString(syntax); }

/// How many values of the volume in a file are further than `most` from those that are wanted; all where there are not
/// as many.
std::size_t wrongValues(const std::string& path, const std::vector<int>& wanted, double most = 0) {
    const Volume volume = loadVolume(at(path));
    if (volume.size() != wanted.size()) return wanted.size();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) wrong += !(std::abs(volume.value(i) - wanted[i]) <= most);
    return wrong;
}

std::string errorAt(const std::string& path) {
    try {
        loadVolume(at(path));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// Numbers of `width` bytes, the lowest first.
std::string littleEndian(const std::vector<std::size_t>& numbers, int width) {
    std::string bytes;
    for (const std::size_t number : numbers)
        for (int i = 0; i < width; ++i) bytes += static_cast<char>(number >> (8 * i) & 255);
    return bytes;
}

std::string decimals(const std::vector<double>& numbers) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::setprecision(9);
    for (std::size_t i = 0; i < numbers.size(); ++i) text << (i > 0 ? "\\" : "") << numbers[i];
    return text.str();
}

} // namespace

TEST_CASE("a folder of slices is one volume, in the order of their places", "[dicom]") {
    const TempFolder folder;
    writeStack(folder, "scan", 4);
    folder.write("scan/README.txt", "Slices of a head.");
    const SeriesListing listing = listSeries(at(folder.path("scan")));
    REQUIRE(listing.frames.size() == 1);
    CHECK(listing.title == "scan");
    const Volume volume = loadVolume(listing.frames[0].source);
    CHECK(volume.format == "DICOM");
    CHECK(volume.title == "scan");
    CHECK(volume.dims() == Int3(3, 2, 4));
    CHECK(volume.sampleType() == SampleType::U16);
    // Pixel spacing is that of rows, then of columns: "2\1" is 1 along x.
    CHECK(volume.geometry().spacing == Vec3(1, 2, 1.5));
    CHECK(volume.geometry().origin == Vec3(-10, -20, 0));
    CHECK(volume.geometry().worldAxes == WorldAxes::Patient);
    CHECK(volume.notices.empty());
    for (int z = 0; z < 4; ++z)
        for (int i = 0; i < 6; ++i) CHECK(volume.value(static_cast<std::size_t>(6 * z + i)) == 100 * z + i);
    // Any slice stands for its series, and a pattern of slices for one volume.
    CHECK(loadVolume(at(folder.path("scan/IM00"))).samples() == volume.samples());
    CHECK(listSeries(at(folder.path("scan/IM*"))).frames.size() == 1);
    CHECK(filesOf(at(folder.path("scan"))).size() == 5); // the folder and its slices
}

TEST_CASE("DICOM stored numbers become values", "[dicom]") {
    const TempFolder folder;
    DicomSlice slice = sliceAt(0);
    SECTION("bits that are not used are left out; a sign is one of the bits that are") {
        // 12 of 16 bits: 0x8fff has an overlay in its highest bit; as signed 0xfff is −1, 0x7ff 2047, 0x800 −2048.
        slice.pixels = words({0x8fff, 0x07ff, 0x0800, 0, 1, 2});
        CHECK(loadVolume(at(folder.write("u.dcm", dicomFile(slice)))).value(0) == 4095);
        slice.isSigned = 1;
        slice.series = "1.2.4";
        const Volume volume = loadVolume(at(folder.write("s.dcm", dicomFile(slice))));
        CHECK(volume.sampleType() == SampleType::I16);
        CHECK(volume.value(0) == -1);
        CHECK(volume.value(1) == 2047);
        CHECK(volume.value(2) == -2048);
    }
    SECTION("a whole number is added exactly, in the smallest type that holds all") {
        slice.slope = "1";
        slice.intercept = "-1024"; // 12 bits: −1024 … 3071
        const Volume volume = loadVolume(at(folder.write("ct.dcm", dicomFile(slice))));
        CHECK(volume.sampleType() == SampleType::I16);
        CHECK(volume.value(5) == -1019);
    }
    SECTION("a slope makes floats") {
        slice.slope = "0.5";
        slice.intercept = "10";
        const Volume volume = loadVolume(at(folder.write("pet.dcm", dicomFile(slice))));
        CHECK(volume.sampleType() == SampleType::F32);
        CHECK(volume.value(5) == 12.5);
    }
    SECTION("each slice has its own scaling") {
        fs::create_directory(folder.path("pet"));
        for (int n = 0; n < 2; ++n) {
            DicomSlice one = sliceAt(n);
            one.slope = n == 0 ? "1" : "2.5";
            folder.write("pet/" + std::to_string(n), dicomFile(one));
        }
        const Volume volume = loadVolume(at(folder.path("pet")));
        CHECK(volume.value(3) == 3);
        CHECK(volume.value(6 + 3) == 2.5 * 103);
    }
    SECTION("the padding value is missing") {
        slice.more.number(0x0028, 0x0120, 3);
        slice.intercept = "-1000";
        const Volume volume = loadVolume(at(folder.write("p.dcm", dicomFile(slice))));
        CHECK(volume.invalidCount() == 1);
        CHECK_FALSE(volume.isValid(3));
        CHECK(volume.missing() == -997.0);
    }
    SECTION("8 bits of three colours are components") {
        slice.samples = 3;
        slice.bitsAllocated = slice.bitsStored = 8;
        slice.photometric = "RGB";
        slice.pixels.clear();
        for (int i = 0; i < 18; ++i) slice.pixels += static_cast<char>(10 * i);
        const std::string path = folder.write("rgb.dcm", dicomFile(slice));
        CHECK(contentsOf(at(path)).components == 3);
        VolumeSource green = at(path);
        green.component = 1;
        CHECK(loadVolume(green).value(2) == 70); // third pixel, second colour: 10 · (3 · 2 + 1)
    }
    SECTION("a segmentation has eight pixels in a byte") {
        slice.bitsAllocated = slice.bitsStored = 1;
        slice.pixels = "\x25"; // 100101, the first pixel is the lowest bit
        const Volume volume = loadVolume(at(folder.write("seg.dcm", dicomFile(slice))));
        const int expected[] = {1, 0, 1, 0, 0, 1};
        for (std::size_t i = 0; i < 6; ++i) CHECK(volume.value(i) == expected[i]);
    }
}

TEST_CASE("DICOM pixels come out of every transfer syntax as they went in", "[dicom]") {
    const TempFolder folder;
    const auto bits = GENERATE(as<std::uint16_t>(), 16, 8);
    const auto isSigned = GENERATE(as<std::uint16_t>(), 0, 1);
    const PackedCase made = packedCase(bits, isSigned);
    const std::string plain = folder.write("plain.dcm", dicomFile(made.slice));
    CHECK(wrongValues(plain, made.values) == 0);
    for (const Syntax::TSType syntax :
         {Syntax::ImplicitVRLittleEndian, Syntax::ExplicitVRBigEndian, Syntax::DeflatedExplicitVRLittleEndian,
          Syntax::RLELossless, Syntax::JPEGLosslessProcess14_1, Syntax::JPEGLSLossless, Syntax::JPEG2000Lossless}) {
        CAPTURE(bits, isSigned, syntaxName(syntax));
        const TempFolder own; // a slice stands for its series
        const std::string path = own.path("packed.dcm");
        writePacked(plain, path, syntax);
        CHECK_THAT(own.read("packed.dcm").substr(0, 1000), Contains(syntaxName(syntax)));
        CHECK(wrongValues(path, made.values) == 0);
    }
}

TEST_CASE("DICOM pixels that are packed with loss come out nearly as they went in", "[dicom]") {
    const TempFolder folder;
    PackedCase made = packedCase(8, 0, true);
    made.values.front() = made.values[1]; // no peaks, which JPEG spreads
    made.values.back() = made.values[made.values.size() - 2];
    made.slice.pixels.front() = made.slice.pixels[1];
    made.slice.pixels.back() = made.slice.pixels[made.slice.pixels.size() - 2];
    const std::string plain = folder.write("plain.dcm", dicomFile(made.slice));
    const TempFolder own;
    writePacked(plain, own.path("packed.dcm"), Syntax::JPEGBaselineProcess1);
    CHECK_THAT(own.read("packed.dcm").substr(0, 1000), Contains("1.2.840.10008.1.2.4.50"));
    CHECK(wrongValues(own.path("packed.dcm"), made.values, 4) == 0); // of 20 … 201, at quality 95
}

TEST_CASE("a packed DICOM picture may lie in several parts", "[dicom]") {
    const TempFolder folder;
    const auto syntax = GENERATE(Syntax::JPEGLosslessProcess14_1, Syntax::JPEGLSLossless, Syntax::JPEG2000Lossless);
    CAPTURE(syntaxName(syntax));
    // Three parts of each picture, of which the first has `head` bytes.
    const auto cut = [](const std::vector<std::string>& pictures, std::size_t head) {
        std::vector<std::string> parts;
        for (const std::string& picture : pictures) {
            const std::size_t second = picture.size() / 4 * 2;
            parts.push_back(picture.substr(0, head));
            parts.push_back(picture.substr(head, second - head));
            parts.push_back(picture.substr(second));
        }
        return parts;
    };
    const auto fileOf = [&](const PackedCase& made, const std::vector<std::string>& parts, const std::string& table,
                            const std::string& wideTable = "") {
        DicomElements set = elementsOf(made.slice);
        set.packedPixels(parts, table);
        if (!wideTable.empty()) set.bytes(0x7fe0, 0x0001, "OV", wideTable);
        return dicomFile(set, syntaxName(syntax));
    };
    SECTION("one picture") {
        const PackedCase made = packedCase(16, 0);
        const auto pictures = packedPictures(folder.write("plain.dcm", dicomFile(made.slice)), syntax);
        REQUIRE(pictures.size() == 1);
        const TempFolder own;
        CHECK(wrongValues(own.write("a.dcm", fileOf(made, cut(pictures, 100), "")), made.values) == 0);
        // Two pictures where the header says one: the first one alone would be a guess.
        CHECK_THAT(errorAt(own.write("a.dcm", fileOf(made, {pictures[0], pictures[0]}, ""))),
                   Contains("more packed pictures than the 1"));
    }
    SECTION("several pictures") {
        const PackedCase made = packedCase(16, 0, false, 2);
        const auto pictures = packedPictures(folder.write("plain.dcm", dicomFile(made.slice)), syntax);
        REQUIRE(pictures.size() == 2);
        // The second one begins behind the three parts of the first one, each of which has 8 bytes more before it.
        const std::vector<std::size_t> begins{0, pictures[0].size() + 3 * 8};
        const TempFolder own;
        // By the table, by that of wide numbers, and by the marks with which pictures begin.
        CHECK(wrongValues(own.write("a.dcm", fileOf(made, cut(pictures, 2), littleEndian(begins, 4))), made.values) ==
              0);
        CHECK(wrongValues(own.write("a.dcm", fileOf(made, cut(pictures, 2), "", littleEndian(begins, 8))),
                          made.values) == 0);
        CHECK(wrongValues(own.write("a.dcm", fileOf(made, cut(pictures, 100), "")), made.values) == 0);
        // As is usual, one part for each, with and without a table.
        CHECK(wrongValues(own.write("a.dcm", fileOf(made, pictures, littleEndian({0, pictures[0].size() + 8}, 4))),
                          made.values) == 0);
        CHECK(wrongValues(own.write("a.dcm", fileOf(made, pictures, "")), made.values) == 0);
        // The mark is cut in two, and no table says where the second one begins; or one says what cannot be.
        CHECK_THAT(errorAt(own.write("a.dcm", fileOf(made, cut(pictures, 2), ""))),
                   Contains("in 6 parts") && Contains("its 2 pictures"));
        CHECK_THAT(errorAt(own.write("a.dcm", fileOf(made, cut(pictures, 2), littleEndian({0, 7}, 4)))),
                   Contains("in 6 parts") && Contains("its 2 pictures"));
        CHECK_THAT(errorAt(own.write("a.dcm", fileOf(made, {pictures[0]}, ""))),
                   Contains("there are 1 of 2 packed pictures"));
    }
}

TEST_CASE("a DICOM picture that is packed by RLE lies in one part", "[dicom]") {
    const TempFolder folder;
    const PackedCase made = packedCase(16, 0);
    const auto pictures = packedPictures(folder.write("plain.dcm", dicomFile(made.slice)), Syntax::RLELossless);
    REQUIRE(pictures.size() == 1);
    DicomElements set = elementsOf(made.slice);
    set.packedPixels({pictures[0], pictures[0]});
    CHECK_THAT(errorAt(folder.write("plain.dcm", dicomFile(set, syntaxName(Syntax::RLELossless)))),
               Contains("2 pictures packed by RLE instead of 1"));
}

TEST_CASE("the bits of DICOM pixels that are in use may be the upper ones", "[dicom]") {
    const TempFolder folder;
    DicomSlice slice = sliceAt(0);
    const auto fileOf = [&](std::uint16_t highBit, const std::string& syntax = "1.2.840.10008.1.2.1") {
        DicomElements set = elementsOf(slice); // 12 of 16 bits
        set.number(0x0028, 0x0102, highBit);
        return dicomFile(set, syntax);
    };
    // Bits 4 to 15: 0xabcd is 0xabc. Bits 2 to 13: (0xabcd >> 2) & 0xfff is 0xaf3.
    slice.pixels = words({0xabcd, 0xfff0, 0x8000, 0x7fff, 0x0010, 0x000f});
    SECTION("without a sign") {
        CHECK(wrongValues(folder.write("a.dcm", fileOf(15)), {0xabc, 0xfff, 0x800, 0x7ff, 1, 0}) == 0);
        CHECK(wrongValues(folder.write("a.dcm", fileOf(13)), {0xaf3, 0xffc, 0, 0xfff, 4, 3}) == 0);
        CHECK(wrongValues(folder.write("a.dcm", fileOf(11)), {0xbcd, 0xff0, 0, 0xfff, 0x10, 0xf}) == 0);
    }
    SECTION("with a sign, which is the highest bit in use") {
        slice.isSigned = 1; // 0xabc − 0x1000 = −1348
        CHECK(wrongValues(folder.write("a.dcm", fileOf(15)), {-1348, -1, -2048, 2047, 1, 0}) == 0);
        CHECK(loadVolume(at(folder.path("a.dcm"))).sampleType() == SampleType::I16);
    }
    SECTION("also if they are packed as they are, but not by JPEG") {
        slice.more.text(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.2");
        slice.bitsStored = 16;
        const std::string whole = folder.write("whole.dcm", dicomFile(slice));
        for (const auto syntax : {Syntax::RLELossless, Syntax::JPEGLosslessProcess14_1}) {
            const std::vector<std::string> pictures = packedPictures(whole, syntax);
            DicomElements set = elementsOf(slice);
            set.number(0x0028, 0x0101, 12);
            set.number(0x0028, 0x0102, 15);
            set.packedPixels(pictures);
            const TempFolder own;
            const std::string path = own.write("a.dcm", dicomFile(set, syntaxName(syntax)));
            if (syntax == Syntax::RLELossless)
                CHECK(wrongValues(path, {0xabc, 0xfff, 0x800, 0x7ff, 1, 0}) == 0);
            else
                CHECK_THAT(errorAt(path), Contains("the lowest bits are not used (HighBit)"));
        }
    }
    SECTION("bits that cannot be are told") {
        CHECK_THAT(errorAt(folder.write("a.dcm", fileOf(16))), Contains("the 12 bits in use of 16 end with bit 16"));
        CHECK_THAT(errorAt(folder.write("a.dcm", fileOf(10))), Contains("end with bit 10"));
    }
}

TEST_CASE("padding of DICOM is missing, whatever the scaling of slices", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("a"));
    const auto write = [&](int n, const std::vector<int>& values, const std::string& slope,
                           const std::string& intercept, bool isPadded = true) {
        DicomSlice slice = sliceAt(n);
        slice.slope = slope;
        slice.intercept = intercept;
        slice.pixels = words(values);
        if (isPadded) slice.more.number(0x0028, 0x0120, 3);
        folder.write("a/" + std::to_string(n), dicomFile(slice));
    };
    SECTION("slices with slopes of their own") {
        write(0, {3, 1, 2, 3, 4, 5}, "1", "0");
        write(1, {0, 1, 2, 3, 4, 6}, "0.5", "0"); // 6 becomes 3, which is no padding
        write(2, {3, 3, 3, 3, 3, 3}, "2", "1", false);
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.sampleType() == SampleType::F32);
        CHECK(volume.invalidCount() == 3);
        for (const std::size_t i : {0, 3, 6 + 3}) CHECK_FALSE(volume.isValid(i));
        CHECK(volume.value(6 + 5) == 3);
        CHECK(volume.value(12) == 7);
    }
    SECTION("whole numbers with intercepts of their own stay whole") {
        write(0, {3, 1, 2, 3, 4, 5}, "1", "0");
        write(1, {0, 1, 2, 3, 4, 13}, "1", "-10"); // 13 becomes 3
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.sampleType() == SampleType::I16); // −10 … 4095, and one for what is missing
        CHECK(volume.invalidCount() == 3);
        for (const std::size_t i : {0, 3, 6 + 3}) CHECK_FALSE(volume.isValid(i));
        CHECK(volume.value(6 + 5) == 3);
        CHECK(volume.value(6) == -10);
    }
    SECTION("nothing is interpolated between padding and a value") {
        write(0, {3, 10, 10, 10, 10, 10}, "1", "0");
        write(1, {20, 20, 20, 20, 20, 20}, "1", "0");
        write(3, {40, 3, 40, 40, 40, 40}, "1", "0"); // slice 2 is not there
        write(4, {50, 50, 50, 50, 50, 50}, "1", "0");
        const Volume volume = loadVolume(at(folder.path("a")));
        REQUIRE(volume.dims().z == 5);
        CHECK(volume.invalidCount() == 3);
        for (const std::size_t i : {0, 12 + 1, 18 + 1}) CHECK_FALSE(volume.isValid(i));
        CHECK(volume.value(12) == 30);
    }
    SECTION("a range, from the padding value to its limit") {
        DicomSlice slice = sliceAt(0);
        slice.more.number(0x0028, 0x0120, 4);
        slice.more.number(0x0028, 0x0121, 2);
        slice.intercept = "-1000";
        const Volume volume = loadVolume(at(folder.write("a/0", dicomFile(slice)))); // 0 … 5
        CHECK(volume.invalidCount() == 3);
        for (const std::size_t i : {2, 3, 4}) CHECK_FALSE(volume.isValid(i));
        CHECK(volume.value(1) == -999);
        CHECK(volume.value(5) == -995);
        CHECK(volume.sampleType() == SampleType::I16);
    }
    SECTION("a range below zero") {
        DicomSlice slice = sliceAt(0);
        slice.isSigned = 1;
        slice.bitsStored = 16;
        slice.more.number(0x0028, 0x0120, static_cast<std::uint16_t>(-2000));
        slice.more.number(0x0028, 0x0121, static_cast<std::uint16_t>(-2010));
        slice.pixels = words({-2000, -2011, -2010, -1999, 0, -2005});
        const Volume volume = loadVolume(at(folder.write("a/0", dicomFile(slice))));
        CHECK(volume.invalidCount() == 3);
        for (const std::size_t i : {0, 2, 5}) CHECK_FALSE(volume.isValid(i));
        CHECK(volume.value(1) == -2011);
    }
    SECTION("a number that 8 bits cannot have is no padding") {
        DicomSlice slice = sliceAt(0);
        slice.bitsAllocated = slice.bitsStored = 8;
        slice.more.number(0x0028, 0x0120, 511);
        slice.pixels = {'\xff', 1, 2, 3, 4, 5};
        const Volume volume = loadVolume(at(folder.write("a/0", dicomFile(slice))));
        CHECK(volume.invalidCount() == 0);
        CHECK(volume.value(0) == 255);
    }
}

TEST_CASE("a table gives the values of DICOM pixels", "[dicom]") {
    const TempFolder folder;
    DicomSlice slice = sliceAt(0); // 0, 1, … 5
    const auto fileOf = [&](const std::vector<int>& descriptor, const std::string& data) {
        DicomSlice one = slice;
        DicomElements table;
        table.bytes(0x0028, 0x3002, "US", words(descriptor));
        table.bytes(0x0028, 0x3006, "OW", data);
        one.more.items(0x0028, 0x3000, {table});
        return folder.write("a.dcm", dicomFile(one));
    };
    SECTION("of 16 bits, with the first and the last value beyond its ends") {
        const std::string path = fileOf({3, 2, 16}, words({500, 60000, 7}));
        CHECK(wrongValues(path, {500, 500, 500, 60000, 7, 7}) == 0);
        CHECK(loadVolume(at(path)).sampleType() == SampleType::U16);
    }
    SECTION("of 8 bits, two to a word or one") {
        CHECK(wrongValues(fileOf({3, 2, 8}, std::string("\x05\xff\x09\x00", 4)), {5, 5, 5, 255, 9, 9}) == 0);
        CHECK(wrongValues(fileOf({3, 2, 8}, words({5, 255, 9})), {5, 5, 5, 255, 9, 9}) == 0);
    }
    SECTION("the number of its first value has the sign of pixels") {
        slice.isSigned = 1;
        slice.pixels = words({-2, -1, 0, 1, -1, -100});
        CHECK(wrongValues(fileOf({3, -1, 16}, words({10, 20, 30})), {10, 10, 20, 30, 10, 10}) == 0);
    }
    SECTION("as many as 65536, which are said by 0") {
        slice.bitsStored = 16;
        slice.pixels = words({0, 1, 0xffff, 256, 4, 5});
        std::vector<int> falling;
        for (int i = 0; i < 65536; ++i) falling.push_back(65535 - i);
        CHECK(wrongValues(fileOf({0, 0, 16}, words(falling)), {65535, 65534, 0, 65535 - 256, 65531, 65530}) == 0);
    }
    SECTION("padding is told by stored numbers") {
        slice.more.number(0x0028, 0x0120, 3);
        const Volume volume = loadVolume(at(fileOf({6, 0, 16}, words({3, 3, 3, 9, 3, 3}))));
        CHECK(volume.invalidCount() == 1);
        CHECK_FALSE(volume.isValid(3));
        CHECK(volume.value(0) == 3);
    }
    SECTION("a rescale beside it is not applied, and that is said") {
        slice.slope = "2";
        const std::string path = fileOf({6, 0, 16}, words({0, 10, 20, 30, 40, 50}));
        CHECK(wrongValues(path, {0, 10, 20, 30, 40, 50}) == 0);
        CHECK(hasNotice(loadVolume(at(path)), "the table is used"));
    }
    SECTION("one that is cut off is told") {
        CHECK_THAT(errorAt(fileOf({6, 0, 16}, words({0, 10, 20, 30}))), Contains("8 of 12 bytes"));
        CHECK_THAT(errorAt(fileOf({6, 0, 16}, words({0, 10}))), Contains("Modality LUT") && Contains("cut off"));
    }
}

TEST_CASE("DICOM slices lie where the patient was", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("a"));
    SECTION("oblique: directions are those of columns, of rows, and from slice to slice") {
        // Columns go along (0.6, 0.8, 0), rows along (−0.8, 0.6, 0) and slices along z.
        for (int n = 0; n < 3; ++n) {
            DicomSlice slice = sliceAt(n);
            slice.axes = "0.6\\0.8\\0\\-0.8\\0.6\\0";
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Geometry g = loadVolume(at(folder.path("a"))).geometry();
        CHECK(glm::length(g.directions[0] - Vec3(0.6, 0.8, 0)) < 1e-12);
        CHECK(glm::length(g.directions[1] - Vec3(-0.8, 0.6, 0)) < 1e-12);
        CHECK(g.directions[2] == Vec3(0, 0, 1));
    }
    SECTION("directions that headers round are the same, those of another scan are not") {
        // 0.0025 ± 1e−6, a place where rounding to hundredths or so would tell them apart, and 2° beside.
        for (int n = 0; n < 8; ++n) {
            DicomSlice slice = sliceAt(n);
            const double turn = n < 6 ? 0.0025 + (n % 2 == 0 ? 1e-6 : -1e-6) : 0.035, c = std::cos(turn),
                         s = std::sin(turn);
            slice.axes = decimals({c, s, 0, -s, c, 0});
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.dims().z == 6);
        CHECK(volume.geometry().spacing.z == Approx(1.5));
        CHECK(hasNotice(volume, "series '1: head' of 2 is shown"));
        CHECK(loadVolume(at(folder.path("a/1"))).dims().z == 6);
        CHECK(loadVolume(at(folder.path("a/7"))).dims().z == 2);
    }
    SECTION("sagittal slices ascend along the normal of their axes") {
        // Columns go back, rows down: the normal is (0,1,0) × (0,0,−1) = (−1, 0, 0), so that the first is the leftmost.
        for (int n = 0; n < 3; ++n) {
            DicomSlice slice = sliceAt(n);
            slice.axes = "0\\1\\0\\0\\0\\-1";
            slice.position = std::to_string(2 * n) + "\\0\\0";
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.geometry().origin == Vec3(4, 0, 0));
        CHECK(volume.geometry().directions[2] == Vec3(-1, 0, 0));
        CHECK(volume.value(0) == 200);
    }
    SECTION("a tilted gantry shears the grid") {
        // From slice to slice (0, 0.5, 1.2): 22.6° against the normal; 1.3 mm long.
        for (int n = 0; n < 4; ++n) {
            DicomSlice slice = sliceAt(n);
            slice.position = "0\\" + std::to_string(0.5 * n) + "\\" + std::to_string(1.2 * n);
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.geometry().spacing.z == Approx(1.3));
        CHECK(glm::length(volume.geometry().directions[2] - Vec3(0, 0.5 / 1.3, 1.2 / 1.3)) < 1e-6);
        CHECK(hasNotice(volume, "tilted by 22.6°"));
    }
    SECTION("a slice that is missing is interpolated, and said") {
        for (const int n : {0, 1, 3, 4}) folder.write("a/" + std::to_string(n), dicomFile(sliceAt(n)));
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.dims().z == 5);
        CHECK(volume.geometry().spacing.z == Approx(1.5));
        CHECK(volume.value(12) == 200); // between 100 and 300
        CHECK(volume.value(18) == 300); // as it is
        CHECK(hasNotice(volume, "1 of 5 layers are interpolated"));
    }
    SECTION("a slice that is there twice counts once") {
        for (const int n : {0, 1, 2}) folder.write("a/" + std::to_string(n), dicomFile(sliceAt(n)));
        folder.write("a/copy", dicomFile(sliceAt(1)));
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.dims().z == 3);
        CHECK(hasNotice(volume, "1 slice is there twice"));
    }
    SECTION("pictures without a place are taken as they are numbered") {
        for (const int n : {2, 0, 1}) {
            DicomSlice slice = sliceAt(n);
            slice.position.clear();
            slice.axes.clear();
            slice.spacing.clear();
            folder.write("a/" + std::to_string(9 - n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.value(6) == 100);
        CHECK(volume.geometry().worldAxes == WorldAxes::File);
        CHECK(hasNotice(volume, "do not say where slices lie"));
        CHECK(hasNotice(volume, "1 mm is taken"));
    }
}

TEST_CASE("one anatomy in eight orientations lies in one place, through DICOM", "[dicom]") {
    Geometry grid;
    grid.dims = {6, 5, 4};
    grid.spacing = {1, 1.5, 2};
    grid.origin = {-7, 3, 11};
    Samples samples;
    std::vector<float> numbers;
    for (int i = 0; i < 6 * 5 * 4; ++i)
        numbers.push_back(static_cast<float>(8 * (i % 6) + 64 * (i / 6 % 5) + 512 * (i / 30)));
    samples = numbers;
    const Volume anatomy(grid, samples);
    std::vector<Oriented> all = orientations(anatomy, 0);
    // DICOM has no slices with slanted edges: the last one is slanted from slice to slice.
    const double slant = glm::radians(15.0);
    const Geometry slanted =
        regridded(grid, grid.dims + grid.dims / 2,
                  Mat3(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, std::sin(slant), std::cos(slant))), grid.spacing);
    all.back() = {"slanted by 15°", std::make_shared<const Volume>(slanted, sampledOn(slanted, anatomy, 0))};
    REQUIRE(all.size() == 8);
    for (const auto& [name, volume] : all) {
        CAPTURE(name);
        const TempFolder folder;
        const Geometry& g = volume->geometry();
        const std::size_t perSlice = static_cast<std::size_t>(g.dims.x) * static_cast<std::size_t>(g.dims.y);
        for (int k = 0; k < g.dims.z; ++k) {
            DicomSlice slice = sliceAt(k);
            slice.columns = g.dims.x;
            slice.rows = g.dims.y;
            const Vec3 x = g.directions[0], y = g.directions[1], place = g.worldFromVoxel(Vec3(0, 0, k));
            slice.axes = decimals({x.x, x.y, x.z, y.x, y.y, y.z});
            slice.position = decimals({place.x, place.y, place.z});
            slice.spacing = decimals({g.spacing.y, g.spacing.x});
            std::vector<int> values;
            for (std::size_t i = 0; i < perSlice; ++i)
                values.push_back(
                    static_cast<int>(std::lround(volume->value(perSlice * static_cast<std::size_t>(k) + i))));
            slice.pixels = words(values);
            folder.write(std::to_string(k), dicomFile(slice));
        }
        const Volume read = loadVolume(at(folder.path("")));
        CHECK(read.geometry().worldAxes == WorldAxes::Patient);
        CHECK(hasNotice(read, "tilted by 15°") == (name == "slanted by 15°"));
        REQUIRE(read.size() == volume->size());
        // Layers ascend along the normal of slices: each voxel has the value of the one that lies in its place.
        std::size_t wrong = 0;
        double off = 0;
        const Int3& d = read.dims();
        for (int k = 0; k < d.z; ++k)
            for (int j = 0; j < d.y; ++j)
                for (int i = 0; i < d.x; ++i) {
                    const Vec3 there = g.voxelFromWorld(read.geometry().worldFromVoxel(Vec3(i, j, k)));
                    const Int3 v = glm::clamp(Int3(glm::round(there)), Int3(0), g.dims - 1);
                    off = std::max(off, glm::distance(there, Vec3(v)));
                    const auto index = [](const Int3& dims, const Int3& at) {
                        return static_cast<std::size_t>(at.x + dims.x * (at.y + dims.y * at.z));
                    };
                    wrong += read.value(index(d, {i, j, k})) != std::round(volume->value(index(g.dims, v)));
                }
        CHECK(off < 1e-5); // numbers of the header have 9 digits
        CHECK(wrong == 0);
    }
}

TEST_CASE("of several series in a folder one is chosen", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("study"));
    for (int n = 0; n < 3; ++n) folder.write("study/a" + std::to_string(n), dicomFile(sliceAt(n)));
    for (int n = 0; n < 2; ++n) {
        DicomSlice slice = sliceAt(n);
        slice.series = "1.2.9";
        slice.seriesNumber = "7";
        slice.description = "thin\x1b[31m";
        folder.write("study/b" + std::to_string(n), dicomFile(slice));
    }
    DicomSlice german = sliceAt(0);
    german.series = "1.2.10";
    german.seriesNumber = "8";
    german.description = "Sch\xe4"
                         "del"; // ä in Latin-1
    german.more.text(0x0008, 0x0005, "CS", "ISO_IR 100");
    folder.write("study/c", dicomFile(german));
    const FileContents contents = contentsOf(at(folder.path("study")));
    REQUIRE(contents.arrays.size() == 3);
    CHECK(contents.arrays[2] == "8: Schädel");
    CHECK(contents.array == "1: head");
    CHECK(contents.details[0] == "3 × 2 pixels, 3 pictures");
    CHECK(contents.arrays[0] == "1: head");
    CHECK(contents.arrays[1].find('\x1b') == std::string::npos);
    const Volume largest = loadVolume(at(folder.path("study")));
    CHECK(largest.dims().z == 3);
    CHECK(hasNotice(largest, "series '1: head' of 3 is shown"));
    for (const std::string& name : {std::string("7"), contents.arrays[1], std::string("1.2.9")}) {
        const Volume chosen = loadVolume(at(folder.path("study"), name));
        CHECK(chosen.dims().z == 2);
        CHECK(chosen.notices.empty());
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("study"), "9")),
                      Contains("there is no series '9'") && Contains("1: head"));
    CHECK_THROWS_AS(loadVolume(at(folder.path("study"), "9")), UsageError);
}

TEST_CASE("what a folder holds is told anew once its files have changed", "[dicom]") {
    const TempFolder folder;
    writeStack(folder, "scan", 3);
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 3);
    CHECK(contentsOf(at(folder.path("scan/IM00"))).dims.z == 3);
    folder.write("scan/IM99", dicomFile(sliceAt(3)));
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 4);
    CHECK(contentsOf(at(folder.path("scan/IM00"))).dims.z == 4);
    fs::remove(folder.path("scan/IM99"));
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 3);
    // Nothing has changed: no program is asked.
    setReaderProgram(folder.path("none"));
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 3);
    setReaderProgram({});
}

TEST_CASE("several pictures of each place are time steps", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("heart"));
    int number = 0;
    const auto write = [&](int n, int step, const auto& mark) {
        DicomSlice slice = sliceAt(n);
        slice.number = ++number;
        slice.pixels = words({1000 * step + 100 * n, 0, 0, 0, 0, 0});
        mark(slice);
        folder.write("heart/" + std::to_string(number), dicomFile(slice));
    };
    SECTION("by the time after the heart beat, which may differ from slice to slice") {
        for (int n = 0; n < 3; ++n)
            for (int step = 1; step >= 0; --step)
                write(n, step,
                      [&](DicomSlice& slice) { slice.more.text(0x0018, 0x1060, "DS", std::to_string(40 * step + n)); });
        const SeriesListing listing = listSeries(at(folder.path("heart")));
        REQUIRE(listing.frames.size() == 2);
        CHECK(listing.timeUnit == "ms");
        CHECK(listing.frames[1].time == Approx(41)); // the mean of 40, 41, 42
        CHECK(loadVolume(listing.frames[1].source).value(12) == 1200);
        CHECK(loadVolume(listing.frames[0].source).value(12) == 200);
    }
    SECTION("by b-value; a step that lacks slices is left out") {
        for (int n = 0; n < 3; ++n)
            for (const int b : {0, 500, 1000})
                if (n != 2 || b != 1000)
                    write(n, b / 500, [&](DicomSlice& slice) { slice.more.real(0x0018, 0x9087, b); });
        const FileContents contents = contentsOf(at(folder.path("heart")));
        CHECK(contents.steps == 2);
        CHECK(contents.times == std::vector<double>{0, 500});
        CHECK(contents.timeUnit == "s/mm²");
        CHECK(hasNotice(loadVolume(at(folder.path("heart"))), "1 time step lacks slices"));
    }
    const auto checkDiffusion = [&] {
        const FileContents contents = contentsOf(at(folder.path("heart")));
        CHECK(contents.times == std::vector<double>{0, 500, 1000});
        CHECK(contents.timeUnit == "s/mm²");
        const SeriesListing listing = listSeries(at(folder.path("heart")));
        REQUIRE(listing.frames.size() == 3);
        CHECK(loadVolume(listing.frames[2].source).value(12) == 2200);
    };
    // Written from the highest down, so that their order alone would be another one.
    SECTION("by b-value, where Siemens has it") {
        for (int n = 0; n < 3; ++n)
            for (const int b : {1000, 500, 0})
                write(n, b / 500, [&](DicomSlice& slice) {
                    slice.more.text(0x0019, 0x0010, "LO", "SOMEBODY ELSE");
                    slice.more.text(0x0019, 0x0011, "LO", "SIEMENS MR HEADER");
                    slice.more.text(0x0019, 0x100c, "IS", "7");
                    slice.more.text(0x0019, 0x110c, "IS", std::to_string(b));
                });
        checkDiffusion();
    }
    SECTION("by b-value, where GE has it: newer scanners add 1e9") {
        for (int n = 0; n < 3; ++n)
            for (const int b : {1000, 500, 0})
                write(n, b / 500, [&](DicomSlice& slice) {
                    slice.more.text(0x0043, 0x0010, "LO", "GEMS_PARM_01");
                    slice.more.text(0x0043, 0x1039, "IS",
                                    std::to_string(b + (b > 0 ? 1'000'000'000 : 0)) + "\\8\\0\\0");
                });
        checkDiffusion();
    }
    SECTION("by b-value, where Philips has it") {
        for (int n = 0; n < 3; ++n)
            for (const int b : {1000, 500, 0})
                write(n, b / 500, [&](DicomSlice& slice) {
                    const auto value = static_cast<float>(b);
                    std::string bytes(sizeof value, '\0');
                    std::memcpy(bytes.data(), &value, sizeof value);
                    slice.more.text(0x2001, 0x0010, "LO", "Philips Imaging DD 001");
                    slice.more.bytes(0x2001, 0x1003, "FL", bytes);
                });
        checkDiffusion();
    }
}

TEST_CASE("frames of one DICOM file are slices, each with its own place and scaling", "[dicom]") {
    const TempFolder folder;
    DicomSlice slice;
    slice.position.clear();
    slice.axes.clear();
    slice.spacing.clear();
    slice.more.text(0x0028, 0x0008, "IS", "3");
    DicomElements shared, orientation, measures;
    orientation.text(0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0");
    measures.text(0x0028, 0x0030, "DS", "0.5\\0.25");
    shared.items(0x0020, 0x9116, {orientation});
    shared.items(0x0028, 0x9110, {measures});
    slice.more.items(0x5200, 0x9229, {shared});
    std::vector<DicomElements> frames;
    std::vector<int> values;
    for (int n = 0; n < 3; ++n) { // from the highest down
        DicomElements frame, place, scaling;
        place.text(0x0020, 0x0032, "DS", "1\\2\\" + std::to_string(10 - 2 * n));
        scaling.text(0x0028, 0x1052, "DS", "0");
        scaling.text(0x0028, 0x1053, "DS", std::to_string(n + 1) + ".5");
        frame.items(0x0020, 0x9113, {place});
        frame.items(0x0028, 0x9145, {scaling});
        frames.push_back(frame);
        for (int i = 0; i < 6; ++i) values.push_back(10 * n + i);
    }
    slice.more.items(0x5200, 0x9230, frames);
    slice.pixels = words(values);
    const Volume volume = loadVolume(at(folder.write("enhanced.dcm", dicomFile(slice))));
    CHECK(volume.dims() == Int3(3, 2, 3));
    CHECK(volume.geometry().spacing == Vec3(0.25, 0.5, 2));
    CHECK(volume.geometry().origin == Vec3(1, 2, 6));
    CHECK(volume.value(0) == 20 * 3.5); // the lowest is the last frame
    CHECK(volume.value(17) == 5 * 1.5);
}

TEST_CASE("what is wrong with a DICOM file is told", "[dicom]") {
    const TempFolder folder;
    const auto errorOf = [&](const std::string& bytes) {
        const TempFolder own;
        try {
            loadVolume(at(own.write("x.dcm", bytes)));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    DicomSlice slice = sliceAt(0);
    const std::string whole = dicomFile(slice);
    CHECK(errorOf(whole) == "no error");
    CHECK_THAT(errorOf(whole.substr(0, whole.size() - 1)),
               Contains("the pixels have 11 of 12 bytes") && Contains("x.dcm"));
    slice.rows = 60000;
    slice.columns = 60000;
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("the pixels have 12 of 7200000000 bytes") || Contains("memory"));
    slice = sliceAt(0);
    slice.bitsAllocated = 64;
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("64 bits"));
    slice = sliceAt(0);
    slice.bitsStored = 17;
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("17 of 16 bits"));
    slice = sliceAt(0);
    slice.pixels.clear();
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("has no pictures"));
    slice = sliceAt(0);
    slice.more.text(0x0028, 0x0008, "IS", "99999999");
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("99999999 frames"));
    // A name does not make a DICOM file.
    CHECK_THAT(errorOf(std::string(5000, '\0')), Contains("this is not a DICOM file but binary data"));
    CHECK_THAT(errorOf(std::string(100, '\0')), Contains("this is not a DICOM file"));
    // One broken slice of a folder is named.
    writeStack(folder, "scan", 3);
    folder.write("scan/IM71", dicomFile(sliceAt(1)).substr(0, dicomFile(sliceAt(1)).size() - 4));
    CHECK_THROWS_WITH(loadVolume(at(folder.path("scan"))), Contains("8 of 12 bytes") && Contains("IM71"));
}

TEST_CASE("a DICOMDIR names the files of a study", "[dicom]") {
    const TempFolder folder;
    writeStack(folder, "IMAGES", 3);
    std::vector<DicomElements> records;
    for (const auto& entry : fs::directory_iterator(folder.path("IMAGES"))) {
        DicomElements record;
        record.text(0x0004, 0x1430, "CS", "IMAGE");
        record.text(0x0004, 0x1500, "CS", "IMAGES\\" + entry.path().filename().string());
        records.push_back(record);
    }
    DicomElements outside; // a name that leaves the folder is not followed
    outside.text(0x0004, 0x1500, "CS", "..\\..\\etc\\passwd");
    records.push_back(outside);
    DicomElements directory;
    directory.items(0x0004, 0x1220, records);
    const std::string path = folder.write("DICOMDIR", dicomFile(directory));
    const Volume volume = loadVolume(at(path));
    CHECK(volume.dims() == Int3(3, 2, 3));
    CHECK(volume.notices.empty());
}

TEST_CASE("what happens to the process that reads is told in a sentence", "[dicom]") {
    const TempFolder folder;
    const std::string path = folder.write("a.dcm", dicomFile(sliceAt(0)));
    const struct Restore {
        ~Restore() { setReaderProgram({}); }
    } restore;
    const auto with = [&](const std::string& script) {
        const std::string program = folder.write("reader.sh", "#!/bin/sh\n" + script + "\n");
        fs::permissions(program, fs::perms::owner_all);
        setReaderProgram(program);
    };
    with("read line; kill -SEGV $$");
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("crashed on it (signal 11)") && Contains("a.dcm"));
    // A file that takes too long is not tried twice.
    with("echo once >> '" + folder.path("count") + "'; read line; kill -XCPU $$");
    CHECK_THROWS_WITH(listSeries(at(path)), Contains("takes too long") && Contains("a.dcm"));
    CHECK(fs::file_size(folder.path("count")) == 5);  // "once" and a line end
    CHECK_THROWS_AS(filesOf(at(path)), TakesTooLong); // with which commands begin
    with("read line; echo nonsense");
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("can be understood"));
    with("read line; echo '{\"layout\":{\"axes\":[]}}'; sleep 100");
    CHECK_THROWS_AS(loadVolume(at(path)), Error);
    // More than any memory has: before anything is allocated.
    with("read line; echo '{\"layout\":{\"axes\":[{\"size\":2000000000,\"components\":false,\"time\":false},"
         "{\"size\":1000000000,\"components\":false,\"time\":false}],\"type\":0,\"spacing\":[1,1,1],\"origin\":[0,0,0],"
         "\"directions\":[[1,0,0],[0,1,0],[0,0,1]],\"patient\":false,\"length_unit\":\"\",\"array\":\"\",\"layers_at_"
         "once\":1,"
         "\"notices\":[]}}'; sleep 100");
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("would take hours"));
    setReaderProgram(folder.path("none"));
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("cannot be started"));
    // Cancelled: the process is ended, and nobody waits for it.
    with("read line; sleep 100");
    std::stop_source stop;
    JobControl job;
    job.stop = stop.get_token();
    stop.request_stop();
    CHECK_THROWS_AS(loadVolume(at(path), job), Cancelled);
}
