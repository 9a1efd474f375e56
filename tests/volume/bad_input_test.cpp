// What bad files get: one clear line, no crash, nothing allocated before the check.
#include <filesystem>
#include <iostream>
#include <limits>
#include <sstream>

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/formats/file_check.h"
#include "volume/loader.h"
#include "volume/series.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

/// The error line of opening `source`; also checks its form and that nothing else was printed.
std::string errorOf(const VolumeSource& source) {
    std::ostringstream out, err;
    auto* const outBefore = std::cout.rdbuf(out.rdbuf());
    auto* const errBefore = std::cerr.rdbuf(err.rdbuf());
    std::string line = "no error";
    std::string where;
    try {
        loadVolume(source);
    } catch (const FileError& e) {
        line = e.what();
        where = e.where();
    } catch (const Error& e) {
        line = std::string("not a FileError: ") + e.what();
    }
    std::cout.rdbuf(outBefore);
    std::cerr.rdbuf(errBefore);
    CHECK(out.str().empty());
    CHECK(err.str().empty());
    CHECK(line.find('\n') == std::string::npos);
    CHECK(line.size() < 400 + where.size());
    CHECK(!where.empty());
    return line;
}

std::string errorOf(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return errorOf(source);
}

using namespace std::string_literals;
const std::string kPng = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR and so on"s;

std::string nrrd(const std::string& fields, const std::string& data) {
    return "NRRD0004\ntype: uint8\ndimension: 3\n" + fields + "\nencoding: raw\n\n" + data;
}
std::string mha(const std::string& fields, const std::string& data) {
    return "ObjectType = Image\nNDims = 3\nElementType = MET_UCHAR\n" + fields + "\nElementDataFile = LOCAL\n" + data;
}

} // namespace

TEST_CASE("a path that is no file is refused", "[bad-input]") {
    const TempFolder folder;
    CHECK_THAT(errorOf(folder.path("none.nrrd")), Contains("no such file"));
    CHECK_THAT(errorOf(folder.path(".")), Contains("folder"));
    std::filesystem::create_directory(folder.path("folder.nrrd"));
    CHECK_THAT(errorOf(folder.path("folder.nrrd")), Contains("folder"));
    CHECK_THAT(errorOf("/dev/null"), Contains("not a regular file"));
    CHECK_THROWS_AS(loadVolume(VolumeSource{}), UsageError);
}

TEST_CASE("an empty file is refused in every format", "[bad-input]") {
    const TempFolder folder;
    for (const char* name : {"a.nrrd", "a.nhdr", "a.mhd", "a.mha", "a.nii", "a.nii.gz", "a.raw", "a.txt"})
        CHECK_THAT(errorOf(folder.write(name, "")), Contains("the file is empty"));
}

TEST_CASE("an unknown suffix lists what can be read", "[bad-input]") {
    const TempFolder folder;
    const std::string line = errorOf(folder.write("a.xyz", "abc"));
    for (const char* part : {".nrrd", ".nhdr", ".mhd", ".mha", ".nii", ".nii.gz"}) CHECK_THAT(line, Contains(part));
    CHECK_THAT(errorOf(folder.write("nrrd", "abc")), Contains("suffix"));
    for (const char* name : {"a.xyz", "a.raw"}) { // each door names its own way to tell a layout
        VolumeSource source;
        source.path = folder.write(name, "abc");
        try {
            loadVolume(source);
            FAIL("it was read");
        } catch (const FileError& e) {
            CHECK(e.remedy() == Remedy::GiveRawLayout);
        }
    }
}

TEST_CASE("a file of another type under a volume's name is told what it is", "[bad-input]") {
    const TempFolder folder;
    for (const char* name : {"p.nrrd", "p.nhdr", "p.mhd", "p.mha", "p.nii", "p.nii.gz"}) {
        CHECK_THAT(errorOf(folder.write(name, kPng)), Contains("a PNG image"));
        CHECK_THAT(errorOf(folder.write(name, "Dear reader,\nthis is a letter.\n")), Contains("text"));
        CHECK_THAT(errorOf(folder.write(name, std::string(5000, '\0'))), Contains("not a"));
        CHECK_THAT(errorOf(folder.write(name, "x")), Contains("not a"));
    }
}

