// VTK's XML files of image data (.vti), and collections of files over time (.pvd).
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <span>

#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/vtk_bytes.h"
#include "volume/formats/xml_tags.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostArrays = 10'000;
constexpr std::size_t kMostFiles = 1'000'000;
constexpr const char* kCorrect = "correct the file, or write it again";

/// One DataArray.
struct VtkArray {
    std::string name, type, format;
    std::int64_t components = 1;
    std::uint64_t contentStart = 0; ///< byte of the file behind its tag
    std::uint64_t offset = 0;       ///< of appended data
};

/// All of the file but its data.
struct VtkImage {
    std::string path;
    bool bigEndian = false, compressed = false;
    int headerBytes = 4;
    std::optional<std::string> wholeExtent,
        pieceExtent; ///< of the elements ImageData and Piece, which have to be there
    std::string spacing, origin, direction, activeScalars;
    std::vector<VtkArray> arrays; ///< of the points
    std::size_t cellArrays = 0;
    std::optional<VtkArray> time; ///< FieldData's TimeValue
    bool appendedBase64 = false;
    std::optional<std::uint64_t> appendedStart; ///< byte of the file that offset 0 is
};

[[noreturn]] void failAt(const std::string& path, const std::string& what, const std::string& toDo = kCorrect) {
    throw FileError(what, path, toDo);
}

std::int64_t wholeNumber(const XmlTag& tag, const std::string& attribute, std::int64_t otherwise,
                         const std::string& path) {
    const std::string text = trimmed(tag.get(attribute));
    std::int64_t value = otherwise;
    if (!text.empty() && !parseNumber(text, value))
        failAt(path, "the attribute " + attribute + " " + inQuotes(text) + " is not a whole number");
    return value;
}

/// As many finite numbers as `otherwise` has, which are taken where the text is empty.
std::vector<double> numbersIn(const std::string& text, const std::string& what, const std::vector<double>& otherwise,
                              const std::string& path) {
    const std::vector<double> numbers = finiteNumbers(text, what, path);
    if (numbers.empty()) return otherwise;
    if (numbers.size() != otherwise.size())
        failAt(path,
               what + " has " + std::to_string(numbers.size()) + " numbers, not " + std::to_string(otherwise.size()));
    return numbers;
}

/// The root of the file, which has to be a VTKFile of `type`.
void checkRoot(const XmlTag& tag, const std::string& type, const std::string& path) {
    if (tag.name != "VTKFile" || !tag.opens)
        failAt(path, "this is not a VTK file but one of " + inQuotes(tag.name), "give it the suffix of its own format");
    if (tag.get("type") != type)
        failAt(path, "this VTK file holds " + inQuotes(tag.get("type")) + ", not " + type,
               type == "ImageData" ? "resample it to an image" : kCorrect);
}

/// Throws FileError unless a file could be XML.
void checkIsXml(const std::string& path) {
    const std::string head = fileHead(path, 1024);
    const std::size_t begin = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (begin == std::string::npos || head[begin] != '<') throw notOfFormat("a VTK XML file", path, head);
}

/// The byte behind the "_" that appended data begin with.
std::uint64_t appendedStart(const std::string& path, std::uint64_t from, const JobControl& job) {
    FileCharacters text(path, from, job);
    while (std::isspace(text.peek()) != 0) text.pass();
    if (text.peek() != '_') failAt(path, "the appended data do not begin with an underscore");
    return from + text.passed() + 1;
}

VtkArray arrayOf(const XmlTag& tag, const std::string& path) {
    VtkArray array{tag.get("Name"),
                   tag.get("type"),
                   lowerCase(tag.get("format")),
                   wholeNumber(tag, "NumberOfComponents", 1, path),
                   tag.end,
                   0};
    const std::int64_t offset = wholeNumber(tag, "offset", 0, path);
    if (offset < 0) failAt(path, "the offset of an array is negative");
    array.offset = static_cast<std::uint64_t>(offset);
    return array;
}

/// The root: how all data of the file are stored.
void readRoot(VtkImage& image, const XmlTag& tag) {
    checkRoot(tag, "ImageData", image.path);
    const std::string order = tag.get("byte_order"), header = tag.get("header_type"),
                      compressor = tag.get("compressor");
    if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
        failAt(image.path, "the byte order " + inQuotes(order) + " is not known");
    if (!header.empty() && header != "UInt32" && header != "UInt64")
        failAt(image.path, "the header type " + inQuotes(header) + " is not known");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
        failAt(image.path, "the compressor " + inQuotes(compressor) + " is not supported",
               "write it with ZLib compression, or none");
    image.bigEndian = order == "BigEndian";
    image.headerBytes = header == "UInt64" ? 8 : 4;
    image.compressed = !compressor.empty();
}

