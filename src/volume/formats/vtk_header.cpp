#include "volume/formats/vtk_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <span>

#include <glm/common.hpp>

#include "volume/formats/file_check.h"
#include "volume/outside_files.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostElements = 1'000'000;
constexpr std::size_t kMostArrays = 10'000; // of the image, or of a piece
constexpr std::size_t kMostPieces = 100'000;

std::int64_t wholeNumber(const XmlTag& tag, const std::string& attribute, std::int64_t otherwise,
                         const std::string& path) {
    const std::string text = trimmed(tag.get(attribute));
    std::int64_t value = otherwise;
    if (!text.empty() && !parseNumber(text, value))
        failInVtk(path, "the attribute " + attribute + " " + inQuotes(text) + " is not a whole number");
    return value;
}

VtkExtent extentIn(const std::string& text, const std::string& path) {
    VtkExtent extent;
    const std::vector<std::string> words = splitWords(text);
    for (std::size_t i = 0; i < 6; ++i) {
        std::int64_t value = 0;
        constexpr std::int64_t kMost = std::int64_t{1} << 31;
        if (words.size() != 6 || !parseNumber(words[i], value) || value < -kMost || value > kMost)
            failInVtk(path, "the extent " + inQuotes(text) + " is not six whole numbers");
        const int axis = static_cast<int>(i / 2);
        (i % 2 == 0 ? extent.lo : extent.hi)[axis] = value + static_cast<std::int64_t>(i % 2);
    }
    return extent;
}

/// The byte behind the "_" that appended data begin with.
std::uint64_t appendedStart(const std::string& path, std::uint64_t from, const JobControl& job) {
    FileCharacters text(path, from, job);
    while (std::isspace(text.peek()) != 0) text.pass();
    if (text.peek() != '_') failInVtk(path, "the appended data do not begin with an underscore");
    return from + text.passed() + 1;
}

VtkArray arrayOf(const XmlTag& tag, const std::string& path, bool ofCells = false) {
    VtkArray array{tag.get("Name"),
                   tag.get("type"),
                   lowerCase(tag.get("format")),
                   wholeNumber(tag, "NumberOfComponents", 1, path),
                   tag.end,
                   0};
    array.ofCells = ofCells;
    const std::int64_t offset = wholeNumber(tag, "offset", 0, path);
    if (offset < 0) failInVtk(path, "the offset of an array is negative");
    array.offset = static_cast<std::uint64_t>(offset);
    return array;
}

/// The file that a piece of the file `path` names.
std::string fileOfPiece(const std::string& source, const std::string& path) {
    if (source.empty()) failInVtk(path, "a piece names no file");
    if (source.size() > 1000) failInVtk(path, "the name of a piece's file is too long");
    requireInside(path, source);
    return (fs::path(path).parent_path() / fs::path(source).lexically_normal()).string();
}

VtkPiece pieceOf(const XmlTag& tag, const VtkImage& image) {
    VtkPiece piece;
    const std::string extent = tag.get("Extent");
    piece.extent = extent.empty() ? image.extent.value_or(VtkExtent{}) : extentIn(extent, image.path);
    piece.path = image.path;
    if (image.piecesInFiles && !piece.extent.isEmpty()) piece.path = fileOfPiece(tag.get("Source"), image.path);
    return piece;
}

/// The root: how all data of the file are stored.
void readRoot(VtkImage& image, const XmlTag& tag) {
    checkRoot(tag, image.piecesInFiles ? "PImageData" : "ImageData", image.path);
    const std::string order = tag.get("byte_order"), header = tag.get("header_type"),
                      compressor = tag.get("compressor");
    if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
        failInVtk(image.path, "the byte order " + inQuotes(order) + " is not known");
    if (!header.empty() && header != "UInt32" && header != "UInt64")
        failInVtk(image.path, "the header type " + inQuotes(header) + " is not known");
    static const std::map<std::string, VtkPacking> kPackings{{"", VtkPacking::None},
                                                             {"vtkZLibDataCompressor", VtkPacking::ZLib},
                                                             {"vtkLZ4DataCompressor", VtkPacking::Lz4},
                                                             {"vtkLZMADataCompressor", VtkPacking::Lzma}};
    const auto packing = kPackings.find(compressor);
    if (packing == kPackings.end())
        failInVtk(image.path, "the compressor " + inQuotes(compressor) + " is not supported",
                  "write it with ZLib, LZ4 or LZMA compression, or none");
    image.bigEndian = order == "BigEndian";
    image.headerBytes = header == "UInt64" ? 8 : 4;
    image.packing = packing->second;
}

