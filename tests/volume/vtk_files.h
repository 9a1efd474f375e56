// Image data of VTK's XML files in each encoding, written by the tests themselves.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "packers.h"
#include "volume_files.h"

namespace pellucid::test {

inline std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t b = 0; b < 3; ++b)
            bits = bits << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0u);
        for (std::size_t d = 0; d < 4; ++d) text += i + d > bytes.size() ? '=' : digits[bits >> (18 - 6 * d) & 63];
    }
    return text;
}

/// How a file is written.
struct Style {
    enum class Place { Ascii, Inline, Raw, Base64 } place = Place::Ascii;
    bool compressed = false, bigEndian = false, wide = false; ///< wide: UInt64 headers
    std::size_t block = 10;                                   ///< bytes of a compressed block; the last one is shorter
    enum class Packer { ZLib, Lz4, Lzma } packer = Packer::ZLib;
};

/// A number of a header, as the style has it.
inline std::string number(const Style& style, std::uint64_t value) {
    std::string bytes;
    const int count = style.wide ? 8 : 4;
    for (int i = 0; i < count; ++i)
        bytes += static_cast<char>(value >> (8 * (style.bigEndian ? count - 1 - i : i)) & 255);
    return bytes;
}

inline std::string swapped(std::string bytes, std::size_t each, const Style& style) {
    if (style.bigEndian != (std::endian::native == std::endian::big))
        for (std::size_t i = 0; i < bytes.size(); i += each)
            std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                         bytes.begin() + static_cast<std::ptrdiff_t>(i + each));
    return bytes;
}

/// One block as the style has it.
inline std::string packed(const Style& style, const std::string& bytes) {
    if (style.packer == Style::Packer::Lz4) return lz4Packed(bytes);
    return style.packer == Style::Packer::Lzma ? lzmaPacked(bytes) : zlibbed(bytes);
}

/// Header and data of an array.
inline std::string stored(const Style& style, const std::string& data) {
    const bool text = style.place == Style::Place::Inline || style.place == Style::Place::Base64;
    const auto encoded = [&](const std::string& bytes) { return text ? base64(bytes) : bytes; };
    if (!style.compressed) return encoded(number(style, data.size()) + data);
    std::string all, sizes;
    std::uint64_t blocks = 0;
    for (std::size_t i = 0; i < data.size(); i += style.block, ++blocks) {
        const std::string block = packed(style, data.substr(i, style.block));
        all += block;
        sizes += number(style, block.size());
    }
    return encoded(number(style, blocks) + number(style, style.block) + number(style, data.size() % style.block) +
                   sizes) +
           encoded(all);
}

struct Array {
    std::string attributes; ///< name, type, components
    std::string ascii, data;
};

/// A part of an image, "0 1 0 2 0 0", and its arrays.
struct Piece {
    std::string extent;
    std::vector<Array> arrays, cells = {};
};

/// A file of these pieces.
inline std::string vtiOfPieces(const Style& style, const std::vector<Piece>& pieces, const std::string& pointData,
                               const std::string& image) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<!-- <VTKFile type=\"Other\"> -->\n<VTKFile type=\"ImageData\" version=\"1.0\"";
    text += std::string(" byte_order=\"") + (style.bigEndian ? "BigEndian" : "LittleEndian") + "\"";
    if (style.wide) text += " header_type=\"UInt64\"";
    constexpr const char* kCompressors[] = {"vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"};
    if (style.compressed)
        text += std::string(" compressor=\"") + kCompressors[static_cast<std::size_t>(style.packer)] + "\"";
    text += ">\n <ImageData " + image + ">\n";
    std::string appended;
    for (const Piece& piece : pieces) {
        const auto add = [&](const Array& array) {
            text += "    <DataArray " + array.attributes;
            switch (style.place) {
            case Style::Place::Ascii:
                text += " format=\"ascii\">" + array.ascii + "</DataArray>\n";
                break;
            case Style::Place::Inline:
                text += " format=\"binary\">\n  " + stored(style, array.data) + "\n</DataArray>\n";
                break;
            default:
                text += " format=\"appended\" offset=\"" + std::to_string(appended.size()) + "\"/>\n";
                appended += stored(style, array.data);
            }
        };
        text += "  <Piece Extent=\"" + piece.extent + "\">\n   <PointData" + pointData + ">\n";
        for (const Array& array : piece.arrays) add(array);
        text += "   </PointData>\n   <CellData>";
        for (const Array& array : piece.cells) add(array);
        text += "</CellData>\n  </Piece>\n";
    }
    text += " </ImageData>\n";
    if (!appended.empty())
        text += std::string(" <AppendedData encoding=\"") + (style.place == Style::Place::Raw ? "raw" : "base64") +
                "\">\n  _" + appended + "\n </AppendedData>\n";
    return text + "</VTKFile>\n";
}

/// A file of these arrays.
inline std::string vti(const Style& style, const std::vector<Array>& arrays, const std::string& pointData = "",
                       const std::string& image = "WholeExtent=\"0 1 0 2 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"",
                       const std::string& extent = "0 1 0 2 0 0") {
    return vtiOfPieces(style, {{extent, arrays}}, pointData, image);
}

/// A file whose pieces, given by extent and name, are files of their own. `arrays`: the attributes of each.
inline std::string pvti(const std::string& image, const std::vector<std::string>& arrays,
                        const std::vector<std::pair<std::string, std::string>>& pieces,
                        const std::string& pointData = "", const std::vector<std::string>& cells = {}) {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PImageData\" version=\"1.0\">\n <PImageData " + image +
                       " GhostLevel=\"0\">\n  <PPointData" + pointData + ">\n";
    for (const std::string& array : arrays) text += "   <PDataArray " + array + "/>\n";
    text += "  </PPointData>\n  <PCellData>\n";
    for (const std::string& array : cells) text += "   <PDataArray " + array + "/>\n";
    text += "  </PCellData>\n";
    for (const auto& [extent, source] : pieces)
        text += "  <Piece Extent=\"" + extent + "\" Source=\"" + source + "\"/>\n";
    return text + " </PImageData>\n</VTKFile>\n";
}

} // namespace pellucid::test
