// Voreen's volume descriptions (.vvd): XML beside a file with the voxels as they are.
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "base/round_numbers.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/voreen_format.h"
#include "volume/formats/vtk_header.h"
#include "volume/formats/xml_tags.h"
#include "volume/outside_files.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostVolumes = 10'000, kMostElements = 1'000'000;

/// One volume of a description, texts as the file has them.
struct VvdVolume {
    std::string file, format;
    std::array<std::string, 3> sizes;
    std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; ///< row by row
    Vec3 spacing{1, 1, 1}, offset{0, 0, 0};
    double scale = 1, add = 0; ///< of values that are 1 at the end of their type
    bool isScaled = false;
    std::optional<double> time;
};

double numberOf(const XmlTag& tag, const std::string& attribute, const std::string& path) {
    const std::string text = trimmed(tag.get(attribute));
    const double value = numberIn(text);
    if (!std::isfinite(value))
        failInVtk(path, "the attribute " + attribute + " of " + inQuotes(tag.name) + " is " + inQuotes(text) +
                            ", not a number");
    return value;
}

Vec3 vectorOf(const XmlTag& tag, const std::string& path) {
    return {numberOf(tag, "x", path), numberOf(tag, "y", path), numberOf(tag, "z", path)};
}

/// What an element within the description `item` of the volume says.
void readItem(VvdVolume& volume, const std::string& item, const XmlTag& tag, const std::string& path) {
    const std::string name = lowerCase(item);
    if (name == "spacing" && tag.name == "value") volume.spacing = vectorOf(tag, path);
    if (name == "offset" && tag.name == "value") volume.offset = vectorOf(tag, path);
    if (name == "timestep" && tag.name == "MetaItem" && !tag.get("value").empty())
        volume.time = numberOf(tag, "value", path);
    if (name == "realworldmapping" && tag.name == "value") {
        volume.isScaled = true;
        volume.scale = numberOf(tag, "scale", path);
        volume.add = numberOf(tag, "offset", path);
    }
    for (std::size_t row = 0; row < 4 && name == "transformation"; ++row) {
        if (!tag.name.ends_with("row" + std::to_string(row))) continue;
        const char* const columns[] = {"x", "y", "z", "w"};
        for (std::size_t c = 0; c < 4; ++c) volume.matrix[4 * row + c] = numberOf(tag, columns[c], path);
    }
}

/// Goes through a description. Newer ones list the places of the data file as items of RawData.
std::vector<VvdVolume> readVolumes(const std::string& path, const JobControl& job) {
    const std::string head = fileHead(path, 1024);
    if (describeContent(head) != kVvdContent) throw notOfFormat("a volume description of Voreen", path, head);
    XmlTags tags(path, job);
    XmlTag tag;
    std::vector<VvdVolume> volumes;
    std::string item; // of MetaData that is open
    bool isInRaw = false;
    for (std::size_t elements = 0; tags.next(tag); ++elements) {
        if (elements >= kMostElements) failInVtk(path, "there are too many elements");
        if (tag.name == "Volume" && tag.opens) volumes.emplace_back();
        if (volumes.size() > kMostVolumes) failInVtk(path, "there are too many volumes");
        if (volumes.empty()) continue;
        VvdVolume& volume = volumes.back();
        if (tag.opens && (tag.name == "OctreeData" || tag.name == "RawDataNoExternalFile"))
            failInVtk(path, "a volume with " + inQuotes(tag.name) + " is not supported",
                      "write it in Voreen with its data as a raw file");
        if (tag.name == "RawData") {
            isInRaw = tag.opens && !tag.closes;
            if (!tag.opens) continue;
            volume.file = tag.get("filename");
            volume.format = tag.get("format");
            volume.sizes = {tag.get("x"), tag.get("y"), tag.get("z")};
        }
        if (isInRaw && tag.name == "item" && volume.file.empty()) volume.file = tag.get("value");
        if (tag.name == "MetaItem") item = tag.opens ? tag.get("name") : "";
        if (tag.opens && !item.empty()) readItem(volume, item, tag, path);
        if (tag.name == "MetaItem" && tag.closes) item.clear();
    }
    if (volumes.empty()) failInVtk(path, "the file describes no volume");
    return volumes;
}

