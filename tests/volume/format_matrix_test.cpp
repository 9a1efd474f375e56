// Every combination of what headers of NIfTI, NRRD, MetaImage and VTK can say of their values: each is read right.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <optional>

#include "packers.h"
#include "support/format_matrix.h"
#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume_files.h"
#include "vtk_files.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

VolumeSource at(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return source;
}

/// Whether `read` is `exact`, in double precision or rounded to single.
bool isSame(double read, double exact) {
    return read == exact || read == static_cast<double>(static_cast<float>(exact));
}

/// How many of the voxels differ from the entries of `values` from `first` on, one every `stride`, scaled.
std::size_t wrongOnes(const Volume& volume, const std::vector<double>& values, std::size_t first, std::size_t stride,
                      double slope, double intercept) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < volume.size(); ++i)
        wrong += isSame(volume.value(i), slope * values.at(first + i * stride) + intercept) ? 0u : 1u;
    return wrong;
}

std::size_t countOf(const std::vector<int>& sizes, std::size_t from = 0) {
    std::size_t count = 1;
    for (std::size_t a = from; a < sizes.size(); ++a) count *= static_cast<std::size_t>(sizes[a]);
    return count;
}

} // namespace

TEST_CASE("NIfTI of any type, scaling, number of axes, byte order and container", "[matrix]") {
    const TempFolder folder;
    struct Scaling {
        float slope, intercept;
    };
    const float notANumber = std::numeric_limits<float>::quiet_NaN();
    const Scaling scalings[] = {{0, 0}, {1, 0}, {2, 0}, {0.5f, -3}, {-1, 10}, {0.001f, 0.25f}, {notANumber, 7}};
    const std::vector<int> all{5, 4, 3, 2, 2, 2, 2};
    std::size_t files = 0;
    for (const MatrixType& type : matrixTypes())
        for (std::size_t rank = 1; rank <= 7; ++rank) {
            const std::vector<int> sizes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(rank));
            const auto components = static_cast<std::size_t>(type.components);
            const std::vector<double> values = type.values(countOf(sizes) * components);
            const std::string native = type.stored(values);
            for (const Scaling& scaling : scalings)
                for (const bool bigEndian : {false, true}) {
                    Nifti nifti;
                    nifti.dim = {static_cast<std::int16_t>(rank), 1, 1, 1, 1, 1, 1, 1};
                    for (std::size_t a = 0; a < rank; ++a) nifti.dim[a + 1] = static_cast<std::int16_t>(sizes[a]);
                    nifti.datatype = static_cast<std::int16_t>(type.nifti);
                    nifti.bitpix = static_cast<std::int16_t>(8 * type.bytes * components);
                    nifti.slope = scaling.slope;
                    nifti.intercept = scaling.intercept;
                    const std::string data = inOrder(native, type.bytes, bigEndian);
                    const bool swaps = bigEndian != (std::endian::native == std::endian::big);
                    const auto header = [&] { return swaps ? swappedNifti(nifti.header()) : nifti.header(); };
                    const std::string one = header() + data;
                    folder.write("a.nii", one);
                    folder.write("b.nii.gz", gzipped(one));
                    nifti.magic = "ni1";
                    nifti.voxOffset = 0;
                    folder.write("c.hdr", header().substr(0, 348));
                    folder.write("c.img", data);
                    const bool isScaled = !type.isColour && scaling.slope != 0 && std::isfinite(scaling.slope);
                    const double slope = isScaled ? static_cast<double>(scaling.slope) : 1;
                    const double intercept = isScaled ? static_cast<double>(scaling.intercept) : 0;
                    const std::size_t steps = rank > 3 ? countOf(sizes, 3) : 1;
                    const std::size_t voxels = countOf(sizes) / steps;
                    for (const char* name : {"a.nii", "b.nii.gz", "c.hdr"}) {
                        CAPTURE(type.nifti, rank, scaling.slope, bigEndian, name);
                        VolumeSource source = at(folder.path(name));
                        source.step = static_cast<int>(steps) - 1;
                        source.component = type.components - 1;
                        const Volume volume = loadVolume(source);
                        REQUIRE(volume.size() == voxels);
                        REQUIRE(wrongOnes(volume, values, ((steps - 1) * voxels + 1) * components - 1, components,
                                          slope, intercept) == 0);
                        ++files;
                    }
                }
        }
    CHECK(files == 14 * 7 * 7 * 2 * 3);
}