TEST_CASE("headerless data are not taken for DICOM or TIFF", "[bad-input]") {
    const TempFolder folder;
    const std::string rest(400, '\7');
    // Numbers that happen to begin like an element of DICOM, whose length leads nowhere, or like a TIFF file.
    for (const std::string& begin : {"\x08\0\x05\0\x0a\0\0\0"s, "\x08\0\x05\0CS\x0a\0"s, "II"s, "MM\0\0"s}) {
        const std::string path = folder.write("numbers", begin + rest);
        CHECK(mayBeHeaderless(path));
        CHECK_THAT(errorOf(path), Contains("suffix"));
    }
    CHECK_FALSE(mayBeHeaderless(folder.path("none")));
    CHECK_FALSE(mayBeHeaderless(folder.write("b.nrrd", "abc")));
}

TEST_CASE("a header that claims more than its file holds is refused", "[bad-input]") {
    // 10000³ = 10¹² voxels; the product in the last lines passes 2⁶³ and, unchecked, would come out as 0.
    const TempFolder folder;
    CHECK_THAT(errorOf(folder.write("a.nrrd", nrrd("sizes: 10000 10000 10000", "abc"))),
               Contains("3 of 1000000000000 bytes"));
    CHECK_THAT(errorOf(folder.write("a.mha", mha("DimSize = 10000 10000 10000", "abc"))),
               Contains("3 of 1000000000000 bytes"));
    Nifti nifti;
    nifti.dim = {3, 10000, 10000, 10000, 1, 1, 1, 1};
    CHECK_THAT(errorOf(folder.write("a.nii", nifti.header() + "abc")), Contains("3 of 1000000000000 bytes"));
    CHECK_THAT(errorOf(folder.write("a.nii.gz", gzipped(nifti.header() + "abc"))), Contains("cannot hold"));
    CHECK_THAT(errorOf(folder.write("z.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 10000 10000 10000\n"
                                              "encoding: gzip\n\n" +
                                                  gzipped("abc"))),
               Contains("cannot hold"));
    CHECK_THAT(errorOf(folder.write("t.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 10000 10000 10000\n"
                                              "encoding: ascii\n\n1 2 3\n")),
               Contains("cannot hold"));
    CHECK_THAT(errorOf(folder.write("z.mha", mha("CompressedData = True\nDimSize = 10000 10000 10000", "abc"))),
               Contains("cannot hold"));
    CHECK_THAT(errorOf(folder.write("b.nrrd", nrrd("sizes: 2147483648 2147483648 4", ""))),
               Contains("more than any memory"));
    CHECK_THAT(errorOf(folder.write("b.mha", mha("DimSize = 1073741824 1073741824 16", ""))),
               Contains("more than any memory"));
}

TEST_CASE("a volume that memory cannot hold is refused before it is allocated", "[bad-input]") {
    // A file with a hole is as large as its header claims and takes no space.
    const TempFolder folder;
    const std::string path = folder.write("huge.raw", "x");
    std::error_code ec;
    std::filesystem::resize_file(path, 1'000'000'000'000, ec);
    if (ec) {
        WARN("skipped: this file system takes no file of 1 TB (" << ec.message() << ")");
        return;
    }
    VolumeSource source;
    source.path = path;
    source.raw = parseRawLayout("10000,10000,10000,u8");
    source.downsample = 1;
    CHECK_THAT(errorOf(source), Contains("needs 1 TB of memory"));
    const std::string header = folder.write("huge.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 10000 10000 10000\n"
                                                        "ElementType = MET_UCHAR\nElementDataFile = huge.raw\n");
    source.raw.reset();
    source.path = header;
    CHECK_THAT(errorOf(source), Contains("of memory"));
}

TEST_CASE("a dimension below one is refused", "[bad-input]") {
    const TempFolder folder;
    for (const char* sizes : {"2 0 2", "2 -2 2", "-2 -2 2"}) {
        CHECK_THAT(errorOf(folder.write("a.nrrd", nrrd(std::string("sizes: ") + sizes, "12345678"))),
                   Contains("at least 1"));
        CHECK_THAT(errorOf(folder.write("a.mha", mha(std::string("DimSize = ") + sizes, "12345678"))),
                   Contains("at least 1"));
    }
    for (const std::int16_t size : {std::int16_t{0}, std::int16_t{-3}}) {
        Nifti nifti;
        nifti.dim[2] = size;
        CHECK_THAT(errorOf(folder.write("a.nii", nifti.header() + std::string(100, 'x'))), Contains("at least 1"));
    }
    Nifti nifti;
    nifti.dim[0] = 0;
    CHECK_THAT(errorOf(folder.write("a.nii", nifti.header() + std::string(100, 'x'))), Contains("0 axes"));
}

