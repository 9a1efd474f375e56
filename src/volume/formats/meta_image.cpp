// MetaImage: .mha (header and data in one file) and .mhd (header beside a data file).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <map>

#include "volume/formats/file_check.h"
#include "volume/formats/reader.h"
#include "volume/formats/samples.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostHeaderBytes = 1u << 20;

struct MetaHeader {
    std::map<std::string, std::string> fields;
    std::uint64_t dataStart = 0; ///< first byte after the line of ElementDataFile

    std::string get(const std::string& name) const {
        const auto it = fields.find(name);
        return it == fields.end() ? std::string() : it->second;
    }
    bool has(const std::string& name) const { return fields.count(name) > 0; }
    bool isTrue(const std::string& name) const {
        const std::string value = get(name);
        return !value.empty() && (value.front() == 'T' || value.front() == 't' || value.front() == '1');
    }
};

MetaHeader parseHeader(const std::string& path) {
    const std::string head = fileHead(path, kMostHeaderBytes);
    MetaHeader header;
    std::size_t begin = 0;
    while (begin < head.size() && header.fields.count("ElementDataFile") == 0) {
        const std::size_t end = std::min(head.find('\n', begin), head.size());
        const std::string_view line = std::string_view(head).substr(begin, end - begin);
        const std::size_t sign = line.find_first_of("=:");
        if (sign == std::string_view::npos && !trimmed(line).empty()) break;
        if (sign != std::string_view::npos) {
            const auto [field, isNew] =
                header.fields.insert({trimmed(line.substr(0, sign)), trimmed(line.substr(sign + 1))});
            if (!isNew && field->second != trimmed(line.substr(sign + 1)))
                throw FileError("the header gives " + inQuotes(field->first) + " twice", path, "correct the header");
        }
        begin = std::min(end + 1, head.size());
    }
    header.dataStart = begin;
    if (begin == kMostHeaderBytes)
        throw FileError("the header does not end within " + describeBytes(kMostHeaderBytes), path,
                        "correct the header, or copy the file again");
    if (header.fields.count("NDims") == 0 && header.fields.count("ObjectType") == 0)
        throw notOfFormat("a MetaImage file", path, std::string_view(head).substr(0, 1024));
    for (const char* name : {"NDims", "DimSize", "ElementType", "ElementDataFile"})
        if (header.get(name).empty())
            throw FileError("the header has no " + std::string(name), path,
                            "correct the header, or copy the file again");
    if (const std::string object = header.get("ObjectType"); !object.empty() && object != "Image")
        throw FileError("this MetaIO file holds an object of type " + inQuotes(object) + ", not an image", path, "");
    return header;
}

std::int64_t wholeNumber(const MetaHeader& header, const std::string& name, std::int64_t otherwise,
                         const std::string& path) {
    std::int64_t value = otherwise;
    const std::string text = header.get(name);
    if (!text.empty() && !parseNumber(text, value))
        throw FileError("the header's " + name + " is not a whole number", path, "correct the header");
    return value;
}

ValueType typeIn(const MetaHeader& header, const std::string& path) {
    static const std::map<std::string, ValueType> kTypes{
        {"MET_CHAR", ValueType::I8},        {"MET_UCHAR", ValueType::U8},  {"MET_SHORT", ValueType::I16},
        {"MET_USHORT", ValueType::U16},     {"MET_INT", ValueType::I32},   {"MET_UINT", ValueType::U32},
        {"MET_LONG", ValueType::I32},       {"MET_ULONG", ValueType::U32}, {"MET_LONG_LONG", ValueType::I64},
        {"MET_ULONG_LONG", ValueType::U64}, {"MET_FLOAT", ValueType::F32}, {"MET_DOUBLE", ValueType::F64}};
    const std::string given = header.get("ElementType");
    std::string type = given;
    if (type.size() > 6 && type.ends_with("_ARRAY")) type.resize(type.size() - 6);
    const auto it = kTypes.find(type);
    if (it != kTypes.end()) return it->second;
    throw FileError("the ElementType " + inQuotes(given) + " is not supported", path,
                    "it is one of MET_CHAR, MET_UCHAR, … MET_FLOAT, MET_DOUBLE");
}

std::vector<std::int64_t> sizesIn(const MetaHeader& header, const std::string& path) {
    const std::int64_t dimensions = wholeNumber(header, "NDims", 0, path);
    std::vector<std::int64_t> sizes;
    for (const std::string& word : splitWords(header.get("DimSize"))) {
        std::int64_t size = 0;
        if (!parseNumber(word, size))
            throw FileError("the header's DimSize " + inQuotes(word) + " is not a whole number", path,
                            "correct the header");
        sizes.push_back(size);
    }
    if (dimensions < 1 || dimensions > 10 || sizes.size() != static_cast<std::size_t>(dimensions))
        throw FileError("the header gives " + std::to_string(sizes.size()) +
                            " sizes for NDims = " + std::to_string(dimensions),
                        path, "correct the header");
    return sizes;
}

