// MetaImage: .mha (header and data in one file) and .mhd (header beside a data file).
#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>

#include "base/round_numbers.h"
#include "volume/formats/data_files.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"

namespace pellucid {

namespace {

TextHeader parseHeader(const std::string& path) {
    TextHeader header(path, [isList = false](TextHeader& fields, const std::string& line) mutable {
        if (isList) { // names to the end of the file
            if (!line.empty()) fields.addListed(line);
            return true;
        }
        const std::size_t sign = line.find_first_of("=:");
        if (sign == std::string::npos) return line.empty();
        const std::string name = trimmed(line.substr(0, sign)), value = trimmed(line.substr(sign + 1));
        if (fields.has(name) && fields.get(name) != value) fields.fail("the header gives " + inQuotes(name) + " twice");
        fields.set(name, value);
        if (name != "ElementDataFile") return true;
        isList = isListOfFiles(fields, name);
        return isList; // otherwise it ends the header
    });
    if (!header.has("NDims") && !header.has("ObjectType"))
        throw notOfFormat("a MetaImage file", path, fileHead(path, 1024));
    for (const char* name : {"NDims", "DimSize", "ElementType", "ElementDataFile"})
        if (header.get(name).empty())
            header.fail("the header has no " + std::string(name), "correct the header, or copy the file again");
    if (const std::string object = header.get("ObjectType"); !object.empty() && object != "Image")
        header.fail("this MetaIO file holds an object of type " + inQuotes(object) + ", not an image", "");
    return header;
}

bool isTrue(const TextHeader& header, const std::string& name) {
    const std::string value = header.get(name);
    return !value.empty() && std::string_view("Tt1").find(value.front()) != std::string_view::npos;
}

bool isLocal(const TextHeader& header) { return lowerCase(header.get("ElementDataFile")) == "local"; }

ValueType typeIn(const TextHeader& header) {
    static const std::map<std::string, ValueType> kTypes{
        {"MET_CHAR", ValueType::I8},        {"MET_UCHAR", ValueType::U8},  {"MET_SHORT", ValueType::I16},
        {"MET_USHORT", ValueType::U16},     {"MET_INT", ValueType::I32},   {"MET_UINT", ValueType::U32},
        {"MET_LONG", ValueType::I32},       {"MET_ULONG", ValueType::U32}, {"MET_LONG_LONG", ValueType::I64},
        {"MET_ULONG_LONG", ValueType::U64}, {"MET_FLOAT", ValueType::F32}, {"MET_DOUBLE", ValueType::F64}};
    const std::string given = header.get("ElementType");
    std::string type = given;
    if (type.size() > 6 && type.ends_with("_ARRAY")) type.resize(type.size() - 6);
    if (const auto it = kTypes.find(type); it != kTypes.end()) return it->second;
    header.fail("the ElementType " + inQuotes(given) + " is not supported",
                "use one of MET_CHAR, MET_UCHAR, … MET_FLOAT, MET_DOUBLE");
}

/// The numbers of the first of `names` that the header has; empty where it has none. Throws FileError unless they are
/// finite and at least `count`.
std::vector<double> numbersIn(const TextHeader& header, std::initializer_list<const char*> names, std::size_t count) {
    for (const char* name : names) {
        const std::vector<double> numbers = finiteNumbers(header.get(name), name, header.path());
        if (numbers.empty()) continue;
        if (numbers.size() < count)
            header.fail("the header gives " + std::to_string(numbers.size()) + " of " + std::to_string(count) +
                        " numbers as " + name);
        return numbers;
    }
    return {};
}

std::vector<double> originIn(const TextHeader& header, std::size_t axes) {
    return numbersIn(header, {"Origin", "Offset", "Position"}, axes);
}

/// ElementSpacing, or ElementSize where there is none. Each must be positive, since its absolute value would give a
/// volume that looks right and is not.
Vec3 spacingIn(const TextHeader& header, std::size_t axes) {
    Vec3 spacing(1);
    for (const char* field : {"ElementSize", "ElementSpacing"}) {
        const std::vector<std::string> words = splitWords(header.get(field));
        if (words.empty()) continue;
        if (words.size() != axes)
            header.fail("the header gives " + std::to_string(words.size()) + " numbers as " + field + " for " +
                        std::to_string(axes) + " axes");
        for (std::size_t a = 0; a < std::min<std::size_t>(axes, 3); ++a) {
            double& value = spacing[static_cast<int>(a)];
            value = numberIn(words[a]);
            requireSpacing(value, a, words[a], header.path());
        }
    }
    return spacing;
}

/// Row n of the header's matrix is where axis n points.
Mat3 directionsIn(const TextHeader& header, std::size_t axes) {
    Mat3 directions(1);
    const std::vector<double> matrix = numbersIn(header, {"TransformMatrix", "Rotation", "Orientation"}, axes * axes);
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

/// MetaImage's world is LPS wherever it is a patient's, and it is one where the anatomy of the axes is named.
WorldAxes worldAxesIn(const TextHeader& header) {
    const std::string letters = lowerCase(header.get("AnatomicalOrientation"));
    return letters.size() >= 3 && letters.find_first_not_of("rlapsi") >= 3 ? WorldAxes::Patient : WorldAxes::File;
}

/// The header's unit of length; Unknown where it names none. Throws FileError for one that is not known.
LengthUnit lengthUnitIn(const TextHeader& header) {
    const std::string unit = header.get("DistanceUnits");
    if (unit.empty() || unit == "?") return LengthUnit::Unknown;
    if (const auto known = lengthUnitNamed(unit)) return *known;
    header.fail("the DistanceUnits " + inQuotes(unit) + " are not known", "write um, mm or cm");
}

/// The number of a field, finite; `otherwise` where there is no such field.
double fieldNumber(const TextHeader& header, const std::string& name, double otherwise) {
    const std::vector<double> numbers = finiteNumbers(header.get(name), name, header.path());
    return numbers.empty() ? otherwise : numbers.front();
}

/// What the header makes of the numbers in the file.
std::optional<ValueScaling> scalingIn(const TextHeader& header, std::vector<std::string>& notices) {
    const ValueScaling scaling{fieldNumber(header, "ElementToIntensityFunctionSlope", 1),
                               fieldNumber(header, "ElementToIntensityFunctionOffset", 0)};
    if (scaling.slope == 1 && scaling.intercept == 0) return {};
    if (scaling.slope == 0) {
        notices.emplace_back(
            "the header's ElementToIntensityFunction would make all values the same: it is passed over");
        return {};
    }
    notices.push_back("values are " + exactText(scaling.slope) + " x what the file stores" +
                      (scaling.intercept < 0 ? " - " : " + ") + exactText(std::abs(scaling.intercept)) +
                      ", as its ElementToIntensityFunction says");
    return scaling;
}

bool isBigEndian(const TextHeader& header) {
    const char* const names[] = {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"};
    const bool isFirst = isTrue(header, names[0]), isSecond = isTrue(header, names[1]);
    if (header.has(names[0]) && header.has(names[1]) && isFirst != isSecond)
        header.fail("the header gives two byte orders");
    return isFirst || isSecond;
}

Encoding encodingIn(const TextHeader& header) {
    const bool compressed = isTrue(header, "CompressedData");
    const bool text = header.has("BinaryData") && !isTrue(header, "BinaryData");
    if (compressed && text) header.fail("the header calls the data both text and compressed");
    return compressed ? Encoding::Deflate : text ? Encoding::Text : Encoding::Raw;
}

/// The files that hold the samples.
DataFiles filesIn(const TextHeader& header) {
    if (isLocal(header)) return {{header.path()}, {}};
    return dataFilesIn(header, "ElementDataFile", [&] { return header.sizes("DimSize", "NDims", 10); });
}

/// When the steps along the fourth axis are, in no unit that the header names. None where it says nothing but 0, 1, 2.
std::optional<StepTimes> timesIn(const TextHeader& header, const std::vector<std::int64_t>& sizes) {
    if (sizes.size() != 4 || sizes[3] < 2) return {};
    StepTimes times;
    if (const auto origin = originIn(header, 4); !origin.empty()) times.first = origin[3];
    std::vector<std::string> words = splitWords(header.get("ElementSpacing"));
    if (words.empty()) words = splitWords(header.get("ElementSize"));
    if (words.size() == 4) times.width = numberIn(words[3]);
    if (!(times.width > 0) || !std::isfinite(times.width)) return {};
    if (times.first == 0 && times.width == 1) return {};
    return times;
}

/// Where the data lie, checked up to the end of `step`.
void placeData(FileLayout& layout, const TextHeader& header, int step, const JobControl& job) {
    const char* toDo = "check DimSize and ElementType in the header, or copy the file again";
    const std::uint64_t fileBytes = dataFileBytes(layout.dataPath, header.path());
    // HeaderSize counts from the beginning of the file that holds the data, even where that is this one.
    const std::int64_t skip = header.wholeNumber("HeaderSize", 0);
    if (skip < -1) header.fail("the header's HeaderSize is negative");
    if (isLocal(header) && skip > 0 && static_cast<std::uint64_t>(skip) < header.dataStart())
        header.fail("the header's HeaderSize lies within the header");
    layout.start = skip > 0 ? static_cast<std::uint64_t>(skip) : isLocal(header) ? header.dataStart() : 0;
    // The stream itself tells where it ends, so that CompressedDataSize may be absent or too small.
    const std::int64_t packed = layout.encoding == Encoding::Deflate ? header.wholeNumber("CompressedDataSize", 0) : 0;
    if (packed < 0) header.fail("the header's CompressedDataSize is negative");
    std::uint64_t stored = fileBytes - std::min(layout.start, fileBytes);
    if (skip == -1) { // the data end where the file ends
        const std::uint64_t last = layout.encoding == Encoding::Raw
                                       ? valuesIn(layout, header.path()) * bytesPerValue(layout.type)
                                       : static_cast<std::uint64_t>(packed);
        if (layout.encoding == Encoding::Text || last == 0)
            header.fail("the header does not tell where the data begin", "correct HeaderSize");
        requireStored(layout.dataPath, Encoding::Raw, last, 1, stored, toDo);
        layout.start = fileBytes - last;
        stored = last;
    }
    requireStored(layout.dataPath, Encoding::Raw, static_cast<std::uint64_t>(packed), 1, stored, toDo);
    requireData(layout, stored, valuesUpTo(layout, step), toDo, job);
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const TextHeader header = parseHeader(source.path);
    const std::vector<std::int64_t> sizes = header.sizes("DimSize", "NDims", 10);
    FileLayout layout;
    layout.spacing = spacingIn(header, sizes.size());
    const std::int64_t channels = header.wholeNumber("ElementNumberOfChannels", 1);
    if (channels != 1) layout.axes.push_back({channels, true});
    for (const std::int64_t size : sizes) layout.axes.push_back({size, false});
    layout.type = typeIn(header);
    valuesIn(layout, source.path); // throws where they are too many to count
    const std::vector<double> origin = originIn(header, sizes.size());
    for (std::size_t a = 0; a < std::min<std::size_t>({3, sizes.size(), origin.size()}); ++a)
        layout.origin[static_cast<int>(a)] = origin[a];
    layout.directions = directionsIn(header, sizes.size());
    layout.worldAxes = worldAxesIn(header);
    const LengthUnit ofFile = lengthUnitIn(header);
    if (layout.worldAxes == WorldAxes::File) { // where there is no patient, lengths stay in the unit of the file
        layout.lengthUnit = ofFile;
    } else {
        const double millimetres = converted(1, ofFile, LengthUnit::Millimetre);
        layout.spacing *= millimetres;
        layout.origin *= millimetres;
    }
    layout.scaling = scalingIn(header, layout.notices);
    layout.bigEndian = isBigEndian(header);
    layout.encoding = encodingIn(header);
    layout.zlib = true;
    DataFiles files = filesIn(header);
    layout.dataPath = files.paths.front();
    layout.times = timesIn(header, sizes);
    if (!step) return layout;
    if (files.share.empty()) {
        placeData(layout, header, *step, job);
    } else {
        files.share.insert(files.share.begin(), channels);
        placeParts(layout, files.paths, files.share, *step, [&](FileLayout& part) { placeData(part, header, 0, job); });
    }
    return layout;
}

std::vector<std::string> dataFiles(const std::string& path) { return filesIn(parseHeader(path)).paths; }

} // namespace

VolumeFormat metaImageFormat() {
    return {"MetaImage",          {".mhd", ".mha"}, describeLayout<layoutOf>,
            readLayout<layoutOf>, dataFiles,        kMetaImageContent};
}

} // namespace pellucid