TEST_CASE("a spacing that is zero, negative, infinite or no number is refused", "[bad-input]") {
    const TempFolder folder;
    for (const char* bad : {"-1", "0", "nan", "inf", "abc"}) {
        CAPTURE(bad);
        const std::string triple = std::string("1 ") + bad + " 1";
        CHECK_THAT(errorOf(folder.write("a.nrrd", nrrd("sizes: 2 2 2\nspacings: " + triple, "12345678"))),
                   Contains("spacing of axis 1") && Contains("positive and finite"));
        CHECK_THAT(errorOf(folder.write("a.mha", mha("DimSize = 2 2 2\nElementSpacing = " + triple, "12345678"))),
                   Contains("spacing of axis 1") && Contains("positive and finite"));
    }
    CHECK_THAT(
        errorOf(folder.write("d.nrrd", nrrd("sizes: 2 2 2\nspace dimension: 3\nspace directions: (1,0,0) (0,0,0) "
                                            "(0,0,1)",
                                            "12345678"))),
        Contains("spacing of axis 1"));
    for (const float bad : {-1.0f, 0.0f, std::numeric_limits<float>::quiet_NaN()}) {
        CAPTURE(bad);
        Nifti nifti;
        nifti.pixdim[2] = bad;
        CHECK_THAT(errorOf(folder.write("a.nii", nifti.header() + std::string(24, 'x'))),
                   Contains("spacing of axis 1") && Contains("positive and finite"));
    }
}

TEST_CASE("a spacing that is too small or too large to compute with is refused with that reason", "[bad-input]") {
    // Lengths of 1e-15 pass for zero somewhere, and products of lengths of 1e30 are no floats.
    const TempFolder folder;
    const std::string vti =
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\" Spacing=\"1 SPACING 1\">"
        "<Piece Extent=\"0 1 0 1 0 1\"><PointData><DataArray type=\"UInt8\" format=\"ascii\">"
        "1 2 3 4 5 6 7 8</DataArray></PointData></Piece></ImageData></VTKFile>";
    for (const auto& [value, what] : {std::pair{"1e-15", "too small"},
                                      {"9e-13", "too small"},
                                      {"1e-40", "too small"},
                                      {"1.1e24", "too large"},
                                      {"1e30", "too large"},
                                      {"1e200", "too large"},
                                      {"1e-12", ""},
                                      {"1e24", ""}}) {
        CAPTURE(value);
        const std::string triple = std::string("1 ") + value + " 1";
        std::string image = vti;
        image.replace(image.find("SPACING"), 7, value);
        std::vector<VolumeSource> sources(4);
        sources[0].path = folder.write("a.nrrd", nrrd("sizes: 2 2 2\nspacings: " + triple, "12345678"));
        sources[1].path = folder.write("a.mha", mha("DimSize = 2 2 2\nElementSpacing = " + triple, "12345678"));
        sources[2].path = folder.write("a.vti", image);
        sources[3].path = folder.write("a.raw", "12345678");
        sources[3].raw = parseRawLayout("2,2,2,u8");
        sources[3].spacing = GridSpacing{{1, std::stod(value), 1}};
        for (const VolumeSource& source : sources) {
            CAPTURE(source.path);
            if (*what == '\0')
                CHECK(loadVolume(source).geometry().spacing.y == std::stod(value));
            else
                CHECK_THROWS_WITH(loadVolume(source), Contains("spacing of axis 1") && Contains(what));
        }
    }
    Nifti nifti;
    nifti.pixdim[2] = 1e-20f;
    CHECK_THAT(errorOf(folder.write("a.nii", nifti.header() + std::string(24, 'x'))),
               Contains("spacing of axis 1 is 1e-20, too small"));
    nifti.pixdim[2] = 1e22f;
    nifti.units = 1; // metres, each of which is 1000 of a patient's
    nifti.sformCode = 1;
    nifti.sform = {1, 0, 0, 0, 0, 1e22f, 0, 0, 0, 0, 1, 0};
    CHECK_THAT(errorOf(folder.write("b.nii", nifti.header() + std::string(24, 'x'))),
               Contains("spacing of axis 1 is 1e+25, too large"));
}