/// The numbers of the first of `names` that the header has; empty where it has none. Throws FileError unless they are
/// finite and at least `count`.
std::vector<double> numbersIn(const MetaHeader& header, std::initializer_list<const char*> names, std::size_t count,
                              const std::string& path) {
    for (const char* name : names) {
        const std::vector<std::string> words = splitWords(header.get(name));
        if (words.empty()) continue;
        std::vector<double> numbers(words.size());
        for (std::size_t i = 0; i < words.size(); ++i)
            if (!parseNumber(words[i], numbers[i]) || !std::isfinite(numbers[i]))
                throw FileError("there is " + inQuotes(words[i]) + " among the numbers of " + name, path,
                                "correct the header");
        if (numbers.size() < count)
            throw FileError("the header gives " + std::to_string(words.size()) + " of " + std::to_string(count) +
                                " numbers as " + name,
                            path, "correct the header");
        return numbers;
    }
    return {};
}

/// ElementSpacing, or ElementSize where there is none. Each must be positive, since its absolute value would give a
/// volume that looks right and is not.
Vec3 spacingIn(const MetaHeader& header, std::size_t axes, const std::string& path) {
    Vec3 spacing(1);
    for (const char* field : {"ElementSize", "ElementSpacing"}) {
        const std::vector<std::string> words = splitWords(header.get(field));
        if (words.empty()) continue;
        if (words.size() != axes)
            throw FileError("the header gives " + std::to_string(words.size()) + " numbers as " + field + " for " +
                                std::to_string(axes) + " axes",
                            path, "correct the header");
        for (std::size_t a = 0; a < std::min<std::size_t>(axes, 3); ++a) {
            double& value = spacing[static_cast<int>(a)];
            if (!parseNumber(words[a], value) || !(value > 0) || !std::isfinite(value))
                throw FileError("the spacing of axis " + std::to_string(a) + " is " + inQuotes(words[a]) +
                                    ", it must be positive and finite",
                                path, "correct the header");
        }
    }
    return spacing;
}

/// Row n of the header's matrix is where axis n points.
Mat3 directionsIn(const MetaHeader& header, std::size_t axes, const std::string& path) {
    Mat3 directions(1);
    const std::vector<double> matrix =
        numbersIn(header, {"TransformMatrix", "Rotation", "Orientation"}, axes * axes, path);
    if (matrix.empty()) return directions;
    const int inSpace = static_cast<int>(std::min<std::size_t>(axes, 3));
    for (int axis = 0; axis < inSpace; ++axis) {
        Vec3 direction(0);
        for (int c = 0; c < inSpace; ++c)
            direction[c] = matrix[static_cast<std::size_t>(axis) * axes + static_cast<std::size_t>(c)];
        directions[axis] = cleanDirection(direction);
    }
    return directions;
}

/// MetaImage's world is LPS wherever a patient is spoken of, which those do who name the anatomy of the axes.
Frame frameIn(const MetaHeader& header) {
    const std::string letters = lowerCase(header.get("AnatomicalOrientation"));
    const bool known = letters.size() >= 3 && std::all_of(letters.begin(), letters.begin() + 3, [](char c) {
                           return std::string_view("rlapsi").find(c) != std::string_view::npos;
                       });
    return known ? Frame::Patient : Frame::File;
}