/// What an element within `parent` says of the image; most say nothing.
void readElement(VtkImage& image, const XmlTag& tag, const std::string& parent, const JobControl& job) {
    const std::string& path = image.path;
    if (tag.name == "ImageData" && parent == "VTKFile") {
        image.wholeExtent = tag.get("WholeExtent");
        image.spacing = tag.get("Spacing");
        image.origin = tag.get("Origin");
        image.direction = tag.get("Direction");
    } else if (tag.name == "Piece" && parent == "ImageData") {
        if (image.pieceExtent) failAt(path, "the image is in several pieces", "write it in one piece");
        image.pieceExtent = tag.get("Extent");
    } else if (tag.name == "PointData" && parent == "Piece") {
        image.activeScalars = tag.get("Scalars");
    } else if (tag.name == "DataArray" && parent == "PointData") {
        if (image.arrays.size() >= kMostArrays) failAt(path, "there are too many arrays");
        image.arrays.push_back(arrayOf(tag, path));
    } else if (tag.name == "DataArray" && parent == "CellData") {
        ++image.cellArrays;
    } else if (tag.name == "DataArray" && parent == "FieldData" && tag.get("Name") == "TimeValue") {
        image.time = arrayOf(tag, path);
    } else if (tag.name == "AppendedData" && parent == "VTKFile") {
        const std::string encoding = lowerCase(tag.get("encoding"));
        if (encoding != "raw" && encoding != "base64")
            failAt(path, "the encoding " + inQuotes(encoding) + " of the appended data is not known");
        image.appendedBase64 = encoding == "base64";
        image.appendedStart = appendedStart(path, tag.end, job);
    }
}

VtkImage readHeader(const std::string& path, const JobControl& job) {
    checkIsXml(path);
    VtkImage image;
    image.path = path;
    XmlTags tags(path, job);
    XmlTag tag;
    std::vector<std::string> inside; // names of the elements that are open
    bool ended = false;
    for (std::size_t elements = 0; !ended && tags.next(tag); ++elements) {
        if (elements >= 100 * kMostArrays) failAt(path, "there are too many elements");
        if (tag.opens) {
            if (inside.empty())
                readRoot(image, tag);
            else
                readElement(image, tag, inside.back(), job);
            if (!tag.closes) inside.push_back(tag.name);
            if (inside.size() > 100) failAt(path, "the elements are nested too deeply");
            ended = image.appendedStart.has_value(); // no XML from here on
        } else {
            if (inside.empty() || inside.back() != tag.name)
                failAt(path, "this is not valid XML: </" + tag.name + "> closes an element that is not open");
            inside.pop_back();
            ended = inside.empty();
        }
    }
    if (!ended && !inside.empty())
        failAt(path, "the file ends within its element " + inQuotes(inside.back()), "copy it again");
    if (!image.wholeExtent) failAt(path, "the file has no ImageData");
    if (image.pieceExtent && !image.pieceExtent->empty() &&
        splitWords(*image.pieceExtent) != splitWords(*image.wholeExtent))
        failAt(path, "its piece is not the whole image", "write the whole image in one piece");
    return image;
}

ValueType typeOf(const VtkArray& array, const std::string& path) {
    static const std::map<std::string, ValueType> kTypes{
        {"Int8", ValueType::I8},     {"UInt8", ValueType::U8},   {"Int16", ValueType::I16}, {"UInt16", ValueType::U16},
        {"Int32", ValueType::I32},   {"UInt32", ValueType::U32}, {"Int64", ValueType::I64}, {"UInt64", ValueType::U64},
        {"Float32", ValueType::F32}, {"Float64", ValueType::F64}};
    const auto it = kTypes.find(array.type);
    if (it != kTypes.end()) return it->second;
    failAt(path, "the type " + inQuotes(array.type) + " is not supported",
           "use one of Int8, UInt8, … Float32, Float64");
}