TEST_CASE("truncated data is refused in every format and encoding", "[bad-input]") {
    const TempFolder folder;
    std::vector<std::uint16_t> values(24 * 100);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i * 40503u); // hard to pack
    const std::string data = bytesOf(values);
    const std::string half = data.substr(0, data.size() / 2);
    const std::string head = "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 20 30 4\nendian: little\nencoding: ";
    CHECK_THAT(errorOf(folder.write("r.nrrd", head + "raw\n\n" + half)), Contains("2400 of 4800 bytes"));
    const std::string packed = gzipped(data);
    CHECK_THAT(errorOf(folder.write("z.nrrd", head + "gzip\n\n" + packed.substr(0, packed.size() / 2))),
               Contains("compressed data"));
    CHECK_THAT(errorOf(folder.write("s.nrrd", head + "gzip\n\n" + gzipped(half))), Contains("compressed data"));
    CHECK_THAT(errorOf(folder.write("g.nrrd", head + "gzip\n\n" + data)), Contains("compressed data"));

    const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 20 30 4\nElementType = MET_USHORT\n";
    CHECK_THAT(errorOf(folder.write("r.mha", meta + "ElementDataFile = LOCAL\n" + half)), Contains("2400 of 4800"));
    CHECK_THAT(
        errorOf(folder.write("t.mha", "ObjectType = Image\nNDims = 2\nDimSize = 3 3\nBinaryData = False\n"
                                      "ElementType = MET_USHORT\nElementDataFile = LOCAL\n10000 20000 30000\n40000\n")),
        Contains("4 of 9 values"));
    CHECK_THAT(errorOf(folder.write("t.nrrd", "NRRD0004\ntype: ushort\ndimension: 2\nsizes: 3 3\nencoding: text\n\n"
                                              "10000 20000 30000\n40000\n")),
               Contains("4 of 9 values"));
    const std::string hex = "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 2 2\nencoding: hex\n\n";
    CHECK_THAT(errorOf(folder.write("h.nrrd", hex + "01 02 03")), Contains("cannot be read"));
    CHECK_THAT(errorOf(folder.write("i.nrrd", hex + "010203")), Contains("3 of 4 bytes"));
    CHECK_THAT(errorOf(folder.write("u.mha", "ObjectType = Image\nNDims = 2\nDimSize = 1 2\nBinaryData = False\n"
                                             "ElementType = MET_USHORT\nElementDataFile = LOCAL\n1 two\n")),
               Contains("'two'"));
    const std::string zlib = zlibbed(data);
    const std::string compressed = meta + "CompressedData = True\n";
    const std::string claimed = compressed + "CompressedDataSize = " + std::to_string(zlib.size()) + "\n";
    const std::string local = "ElementDataFile = LOCAL\n";
    CHECK_THAT(errorOf(folder.write("z.mha", claimed + local + zlib.substr(0, zlib.size() / 2))), Contains(" of "));
    CHECK_THAT(errorOf(folder.write("y.mha", compressed + local + zlib.substr(0, zlib.size() / 2))),
               Contains("compressed data"));
    CHECK_THAT(errorOf(folder.write("x.mha", compressed + local + data)), Contains("compressed data"));
    CHECK_THAT(errorOf(folder.write("w.mha", compressed + local + zlibbed(half))), Contains("compressed data"));

    Nifti nifti;
    nifti.dim = {3, 20, 30, 4, 1, 1, 1, 1};
    nifti.datatype = 512;
    nifti.bitpix = 16;
    CHECK_THAT(errorOf(folder.write("r.nii", nifti.header() + half)), Contains("2400 of 4800"));
    const std::string whole = gzipped(nifti.header() + data);
    CHECK_THAT(errorOf(folder.write("z.nii.gz", whole.substr(0, whole.size() / 2))), Contains("compressed data"));
    CHECK_THAT(errorOf(folder.write("s.nii.gz", gzipped(nifti.header() + half))), Contains("compressed data"));
    CHECK_THAT(errorOf(folder.write("h.nii.gz", whole.substr(0, 30))), Contains("fewer than a NIfTI header"));
}

