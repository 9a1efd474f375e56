// NRRD and its detached form NHDR (teem's "nearly raw raster data"), versions 1 to 5.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

#include "volume/formats/file_check.h"
#include "volume/formats/itk_image.h"
#include "volume/formats/reader.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostHeaderBytes = 1u << 20;

/// The fields of a header: names in lower case without blanks ("spacedirections"), since writers differ in both.
struct NrrdHeader {
    std::map<std::string, std::string> fields;
    std::uint64_t dataStart = 0; ///< first byte after the header

    std::string get(const std::string& name) const {
        const auto it = fields.find(name);
        return it == fields.end() ? std::string() : it->second;
    }
};

NrrdHeader parseHeader(const std::string& path) {
    const std::string head = fileHead(path, kMostHeaderBytes);
    if (head.rfind("NRRD000", 0) != 0)
        throw FileError("this is not an NRRD file but " + describeContent(head.substr(0, 1024)), path,
                        "give it the suffix of its own format", Remedy::GiveRawLayout);
    NrrdHeader header;
    std::size_t begin = 0;
    for (bool first = true; begin < head.size(); first = false) {
        const std::size_t end = std::min(head.find('\n', begin), head.size());
        const std::string line = trimmed(std::string_view(head).substr(begin, end - begin));
        begin = std::min(end + 1, head.size());
        if (line.empty()) break; // the blank line that ends the header
        const std::size_t colon = line.find(':');
        if (first || line.front() == '#' || colon == std::string::npos || line.compare(colon, 2, ":=") == 0) continue;
        std::string name = lowerCase(line.substr(0, colon));
        std::erase(name, ' ');
        if (name == "sizes" && header.fields.count(name) > 0)
            throw FileError("the header gives the sizes twice", path, "correct the header");
        header.fields[name] = trimmed(line.substr(colon + 1));
    }
    header.dataStart = begin;
    return header;
}

std::int64_t wholeNumber(const NrrdHeader& header, const std::string& field, std::int64_t otherwise,
                         const std::string& path) {
    std::int64_t value = otherwise;
    const std::string text = header.get(field);
    if (!text.empty() && !parseNumber(text, value))
        throw FileError("the header's field " + inQuotes(field) + " is not a whole number", path, "correct the header");
    return value;
}

std::uint64_t bytesOfType(const std::string& type, const std::string& path) {
    static const std::map<std::string, std::uint64_t> kBytes = [] {
        std::map<std::string, std::uint64_t> bytes;
        for (const char* name : {"signed char", "int8", "int8_t", "uchar", "unsigned char", "uint8", "uint8_t"})
            bytes[name] = 1;
        for (const char* name : {"short", "short int", "signed short", "signed short int", "int16", "int16_t", "ushort",
                                 "unsigned short", "unsigned short int", "uint16", "uint16_t"})
            bytes[name] = 2;
        for (const char* name :
             {"int", "signed int", "int32", "int32_t", "uint", "unsigned int", "uint32", "uint32_t", "float"})
            bytes[name] = 4;
        for (const char* name :
             {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t",
              "ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t", "double"})
            bytes[name] = 8;
        return bytes;
    }();
    const auto it = kBytes.find(lowerCase(type));
    if (it != kBytes.end()) return it->second;
    throw FileError(type.empty() ? "the header names no type" : "the type " + inQuotes(type) + " is not supported",
                    path, "the types are signed and unsigned integers of 8 to 64 bits, float and double");
}

/// "none (1,0,0) (0,1,0)": one word per axis; blanks inside the brackets are allowed.
std::vector<std::string> splitVectors(const std::string& text) {
    std::vector<std::string> words;
    bool inside = false;
    std::string word;
    for (const char c : text + " ") {
        const bool blank = c == ' ' || c == '\t';
        if (!blank) word += c;
        if (c == '(') inside = true;
        if (c == ')') inside = false;
        if ((blank || c == ')') && !inside && !word.empty()) {
            words.push_back(word);
            word.clear();
        }
    }
    return words;
}

/// Length of "(x,y,z)"; NaN where it cannot be read.
double lengthOfVector(const std::string& text) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    if (text.size() < 3 || text.front() != '(' || text.back() != ')') return kNan;
    double sum = 0;
    std::size_t begin = 1;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size() - 1);
        double value = 0;
        if (!parseNumber(std::string_view(text).substr(begin, end - begin), value)) return kNan;
        sum += value * value;
        begin = end + 1;
    }
    return std::sqrt(sum);
}

/// Which axes lie in space or time, as opposed to the components of a voxel; as the NRRD definition has it.
std::vector<bool> domainAxes(const NrrdHeader& header, std::size_t axes) {
    std::vector<bool> domain(axes, true);
    const std::vector<std::string> kinds = splitWords(header.get("kinds"));
    for (std::size_t a = 0; a < std::min(axes, kinds.size()); ++a) {
        const std::string kind = lowerCase(kinds[a]);
        domain[a] = kind == "domain" || kind == "space" || kind == "time" || kind == "???" || kind == "none";
    }
    return domain;
}

/// ITK takes the absolute value of a negative spacing and 1 for an unknown one: a volume that looks right and is not.
void checkSpacing(const NrrdHeader& header, std::size_t axes, const std::string& path) {
    const std::vector<bool> domain = domainAxes(header, axes);
    const std::vector<std::string> spacings = splitWords(header.get("spacings"));
    const std::vector<std::string> directions = splitVectors(header.get("spacedirections"));
    int spatial = 0;
    for (std::size_t a = 0; a < axes && spatial < 3; ++a) {
        if (!domain[a]) continue;
        ++spatial;
        double spacing = 1;
        std::string text;
        if (a < directions.size() && directions[a] != "none") {
            text = directions[a];
            spacing = lengthOfVector(text);
        } else if (a < spacings.size()) {
            text = spacings[a];
            if (!parseNumber(text, spacing)) spacing = std::numeric_limits<double>::quiet_NaN();
        }
        if (!(spacing > 0) || !std::isfinite(spacing))
            throw FileError("the spacing of axis " + std::to_string(a) + " is " + inQuotes(text) +
                                ", it must be positive and finite",
                            path, "correct the header");
    }
}