/// What an element within `parent` says of the image; most say nothing.
void readElement(VtkImage& image, const XmlTag& tag, const std::string& parent, const JobControl& job) {
    const std::string& path = image.path;
    const std::string p = image.piecesInFiles ? "P" : ""; // how the names begin where pieces are files
    const bool ofPiece = !image.piecesInFiles && !image.pieces.empty();
    VtkArrays& arrays = ofPiece ? image.pieces.back().arrays : image.arrays;
    if (tag.name == p + "ImageData" && parent == "VTKFile") {
        image.extent = extentIn(tag.get("WholeExtent"), path);
        image.spacing = tag.get("Spacing");
        image.origin = tag.get("Origin");
        image.direction = tag.get("Direction");
    } else if (tag.name == "Piece" && parent == p + "ImageData") {
        if (image.pieces.size() >= kMostPieces) failInVtk(path, "there are too many pieces");
        image.pieces.push_back(pieceOf(tag, image));
    } else if (tag.name == p + "PointData" && parent == (image.piecesInFiles ? "PImageData" : "Piece")) {
        arrays.active = tag.get("Scalars");
    } else if (tag.name == p + "DataArray" && (parent == p + "PointData" || parent == p + "CellData")) {
        if (arrays.all.size() >= kMostArrays) failInVtk(path, "there are too many arrays");
        arrays.all.push_back(arrayOf(tag, path, parent == p + "CellData"));
    } else if (tag.name == "DataArray" && parent == "FieldData" && tag.get("Name") == "TimeValue") {
        image.time = arrayOf(tag, path);
    } else if (tag.name == "AppendedData" && parent == "VTKFile") {
        const std::string encoding = lowerCase(tag.get("encoding"));
        if (encoding != "raw" && encoding != "base64")
            failInVtk(path, "the encoding " + inQuotes(encoding) + " of the appended data is not known");
        image.appendedBase64 = encoding == "base64";
        image.appendedStart = appendedStart(path, tag.end, job);
    }
}

void readElements(VtkImage& image, const JobControl& job) {
    const std::string& path = image.path;
    XmlTags tags(path, job);
    XmlTag tag;
    std::vector<std::string> inside; // names of the elements that are open
    bool ended = false;
    for (std::size_t elements = 0; !ended && tags.next(tag); ++elements) {
        if (elements >= kMostElements) failInVtk(path, "there are too many elements");
        if (tag.opens) {
            if (inside.empty())
                readRoot(image, tag);
            else
                readElement(image, tag, inside.back(), job);
            if (!tag.closes) inside.push_back(tag.name);
            if (inside.size() > 100) failInVtk(path, "the elements are nested too deeply");
            ended = image.appendedStart.has_value(); // no XML from here on
        } else {
            if (inside.empty() || inside.back() != tag.name)
                failInVtk(path, "this is not valid XML: </" + tag.name + "> closes an element that is not open");
            inside.pop_back();
            ended = inside.empty();
        }
    }
    if (!ended && !inside.empty())
        failInVtk(path, "the file ends within its element " + inQuotes(inside.back()), "copy it again");
}

/// `from` without `box`, as at most six boxes.
void appendWithout(const VtkExtent& from, const VtkExtent& box, std::vector<VtkExtent>& rest) {
    const VtkExtent inside = common(from, box);
    if (inside.isEmpty()) return rest.push_back(from);
    VtkExtent left = from;
    for (int a = 0; a < 3; ++a) {
        VtkExtent before = left, behind = left;
        before.hi[a] = left.lo[a] = inside.lo[a];
        behind.lo[a] = left.hi[a] = inside.hi[a];
        for (const VtkExtent& part : {before, behind})
            if (!part.isEmpty()) rest.push_back(part);
    }
}

} // namespace

void failInVtk(const std::string& path, const std::string& what, const std::string& toDo) {
    throw FileError(what, path, toDo);
}

std::vector<std::string> VtkArrays::names() const {
    std::vector<std::string> ofPoints, ofCells;
    for (const VtkArray& array : all) (array.ofCells ? ofCells : ofPoints).push_back(array.name);
    return offeredNames(ofPoints, ofCells);
}

VtkExtent cellsOf(const VtkExtent& part, const VtkExtent& whole) {
    VtkExtent cells = part;
    for (int a = 0; a < 3; ++a)
        if (whole.hi[a] - whole.lo[a] > 1) --cells.hi[a];
    return cells;
}