TEST_CASE("a data file beside the header must exist and be long enough", "[bad-input]") {
    const TempFolder folder;
    folder.write("short.raw", "1234567");
    folder.write("long.raw", "123456789");
    const auto mhd = [&](const std::string& data) {
        return folder.write("a.mhd",
                            "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = " + data + "\n");
    };
    const auto nhdr = [&](const std::string& data) {
        return folder.write(
            "a.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: " + data + "\n");
    };
    for (const auto& make :
         {std::function<std::string(std::string)>(mhd), std::function<std::string(std::string)>(nhdr)}) {
        // The header is there: what is missing is named beside it.
        const std::string header = make("none.raw");
        CHECK_THAT(errorOf(header), Contains("the data file 'none.raw' that the header names is missing") &&
                                        Contains(header) && !Contains("no such file"));
        CHECK_THAT(errorOf(make("below/none.raw")), Contains("'below/none.raw'"));
        CHECK_THAT(errorOf(make(std::string(100, 'x') + "/none.raw")), Contains("'none.raw'"));
        CHECK_THAT(errorOf(make("short.raw")), Contains("7 of 8 bytes") && Contains("short.raw"));
        CHECK_THAT(errorOf(make("LIST")), Contains("lists no data files"));
        CHECK_THAT(errorOf(make("slice%s.raw 1 2 1")), Contains("pattern of the data files"));
        VolumeSource source;
        source.path = make("long.raw"); // more than the header says: opens, with a remark
        const Volume volume = loadVolume(source);
        CHECK(volume.value(0) == '1');
        REQUIRE(volume.notices.size() == 1);
        CHECK_THAT(volume.notices[0], Contains("1 bytes more"));
    }
}

TEST_CASE("a raw file of another size than its layout is refused", "[bad-input]") {
    const TempFolder folder;
    VolumeSource source;
    source.path = folder.write("a.raw", std::string(47, 'x'));
    source.raw = parseRawLayout("2,3,4,u16"); // 48 bytes
    CHECK_THAT(errorOf(source), Contains("47 bytes") && Contains("are 48"));
    source.path = folder.write("b.raw", std::string(49, 'x'));
    CHECK_THAT(errorOf(source), Contains("49 bytes"));
    source.raw->skipBytes = 2;
    CHECK_THAT(errorOf(source), Contains("after 2 skipped"));
    source.raw->skipBytes = std::numeric_limits<std::uint64_t>::max(); // must not wrap around to a small number
    CHECK_THAT(errorOf(source), Contains("49 bytes"));
    source.raw = parseRawLayout("2147483647,2147483647,2147483647,f64");
    CHECK_THAT(errorOf(source), Contains("more than any memory"));
}

TEST_CASE("a wrong raw layout is wrong usage", "[bad-input]") {
    for (const char* bad : {"", "2,3,4", "2,3,u8", "2,3,4,u12", "2,3,4,u8,middle", "0,3,4,u8", "-2,3,4,u8",
                            "2,3,4.5,u8", "2,3,99999999999,u8", "2,3,4,u8,big,more", "a,b,c,u8"})
        CHECK_THROWS_AS(parseRawLayout(bad), UsageError);
    const TempFolder folder;
    VolumeSource source;
    source.path = folder.write("a.raw", std::string(8, 'x'));
    source.raw = parseRawLayout("2,2,2,u8");
    source.spacing = GridSpacing{{1, -1, 1}};
    CHECK_THROWS_AS(loadVolume(source), UsageError);
    source.spacing.reset();
    source.component = 1;
    CHECK_THROWS_AS(loadVolume(source), UsageError);
}

