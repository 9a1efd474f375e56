// NRRD and its detached form NHDR (teem's "nearly raw raster data"), versions 1 to 5.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/round_numbers.h"
#include "volume/formats/data_files.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The fields of a header: names in lower case without blanks ("spacedirections"), since writers differ in both.
TextHeader parseHeader(const std::string& path) {
    if (const std::string head = fileHead(path, 1024); !head.starts_with("NRRD000"))
        throw notOfFormat("an NRRD file", path, head);
    return TextHeader(path, [isList = false](TextHeader& header, const std::string& line) mutable {
        if (isList) { // names to the end of the file
            if (!line.empty()) header.addListed(line);
            return true;
        }
        const std::size_t colon = line.find(':');
        const bool isField = colon != std::string::npos && line.compare(colon, 2, ":=") != 0;
        if (line.starts_with('#') || line.starts_with("NRRD000") || !isField) return !line.empty(); // a blank line ends
        std::string name = lowerCase(line.substr(0, colon));
        std::erase(name, ' ');
        if (header.has(name)) header.fail("the header gives " + inQuotes(name) + " twice");
        header.set(name, trimmed(line.substr(colon + 1)));
        isList = name == "datafile" && isListOfFiles(header, name);
        return true;
    });
}

ValueType typeIn(const TextHeader& header) {
    static const std::map<ValueType, std::set<std::string>> kNames{
        {ValueType::I8, {"signed char", "int8", "int8_t"}},
        {ValueType::U8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
        {ValueType::I16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
        {ValueType::U16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
        {ValueType::I32, {"int", "signed int", "int32", "int32_t"}},
        {ValueType::U32, {"uint", "unsigned int", "uint32", "uint32_t"}},
        {ValueType::I64,
         {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"}},
        {ValueType::U64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
        {ValueType::F32, {"float"}},
        {ValueType::F64, {"double"}}};
    const std::string given = header.get("type");
    for (const auto& [type, names] : kNames)
        if (names.contains(lowerCase(given))) return type;
    header.fail(given.empty() ? "the header names no type" : "the type " + inQuotes(given) + " is not supported",
                "the types are signed and unsigned integers of 8 to 64 bits, float and double");
}

bool isBigEndian(const TextHeader& header, const FileLayout& layout) {
    const std::string endian = lowerCase(header.get("endian"));
    if (endian == "big" || endian == "little") return endian == "big";
    if (!endian.empty() || (bytesPerValue(layout.type) > 1 && layout.encoding != Encoding::Text))
        header.fail(endian.empty() ? "the header gives no byte order"
                                   : "the byte order " + inQuotes(endian) + " is not known",
                    "correct its field endian: little or big");
    return false;
}

/// "none (1,0,0) (0,1,0)": one word per axis; blanks inside the brackets are allowed.
std::vector<std::string> splitVectors(const std::string& text) {
    std::string spaced;
    bool inside = false;
    for (const char c : text) {
        inside = c == '(' || (inside && c != ')');
        if (!inside || (c != ' ' && c != '\t')) spaced += c;
        if (c == ')') spaced += ' ';
    }
    return splitWords(spaced);
}

/// The numbers of "(x,y,z)". Throws FileError where they cannot be read or are not finite.
std::vector<double> vectorIn(const std::string& text, const TextHeader& header) {
    std::vector<double> numbers;
    const std::string inside = text.substr(0, text.size() - 1).erase(0, 1);
    for (const std::string& word : splitAt(',', inside)) numbers.push_back(numberIn(word));
    const bool areFinite = std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
    if (!text.starts_with('(') || !text.ends_with(')') || numbers.empty() || !areFinite)
        header.fail(inQuotes(text) + " is not a vector of numbers");
    return numbers;
}

/// The words of a field with one for each axis; empty where there is no such field.
std::vector<std::string> wordsPerAxis(const TextHeader& header, const std::string& field, std::size_t axes) {
    const bool vectors = field == "spacedirections";
    const std::vector<std::string> words = vectors ? splitVectors(header.get(field)) : splitWords(header.get(field));
    if (!words.empty() && words.size() != axes)
        header.fail("the header's field " + inQuotes(field) + " has " + std::to_string(words.size()) + " words for " +
                    std::to_string(axes) + " axes");
    return words;
}

bool isNone(const std::string& word) { return word == "none" || word == "???"; }

/// How many entries an axis of this kind has; 0: any number. Throws FileError for a kind that NRRD does not know.
std::int64_t entriesOfKind(const std::string& kind, const std::string& axis, const TextHeader& header) {
    static const std::map<std::int64_t, std::set<std::string>> kKinds{
        {0, {"list", "point", "vector", "covariant-vector", "normal"}},
        {1, {"stub", "scalar"}},
        {2, {"complex", "2-vector"}},
        {3,
         {"3-color", "rgb-color", "hsv-color", "xyz-color", "3-vector", "3-gradient", "3-normal",
          "2d-symmetric-matrix"}},
        {4, {"4-color", "rgba-color", "4-vector", "quaternion", "2d-masked-symmetric-matrix", "2d-matrix"}},
        {5, {"2d-masked-matrix"}},
        {6, {"3d-symmetric-matrix"}},
        {7, {"3d-masked-symmetric-matrix"}},
        {9, {"3d-matrix"}},
        {10, {"3d-masked-matrix"}}};
    for (const auto& [entries, kinds] : kKinds)
        if (kinds.contains(kind)) return entries;
    header.fail("the kind " + inQuotes(kind) + " of axis " + axis + " is not known");
}

/// Says of each axis what lies along it, by its kind. An axis without a kind has the components of a voxel where it has
/// no direction in space; a list, or an axis without a kind, behind three axes in space has time steps.
void setKinds(std::vector<FileAxis>& axes, const TextHeader& header) {
    const std::vector<std::string> kinds = wordsPerAxis(header, "kinds", axes.size());
    const std::vector<std::string> directions = wordsPerAxis(header, "spacedirections", axes.size());
    std::size_t inSpace = 0;
    bool found = false;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const std::string kind = kinds.empty() ? "none" : lowerCase(kinds[a]), axis = std::to_string(a);
        axes[a].time = kind == "time";
        if (axes[a].time || (inSpace >= 3 && (isNone(kind) || kind == "list"))) continue;
        const bool hasDirection = directions.empty() || !isNone(directions[a]);
        if (kind == "domain" || kind == "space" || (isNone(kind) && hasDirection)) {
            ++inSpace;
            continue;
        }
        const std::int64_t entries = isNone(kind) ? 0 : entriesOfKind(kind, axis, header);
        if (entries != 0 && entries != axes[a].size)
            header.fail("axis " + axis + " of kind " + kind + " has " + std::to_string(axes[a].size) +
                        " entries, not " + std::to_string(entries));
        if (std::exchange(found, true))
            header.fail("more than one axis has components of a voxel", "write one file for each component");
        axes[a].components = true;
    }
    if (inSpace == 0) header.fail("no axis lies in space");
}

/// What turns the header's space into ours, whose axes go to the left, the back and the top; empty where the header's
/// space knows of no patient.
std::optional<Vec3> flipOfSpace(const TextHeader& header) {
    std::string space = lowerCase(header.get("space"));
    static const std::set<std::string> kInTime{"rast", "last", "lpst"};
    static const std::set<std::string> kWithoutPatient{"", "scanner-xyz", "3d-right-handed", "3d-left-handed"};
    // Four axes: "rast", or a long name, which has another "-" before.
    if (space.ends_with("-time") && space.find('-') < space.size() - 5) space.resize(space.size() - 5);
    if (kInTime.contains(space)) space.resize(3);
    if (space == "right-anterior-superior" || space == "ras") return Vec3{-1, -1, 1};
    if (space == "left-anterior-superior" || space == "las") return Vec3{1, -1, 1};
    if (space == "left-posterior-superior" || space == "lps") return Vec3{1, 1, 1};
    if (!kWithoutPatient.contains(space)) header.fail("the space " + inQuotes(header.get("space")) + " is not known");
    return {};
}

/// The n-th of the texts in quotes of a field; in them, \" is a quote.
std::string quotedWord(const std::string& text, std::size_t n) {
    constexpr std::size_t kMostUnit = 40; // bytes
    std::string word;
    bool isInside = false;
    std::size_t count = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const bool isEscaped = isInside && text[at] == '\\' && at + 1 < text.size() && text[at + 1] == '"';
        if (text[at] == '"') {
            if (isInside && count++ == n) return trimmed(word).substr(0, kMostUnit);
            isInside = !isInside;
            word.clear();
        } else if (isInside) {
            word += text[isEscaped ? ++at : at];
        }
    }
    return {};
}

/// The units of the first axes in space, as the header names them in "space units" or else for each of these axes of
/// the file; empty where it names none.
std::vector<std::string> unitsIn(const TextHeader& header, const std::vector<std::size_t>& inSpace) {
    const bool areOfSpace = header.has("spaceunits");
    const std::string text = header.get(areOfSpace ? "spaceunits" : "units");
    const std::vector<std::string> words = splitWords(text);
    std::vector<std::string> units;
    for (std::size_t i = 0; i < inSpace.size(); ++i) {
        const std::size_t n = areOfSpace ? i : inSpace[i]; // in quotes, as it should be, or not
        std::string unit =
            text.find('"') != std::string::npos ? quotedWord(text, n) : (n < words.size() ? words[n] : std::string());
        if (!unit.empty() && !isNone(unit)) units.push_back(std::move(unit));
    }
    return units;
}

/// The header's unit of length; Unknown where it names none that is known or, where no patient is, not one for each
/// axis. Throws FileError where axes have different ones.
LengthUnit lengthUnitIn(const TextHeader& header, const std::vector<std::size_t>& inSpace, bool ofPatient,
                        std::vector<std::string>& notices) {
    const std::vector<std::string> units = unitsIn(header, inSpace);
    if (units.empty()) return LengthUnit::Unknown;
    const auto first = lengthUnitNamed(units.front());
    for (const std::string& unit : units) {
        const auto other = lengthUnitNamed(unit);
        if (first && other ? first == other : lowerCase(unit) == lowerCase(units.front())) continue;
        const std::string differ =
            "the header measures axes in different units, " + inQuotes(units.front()) + " and " + inQuotes(unit);
        if (ofPatient || (first && other)) header.fail(differ, "convert them, and correct space units or units");
        notices.push_back(printable(differ) + ": their numbers are taken as they are");
        return LengthUnit::Unknown;
    }
    if (!first && ofPatient)
        notices.push_back("the unit of length " + printable(inQuotes(units.front())) +
                          " is not known: millimetres are assumed");
    const bool isOfAll = ofPatient || units.size() == inSpace.size();
    return isOfAll ? first.value_or(LengthUnit::Unknown) : LengthUnit::Unknown;
}

/// What the header says of its axes one by one, with no direction in space. Numbers are NaN where it does not say.
class AxisFields {
public:
    AxisFields(const TextHeader& header, const std::vector<FileAxis>& axes)
        : m_axes(axes), m_spacings(wordsPerAxis(header, "spacings", axes.size())),
          m_mins(wordsPerAxis(header, "axismins", axes.size())), m_maxs(wordsPerAxis(header, "axismaxs", axes.size())),
          m_centers(wordsPerAxis(header, "centers", axes.size())) {
        if (m_centers.empty()) m_centers = wordsPerAxis(header, "centerings", axes.size());
    }

    bool hasFirst() const { return !m_mins.empty() && !(m_maxs.empty() && m_spacings.empty()); }
    double min(std::size_t a) const { return numberOf(m_mins, a); }
    double spacing(std::size_t a) const { return numberOf(m_spacings, a); }
    const std::vector<std::string>& spacings() const { return m_spacings; }
    /// From sample to sample as "axis mins" and "axis maxs" say: where samples are nodes they are those of the first
    /// and the last one, where they are cells, as without a word, of the ends of these.
    double spread(std::size_t a) const {
        const auto intervals = static_cast<double>(m_axes[a].size - (isOfNodes(a) ? 1 : 0));
        return intervals > 0 ? (numberOf(m_maxs, a) - min(a)) / intervals : kNaN;
    }
    /// spacing(), or where there is none spread().
    double width(std::size_t a) const { return std::isnan(spacing(a)) ? spread(a) : spacing(a); }
    /// Where the first sample is, by "axis mins".
    double first(std::size_t a) const { return isOfNodes(a) ? min(a) : min(a) + 0.5 * width(a); }

private:
    static double numberOf(const std::vector<std::string>& words, std::size_t a) {
        return words.empty() ? kNaN : numberIn(words[a]);
    }
    bool isOfNodes(std::size_t a) const { return !m_centers.empty() && lowerCase(m_centers[a]) == "node"; }

    const std::vector<FileAxis>& m_axes;
    std::vector<std::string> m_spacings, m_mins, m_maxs, m_centers;
};

/// Without a named space: the first voxel's centre after "axis mins", where each axis in space has one and a width.
void placeByMins(FileLayout& layout, const AxisFields& fields, const std::vector<std::size_t>& inSpace,
                 const TextHeader& header) {
    if (!fields.hasFirst()) return;
    for (std::size_t i = 0; i < inSpace.size(); ++i) {
        const double first = fields.first(inSpace[i]);
        if (!std::isfinite(first))
            header.fail("the header does not tell where axis " + std::to_string(inSpace[i]) + " begins",
                        "correct axis mins and axis maxs");
        layout.origin[static_cast<int>(i)] = first;
    }
}

/// Spacing, origin and directions. A negative spacing is refused: its absolute value would give a volume that looks
/// right and is not.
void placeGrid(FileLayout& layout, const TextHeader& header) {
    const std::size_t axes = layout.axes.size();
    const AxisFields fields(header, layout.axes);
    const auto directions = wordsPerAxis(header, "spacedirections", axes);
    const std::optional<Vec3> patient = flipOfSpace(header);
    const Vec3 flip = patient.value_or(Vec3(1));
    layout.worldAxes = patient ? WorldAxes::Patient : WorldAxes::File;
    std::vector<std::size_t> inSpace;
    for (std::size_t a = 0; a < axes && inSpace.size() < 3; ++a)
        if (!layout.axes[a].components && !layout.axes[a].time) inSpace.push_back(a);
    // Where there is no patient, lengths stay in the unit of the file.
    const LengthUnit ofFile = lengthUnitIn(header, inSpace, patient.has_value(), layout.notices);
    if (!patient) layout.lengthUnit = ofFile;
    const double unit = patient ? converted(1, ofFile, LengthUnit::Millimetre) : 1;
    for (std::size_t i = 0; i < inSpace.size(); ++i) {
        const std::size_t a = inSpace[i];
        double& spacing = layout.spacing[static_cast<int>(i)];
        std::string text = "1";
        if (!directions.empty() && !isNone(directions[a])) {
            text = directions[a];
            const std::vector<double> vector = vectorIn(text, header);
            double square = 0;
            for (const double v : vector) square += v * v;
            spacing = std::sqrt(square);
            if (std::abs(fields.spacing(a) - spacing) > 1e-6 * spacing)
                header.fail("the header gives two spacings of axis " + std::to_string(a),
                            "correct spacings or space directions");
            Vec3 direction(0);
            for (int c = 0; c < 3 && static_cast<std::size_t>(c) < vector.size(); ++c)
                direction[c] = flip[c] * vector[static_cast<std::size_t>(c)] / spacing;
            layout.directions[static_cast<int>(i)] = cleanDirection(direction);
        } else if (!std::isnan(fields.spread(a)) && std::isnan(fields.spacing(a))) {
            spacing = fields.spread(a);
            text = plainText(spacing);
        } else if (!fields.spacings().empty()) {
            spacing = fields.spacing(a);
            text = fields.spacings()[a];
            if (std::abs(fields.spread(a) - spacing) > 1e-3 * spacing)
                layout.notices.push_back("the header's spacings and axis mins and maxs differ along axis " +
                                         std::to_string(a) + ": spacings counts");
        }
        spacing *= unit;
        requireSpacing(spacing, a, text, header.path());
    }
    const bool hasComponents = std::ranges::any_of(layout.axes, [](const FileAxis& axis) { return axis.components; });
    const std::string frame = joined(splitVectors(header.get("measurementframe")), " ");
    if (hasComponents && !frame.empty() && frame != "(1,0,0) (0,1,0) (0,0,1)")
        layout.notices.emplace_back("the header's measurement frame is not applied: components are shown as stored");
    const std::vector<std::string> origin = splitVectors(header.get("spaceorigin"));
    if (origin.empty() && directions.empty()) placeByMins(layout, fields, inSpace, header);
    if (origin.empty() || isNone(origin.front())) return;
    const std::vector<double> place = vectorIn(origin.front(), header);
    for (std::size_t c = 0; c < std::min(place.size(), inSpace.size()); ++c)
        layout.origin[static_cast<int>(c)] = flip[static_cast<int>(c)] * place[c] * unit;
}

/// When the steps are, where they lie along one axis whose width the header gives.
std::optional<StepTimes> timesIn(const FileLayout& layout, const TextHeader& header) {
    const std::size_t axes = layout.axes.size();
    std::size_t inSpace = 0, time = axes;
    for (std::size_t a = 0; a < axes; ++a) {
        if (layout.axes[a].components || (!layout.axes[a].time && ++inSpace <= 3)) continue;
        if (time < axes) return {}; // steps of steps
        time = a;
    }
    if (time == axes) return {};
    const auto directions = wordsPerAxis(header, "spacedirections", axes);
    StepTimes times;
    const AxisFields fields(header, layout.axes);
    times.width = fields.width(time);
    if (std::isfinite(fields.min(time))) times.first = fields.min(time);
    if (!directions.empty() && !isNone(directions[time])) { // of a space with time as its last axis
        const std::vector<double> vector = vectorIn(directions[time], header);
        const std::vector<std::string> origin = splitVectors(header.get("spaceorigin"));
        if (vector.size() == 4) {
            times.width = vector[3];
            times.unit = quotedWord(header.get("spaceunits"), 3);
            if (!origin.empty() && !isNone(origin.front()))
                if (const std::vector<double> place = vectorIn(origin.front(), header); place.size() == 4)
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

Encoding encodingIn(const TextHeader& header) {
    const std::string name = lowerCase(header.get("encoding"));
    if (name == "raw") return Encoding::Raw;
    if (name == "gzip" || name == "gz") return Encoding::Deflate;
    if (name == "bzip2" || name == "bz2") return Encoding::Bzip2;
    if (name == "ascii" || name == "text" || name == "txt") return Encoding::Text;
    if (name == "hex") return Encoding::Hex;
    header.fail(name.empty() ? "the header names no encoding" : "the encoding " + inQuotes(name) + " is not supported",
                "write it with encoding raw, gzip or bzip2");
}

/// The files that hold the samples.
DataFiles filesIn(const TextHeader& header) {
    if (header.get("datafile").empty()) return {{header.path()}, {}};
    return dataFilesIn(header, "datafile", [&] { return header.sizes("sizes", "dimension", 16); });
}

/// Where the data lie, checked up to the end of `step`.
void placeData(FileLayout& layout, const TextHeader& header, int step, const JobControl& job) {
    const std::uint64_t fileBytes = dataFileBytes(layout.dataPath, header.path());
    const std::int64_t lineSkip = header.wholeNumber("lineskip", 0), byteSkip = header.wholeNumber("byteskip", 0);
    if (lineSkip < 0 || byteSkip < -1) header.fail("the header skips a negative number of lines or bytes");
    const bool fromEnd = byteSkip == -1;
    const bool packed = layout.encoding == Encoding::Deflate || layout.encoding == Encoding::Bzip2;
    if (fromEnd && layout.encoding != Encoding::Raw && !packed)
        header.fail("the header gives a byte skip of -1, which text cannot have");
    layout.start = header.get("datafile").empty() ? std::min(header.dataStart(), fileBytes) : 0;
    if (lineSkip > 0) layout.start += bytesOfLines(layout.dataPath, layout.start, lineSkip);
    if (byteSkip > 0) // in compressed data, of what comes out
        (packed ? layout.skip : layout.start) += static_cast<std::uint64_t>(byteSkip);
    const std::uint64_t stored = fileBytes - std::min(layout.start, fileBytes);
    const char* toDo = "check sizes and type in the header, or copy the file again";
    if (!fromEnd) return requireData(layout, stored, valuesUpTo(layout, step), toDo, job);
    // The data end where the file, unpacked, ends.
    const std::uint64_t values = valuesIn(layout, header.path()), bytesPer = bytesPerValue(layout.type);
    requireStored(layout.dataPath, layout.encoding, values, bytesPer, stored, toDo);
    const std::uint64_t bytes = values * bytesPer;
    if (packed)
        layout.skip = requireSoundToEnd(*unpackedBytes(layout, job), bytes, layout.dataPath) - bytes;
    else
        layout.start = fileBytes - bytes;
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const TextHeader header = parseHeader(source.path);
    if (header.get("dimension").empty())
        header.fail("the header gives no dimension", "correct the header, or copy the file again");
    FileLayout layout;
    for (const std::int64_t size : header.sizes("sizes", "dimension", 16)) layout.axes.push_back({size});
    layout.type = typeIn(header);
    valuesIn(layout, source.path); // throws where they are too many to count
    setKinds(layout.axes, header);
    placeGrid(layout, header);
    layout.encoding = encodingIn(header);
    layout.bigEndian = isBigEndian(header, layout);
    const DataFiles files = filesIn(header);
    layout.dataPath = files.paths.front();
    layout.times = timesIn(layout, header);
    if (!step) return layout;
    if (files.share.empty())
        placeData(layout, header, *step, job);
    else
        placeParts(layout, files.paths, files.share, *step, [&](FileLayout& part) { placeData(part, header, 0, job); });
    return layout;
}

std::vector<std::string> dataFiles(const std::string& path) { return filesIn(parseHeader(path)).paths; }

} // namespace

VolumeFormat nrrdFormat() {
    return {"NRRD", {".nrrd", ".nhdr"}, describeLayout<layoutOf>, readLayout<layoutOf>, dataFiles, kNrrdContent};
}

} // namespace pellucid