VtkExtent common(const VtkExtent& a, const VtkExtent& b) { return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)}; }

std::string textOf(const VtkExtent& extent) {
    std::string text;
    for (int a = 0; a < 3; ++a)
        text += (a == 0 ? "" : " ") + std::to_string(extent.lo[a]) + " " + std::to_string(extent.hi[a] - 1);
    return text;
}

std::vector<std::string> offeredNames(const std::vector<std::string>& ofPoints,
                                      const std::vector<std::string>& ofCells) {
    std::vector<std::string> names = ofPoints;
    const std::set<std::string> known(ofPoints.begin(), ofPoints.end());
    for (const std::string& name : ofCells) names.push_back(known.contains(name) ? name + " (cells)" : name);
    return names;
}

std::size_t chosenOf(const std::vector<std::string>& offered, const std::string& asked, const std::string& active,
                     const std::string& path) {
    const auto found = std::ranges::find(offered, asked.empty() ? active : asked);
    if (!asked.empty() && found == offered.end()) {
        const auto shown = std::span(offered).first(std::min<std::size_t>(offered.size(), 20));
        throw UsageError("there is no array " + inQuotes(asked), path,
                         "it has " + joined(shown, ", ", [](const std::string& name) { return name.substr(0, 40); }));
    }
    const bool isNamed = !asked.empty() || !active.empty();
    return isNamed && found != offered.end() ? static_cast<std::size_t>(found - offered.begin()) : 0;
}

void checkIsXml(const std::string& path) {
    const std::string head = fileHead(path, 1024);
    const std::size_t begin = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (begin == std::string::npos || head[begin] != '<') throw notOfFormat("a VTK XML file", path, head);
}

void checkRoot(const XmlTag& tag, const std::string& type, const std::string& path) {
    if (tag.name != "VTKFile" || !tag.opens)
        failInVtk(path, "this is not a VTK file but one of " + inQuotes(tag.name),
                  "give it the suffix of its own format");
    const std::string held = tag.get("type");
    if (held == type) return;
    const bool isRead = held == "ImageData" || held == "PImageData" || held == "Collection";
    failInVtk(path, "this VTK file holds " + inQuotes(held) + ", not " + type,
              isRead ? "give it the suffix of its own format" : "resample it to an image");
}

VtkImage readVtkImage(const std::string& path, bool piecesInFiles, const JobControl& job) {
    checkIsXml(path);
    VtkImage image;
    image.path = path;
    image.piecesInFiles = piecesInFiles;
    readElements(image, job);
    if (!image.extent) failInVtk(path, std::string("the file has no ") + (piecesInFiles ? "PImageData" : "ImageData"));
    const VtkExtent& whole = *image.extent;
    const auto size = whole.hi - whole.lo;
    valueCount(path, std::array{size.x, size.y, size.z}, sizeof(double));
    std::erase_if(image.pieces, [](const VtkPiece& piece) { return piece.extent.isEmpty(); }); // of ranks without any
    for (const VtkPiece& piece : image.pieces)
        if (common(piece.extent, whole) != piece.extent)
            failInVtk(piece.path, "the extent of a piece, " + textOf(piece.extent) +
                                      ", reaches beyond that of the whole image, " + textOf(whole));
    const auto first =
        std::ranges::find_if(image.pieces, [](const VtkPiece& piece) { return !piece.arrays.all.empty(); });
    if (first != image.pieces.end()) image.arrays = first->arrays;
    std::ranges::stable_sort(image.arrays.all, {}, &VtkArray::ofCells);
    return image;
}

void requireCovered(const VtkImage& image, const VtkExtent& extent, const std::string& toDo, const JobControl& job) {
    constexpr std::size_t kMostLeft = 100'000; // pieces of a grid leave about as many as there are across it
    std::vector<VtkExtent> left{extent}, rest;
    for (const VtkPiece& piece : image.pieces) {
        job.throwIfStopped();
        rest.clear();
        for (const VtkExtent& box : left) appendWithout(box, piece.extent, rest);
        if (rest.size() > kMostLeft) failInVtk(image.path, "the pieces of the image lie in too great a disorder");
        std::swap(left, rest);
    }
    if (left.empty()) return;
    const auto& point = left.front().lo;
    failInVtk(image.path,
              "no piece has the point " + std::to_string(point.x) + " " + std::to_string(point.y) + " " +
                  std::to_string(point.z) + " of the extent " + textOf(extent),
              toDo);
}

} // namespace pellucid