TEST_CASE("headers that leave something out or contradict themselves are refused", "[bad-input]") {
    const TempFolder folder;
    const std::string data = "12345678";
    CHECK_THAT(errorOf(folder.write("a.nrrd", "NRRD0004\n")), Contains("no dimension"));
    CHECK_THAT(errorOf(folder.write("h.nrrd", "NRRD0004\ntype: \x1b" + std::string(5000, 'x') +
                                                  "\ndimension: 1\nsizes: 2\nencoding: raw\n\nab")),
               Contains("' xxxx") && Contains("is not supported"));
    CHECK_THAT(errorOf(folder.write("b.nrrd", nrrd("sizes: 2 2", data))), Contains("2 sizes for dimension 3"));
    CHECK_THAT(errorOf(folder.write("c.nrrd", nrrd("sizes: 2 two 2", data))), Contains("whole number"));
    CHECK_THAT(errorOf(folder.write("d.nrrd", nrrd("sizes: 2 2 2\nbyte skip: -7", data))), Contains("negative"));
    CHECK_THAT(errorOf(folder.write("e.nrrd", nrrd("sizes: 2 2 2\nline skip: 1000000000", data))), Contains("0 of 8"));
    CHECK_THAT(errorOf(folder.write("f.nrrd", "NRRD0004\ntype: block\ndimension: 1\nsizes: 2\nencoding: raw\n\nab")),
               Contains("type 'block'"));
    CHECK_THAT(errorOf(folder.write("g.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 2\nencoding: lzma\n\nab")),
               Contains("encoding 'lzma'"));
    CHECK_THAT(errorOf(folder.write("a.mha", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\n")),
               Contains("ElementType"));
    CHECK_THAT(errorOf(folder.write("b.mha", mha("DimSize = 2 2", data))), Contains("2 sizes"));
    CHECK_THAT(errorOf(folder.write("c.mha", mha("DimSize = 2 2 2\nElementSpacing = 1 1", data))),
               Contains("2 numbers"));
    CHECK_THAT(errorOf(folder.write("d.mha", mha("DimSize = 2 2 2\nElementNumberOfChannels = -1", data))),
               Contains("at least 1"));
    Nifti nifti;
    nifti.datatype = 1; // one bit a voxel
    CHECK_THAT(errorOf(folder.write("a.nii", nifti.header() + std::string(24, 'x'))), Contains("data type 1"));
    nifti = Nifti{};
    nifti.voxOffset = -5;
    CHECK_THAT(errorOf(folder.write("b.nii", nifti.header() + std::string(24, 'x'))), Contains("vox_offset"));
    nifti = Nifti{};
    nifti.size = 540; // and the rest of NIfTI-1
    CHECK_THAT(errorOf(folder.write("c.nii", nifti.header() + std::string(240, 'x'))), Contains("mark of NIfTI-2"));
    CHECK_THAT(errorOf(folder.write("c.nii", Nifti{}.header2().substr(0, 500))), Contains("fewer than a NIfTI header"));
    std::string asText = Nifti{}.header2();
    asText.erase(asText.find('\r'), 1);
    CHECK_THAT(errorOf(folder.write("c.nii", asText + std::string(25, 'x'))), Contains("as text"));
    nifti = Nifti{};
    nifti.magic = "ni1";
    CHECK_THAT(errorOf(folder.write("d.nii", nifti.header() + std::string(24, 'x'))), Contains("end in .hdr"));
    const std::string header = folder.write("d.hdr", nifti.header());
    CHECK_THAT(errorOf(header), Contains("the data, d.img, is not beside this header"));
    folder.write("d.img", std::string(352 + 23, 'x')); // vox_offset counts in that file
    CHECK_THAT(errorOf(header), Contains("23 of 24 bytes"));
}

TEST_CASE("NIfTI numbers that are not finite are refused wherever they would be used", "[bad-input]") {
    const TempFolder folder;
    const std::string data(24, 'x');
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
        CAPTURE(bad);
        const auto errorWith = [&](const Nifti& nifti) {
            return errorOf(folder.write("a.nii", nifti.header() + data));
        };
        const auto opens = [&](const Nifti& nifti) {
            VolumeSource source;
            source.path = folder.write("a.nii", nifti.header() + data);
            return loadVolume(source).value(23) == 'x';
        };
        for (std::size_t i = 0; i < 6; ++i) {
            Nifti nifti;
            nifti.qformCode = 1;
            nifti.qform[i] = bad;
            CHECK_THAT(errorWith(nifti), Contains("not finite"));
        }
        for (std::size_t i = 0; i < 12; ++i) {
            Nifti nifti;
            nifti.sformCode = 1;
            nifti.sform = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0};
            nifti.sform[i] = bad;
            CHECK_THAT(errorWith(nifti), Contains("not finite"));
            nifti.sformCode = 0; // not used: not looked at
            CHECK(opens(nifti));
        }
        Nifti nifti;
        nifti.pixdim[3] = bad;
        CHECK_THAT(errorWith(nifti), Contains("spacing of axis 2"));
        nifti = Nifti{};
        nifti.pixdim[0] = nifti.pixdim[4] = nifti.pixdim[7] = bad; // of no axis in space
        CHECK(opens(nifti));
        nifti.slope = 2;
        nifti.intercept = bad;
        CHECK_THAT(errorWith(nifti), Contains("scl_inter"));
        nifti = Nifti{};
        nifti.voxOffset = bad;
        CHECK_THAT(errorWith(nifti), Contains("vox_offset"));
    }
    Nifti skewed;
    skewed.sformCode = 1;
    skewed.sform = {1, 1, 0, 0, 2, 2, 0, 0, 0, 0, 3, 0};
    CHECK_THAT(errorOf(folder.write("b.nii", skewed.header() + data)), Contains("in one plane"));
}