TEST_CASE("NRRD of any type, encoding, byte order, layout and skip", "[matrix]") {
    const TempFolder folder;
    const std::string lines = "two lines\nof another program\n", bytes = "xyz";
    std::size_t files = 0;
    auto types = matrixTypes();
    types.resize(10); // those that are no complex numbers or colours of NIfTI
    for (const MatrixType& type : types)
        for (const int components : {1, 3}) {
            const std::vector<double> values = type.values(static_cast<std::size_t>(4 * 3 * 2 * components));
            for (const bool bigEndian : {false, true})
                for (const std::string encoding : {"raw", "ascii", "hex", "gzip", "bzip2"})
                    for (const bool isDetached : {false, true})
                        for (const int skip : {0, 1, 2, 3}) { // none, lines, bytes, from the end
                            const bool isPacked = encoding == "gzip" || encoding == "bzip2";
                            if (skip == 3 && encoding != "raw") continue;
                            std::string data = inOrder(type.stored(values), type.bytes, bigEndian);
                            if (encoding == "ascii") {
                                data.clear();
                                for (const double value : values) {
                                    char text[40];
                                    std::snprintf(text, sizeof text, "%.17g ", value);
                                    data += text;
                                }
                            }
                            if (encoding == "hex") {
                                std::string digits;
                                for (const char byte : data) {
                                    char text[4];
                                    std::snprintf(text, sizeof text, "%02x", static_cast<unsigned char>(byte));
                                    digits += text;
                                }
                                data = digits;
                            }
                            // Bytes are skipped in what has been unpacked, lines before.
                            if (skip == 2) data = (encoding == "hex" ? std::string("  \n") : bytes) + data;
                            if (skip == 2 && encoding == "ascii") data.replace(0, 3, "9 \n");
                            if (encoding == "gzip") data = gzipped(data);
                            if (encoding == "bzip2") data = bzipped(data);
                            if (skip == 1) data = lines + data;
                            if (skip == 3) data = bytes + data;
                            std::string header = "NRRD0004\ntype: " + std::string(type.nrrd) +
                                                 "\ndimension: " + (components > 1 ? "4" : "3") +
                                                 "\nsizes: " + (components > 1 ? "3 " : "") +
                                                 "4 3 2\nencoding: " + encoding + "\n";
                            if (components > 1) header += "kinds: vector domain domain domain\n";
                            if (type.bytes > 1 && encoding != "ascii")
                                header += std::string("endian: ") + (bigEndian ? "big" : "little") + "\n";
                            if (skip == 1) header += "line skip: 2\n";
                            if (skip == 2) header += "byte skip: 3\n";
                            if (skip == 3) header += "byte skip: -1\n";
                            std::string path;
                            if (isDetached) {
                                folder.write("d.data", data);
                                path = folder.write("d.nhdr", header + "data file: d.data\n");
                            } else {
                                path = folder.write("a.nrrd", header + "\n" + data);
                            }
                            CAPTURE(type.nrrd, encoding, bigEndian, isDetached, skip, components, isPacked);
                            VolumeSource source = at(path);
                            source.component = components - 1;
                            const Volume volume = loadVolume(source);
                            REQUIRE(volume.dims() == Int3(4, 3, 2));
                            REQUIRE(wrongOnes(volume, values, static_cast<std::size_t>(components - 1),
                                              static_cast<std::size_t>(components), 1, 0) == 0);
                            ++files;
                        }
        }
    CHECK(files == 10 * 2 * 2 * 2 * (5 * 3 + 1));
}

