// MetaImage: .mha (header and data in one file) and .mhd (header beside a data file).
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "volume/formats/file_check.h"
#include "volume/formats/itk_image.h"
#include "volume/formats/reader.h"

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
        if (sign != std::string_view::npos)
            header.fields[trimmed(line.substr(0, sign))] = trimmed(line.substr(sign + 1));
        begin = std::min(end + 1, head.size());
    }
    header.dataStart = begin;
    if (header.fields.count("NDims") == 0 && header.fields.count("ObjectType") == 0)
        throw FileError("this is not a MetaImage file but " + describeContent(head.substr(0, 1024)), path,
                        "give it the suffix of its own format", Remedy::GiveRawLayout);
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

std::uint64_t bytesOfType(std::string type, const std::string& path) {
    static const std::map<std::string, std::uint64_t> kBytes{
        {"MET_CHAR", 1},      {"MET_UCHAR", 1},      {"MET_SHORT", 2}, {"MET_USHORT", 2},
        {"MET_INT", 4},       {"MET_UINT", 4},       {"MET_LONG", 4},  {"MET_ULONG", 4},
        {"MET_LONG_LONG", 8}, {"MET_ULONG_LONG", 8}, {"MET_FLOAT", 4}, {"MET_DOUBLE", 8}};
    const std::string given = type;
    if (type.size() > 6 && type.ends_with("_ARRAY")) type.resize(type.size() - 6);
    const auto it = kBytes.find(type);
    if (it != kBytes.end()) return it->second;
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

/// ITK would take the absolute value of a negative spacing and 1 for zero.
void checkSpacing(const MetaHeader& header, std::size_t axes, const std::string& path) {
    for (const char* field : {"ElementSpacing", "ElementSize"}) {
        const std::vector<std::string> words = splitWords(header.get(field));
        if (words.empty()) continue;
        if (words.size() != axes)
            throw FileError("the header gives " + std::to_string(words.size()) + " numbers as " + field + " for " +
                                std::to_string(axes) + " axes",
                            path, "correct the header");
        for (std::size_t a = 0; a < std::min<std::size_t>(axes, 3); ++a) {
            double spacing = 0;
            if (!parseNumber(words[a], spacing) || !(spacing > 0) || !std::isfinite(spacing))
                throw FileError("the spacing of axis " + std::to_string(a) + " is " + inQuotes(words[a]) +
                                    ", it must be positive and finite",
                                path, "correct the header");
        }
    }
}

/// The file with the data: `path` itself, or the one that its header names.
std::string dataPathIn(const MetaHeader& header, const std::string& path) {
    const std::string dataFile = header.get("ElementDataFile");
    if (lowerCase(dataFile) == "local") return path;
    if (dataFile.rfind("LIST", 0) == 0 || dataFile.find('%') != std::string::npos)
        throw FileError("a data file in several parts is not supported", path, "write it as one file");
    if (dataFile.size() > 1000) throw FileError("the name of the data file is too long", path, "correct the header");
    const fs::path data(dataFile);
    return (data.is_absolute() ? data : fs::path(path).parent_path() / data).string();
}

HeaderClaim checkedClaim(const std::string& path, const JobControl& job) {
    const MetaHeader header = parseHeader(path);
    std::vector<std::int64_t> sizes = sizesIn(header, path);
    checkSpacing(header, sizes.size(), path);
    sizes.push_back(wholeNumber(header, "ElementNumberOfChannels", 1, path));
    HeaderClaim claim;
    claim.bytesPerValue = bytesOfType(header.get("ElementType"), path);
    claim.values = valueCount(path, sizes, claim.bytesPerValue);

    claim.dataPath = dataPathIn(header, path);
    const bool local = lowerCase(header.get("ElementDataFile")) == "local";
    const std::int64_t skip = wholeNumber(header, "HeaderSize", 0, path); // −1: the data end where the file ends
    if (skip < -1) throw FileError("the header's HeaderSize is negative", path, "correct the header");
    const std::uint64_t start = local ? header.dataStart : static_cast<std::uint64_t>(std::max(skip, std::int64_t{0}));
    const std::uint64_t fileBytes = readableFileBytes(claim.dataPath);
    const std::uint64_t stored = fileBytes - std::min(start, fileBytes);

    const bool compressed = header.isTrue("CompressedData");
    const bool text = !header.get("BinaryData").empty() && !header.isTrue("BinaryData");
    const Encoding encoding = compressed ? Encoding::Deflate : text ? Encoding::Text : Encoding::Raw;
    const char* toDo = "check DimSize and ElementType in the header, or copy the file again";
    if (compressed) {
        const std::int64_t size = wholeNumber(header, "CompressedDataSize", 0, path);
        if (size < 0) throw FileError("the header's CompressedDataSize is negative", path, "correct the header");
        if (size > 0) requireStored(claim.dataPath, Encoding::Raw, static_cast<std::uint64_t>(size), 1, stored, toDo);
    }
    requireStored(claim.dataPath, encoding, claim.values, claim.bytesPerValue, stored, toDo);
    const std::uint64_t bytes = claim.values * claim.bytesPerValue;
    if (compressed) requireInflates(claim.dataPath, start, true, bytes, job);
    if (encoding == Encoding::Text) requireNumbers(claim.dataPath, start, claim.values, job);
    if (encoding == Encoding::Raw && skip >= 0 && stored > bytes)
        claim.notices.push_back("the data has " + std::to_string(stored - bytes) + " bytes more than the header says");
    return claim;
}

class MetaImageReader final : public VolumeReader {
public:
    const char* name() const override { return "MetaImage"; }
    const std::vector<std::string>& suffixes() const override {
        static const std::vector<std::string> kSuffixes{".mhd", ".mha"};
        return kSuffixes;
    }
    std::string dataFile(const std::string& path) const override { return dataPathIn(parseHeader(path), path); }
    Volume read(const VolumeSource& source, const JobControl& job) const override {
        const HeaderClaim claim = checkedClaim(source.path, job);
        return readWithItk(ItkFormat::MetaImage, source, claim, job);
    }
};

} // namespace

const VolumeReader& metaImageReader() {
    static const MetaImageReader reader;
    return reader;
}

} // namespace pellucid