TEST_CASE("a header that does not end is refused", "[bad-input]") {
    const TempFolder folder;
    const std::string lengthy(3'000'000, 'x');
    CHECK_THAT(errorOf(folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 2\nencoding: raw\n# " +
                                                  lengthy + "\n\nab")),
               Contains("does not end"));
    CHECK_THAT(errorOf(folder.write("a.mha", "NDims = 1\nDimSize = 2\nElementType = MET_UCHAR\nComment = " + lengthy +
                                                 "\nElementDataFile = LOCAL\nab")),
               Contains("does not end"));
}

TEST_CASE("headers whose fields exclude each other are refused", "[bad-input]") {
    const TempFolder folder;
    const std::string data = "12345678";
    const auto ofMeta = [&](const std::string& fields) {
        return errorOf(folder.write("a.mha", mha("DimSize = 2 2 2\n" + fields, data)));
    };
    CHECK_THAT(ofMeta("CompressedData = True\nBinaryData = False"), Contains("both text and compressed"));
    CHECK_THAT(ofMeta("BinaryDataByteOrderMSB = True\nElementByteOrderMSB = False"), Contains("two byte orders"));
    CHECK_THAT(ofMeta("HeaderSize = 20"), Contains("within the header"));
    CHECK_THAT(ofMeta("HeaderSize = -1\nBinaryData = False"), Contains("where the data begin"));
    CHECK_THAT(ofMeta("HeaderSize = -1\nCompressedData = True"), Contains("where the data begin"));
    CHECK_THAT(ofMeta("HeaderSize = 9223372036854775807"), Contains("0 of 8 bytes"));
    CHECK_THAT(ofMeta("DimSize = 2 2 1"), Contains("twice"));
    CHECK_THAT(ofMeta("Offset = 1 2"), Contains("2 of 3 numbers as Offset"));
    CHECK_THAT(ofMeta("Offset = 1 2 nan"), Contains("'nan'"));
    CHECK_THAT(ofMeta("TransformMatrix = 1 0 0 0 1 0 0 0"), Contains("8 of 9"));
    const auto ofNrrd = [&](const std::string& fields) {
        return errorOf(folder.write("a.nrrd", nrrd("sizes: 2 2 2\n" + fields, data)));
    };
    CHECK_THAT(ofNrrd("type: short"), Contains("'type' twice"));
    CHECK_THAT(ofNrrd("spacings: 1 2 3\nspace directions: (1,0,0) (0,1,0) (0,0,3)"),
               Contains("two spacings of axis 1"));
    CHECK_THAT(ofNrrd("kinds: domain domain"), Contains("2 words for 3 axes"));
    CHECK_THAT(ofNrrd("kinds: vector vector domain"), Contains("more than one axis"));
    CHECK_THAT(ofNrrd("kinds: 3-color domain domain"), Contains("2 entries, not 3"));
    CHECK_THAT(ofNrrd("kinds: sort domain domain"), Contains("'sort'"));
    CHECK_THAT(ofNrrd("space: outer"), Contains("'outer'"));
    CHECK_THAT(ofNrrd("space origin: (1,nan,2)"), Contains("not a vector"));
    CHECK_THAT(ofNrrd("space origin: (1,2"), Contains("not a vector"));
    CHECK_THAT(ofNrrd("spacings: 1 1 1\naxis mins: 1 nan 2"), Contains("axis 1 begins"));
    // Both together pass 2⁶⁴ and, unchecked, would come out as a small number.
    CHECK_THAT(ofNrrd("line skip: 9223372036854775807\nbyte skip: 9223372036854775807"), Contains("0 of 8 bytes"));
    CHECK_THAT(errorOf(folder.write("b.nrrd", "NRRD0004\ntype: short\ndimension: 1\nsizes: 2\nencoding: raw\n\nabcd")),
               Contains("no byte order"));
    CHECK_THAT(errorOf(folder.write("c.nrrd", "NRRD0004\ntype: short\ndimension: 1\nsizes: 2\nendian: odd\n"
                                              "encoding: raw\n\nabcd")),
               Contains("'odd'"));
    CHECK_THAT(errorOf(folder.write("d.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 2\nkinds: vector\n"
                                              "encoding: raw\n\nab")),
               Contains("no axis lies in space"));
}