TEST_CASE("MetaImage of any type, packing, byte order, layout and header size", "[matrix]") {
    const TempFolder folder;
    std::size_t files = 0;
    auto types = matrixTypes();
    types.resize(10);
    for (const MatrixType& type : types)
        for (const int channels : {1, 2}) {
            const std::vector<double> values = type.values(static_cast<std::size_t>(4 * 3 * 2 * channels));
            for (const bool bigEndian : {false, true})
                for (const bool isPacked : {false, true})
                    for (const bool isLocal : {false, true})
                        for (const int headerSize : {0, 5, -1}) {
                            if (headerSize != 0 && (isPacked || isLocal)) continue;
                            std::string data = inOrder(type.stored(values), type.bytes, bigEndian);
                            if (isPacked) data = zlibbed(data);
                            if (headerSize != 0) data = "12345" + data;
                            std::string header = "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\n";
                            if (channels > 1) header += "ElementNumberOfChannels = 2\n";
                            header += std::string("BinaryDataByteOrderMSB = ") + (bigEndian ? "True" : "False") + "\n";
                            if (isPacked)
                                header +=
                                    "CompressedData = True\nCompressedDataSize = " + std::to_string(data.size()) + "\n";
                            if (headerSize != 0) header += "HeaderSize = " + std::to_string(headerSize) + "\n";
                            header += "ElementType = " + std::string(type.meta) + "\nElementDataFile = ";
                            std::string path;
                            if (isLocal) {
                                path = folder.write("a.mha", header + "LOCAL\n" + data);
                            } else {
                                folder.write("b.raw", data);
                                path = folder.write("b.mhd", header + "b.raw\n");
                            }
                            CAPTURE(type.meta, channels, bigEndian, isPacked, isLocal, headerSize);
                            VolumeSource source = at(path);
                            source.component = channels - 1;
                            const Volume volume = loadVolume(source);
                            REQUIRE(volume.dims() == Int3(4, 3, 2));
                            REQUIRE(wrongOnes(volume, values, static_cast<std::size_t>(channels - 1),
                                              static_cast<std::size_t>(channels), 1, 0) == 0);
                            ++files;
                        }
        }
    CHECK(files == 10 * 2 * 2 * (3 + 1 + 2)); // raw beside the header with three sizes, and within; packed both ways
}

namespace {

/// Numbers as VTK writes them as text.
std::string numbersText(const MatrixType& type, const std::vector<double>& values) {
    std::string all;
    for (const double value : values) {
        char text[40];
        std::snprintf(text, sizeof text, type.isFloat ? "%.17g " : "%.0f ", value);
        all += text;
    }
    return all;
}

/// Each way in which a file of VTK has its arrays.
std::vector<Style> vtkStyles() {
    using Place = Style::Place;
    using Packer = Style::Packer;
    std::vector<Style> styles;
    for (const Place place : {Place::Ascii, Place::Inline, Place::Raw, Place::Base64})
        for (const std::optional<Packer> packer : {std::optional<Packer>(), std::optional(Packer::ZLib),
                                                   std::optional(Packer::Lz4), std::optional(Packer::Lzma)})
            for (const bool wide : {false, true})
                for (const bool bigEndian : {false, true})
                    // 48 divides the bytes of some arrays, and no array is longer than 1 << 15, which is VTK's own.
                    for (const std::size_t block : {std::size_t{48}, std::size_t{1} << 15})
                        styles.push_back(
                            {place, packer.has_value(), bigEndian, wide, block, packer.value_or(Packer::ZLib)});
    return styles;
}

} // namespace

