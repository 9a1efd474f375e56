// NRRD and its detached form NHDR (teem's "nearly raw raster data"), versions 1 to 5.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/round_numbers.h"
#include "volume/formats/file_check.h"
#include "volume/formats/reader.h"
#include "volume/formats/samples.h"

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
    if (head.rfind("NRRD000", 0) != 0) throw notOfFormat("an NRRD file", path, std::string_view(head).substr(0, 1024));
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
        if (!header.fields.insert({name, trimmed(line.substr(colon + 1))}).second)
            throw FileError("the header gives " + inQuotes(name) + " twice", path, "correct the header");
    }
    header.dataStart = begin;
    if (begin == kMostHeaderBytes)
        throw FileError("the header does not end within " + describeBytes(kMostHeaderBytes), path,
                        "correct the header, or copy the file again");
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

ValueType typeIn(const NrrdHeader& header, const std::string& path) {
    static const std::map<std::string, ValueType> kTypes = [] {
        std::map<std::string, ValueType> types;
        const auto add = [&](ValueType type, std::initializer_list<const char*> names) {
            for (const char* name : names) types[name] = type;
        };
        add(ValueType::I8, {"signed char", "int8", "int8_t"});
        add(ValueType::U8, {"uchar", "unsigned char", "uint8", "uint8_t"});
        add(ValueType::I16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
        add(ValueType::U16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
        add(ValueType::I32, {"int", "signed int", "int32", "int32_t"});
        add(ValueType::U32, {"uint", "unsigned int", "uint32", "uint32_t"});
        add(ValueType::I64,
            {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"});
        add(ValueType::U64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
        add(ValueType::F32, {"float"});
        add(ValueType::F64, {"double"});
        return types;
    }();
    const std::string type = header.get("type");
    const auto it = kTypes.find(lowerCase(type));
    if (it != kTypes.end()) return it->second;
    throw FileError(type.empty() ? "the header names no type" : "the type " + inQuotes(type) + " is not supported",
                    path, "the types are signed and unsigned integers of 8 to 64 bits, float and double");
}

bool isBigEndian(const NrrdHeader& header, std::uint64_t bytesPerValue, Encoding encoding, const std::string& path) {
    const std::string endian = lowerCase(header.get("endian"));
    if (endian == "big" || endian == "little") return endian == "big";
    if (!endian.empty() || (bytesPerValue > 1 && encoding != Encoding::Text))
        throw FileError(endian.empty() ? "the header gives no byte order"
                                       : "the byte order " + inQuotes(endian) + " is not known",
                        path, "correct its field endian: little or big");
    return false;
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
    if (!word.empty()) words.push_back(word); // a bracket that is not closed
    return words;
}

/// The numbers of "(x,y,z)". Throws FileError where they cannot be read or are not finite.
std::vector<double> vectorIn(const std::string& text, const std::string& path) {
    std::vector<double> numbers;
    bool good = text.size() > 2 && text.front() == '(' && text.back() == ')';
    for (std::size_t begin = 1; good && begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size() - 1);
        double value = 0;
        good = parseNumber(text.substr(begin, end - begin), value) && std::isfinite(value);
        numbers.push_back(value);
        begin = end + 1;
    }
    if (!good) throw FileError(inQuotes(text) + " is not a vector of numbers", path, "correct the header");
    return numbers;
}

/// The words of a field with one for each axis; empty where there is no such field.
std::vector<std::string> wordsPerAxis(const NrrdHeader& header, const std::string& field, std::size_t axes,
                                      const std::string& path) {
    const bool vectors = field == "spacedirections";
    const std::vector<std::string> words = vectors ? splitVectors(header.get(field)) : splitWords(header.get(field));
    if (!words.empty() && words.size() != axes)
        throw FileError("the header's field " + inQuotes(field) + " has " + std::to_string(words.size()) +
                            " words for " + std::to_string(axes) + " axes",
                        path, "correct the header");
    return words;
}

bool isNone(const std::string& word) { return word == "none" || word == "???"; }

/// Which axis has the components of a voxel, by its kind or, without one, because it has no direction in space; the
/// number of axes where there is none. A list, or an axis without kind, behind three axes in space has time steps.
std::size_t componentAxis(const NrrdHeader& header, const std::vector<std::int64_t>& sizes, const std::string& path) {
    // Sizes that a kind prescribes; 0: any.
    static const std::map<std::string, int> kKinds{{"stub", 1},
                                                   {"scalar", 1},
                                                   {"complex", 2},
                                                   {"2-vector", 2},
                                                   {"3-color", 3},
                                                   {"rgb-color", 3},
                                                   {"hsv-color", 3},
                                                   {"xyz-color", 3},
                                                   {"4-color", 4},
                                                   {"rgba-color", 4},
                                                   {"3-vector", 3},
                                                   {"3-gradient", 3},
                                                   {"3-normal", 3},
                                                   {"4-vector", 4},
                                                   {"quaternion", 4},
                                                   {"2d-symmetric-matrix", 3},
                                                   {"2d-masked-symmetric-matrix", 4},
                                                   {"2d-matrix", 4},
                                                   {"2d-masked-matrix", 5},
                                                   {"3d-symmetric-matrix", 6},
                                                   {"3d-masked-symmetric-matrix", 7},
                                                   {"3d-matrix", 9},
                                                   {"3d-masked-matrix", 10},
                                                   {"list", 0},
                                                   {"point", 0},
                                                   {"vector", 0},
                                                   {"covariant-vector", 0},
                                                   {"normal", 0}};
    const std::vector<std::string> kinds = wordsPerAxis(header, "kinds", sizes.size(), path);
    const std::vector<std::string> directions = wordsPerAxis(header, "spacedirections", sizes.size(), path);
    std::size_t found = sizes.size(), inSpace = 0;
    for (std::size_t a = 0; a < sizes.size(); ++a) {
        const std::string kind = kinds.empty() ? "none" : lowerCase(kinds[a]);
        if (kind == "time") continue;
        if (kind == "domain" || kind == "space") {
            ++inSpace;
            continue;
        }
        if (inSpace >= 3 && (isNone(kind) || kind == "list")) continue;
        if (isNone(kind)) {
            if (directions.empty() || !isNone(directions[a])) {
                ++inSpace;
                continue;
            }
        } else {
            const auto it = kKinds.find(kind);
            if (it == kKinds.end())
                throw FileError("the kind " + inQuotes(kinds[a]) + " of axis " + std::to_string(a) + " is not known",
                                path, "correct the header");
            if (it->second != 0 && it->second != sizes[a])
                throw FileError("axis " + std::to_string(a) + " of kind " + kind + " has " + std::to_string(sizes[a]) +
                                    " entries, not " + std::to_string(it->second),
                                path, "correct the header");
        }
        if (found < sizes.size())
            throw FileError("more than one axis has components of a voxel", path, "write one file for each component");
        found = a;
    }
    if (inSpace == 0) throw FileError("no axis lies in space", path, "correct the header");
    return found;
}

/// What turns the header's space into ours, whose axes go to the left, the back and the top; empty where the header's
/// space knows of no patient.
std::optional<Vec3> flipOfSpace(const NrrdHeader& header, const std::string& path) {
    std::string space = lowerCase(header.get("space"));
    static const std::set<std::string> kInTime{"rast", "last", "lpst"};
    if (space.ends_with("-superior-time")) space.resize(space.size() - 5);
    if (kInTime.count(space) > 0) space.resize(3);
    static const std::set<std::string> kOthers{"",
                                               "scanner-xyz",
                                               "scanner-xyz-time",
                                               "3d-right-handed",
                                               "3d-left-handed",
                                               "3d-right-handed-time",
                                               "3d-left-handed-time"};
    if (space == "right-anterior-superior" || space == "ras") return Vec3{-1, -1, 1};
    if (space == "left-anterior-superior" || space == "las") return Vec3{1, -1, 1};
    if (space == "left-posterior-superior" || space == "lps") return Vec3{1, 1, 1};
    if (kOthers.count(space) == 0)
        throw FileError("the space " + inQuotes(header.get("space")) + " is not known", path, "correct the header");
    return {};
}

/// Millimetres of the header's unit of length; 1 where it names none that is known.
double millimetresIn(const NrrdHeader& header) {
    const std::string units = lowerCase(header.get("spaceunits"));
    const std::size_t begin = units.find_first_not_of("\" ");
    if (begin == std::string::npos) return 1;
    const std::string unit = units.substr(begin, units.find_first_of("\" ", begin) - begin);
    static const std::map<std::string, double> kUnits{{"m", 1e3}, {"cm", 10}, {"um", 1e-3}, {"µm", 1e-3}, {"nm", 1e-6}};
    const auto it = kUnits.find(unit);
    return it == kUnits.end() ? 1 : it->second;
}

/// The number of axis `a` in a field of numbers; NaN where there is none.
double numberOfAxis(const std::vector<std::string>& words, std::size_t a) {
    double value = 0;
    if (words.empty() || !parseNumber(words[a], value)) return std::numeric_limits<double>::quiet_NaN();
    return value;
}

/// What the header says of its axes one by one, with no direction in space.
class AxisFields {
public:
    AxisFields(const NrrdHeader& header, const std::vector<FileAxis>& axes, const std::string& path)
        : m_axes(axes), m_spacings(wordsPerAxis(header, "spacings", axes.size(), path)),
          m_mins(wordsPerAxis(header, "axismins", axes.size(), path)),
          m_maxs(wordsPerAxis(header, "axismaxs", axes.size(), path)),
          m_centers(wordsPerAxis(header, "centers", axes.size(), path)) {
        if (m_centers.empty()) m_centers = wordsPerAxis(header, "centerings", axes.size(), path);
    }

    bool hasFirst() const { return !m_mins.empty() && !(m_maxs.empty() && m_spacings.empty()); }
    double min(std::size_t a) const { return numberOfAxis(m_mins, a); }
    /// From sample to sample as "spacings" says; NaN where it does not.
    double spacing(std::size_t a) const { return numberOfAxis(m_spacings, a); }
    const std::vector<std::string>& spacings() const { return m_spacings; }
    /// From sample to sample as "axis mins" and "axis maxs" say: where samples are nodes they are those of the first
    /// and the last one, where they are cells, as without a word, of the ends of these. NaN where they do not say.
    double spread(std::size_t a) const {
        const auto intervals = static_cast<double>(m_axes[a].size - (isOfNodes(a) ? 1 : 0));
        return intervals > 0 ? (numberOfAxis(m_maxs, a) - min(a)) / intervals
                             : std::numeric_limits<double>::quiet_NaN();
    }
    /// spacing(), or where there is none spread().
    double width(std::size_t a) const { return std::isnan(spacing(a)) ? spread(a) : spacing(a); }
    /// Where the first sample is, by "axis mins".
    double first(std::size_t a) const { return isOfNodes(a) ? min(a) : min(a) + 0.5 * width(a); }

private:
    bool isOfNodes(std::size_t a) const { return !m_centers.empty() && lowerCase(m_centers[a]) == "node"; }

    const std::vector<FileAxis>& m_axes;
    std::vector<std::string> m_spacings, m_mins, m_maxs, m_centers;
};

/// Without a named space: the first voxel's centre after "axis mins", where each axis in space has one and a width.
void placeByMins(FileLayout& layout, const AxisFields& fields, const std::vector<std::size_t>& inSpace,
                 const std::string& path) {
    if (!fields.hasFirst()) return;
    for (std::size_t i = 0; i < inSpace.size(); ++i) {
        const double first = fields.first(inSpace[i]);
        if (!std::isfinite(first))
            throw FileError("the header does not tell where axis " + std::to_string(inSpace[i]) + " begins", path,
                            "correct axis mins and axis maxs");
        layout.origin[static_cast<int>(i)] = first;
    }
}

/// Spacing, origin and directions. A negative spacing is refused: its absolute value would give a volume that looks
/// right and is not.
void placeGrid(FileLayout& layout, const NrrdHeader& header, const std::string& path) {
    const std::size_t axes = layout.axes.size();
    const AxisFields fields(header, layout.axes, path);
    const auto directions = wordsPerAxis(header, "spacedirections", axes, path);
    const std::optional<Vec3> patient = flipOfSpace(header, path);
    const Vec3 flip = patient.value_or(Vec3(1));
    layout.frame = patient ? Frame::Patient : Frame::File;
    const double unit = patient ? millimetresIn(header) : 1;
    std::vector<std::size_t> inSpace;
    for (std::size_t a = 0; a < axes && inSpace.size() < 3; ++a)
        if (!layout.axes[a].components && !layout.axes[a].time) inSpace.push_back(a);
    for (std::size_t i = 0; i < inSpace.size(); ++i) {
        const std::size_t a = inSpace[i];
        std::string text = "1";
        if (!directions.empty() && !isNone(directions[a])) {
            text = directions[a];
            const std::vector<double> vector = vectorIn(text, path);
            double square = 0;
            for (const double v : vector) square += v * v;
            const double length = std::sqrt(square);
            layout.spacing[static_cast<int>(i)] = length;
            if (std::abs(fields.spacing(a) - length) > 1e-6 * length)
                throw FileError("the header gives two spacings of axis " + std::to_string(a), path,
                                "correct spacings or space directions");
            Vec3 direction(0);
            for (int c = 0; c < 3 && static_cast<std::size_t>(c) < vector.size(); ++c)
                direction[c] = flip[c] * vector[static_cast<std::size_t>(c)] / length;
            layout.directions[static_cast<int>(i)] = cleanDirection(direction);
        } else if (!std::isnan(fields.spread(a)) && std::isnan(fields.spacing(a))) {
            text = plainText(fields.spread(a));
            layout.spacing[static_cast<int>(i)] = fields.spread(a);
        } else if (!fields.spacings().empty()) {
            text = fields.spacings()[a];
            layout.spacing[static_cast<int>(i)] = fields.spacing(a);
            if (std::abs(fields.spread(a) - fields.spacing(a)) > 1e-3 * fields.spacing(a))
                layout.notices.push_back("the header's spacings and axis mins and maxs differ along axis " +
                                         std::to_string(a) + ": spacings counts");
        }
        const double spacing = layout.spacing[static_cast<int>(i)] *= unit;
        if (!(spacing > 0) || !std::isfinite(spacing))
            throw FileError("the spacing of axis " + std::to_string(a) + " is " + inQuotes(text) +
                                ", it must be positive and finite",
                            path, "correct the header");
    }
    const std::vector<std::string> origin = splitVectors(header.get("spaceorigin"));
    if (origin.empty() && directions.empty()) placeByMins(layout, fields, inSpace, path);
    if (origin.empty() || isNone(origin.front())) return;
    const std::vector<double> place = vectorIn(origin.front(), path);
    for (std::size_t c = 0; c < std::min(place.size(), inSpace.size()); ++c)
        layout.origin[static_cast<int>(c)] = flip[static_cast<int>(c)] * place[c] * unit;
}

/// The n-th of the texts in quotes of a field.
std::string quotedWord(const std::string& text, std::size_t n) {
    std::size_t begin = text.find('"');
    for (; n > 0 && begin != std::string::npos; --n) {
        begin = text.find('"', begin + 1);
        if (begin != std::string::npos) begin = text.find('"', begin + 1);
    }
    if (begin == std::string::npos) return {};
    const std::size_t end = text.find('"', begin + 1);
    return end == std::string::npos ? std::string() : trimmed(text.substr(begin + 1, end - begin - 1)).substr(0, 40);
}

/// When the steps are, where they lie along one axis whose width the header gives.
std::optional<StepTimes> timesIn(const FileLayout& layout, const NrrdHeader& header, const std::string& path) {
    const std::size_t axes = layout.axes.size();
    std::size_t inSpace = 0, time = axes;
    for (std::size_t a = 0; a < axes; ++a) {
        if (layout.axes[a].components || (!layout.axes[a].time && ++inSpace <= 3)) continue;
        if (time < axes) return {}; // steps of steps
        time = a;
    }
    if (time == axes) return {};
    const auto directions = wordsPerAxis(header, "spacedirections", axes, path);
    StepTimes times;
    const AxisFields fields(header, layout.axes, path);
    times.width = fields.width(time);
    if (std::isfinite(fields.min(time))) times.first = fields.min(time);
    if (!directions.empty() && !isNone(directions[time])) { // of a space with time as its last axis
        const std::vector<double> vector = vectorIn(directions[time], path);
        const std::vector<std::string> origin = splitVectors(header.get("spaceorigin"));
        if (vector.size() == 4) {
            times.width = vector[3];
            times.unit = quotedWord(header.get("spaceunits"), 3);
            if (!origin.empty() && !isNone(origin.front()))
                if (const std::vector<double> place = vectorIn(origin.front(), path); place.size() == 4)
                    times.first = place[3];
        }
    }
    if (times.unit.empty()) times.unit = quotedWord(header.get("units"), time);
    if (times.unit == "???" || times.unit == "none") times.unit.clear();
    if (!(times.width > 0) || !std::isfinite(times.width)) return {};
    return times;
}

/// Bytes of `lines` lines from byte `start` of a file; more than any file has where there are fewer lines.
std::uint64_t bytesOfLines(const std::string& path, std::uint64_t start, std::int64_t lines) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(start));
    for (std::int64_t i = 0; i < lines && in; ++i) in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    return in ? static_cast<std::uint64_t>(in.tellg()) - start : std::numeric_limits<std::int64_t>::max() / 2;
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

/// The file that holds the samples.
std::string dataPathIn(const NrrdHeader& header, const std::string& path) {
    const std::string dataFile = header.get("datafile");
    if (dataFile.empty()) return path;
    if (dataFile.rfind("LIST", 0) == 0 || dataFile.rfind("SKIPLIST", 0) == 0 || dataFile.find('%') != std::string::npos)
        throw FileError("a data file in several parts is not supported", path, "write it as one file");
    if (dataFile.size() > 1000) throw FileError("the name of the data file is too long", path, "correct the header");
    const fs::path data(dataFile);
    return (data.is_absolute() ? data : fs::path(path).parent_path() / data).string();
}

/// `step`: the one to be read, for which everything is checked; empty: nothing but the header is looked at.
FileLayout checkedLayout(const std::string& path, std::optional<int> step, const JobControl& job) {
    const NrrdHeader header = parseHeader(path);
    const std::vector<std::int64_t> sizes = sizesIn(header, path);
    FileLayout layout;
    for (const std::int64_t size : sizes) layout.axes.push_back({size, false});
    layout.type = typeIn(header, path);
    const std::uint64_t values = valuesIn(layout, path);
    const std::uint64_t bytesPer = bytesPerValue(layout.type);
    const std::uint64_t bytes = values * bytesPer;
    const std::size_t components = componentAxis(header, sizes, path);
    if (components < sizes.size()) layout.axes[components].components = true;
    const std::vector<std::string> kinds = wordsPerAxis(header, "kinds", sizes.size(), path);
    for (std::size_t a = 0; a < kinds.size(); ++a) layout.axes[a].time = lowerCase(kinds[a]) == "time";
    placeGrid(layout, header, path);
    layout.encoding = encodingIn(header, path);
    layout.bigEndian = isBigEndian(header, bytesPer, layout.encoding, path);

    layout.dataPath = dataPathIn(header, path);
    layout.times = timesIn(layout, header, path);
    if (!step) return layout;
    const std::uint64_t wanted = valuesUpTo(layout, *step);
    const bool detached = !header.get("datafile").empty();
    const std::uint64_t fileBytes = dataFileBytes(layout.dataPath, path);
    const std::int64_t lineSkip = wholeNumber(header, "lineskip", 0, path);
    const std::int64_t byteSkip = wholeNumber(header, "byteskip", 0, path);
    if (lineSkip < 0 || byteSkip < -1)
        throw FileError("the header skips a negative number of lines or bytes", path, "correct the header");
    const bool fromEnd = byteSkip == -1; // the data end where the file, unpacked, ends
    if (fromEnd && layout.encoding != Encoding::Raw && layout.encoding != Encoding::Deflate)
        throw FileError("the header gives a byte skip of -1, which text cannot have", path, "correct the header");
    layout.start = detached ? 0 : std::min(header.dataStart, fileBytes);
    if (lineSkip > 0) layout.start += bytesOfLines(layout.dataPath, layout.start, lineSkip);
    if (byteSkip > 0) // in compressed data, of what comes out
        (layout.encoding == Encoding::Deflate ? layout.skip : layout.start) += static_cast<std::uint64_t>(byteSkip);
    const std::uint64_t stored = fileBytes - std::min(layout.start, fileBytes);

    requireStored(layout.dataPath, layout.encoding, fromEnd ? values : wanted, bytesPer, stored,
                  "check sizes and type in the header, or copy the file again");
    if (layout.encoding == Encoding::Text) requireNumbers(layout.dataPath, layout.start, wanted, job);
    if (layout.encoding == Encoding::Deflate && !fromEnd) requireInflated(layout, layout.skip + wanted * bytesPer, job);
    if (layout.encoding == Encoding::Deflate && fromEnd)
        layout.skip = requireInflatesToEnd(layout.dataPath, layout.start, bytes, job) - bytes;
    if (layout.encoding == Encoding::Raw && fromEnd) layout.start = fileBytes - bytes;
    if (layout.encoding == Encoding::Raw && !fromEnd && stored > bytes)
        layout.notices.push_back("the data has " + std::to_string(stored - bytes) + " bytes more than the header says");
    return layout;
}

class NrrdReader final : public VolumeReader {
public:
    const char* name() const override { return "NRRD"; }
    const std::vector<std::string>& suffixes() const override {
        static const std::vector<std::string> kSuffixes{".nrrd", ".nhdr"};
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

const VolumeReader& nrrdReader() {
    static const NrrdReader reader;
    return reader;
}

} // namespace pellucid