TEST_CASE("written numbers that their type cannot hold are refused", "[bad-input]") {
    const TempFolder folder;
    for (const char* bad : {"256", "-1", "1e30", "nan"}) {
        CAPTURE(bad);
        const std::string text = std::string("7 ") + bad;
        CHECK_THAT(
            errorOf(folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 2\nencoding: text\n\n" + text)),
            Contains("does not fit") && Contains(bad));
        CHECK_THAT(errorOf(folder.write("a.mha", "NDims = 1\nDimSize = 2\nElementType = MET_UCHAR\nBinaryData = False\n"
                                                 "ElementDataFile = LOCAL\n" +
                                                     text)),
                   Contains("does not fit") && Contains(bad));
    }
    CHECK_THAT(errorOf(folder.write("b.nrrd", "NRRD0004\ntype: float\ndimension: 1\nsizes: 2\nencoding: text\n\n"
                                              "7 1e39")),
               Contains("'1e39' does not fit"));
}

TEST_CASE("a data file that is no file is refused without being opened", "[bad-input]") {
    const TempFolder folder;
    std::filesystem::create_directory(folder.path("folder"));
    std::filesystem::create_symlink("/dev/zero", folder.path("zero"));
    REQUIRE(mkfifo(folder.path("pipe").c_str(), 0600) == 0); // opening it would wait for a writer
    for (const std::string& data :
         {std::string("pipe"), std::string("zero"), std::string("folder"), std::string("."), std::string(500, 'n')}) {
        CAPTURE(data);
        const std::string fields = "type: uint8\ndimension: 1\nsizes: 2\nencoding: raw\n";
        const std::string expected = data.size() == 500              ? "cannot read"
                                     : data[0] == 'f' || data == "." ? "folder"
                                                                     : "not a regular";
        CHECK_THAT(errorOf(folder.write("a.nhdr", "NRRD0004\n" + fields + "data file: " + data + "\n")),
                   Contains(expected));
        CHECK_THAT(errorOf(folder.write(
                       "a.mhd", "NDims = 1\nDimSize = 2\nElementType = MET_UCHAR\nElementDataFile = " + data + "\n")),
                   Contains(expected));
    }
}

TEST_CASE("suffixes of what is no volume say what to do", "[bad-input]") {
    const TempFolder folder;
    const auto said = [&](const std::string& name) {
        const std::string path = folder.write(name, std::string(100, '\1'));
        CHECK(mayBeHeaderless(path) == (name == "a.raw.gz"));
        return errorOf(path);
    };
    CHECK_THAT(said("a.vtr"), Contains("rectilinear grid") && Contains(".vti"));
    CHECK_THAT(said("a.pvts"), Contains("structured grid"));
    CHECK_THAT(said("a.nii.bz2"), Contains("unpack it first"));
    CHECK_THAT(said("a.zip"), Contains("unpack it first"));
    CHECK_THAT(said("a.raw.gz"), Contains("headerless data needs its layout"));
}