std::string dataPathOf(const VvdVolume& volume, const std::string& path) {
    if (volume.file.empty()) failInVtk(path, "a volume names no file with its data");
    if (volume.file.size() > 1000) failInVtk(path, "the name of the data file is too long");
    requireInside(path, volume.file);
    return (std::filesystem::path(path).parent_path() / volume.file).string();
}

/// Voreen maps integers to 0 … 1 by the end of their type first; where both cancel each other, nothing is scaled.
std::optional<ValueScaling> scalingOf(const VvdVolume& volume, ValueType type, const std::string& path) {
    if (!volume.isScaled) return {};
    const double end = withType(type, [](auto zero) {
        using T = decltype(zero);
        return std::is_integral_v<T> ? static_cast<double>(std::numeric_limits<T>::max()) : 1.0;
    });
    const double slope = volume.scale / end;
    if (slope == 0) failInVtk(path, "RealWorldMapping makes all values the same");
    constexpr double kRounding = 1e-6; // of single precision, in which Voreen keeps both
    if (std::abs(slope - 1) < kRounding && volume.add == 0) return {};
    return ValueScaling{slope, volume.add};
}

const VvdVolume& chosenVolume(const std::vector<VvdVolume>& volumes, const std::vector<std::string>& names,
                              const VolumeSource& source) {
    return volumes[chosenOf(names, source.array, "", source.path)];
}

FileLayout layoutOf(const VolumeSource& source, std::optional<int> step, const JobControl& job) {
    const std::string& path = source.path;
    const std::vector<VvdVolume> volumes = readVolumes(path, job);
    std::vector<std::string> names;
    for (const VvdVolume& volume : volumes) names.push_back(volume.file);
    const VvdVolume& volume = chosenVolume(volumes, names, source);
    const std::optional<VoxelFormat> format = voxelFormatNamed(volume.format);
    if (!format)
        failInVtk(path, "the format " + inQuotes(volume.format) + " is not supported",
                  "use one of uint8, int16, float …, Vector3(uint8) …");
    FileLayout layout;
    layout.dataPath = dataPathOf(volume, path);
    layout.type = format->type;
    if (format->components > 1) layout.axes.push_back({format->components, true});
    for (std::size_t a = 0; a < 3; ++a) {
        std::int64_t size = 0;
        if (!parseNumber(trimmed(volume.sizes[a]), size))
            failInVtk(path, "a size of the volume is " + inQuotes(volume.sizes[a]) + ", not a whole number");
        layout.axes.push_back({size});
        requireSpacing(volume.spacing[static_cast<int>(a)], a, plainText(volume.spacing[static_cast<int>(a)]), path);
    }
    valuesIn(layout, path); // throws where they are too many to count
    layout.spacing = volume.spacing;
    layout.origin = volume.offset;
    transformGrid(layout, volume.matrix, path);
    layout.scaling = scalingOf(volume, format->type, path);
    if (volume.time) layout.times = StepTimes{*volume.time, 1, ""};
    if (volumes.size() > 1) {
        layout.array = volume.file;
        if (source.array.empty())
            layout.notices.push_back("volume " + inQuotes(volume.file) + " of " + std::to_string(volumes.size()) +
                                     " is shown");
    }
    if (step)
        placeRawData(layout, path, *step, job);
    else if (volumes.size() > 1)
        layout.arrays = names;
    return layout;
}

std::vector<std::string> dataFiles(const std::string& path) {
    std::vector<std::string> files;
    for (const VvdVolume& volume : readVolumes(path, {})) files.push_back(dataPathOf(volume, path));
    return files;
}

} // namespace

VolumeFormat vvdFormat() {
    return {"Voreen volume", {".vvd"}, describeLayout<layoutOf>, readLayout<layoutOf>, dataFiles, kVvdContent};
}

} // namespace pellucid