TEST_CASE("VTK image data of any type, encoding, compressor, header type and byte order", "[matrix]") {
    const TempFolder folder;
    std::size_t files = 0;
    auto types = matrixTypes();
    types.resize(10);
    for (const MatrixType& type : types)
        for (const int components : {1, 3}) {
            // Another array before the one that is read, so that its offset matters.
            const std::vector<double> before = type.values(7 * 60),
                                      values = type.values(static_cast<std::size_t>(5 * 3 * 4 * components));
            for (const Style& style : vtkStyles())
                for (const bool ofCells : {false, true}) {
                    const auto arrayOf = [&](const std::string& name, const std::vector<double>& numbers, int count) {
                        return Array{"type=\"" + std::string(type.vtk) + "\" Name=\"" + name +
                                         "\" NumberOfComponents=\"" + std::to_string(count) + "\"",
                                     numbersText(type, numbers),
                                     inOrder(type.stored(numbers), type.bytes, style.bigEndian)};
                    };
                    const std::vector<Array> arrays{arrayOf("before", before, 7), arrayOf("a", values, components)};
                    // 5 x 3 x 4 points, or as many cells between 6 x 4 x 5 points.
                    const std::string extent = ofCells ? "2 7 0 3 -1 3" : "2 6 0 2 -1 2";
                    Piece piece{extent, ofCells ? std::vector<Array>{} : arrays,
                                ofCells ? arrays : std::vector<Array>{}};
                    const std::string path = folder.write(
                        "a.vti", vtiOfPieces(style, {piece}, "", "WholeExtent=\"" + extent + "\" Spacing=\"1 2 3\""));
                    CAPTURE(type.vtk, components, static_cast<int>(style.place), style.compressed,
                            static_cast<int>(style.packer), style.bigEndian, style.wide, style.block, ofCells);
                    VolumeSource source = at(path);
                    source.array = "a";
                    source.component = components - 1;
                    const Volume volume = loadVolume(source);
                    REQUIRE(volume.dims() == Int3(5, 3, 4));
                    REQUIRE(volume.geometry().spacing == Vec3(1, 2, 3));
                    REQUIRE(wrongOnes(volume, values, static_cast<std::size_t>(components - 1),
                                      static_cast<std::size_t>(components), 1, 0) == 0);
                    ++files;
                }
        }
    CHECK(files == 10 * 2 * (4 * 4 * 2 * 2 * 2) * 2); // types, components, styles, points and cells
}

TEST_CASE("VTK image data that says how its arrays are stored in words nobody knows is refused by them", "[matrix]") {
    const TempFolder folder;
    const std::vector<double> values(6, 7.0);
    const auto refusalOf = [&](const std::string& from, const std::string& to, const Style& style) {
        std::string text = vti(
            style, {{"type=\"UInt8\" Name=\"a\"", numbersText(matrixTypes().front(), values), std::string(6, '\7')}});
        text.replace(text.find(from), from.size(), to);
        try {
            loadVolume(at(folder.write("a.vti", text)));
            return std::string("nothing");
        } catch (const FileError& e) {
            return e.problem();
        }
    };
    for (const Style& style : vtkStyles()) {
        CAPTURE(static_cast<int>(style.place), style.compressed, static_cast<int>(style.packer), style.bigEndian,
                style.wide);
        const auto contains = [](const std::string& words) { return Catch::Matchers::Contains(words); };
        CHECK_THAT(refusalOf("type=\"UInt8\"", "type=\"Bit\"", style), contains("'Bit'"));
        CHECK_THAT(refusalOf("type=\"UInt8\"", "type=\"String\"", style), contains("'String'"));
        CHECK_THAT(refusalOf(style.bigEndian ? "BigEndian" : "LittleEndian", "MiddleEndian", style),
                   contains("'MiddleEndian'"));
        if (style.wide) CHECK_THAT(refusalOf("UInt64", "UInt128", style), contains("'UInt128'"));
        if (style.compressed) CHECK_THAT(refusalOf("DataCompressor", "Brotli", style), contains("Brotli"));
        // An array of another size than the extent asks for, in each encoding.
        CHECK(refusalOf("WholeExtent=\"0 1", "WholeExtent=\"0 2", style) != "nothing");
        CHECK(refusalOf("type=\"UInt8\"", "type=\"UInt16\"", style) ==
              (style.place == Style::Place::Ascii ? "nothing"
                                                  : "the array has 6 bytes, but its extent and type need 12"));
    }
}