/// Bytes in the data file before the samples.
std::uint64_t bytesOfLines(const std::string& path, std::uint64_t start, std::int64_t lines) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(start));
    for (std::int64_t i = 0; i < lines && in; ++i) in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    return in ? static_cast<std::uint64_t>(in.tellg()) - start : std::numeric_limits<std::int64_t>::max();
}

std::vector<std::int64_t> sizesIn(const NrrdHeader& header, const std::string& path) {
    const std::int64_t dimension = wholeNumber(header, "dimension", 0, path);
    if (header.get("dimension").empty())
        throw FileError("the header gives no dimension", path, "correct the header, or copy the file again");
    std::vector<std::int64_t> sizes;
    for (const std::string& word : splitWords(header.get("sizes"))) {
        std::int64_t size = 0;
        if (!parseNumber(word, size))
            throw FileError("the header's size " + inQuotes(word) + " is not a whole number", path,
                            "correct the header");
        sizes.push_back(size);
    }
    if (dimension < 1 || dimension > 16 || sizes.size() != static_cast<std::size_t>(dimension))
        throw FileError("the header gives " + std::to_string(sizes.size()) + " sizes for dimension " +
                            std::to_string(dimension),
                        path, "correct the header");
    return sizes;
}

Encoding encodingIn(const NrrdHeader& header, const std::string& path) {
    const std::string name = lowerCase(header.get("encoding"));
    if (name == "raw") return Encoding::Raw;
    if (name == "gzip" || name == "gz") return Encoding::Deflate;
    if (name == "ascii" || name == "text" || name == "txt") return Encoding::Text;
    if (name == "hex") return Encoding::Hex;
    throw FileError(name.empty() ? "the header names no encoding"
                                 : "the encoding " + inQuotes(name) + " is not supported",
                    path, "write it with encoding raw or gzip");
}

/// The file with the data: `path` itself, or the one that its header names.
std::string dataPathIn(const NrrdHeader& header, const std::string& path) {
    const std::string dataFile = header.get("datafile");
    if (dataFile.empty()) return path;
    if (dataFile.rfind("LIST", 0) == 0 || dataFile.rfind("SKIPLIST", 0) == 0 || dataFile.find('%') != std::string::npos)
        throw FileError("a data file in several parts is not supported", path, "write it as one file");
    if (dataFile.size() > 1000) throw FileError("the name of the data file is too long", path, "correct the header");
    const fs::path data(dataFile);
    return (data.is_absolute() ? data : fs::path(path).parent_path() / data).string();
}

HeaderClaim checkedClaim(const std::string& path, const JobControl& job) {
    const NrrdHeader header = parseHeader(path);
    const std::vector<std::int64_t> sizes = sizesIn(header, path);
    HeaderClaim claim;
    claim.bytesPerValue = bytesOfType(header.get("type"), path);
    claim.values = valueCount(path, sizes, claim.bytesPerValue);
    checkSpacing(header, sizes.size(), path);

    const Encoding encoding = encodingIn(header, path);
    claim.dataPath = dataPathIn(header, path);
    const bool detached = !header.get("datafile").empty();
    std::uint64_t stored = readableFileBytes(claim.dataPath);
    std::uint64_t start = detached ? 0 : std::min(header.dataStart, stored);
    const std::int64_t lineSkip = wholeNumber(header, "lineskip", 0, path);
    const std::int64_t byteSkip = wholeNumber(header, "byteskip", 0, path);
    if (lineSkip < 0 || byteSkip < -1)
        throw FileError("the header skips a negative number of lines or bytes", path, "correct the header");
    if (lineSkip > 0) start += bytesOfLines(claim.dataPath, start, lineSkip);
    if (encoding != Encoding::Deflate && byteSkip > 0) start += static_cast<std::uint64_t>(byteSkip);
    stored -= std::min(start, stored);

    requireStored(claim.dataPath, encoding, claim.values, claim.bytesPerValue, stored,
                  "check sizes and type in the header, or copy the file again");
    const std::uint64_t bytes = claim.values * claim.bytesPerValue;
    if (encoding == Encoding::Text) requireNumbers(claim.dataPath, start, claim.values, job);
    if (encoding == Encoding::Deflate) // bytes are skipped in what comes out
        requireInflates(claim.dataPath, start, false,
                        bytes + static_cast<std::uint64_t>(std::max(byteSkip, std::int64_t{0})), job);
    if (encoding == Encoding::Raw && byteSkip >= 0 && stored > bytes)
        claim.notices.push_back("the data has " + std::to_string(stored - bytes) + " bytes more than the header says");
    return claim;
}

class NrrdReader final : public VolumeReader {
public:
    const char* name() const override { return "NRRD"; }
    const std::vector<std::string>& suffixes() const override {
        static const std::vector<std::string> kSuffixes{".nrrd", ".nhdr"};
        return kSuffixes;
    }
    std::string dataFile(const std::string& path) const override { return dataPathIn(parseHeader(path), path); }
    Volume read(const VolumeSource& source, const JobControl& job) const override {
        const HeaderClaim claim = checkedClaim(source.path, job);
        return readWithItk(ItkFormat::Nrrd, source, claim, job);
    }
};

} // namespace

const VolumeReader& nrrdReader() {
    static const NrrdReader reader;
    return reader;
}

} // namespace pellucid