/// Where the data of an array are, checked against the file where `whole`.
void placeData(FileLayout& layout, const VtkImage& image, const VtkArray& array, std::uint64_t values, bool whole,
               const JobControl& job) {
    const std::string& path = image.path;
    layout.dataPath = path;
    layout.type = typeOf(array, path);
    layout.bigEndian = image.bigEndian;
    if (array.format == "ascii") {
        layout.encoding = Encoding::Text;
        layout.start = array.contentStart;
        if (!whole) return;
        const std::uint64_t file = readableFileBytes(path);
        requireData(layout, file - std::min(file, layout.start), values,
                    "check the extent and the type of the array, or copy the file again", job);
        return;
    }
    VtkData data{path, array.contentStart, true, image.compressed, image.bigEndian, image.headerBytes};
    if (array.format == "appended") {
        if (!image.appendedStart) failAt(path, "there are no appended data in the file", "copy it again");
        if (array.offset > (std::uint64_t{1} << 62)) failAt(path, "the offset of an array lies beyond any file");
        data.start = *image.appendedStart + array.offset;
        data.base64 = image.appendedBase64;
    } else if (array.format != "binary") {
        failAt(path, "the format " + inQuotes(array.format) + " of the array is not known");
    }
    if (!whole) return;
    layout.start = requireVtkBytes(data, values * bytesPerValue(layout.type), job);
    if (data.base64 || data.compressed)
        layout.open = [data](const JobControl& control) { return openVtkData(data, control); };
}

/// The array that is asked for.
const VtkArray& chosenArray(const VtkImage& image, const std::string& name) {
    if (image.arrays.empty()) {
        if (image.cellArrays > 0)
            failAt(image.path, "the file has values for cells, not for points", "convert its cell data to point data");
        failAt(image.path, "the file has no values for points");
    }
    const auto found = std::ranges::find(image.arrays, name.empty() ? image.activeScalars : name, &VtkArray::name);
    if (!name.empty() && found == image.arrays.end()) {
        const auto shown = std::span(image.arrays).first(std::min<std::size_t>(image.arrays.size(), 20));
        const auto nameOf = [](const VtkArray& array) { return array.name.substr(0, 40); };
        throw UsageError("there is no array " + inQuotes(name), image.path, "it has " + joined(shown, ", ", nameOf));
    }
    const bool isNamed = !name.empty() || !image.activeScalars.empty();
    return isNamed && found != image.arrays.end() ? *found : image.arrays.front();
}

FileLayout layoutOfArray(const VtkImage& image, const std::string& name, bool whole, const JobControl& job) {
    const std::string& path = image.path;
    const VtkArray& array = chosenArray(image, name);
    FileLayout layout;
    layout.array = array.name;
    if (array.components != 1) layout.axes.push_back({array.components, true});
    std::array<std::int64_t, 6> extent{};
    const std::vector<std::string> words = splitWords(*image.wholeExtent);
    for (std::size_t i = 0; i < extent.size(); ++i)
        if (words.size() != extent.size() || !parseNumber(words[i], extent[i]) ||
            std::abs(extent[i]) > (std::int64_t{1} << 31))
            failAt(path, "the extent " + inQuotes(*image.wholeExtent) + " is not six whole numbers");
    const auto spacing = numbersIn(image.spacing, "Spacing", {1, 1, 1}, path);
    const auto origin = numbersIn(image.origin, "Origin", {0, 0, 0}, path);
    const auto direction = numbersIn(image.direction, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1}, path);
    Vec3 first(0);
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        layout.axes.push_back({extent[2 * a + 1] - extent[2 * a] + 1});
        layout.spacing[axis] = spacing[a];
        layout.origin[axis] = origin[a];
        layout.directions[axis] = cleanDirection({direction[a], direction[3 + a], direction[6 + a]});
        first[axis] = static_cast<double>(extent[2 * a]) * spacing[a];
    }
    layout.origin += layout.directions * first; // the extent need not begin at 0
    const std::uint64_t values = valuesIn(layout, path);
    placeData(layout, image, array, values, whole, job);
    if (image.arrays.size() > 1 && name.empty())
        layout.notices.push_back("array " + inQuotes(array.name) + " of " + std::to_string(image.arrays.size()) +
                                 " is shown");
    return layout;
}

