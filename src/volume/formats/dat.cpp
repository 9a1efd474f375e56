// The headers of Voreen and Inviwo (.dat), beside a file with the voxels as they are. Both name their fields alike.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/voreen_format.h"

namespace pellucid {

namespace {

/// Fields by their names in lower case. Where Inviwo has a name of its own, the one of Voreen stands for both.
TextHeader parseHeader(const std::string& path) {
    static const std::map<std::string, std::string> kSame{{"rawfile", "objectfilename"}, {"dimensions", "resolution"},
                                                          {"spacing", "slicethickness"}, {"endian", "byteorder"},
                                                          {"endianness", "byteorder"},   {"sequences", "numframes"}};
    TextHeader header(path, [](TextHeader& fields, const std::string& text) {
        const std::string line = trimmed(text.substr(0, text.find('#')));
        const std::size_t sign = line.find(':');
        if (sign == std::string::npos || line.starts_with('/')) return true; // a comment, or nothing
        std::string name = lowerCase(trimmed(line.substr(0, sign))), value = trimmed(line.substr(sign + 1));
        if (const auto it = kSame.find(name); it != kSame.end()) name = it->second;
        if (name == "transformmatrix") { // "row0 1 0 0 0"
            const std::vector<std::string> words = splitWords(value);
            if (words.empty()) return true;
            name += lowerCase(words[0]);
            value = trimmed(value.substr(words[0].size()));
        }
        fields.set(name, value);
        return true;
    });
    if (header.has("datfile"))
        header.fail("this header names other .dat files, one for each time step",
                    "open those as a series, by a pattern of their names");
    if (!header.has("objectfilename")) throw notOfFormat("a header of Voreen or Inviwo", path, fileHead(path, 1024));
    for (const char* name : {"objectfilename", "resolution", "format"})
        if (header.get(name).empty())
            header.fail("the header has no " + std::string(name), "correct the header, or copy the file again");
    return header;
}

/// `count` finite numbers; none where the header has no such field.
std::vector<double> numbersIn(const TextHeader& header, const std::string& name, std::size_t count) {
    std::vector<double> numbers = finiteNumbers(header.get(name), name, header.path());
    if (!numbers.empty() && numbers.size() < count)
        header.fail("the header gives " + std::to_string(numbers.size()) + " of " + std::to_string(count) +
                    " numbers as " + name);
    return numbers;
}

VoxelFormat formatIn(const TextHeader& header) {
    const std::string name = header.get("format");
    std::optional<VoxelFormat> format = voxelFormatNamed(splitWords(name).front());
    if (!format)
        header.fail("the format " + inQuotes(name) + " is not supported",
                    "use one of UCHAR, USHORT, FLOAT …, or UINT8, UINT16, FLOAT32, Vec3FLOAT32 …");
    static const std::map<std::string, std::int64_t> kModels{{"", 1},    {"i", 1},   {"la", 2},   {"rg", 2},  {"xy", 2},
                                                             {"rgb", 3}, {"xyz", 3}, {"rgba", 4}, {"xyzw", 4}};
    const std::string model = header.get("objectmodel");
    const auto it = kModels.find(lowerCase(model));
    if (it == kModels.end())
        header.fail("the ObjectModel " + inQuotes(model) + " is not supported", "use one of I, RG, RGB, RGBA");
    if (it->second > 1) format->components = it->second;
    return *format;
}

std::vector<std::int64_t> sizesIn(const TextHeader& header) {
    std::vector<std::int64_t> sizes;
    for (const std::string& word : splitWords(header.get("resolution")))
        if (!parseNumber(word, sizes.emplace_back()))
            header.fail("the header's field \"resolution\" has " + inQuotes(word) + ", which is not a whole number");
    if (sizes.size() != 3)
        header.fail("the header gives " + std::to_string(sizes.size()) + " sizes as resolution, not three");
    return sizes;
}

bool isBigEndian(const TextHeader& header) {
    const std::string text = header.get("byteorder"), order = lowerCase(text);
    if (order == "big" || order == "bigendian" || order == "big-endian") return true;
    if (!order.empty() && order != "little" && order != "littleendian" && order != "little-endian")
        header.fail("the byte order " + inQuotes(text) + " is not known", "write LittleEndian or BigEndian");
    return false;
}

/// Inviwo gives the edges of the whole volume, and the corner where they begin: their matrix, row by row.
void placeByBasis(FileLayout& layout, const TextHeader& header, const std::vector<std::int64_t>& sizes) {
    const std::vector<double> rows[]{numbersIn(header, "basisvector1", 3), numbersIn(header, "basisvector2", 3),
                                     numbersIn(header, "basisvector3", 3)};
    Vec3 edges(0), half(0);
    for (std::size_t a = 0; a < 3; ++a) {
        if (rows[0].empty() || rows[1].empty() || rows[2].empty())
            header.fail("the header has some of BasisVector1, 2, 3, but not all");
        const int axis = static_cast<int>(a);
        const Vec3 edge(rows[0][a], rows[1][a], rows[2][a]);
        const Vec3 voxel = edge / static_cast<double>(sizes[a]);
        layout.spacing[axis] = glm::length(voxel);
        layout.directions[axis] = cleanDirection(voxel);
        edges += edge;
        half += voxel / 2.0;
    }
    layout.origin = half - edges / 2.0; // about the middle, where nothing else is said
    if (const auto corner = numbersIn(header, "offset", 3); !corner.empty())
        layout.origin = Vec3(corner[0], corner[1], corner[2]) + half;
}

void placeBySpacing(FileLayout& layout, const TextHeader& header) {
    const std::vector<std::string> words = splitWords(header.get("slicethickness"));
    if (!words.empty() && words.size() < 3)
        header.fail("the header gives " + std::to_string(words.size()) + " of 3 numbers as spacing");
    const std::vector<double> corner = numbersIn(header, "offset", 3);
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        if (!words.empty()) {
            layout.spacing[axis] = numberIn(words[a]);
            requireSpacing(layout.spacing[axis], a, words[a], header.path());
        }
        if (!corner.empty()) layout.origin[axis] = corner[a] + layout.spacing[axis] / 2;
    }
}

void placeGrid(FileLayout& layout, const TextHeader& header, const std::vector<std::int64_t>& sizes) {
    if (header.has("basisvector1") || header.has("basisvector2") || header.has("basisvector3"))
        placeByBasis(layout, header, sizes);
    else
        placeBySpacing(layout, header);
    for (const std::string name : {"worldvector", "transformmatrixrow"}) {
        std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        bool isGiven = false;
        for (std::size_t row = 0; row < 4; ++row) {
            const std::size_t number = name == "worldvector" ? row + 1 : row;
            const std::vector<double> numbers = numbersIn(header, name + std::to_string(number), 4);
            if (!numbers.empty())
                std::copy_n(numbers.begin(), 4, matrix.begin() + static_cast<std::ptrdiff_t>(4 * row));
            isGiven = isGiven || !numbers.empty();
        }
        if (isGiven) transformGrid(layout, matrix, header.path());
    }
}

/// Inviwo maps what is stored, DataRange, to what is meant, ValueRange.
std::optional<ValueScaling> scalingIn(const TextHeader& header) {
    const std::vector<double> stored = numbersIn(header, "datarange", 2), meant = numbersIn(header, "valuerange", 2);
    if (stored.empty() || meant.empty() || stored == meant) return {};
    const double slope = (meant[1] - meant[0]) / (stored[1] - stored[0]), intercept = meant[0] - slope * stored[0];
    if (slope == 0 || !std::isfinite(slope) || !std::isfinite(intercept))
        header.fail("the header maps a DataRange to a ValueRange where one of them is empty");
    return ValueScaling{slope, intercept};
}

/// Some headers call the voxels colours where each has one value: then the file has just as many bytes.
void correctComponents(FileLayout& layout, VoxelFormat& format, const TextHeader& header) {
    if (format.components == 1) return;
    const std::uint64_t all = valuesIn(layout, header.path()), bytes = dataFileBytes(layout.dataPath, header.path());
    if (bytes != layout.start + all * bytesPerValue(format.type)) return;
    layout.notices.push_back("the header says " + std::to_string(format.components) +
                             " components, but the data have one value for each voxel, and are read so");
    format.components = 1;
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const TextHeader header = parseHeader(source.path);
    const std::vector<std::int64_t> sizes = sizesIn(header);
    VoxelFormat format = formatIn(header);
    FileLayout layout;
    layout.dataPath = header.dataPath(header.get("objectfilename"));
    layout.type = format.type;
    layout.bigEndian = isBigEndian(header);
    const std::int64_t offset = header.wholeNumber("byteoffset", 0), steps = header.wholeNumber("numframes", 1);
    if (offset < 0) header.fail("the header's ByteOffset is negative");
    layout.start = static_cast<std::uint64_t>(offset);
    for (const std::int64_t size : sizes) layout.axes.push_back({size});
    if (steps != 1) layout.axes.push_back({steps, false, true});
    correctComponents(layout, format, header);
    if (format.components > 1) layout.axes.insert(layout.axes.begin(), {format.components, true});
    valuesIn(layout, source.path); // throws where they are too many to count
    layout.scaling = scalingIn(header);
    placeGrid(layout, header, sizes);
    if (step) placeRawData(layout, source.path, *step, job);
    return layout;
}

std::vector<std::string> dataFiles(const std::string& path) {
    const TextHeader header = parseHeader(path);
    return {header.dataPath(header.get("objectfilename"))};
}

} // namespace

VolumeFormat datFormat() {
    return {"Voreen or Inviwo header",
            {},
            describeLayout<layoutOf>,
            readLayout<layoutOf>,
            dataFiles,
            kDatContent,
            {".dat"}};
}

} // namespace pellucid