bool isBigEndian(const MetaHeader& header, const std::string& path) {
    const char* const names[] = {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"};
    if (header.has(names[0]) && header.has(names[1]) && header.isTrue(names[0]) != header.isTrue(names[1]))
        throw FileError("the header gives two byte orders", path, "correct the header");
    return header.isTrue(names[0]) || header.isTrue(names[1]);
}

Encoding encodingIn(const MetaHeader& header, const std::string& path) {
    const bool compressed = header.isTrue("CompressedData");
    const bool text = header.has("BinaryData") && !header.isTrue("BinaryData");
    if (compressed && text)
        throw FileError("the header calls the data both text and compressed", path, "correct the header");
    return compressed ? Encoding::Deflate : text ? Encoding::Text : Encoding::Raw;
}

/// The file that holds the samples.
std::string dataPathIn(const MetaHeader& header, const std::string& path) {
    const std::string dataFile = header.get("ElementDataFile");
    if (lowerCase(dataFile) == "local") return path;
    if (dataFile.rfind("LIST", 0) == 0 || dataFile.find('%') != std::string::npos)
        throw FileError("a data file in several parts is not supported", path, "write it as one file");
    if (dataFile.size() > 1000) throw FileError("the name of the data file is too long", path, "correct the header");
    const fs::path data(dataFile);
    return (data.is_absolute() ? data : fs::path(path).parent_path() / data).string();
}

/// When the steps along the fourth axis are, in no unit that the header names. None where it says nothing but 0, 1, 2.
std::optional<StepTimes> timesIn(const MetaHeader& header, const std::vector<std::int64_t>& sizes,
                                 const std::string& path) {
    if (sizes.size() != 4 || sizes[3] < 2) return {};
    StepTimes times;
    if (const auto origin = numbersIn(header, {"Origin", "Offset", "Position"}, 4, path); !origin.empty())
        times.first = origin[3];
    std::vector<std::string> words = splitWords(header.get("ElementSpacing"));
    if (words.empty()) words = splitWords(header.get("ElementSize"));
    if (words.size() == 4 && (!parseNumber(words[3], times.width) || !(times.width > 0) || !std::isfinite(times.width)))
        return {};
    if (times.first == 0 && times.width == 1) return {};
    return times;
}

/// `step`: the one to be read, for which everything is checked; empty: nothing but the header is looked at.
FileLayout checkedLayout(const std::string& path, std::optional<int> step, const JobControl& job) {
    const MetaHeader header = parseHeader(path);
    const std::vector<std::int64_t> sizes = sizesIn(header, path);
    FileLayout layout;
    layout.spacing = spacingIn(header, sizes.size(), path);
    const std::int64_t channels = wholeNumber(header, "ElementNumberOfChannels", 1, path);
    if (channels != 1) layout.axes.push_back({channels, true});
    for (const std::int64_t size : sizes) layout.axes.push_back({size, false});
    layout.type = typeIn(header, path);
    const std::uint64_t values = valuesIn(layout, path);
    const std::uint64_t bytes = values * bytesPerValue(layout.type);
    const std::vector<double> origin = numbersIn(header, {"Origin", "Offset", "Position"}, sizes.size(), path);
    for (std::size_t a = 0; a < std::min<std::size_t>({3, sizes.size(), origin.size()}); ++a)
        layout.origin[static_cast<int>(a)] = origin[a];
    layout.directions = directionsIn(header, sizes.size(), path);
    layout.frame = frameIn(header);
    layout.bigEndian = isBigEndian(header, path);
    layout.encoding = encodingIn(header, path);
    layout.zlib = true;

    const bool local = lowerCase(header.get("ElementDataFile")) == "local";
    layout.dataPath = dataPathIn(header, path);
    layout.times = timesIn(header, sizes, path);
    if (!step) return layout;
    const std::uint64_t wanted = valuesUpTo(layout, *step);
    const std::uint64_t fileBytes = dataFileBytes(layout.dataPath, path);
    const char* toDo = "check DimSize and ElementType in the header, or copy the file again";
    // HeaderSize counts from the beginning of the file that holds the data, even where that is this one.
    const std::int64_t skip = wholeNumber(header, "HeaderSize", 0, path);
    if (skip < -1) throw FileError("the header's HeaderSize is negative", path, "correct the header");
    if (local && skip > 0 && static_cast<std::uint64_t>(skip) < header.dataStart)
        throw FileError("the header's HeaderSize lies within the header", path, "correct the header");
    layout.start = skip > 0 ? static_cast<std::uint64_t>(skip) : local ? header.dataStart : 0;
    std::int64_t packed = 0;
    if (layout.encoding == Encoding::Deflate) {
        packed = wholeNumber(header, "CompressedDataSize", 0, path);
        if (packed < 0) throw FileError("the header's CompressedDataSize is negative", path, "correct the header");
    }
    std::uint64_t stored = fileBytes - std::min(layout.start, fileBytes);
    if (skip == -1) { // the data end where the file ends
        const std::uint64_t last = layout.encoding == Encoding::Raw ? bytes : static_cast<std::uint64_t>(packed);
        if (layout.encoding == Encoding::Text || last == 0)
            throw FileError("the header does not tell where the data begin", path, "correct HeaderSize");
        requireStored(layout.dataPath, Encoding::Raw, last, 1, stored, toDo);
        layout.start = fileBytes - last;
        stored = last;
    }
    requireStored(layout.dataPath, Encoding::Raw, static_cast<std::uint64_t>(packed), 1, stored, toDo);
    requireStored(layout.dataPath, layout.encoding, wanted, bytesPerValue(layout.type), stored, toDo);
    // The stream itself tells where it ends, so that CompressedDataSize may be absent or wrong.
    if (layout.encoding == Encoding::Deflate) requireInflated(layout, wanted * bytesPerValue(layout.type), job);
    if (layout.encoding == Encoding::Text) requireNumbers(layout.dataPath, layout.start, wanted, job);
    if (layout.encoding == Encoding::Raw && stored > bytes)
        layout.notices.push_back("the data has " + std::to_string(stored - bytes) + " bytes more than the header says");
    return layout;
}

class MetaImageReader final : public VolumeReader {
public:
    const char* name() const override { return "MetaImage"; }
    const std::vector<std::string>& suffixes() const override {
        static const std::vector<std::string> kSuffixes{".mhd", ".mha"};
        return kSuffixes;
    }
    std::vector<std::string> dataFiles(const std::string& path) const override {
        return {dataPathIn(parseHeader(path), path)};
    }
    FileContents describe(const VolumeSource& source, const JobControl& job) const override {
        return contentsOf(checkedLayout(source.path, std::nullopt, job));
    }
    Volume read(const VolumeSource& source, const JobControl& job) const override {
        return readSamples(source, checkedLayout(source.path, source.step, job), job);
    }
};

} // namespace

const VolumeReader& metaImageReader() {
    static const MetaImageReader reader;
    return reader;
}

} // namespace pellucid