/// The one value of TimeValue; none where it cannot be read.
std::optional<double> timeOf(const VtkImage& image, const JobControl& job) {
    if (!image.time || image.time->components != 1) return {};
    try {
        FileLayout layout;
        layout.axes = {{1}};
        placeData(layout, image, *image.time, 1, true, job);
        VolumeSource source;
        source.path = image.path;
        const double time = readSamples(source, layout, {job.stop, {}}).value(0);
        return std::isfinite(time) ? std::optional(time) : std::nullopt;
    } catch (const Error&) {
        return {};
    }
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const VtkImage image = readHeader(source.path, job);
    FileLayout layout = layoutOfArray(image, source.array, step.has_value(), job);
    if (step) return layout;
    for (const VtkArray& array : image.arrays) layout.arrays.push_back(array.name);
    if (const auto time = timeOf(image, job)) layout.times = StepTimes{*time, 1, ""};
    return layout;
}

/// A file of a collection.
struct CollectionEntry {
    std::string path;
    std::optional<double> time;
};

std::vector<CollectionEntry> readCollection(const std::string& path, const JobControl& job) {
    checkIsXml(path);
    XmlTags tags(path, job);
    XmlTag tag;
    std::vector<CollectionEntry> entries;
    bool isRoot = true, ended = false;
    while (tags.next(tag)) {
        if (isRoot) checkRoot(tag, "Collection", path);
        isRoot = false;
        ended = ended || (tag.name == "VTKFile" && tag.closes);
        if (tag.name != "DataSet" || !tag.opens) continue;
        if (entries.size() >= kMostFiles) failAt(path, "there are too many files in the collection");
        const std::string file = tag.get("file");
        if (file.empty()) failAt(path, "a data set of the collection names no file");
        if (file.size() > 1000) failAt(path, "the name of a file is too long");
        if (lowerCase(file).ends_with(".pvd")) failAt(path, "the collection names another collection");
        CollectionEntry entry{(fs::path(path).parent_path() / file).string(), {}};
        const std::string text = trimmed(tag.get("timestep"));
        double time = 0;
        if (!text.empty() && (!parseNumber(text, time) || !std::isfinite(time)))
            failAt(path, "the time step " + inQuotes(text) + " is not a number");
        if (!text.empty()) entry.time = time;
        entries.push_back(std::move(entry));
    }
    if (entries.empty()) failAt(path, "the collection names no files");
    if (!ended) failAt(path, "the file ends within its element \"VTKFile\"", "copy it again");
    if (!std::ranges::all_of(entries, [](const CollectionEntry& e) { return e.time.has_value(); })) return entries;
    std::ranges::stable_sort(entries, {}, &CollectionEntry::time);
    if (std::ranges::adjacent_find(entries, {}, &CollectionEntry::time) != entries.end())
        failAt(path, "two files of the collection have the same time step", "write each step in one piece");
    return entries;
}

std::vector<std::string> filesOfCollection(const std::string& path) {
    std::vector<std::string> files;
    for (const CollectionEntry& entry : readCollection(path, {})) files.push_back(entry.path);
    return files;
}

FileContents describeCollection(const VolumeSource& source, const JobControl& job) {
    const std::vector<CollectionEntry> entries = readCollection(source.path, job);
    FileContents contents;
    for (const CollectionEntry& entry : entries) { // the first that can be read: one may be missing
        VolumeSource file = source;
        file.path = entry.path;
        file.frames.reset();
        try {
            contents = contentsOf(file, job);
            break;
        } catch (const FileError&) {
            if (&entry == &entries.back()) throw;
        }
    }
    contents.steps = static_cast<int>(entries.size());
    contents.times.clear();
    contents.timeUnit.clear();
    for (const CollectionEntry& entry : entries) {
        contents.stepFiles.push_back(entry.path);
        if (entry.time) contents.times.push_back(*entry.time);
    }
    if (contents.times.size() != entries.size()) contents.times.clear();
    return contents;
}

Volume readFromCollection(const VolumeSource& source, const JobControl& job) {
    const std::vector<CollectionEntry> entries = readCollection(source.path, job);
    requireIndex("time step", source.step, entries.size(), source.path);
    VolumeSource file = source;
    file.path = entries[static_cast<std::size_t>(source.step)].path;
    file.step = 0;
    file.range.reset();
    return loadVolume(file, job);
}

} // namespace

VolumeFormat vtiFormat() { return {"VTK image data", {".vti"}, describeLayout<layoutOf>, readLayout<layoutOf>}; }

VolumeFormat pvdFormat() {
    return {"VTK collection", {".pvd"}, describeCollection, readFromCollection, filesOfCollection};
}

} // namespace pellucid
