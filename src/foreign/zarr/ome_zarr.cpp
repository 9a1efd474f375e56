#include "foreign/zarr/ome_zarr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <span>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "base/base64.h"
#include "base/check.h"
#include "base/text.h"
#include "foreign/arrays/array_axes.h"
#include "volume/file_names.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kDeepest = 4; ///< groups in groups that are looked into
constexpr std::size_t kMostImages = 1000;
constexpr std::size_t kMostLevels = 32;
constexpr std::size_t kMostTimes = 100'000; ///< of an array; there may be a thousand arrays

std::string joinedPath(const std::string& folder, const std::string& name) {
    return folder.empty() ? name : folder + "/" + name;
}

std::optional<double> secondsIn(const std::string& unit) {
    static const std::map<std::string, double> kUnits{
        {"second", 1},  {"millisecond", 1e-3}, {"microsecond", 1e-6}, {"nanosecond", 1e-9},
        {"minute", 60}, {"hour", 3600},        {"day", 86400}};
    const auto it = kUnits.find(unit);
    return it == kUnits.end() ? std::nullopt : std::optional(it->second);
}

/// What an image says of its axes.
struct Axes {
    std::string letters;            ///< a letter of "tczyx" for each
    std::vector<std::string> units; ///< "micrometer"; empty: not given
};

Axes axesOfImage(const JsonValue& multiscale, std::size_t count) {
    Axes axes;
    if (!multiscale.has("axes")) { // NGFF 0.1 and 0.2 have five, in this order
        axes.letters = std::string("tczyx").substr(5 - std::min<std::size_t>(count, 5));
        axes.units.resize(axes.letters.size());
        return axes;
    }
    for (const JsonValue& axis : multiscale["axes"].items()) {
        const bool isName = axis.json().is_string(); // NGFF 0.3
        const std::string name = lowerCase(isName ? axis.text() : axis["name"].text());
        const std::string type = !isName && axis.has("type") ? axis["type"].text() : "";
        char letter = name.size() == 1 ? name.front() : '?';
        if (type == "time") letter = 't';
        if (type == "channel") letter = 'c';
        if (std::string("tczyx").find(letter) == std::string::npos || axes.letters.find(letter) != std::string::npos)
            axis.fail("the axis " + inQuotes(name) + " is none of t, c, z, y, x, or stands there twice",
                      "name the axes t, c, z, y, x");
        axes.letters += letter;
        axes.units.push_back(!isName && axis.has("unit") && axis["unit"].json().is_string() ? axis["unit"].text() : "");
    }
    return axes;
}

/// Scale and translation of each axis by a list of transformations: steps[a]·index + offsets[a].
struct Placement {
    std::vector<double> steps, offsets;
    bool hasOwnOffsets = false; ///< by a translation of this array, not of all
    explicit Placement(std::size_t axes) : steps(axes, 1.0), offsets(axes, 0.0) {}
    /// Answers whether there is a translation among them.
    bool apply(const JsonValue& transformations) {
        bool isMoved = false;
        for (const JsonValue& one : transformations.items()) {
            const std::string type = one["type"].text();
            if (type == "identity") continue;
            if (type != "scale" && type != "translation")
                one.fail("the transformation " + inQuotes(type) + " is not supported", "use scale and translation");
            const std::vector<double> numbers = one[type.c_str()].numbers();
            if (numbers.size() != steps.size()) one.fail("there has to be a number for each axis");
            for (std::size_t a = 0; a < numbers.size(); ++a) {
                if (type == "scale") {
                    steps[a] *= numbers[a];
                    offsets[a] *= numbers[a];
                } else {
                    offsets[a] += numbers[a];
                    isMoved = true;
                }
            }
        }
        return isMoved;
    }
};

constexpr std::string_view kSpace = "xyz";
constexpr char kOneEntry = '1'; ///< in place of the letter of an axis that nothing is along

/// Bytes of a text in base64; empty where it is none.
std::string bytesInBase64(const std::string& text) {
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text.substr(0, text.find('='))) {
        const int digit = base64Digit(c);
        if (digit < 0) return {};
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255u);
    }
    return bytes;
}

/// The number that a text in place of one stands for: xarray writes fill values of floats in base64 (version 3).
std::optional<double> numberInText(const std::string& text) {
    if (text == "NaN") return std::numeric_limits<double>::quiet_NaN();
    if (text == "Infinity") return std::numeric_limits<double>::infinity();
    if (text == "-Infinity") return -std::numeric_limits<double>::infinity();
    const std::string bytes = text.size() == 12 ? bytesInBase64(text) : "";
    double number = 0;
    if (bytes.size() != sizeof number) return {};
    std::uint64_t bits = 0;
    for (std::size_t i = sizeof number; i-- > 0;) bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
    std::memcpy(&number, &bits, sizeof number);
    return number;
}

/// An array with the coordinates that lie beside it, as xarray writes them: what NetCDF's rules are asked about.
class ArrayInGroup final : public ArrayFile {
public:
    /// The array without the axis `channels`. `group`: the folder that it is in; empty: not known.
    ArrayInGroup(const ZarrArray& array, const ZarrNode& node, std::optional<std::size_t> channels,
                 const std::string& group, const BeforeFile& before)
        : m_file(array.file()), m_before(before) {
        json attributes = node.attributes;
        // Version 2 has xarray's missing value as that of chunks which are not stored; 0 is that of all other writers.
        if (node.version == 2 && attributes.contains("_ARRAY_DIMENSIONS") && !attributes.contains("_FillValue") &&
            node.metadata.contains("fill_value") && node.metadata["fill_value"] != 0)
            attributes["_FillValue"] = node.metadata["fill_value"];
        add("", array, std::move(attributes));
        for (std::size_t a = 0; a < array.shape().size(); ++a) {
            if (a == channels) continue;
            const std::string name = a < array.names().size() ? array.names()[a] : "";
            m_dimensions.push_back({name, ""});
            if (const bool isName = !name.empty() && name.front() != '.' && name.find('/') == std::string::npos;
                isName && !group.empty())
                addCoordinates(group + "/" + name, m_dimensions.back());
        }
        std::vector<std::int64_t>& dims = m_variables.front().dims;
        if (channels) dims.erase(dims.begin() + static_cast<std::ptrdiff_t>(*channels));
    }

    bool isNetCdf() const override { return false; }
    const std::vector<ArrayVariable>& variables() const override { return m_variables; }
    std::vector<std::string> files() const override { return {m_file}; }
    std::vector<std::string> notices() const override { return m_notices; }

    std::optional<ArrayAttribute> attribute(const ArrayVariable& variable, const std::string& name) const override {
        const json& all = m_attributes.at(indexOf(variable));
        const auto found = all.find(name);
        if (found == all.end()) return {};
        ArrayAttribute attribute;
        const auto take = [&](const json& value) {
            if (value.is_number()) attribute.numbers.push_back(value.get<double>());
            attribute.areFloats = attribute.areFloats || value.is_number_float();
        };
        take(*found);
        if (found->is_array()) std::ranges::for_each(*found, take);
        if (!found->is_string()) return attribute;
        attribute.text = found->get<std::string>();
        const auto number =
            name == "_FillValue" || name == "missing_value" ? numberInText(attribute.text) : std::nullopt;
        if (number) attribute = {"", {*number}, true};
        return attribute;
    }

    std::vector<ArrayDimension> dimensions(const ArrayVariable&) const override { return m_dimensions; }
    std::vector<std::string> check(const ArrayVariable&) const override { return {}; }
    std::vector<std::int64_t> blockSize(const ArrayVariable& variable) const override { return variable.dims; }
    std::optional<PlainValues> plainValues(const ArrayVariable&, const ArrayBox&) const override { return {}; }

    void read(const ArrayVariable& variable, const ArrayBox& box, std::span<std::byte> to) const override {
        PELLUCID_CHECK(box.size.size() == 1);
        constexpr std::int64_t kStride = 1;
        m_arrays.at(indexOf(variable))
            .read({box.first, {box.first[0] + box.size[0]}}, std::span(&kStride, 1), to, m_before, {});
    }

private:
    std::size_t indexOf(const ArrayVariable& variable) const {
        return static_cast<std::size_t>(&variable - m_variables.data());
    }

    void add(const std::string& name, const ZarrArray& array, json attributes) {
        m_variables.push_back({name, array.shape(), array.type(), ""});
        m_arrays.push_back(array);
        m_attributes.push_back(std::move(attributes));
    }

    void addCoordinates(const std::string& folder, ArrayDimension& dimension) {
        try {
            m_before(0);
            const std::optional<ZarrNode> node = zarrNodeAt(folder);
            if (!node || !node->isArray()) return;
            const ZarrArray array(folder, *node);
            if (array.shape().size() != 1) return;
            dimension.coordinates = "/" + dimension.name;
            add(dimension.coordinates, array, node->attributes);
        } catch (const Error& error) {
            m_notices.push_back("the coordinates along " + inQuotes(dimension.name) +
                                " are passed over: " + error.problem());
        }
    }

    std::string m_file;
    BeforeFile m_before;
    std::vector<ArrayVariable> m_variables; ///< the array, then coordinates
    std::vector<ZarrArray> m_arrays;
    std::vector<json> m_attributes;
    std::vector<ArrayDimension> m_dimensions; ///< of the array
    std::vector<std::string> m_notices;
};

} // namespace

std::int64_t OmeZarr::Image::size(char axis, std::size_t level) const {
    const std::size_t at = axes.find(axis);
    return at == std::string::npos ? 1 : levels[level].shape()[at];
}

Int3 OmeZarr::Image::dims(std::size_t level) const {
    return {static_cast<int>(size('x', level)), static_cast<int>(size('y', level)), static_cast<int>(size('z', level))};
}

Int3 OmeZarr::Image::factors(std::size_t level) const {
    return glm::max(Int3(1), Int3(glm::round(Vec3(dims()) / Vec3(dims(level)))));
}

bool OmeZarr::Image::isCoarser(std::size_t level) const {
    // Writers round sizes up or down.
    const Int3 factor = factors(level), least = dims() / factor, most = (dims() - 1) / factor + 1;
    return factor != Int3(1) && glm::all(glm::greaterThanEqual(dims(level), least)) &&
           glm::all(glm::lessThanEqual(dims(level), most)) && levels[level].type() == levels.front().type() &&
           size('c', level) == size('c') && size('t', level) == size('t');
}

OmeZarr::OmeZarr(const std::string& path, const std::string& wanted, const BeforeFile& before) : m_path(path) {
    find(path, "", 0, before);
    if (m_images.empty() && !m_faults.empty()) throw m_faults.front();
    if (m_images.empty())
        throw FileError("there is no image and no array of three axes in it", path, "open another folder");
    const auto found = std::ranges::find(m_images, wanted, &Image::name);
    if (!wanted.empty() && found == m_images.end()) {
        const auto nameOf = [](const Image& image) { return inQuotes(image.name); };
        throw UsageError("there is no image " + inQuotes(wanted), path, "it has " + joined(m_images, ", ", nameOf));
    }
    const auto isSmaller = [](const Image& a, const Image& b) { return voxelCount(a.dims()) < voxelCount(b.dims()); };
    const auto largest = std::ranges::max_element(m_images, isSmaller); // the first of several
    m_shown = static_cast<std::size_t>((wanted.empty() ? largest : found) - m_images.begin());
    if (m_images.size() > 1 && wanted.empty())
        m_images[m_shown].notices.push_back("image " + inQuotes(m_images[m_shown].name) + " of " +
                                            std::to_string(m_images.size()) + " is shown");
}

void OmeZarr::find(const std::string& folder, const std::string& name, int depth, const BeforeFile& before) {
    before(0);
    std::optional<ZarrNode> node;
    try {
        node = zarrNodeAt(folder);
        if (!node) return;
        if (node->isArray()) return addArray(folder, name, *node, before);
        const json& attributes = node->attributes;
        const json& ome = attributes.contains("ome") && attributes["ome"].is_object() ? attributes["ome"] : attributes;
        const JsonValue metadata(ome, node->file);
        if (metadata.has("multiscales")) {
            const std::vector<JsonValue> multiscales = metadata["multiscales"].items();
            // Further ones are the same image in other forms.
            if (!multiscales.empty()) addImage(folder, name, multiscales.front(), before);
            return;
        }
    } catch (const FileError& fault) {
        m_faults.push_back(fault);
        return;
    }
    if (depth == kDeepest) return;
    std::vector<std::string> below;
    std::error_code ec;
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
        if (it->is_directory(ec)) below.push_back(it->path().filename().string());
    std::ranges::sort(below, countsBefore);
    for (const std::string& next : below)
        if (m_images.size() < kMostImages) find(folder + "/" + next, joinedPath(name, next), depth + 1, before);
}

void OmeZarr::addImage(const std::string& folder, const std::string& name, const JsonValue& multiscale,
                       const BeforeFile& before) {
    Image image;
    image.name = name;
    std::vector<Placement> placements;
    Axes axes;
    for (const JsonValue& dataset : multiscale["datasets"].items()) {
        if (image.levels.size() == kMostLevels) break;
        before(0);
        const std::string path = dataset["path"].text();
        if (path.starts_with('/') || path.find("..") != std::string::npos)
            dataset.fail("the path of an array leads out of its image", "correct the path");
        const std::string at = folder + "/" + path;
        const std::optional<ZarrNode> node = zarrNodeAt(at);
        if (!node || !node->isArray())
            throw FileError("this array is missing, a level of its image", at, "copy the image with all of its levels");
        image.levels.emplace_back(at, *node);
        const std::size_t count = image.levels.back().shape().size();
        if (image.levels.size() == 1) axes = axesOfImage(multiscale, count);
        if (count != axes.letters.size())
            dataset.fail("the array has " + std::to_string(count) + " axes, its image " +
                         std::to_string(axes.letters.size()));
        Placement& placed = placements.emplace_back(count);
        if (dataset.has("coordinateTransformations"))
            placed.hasOwnOffsets = placed.apply(dataset["coordinateTransformations"]);
        if (multiscale.has("coordinateTransformations")) placed.apply(multiscale["coordinateTransformations"]);
    }
    if (image.levels.empty()) multiscale.fail("the image has no arrays");
    image.axes = axes.letters;
    if (image.axes.find('x') == std::string::npos || image.axes.find('y') == std::string::npos)
        multiscale.fail("the image has no axes x and y");
    for (std::size_t level = image.levels.size() - 1; level > 0; --level)
        if (!image.isCoarser(level)) {
            image.levels.erase(image.levels.begin() + static_cast<std::ptrdiff_t>(level));
            placements.erase(placements.begin() + static_cast<std::ptrdiff_t>(level));
        }
    image.origins.resize(image.levels.size(), Vec3(0));
    std::string unit;
    bool isOneUnit = true;
    for (int a = 0; a < 3; ++a) {
        const std::size_t at = image.axes.find(kSpace[static_cast<std::size_t>(a)]);
        if (at == std::string::npos) continue;
        if (unit.empty()) unit = axes.units[at];
        const auto own = lengthUnitNamed(axes.units[at]), first = lengthUnitNamed(unit);
        if (!axes.units[at].empty() && axes.units[at] != unit && !(own && first)) {
            isOneUnit = false;
            image.notices.push_back("the axes have different units (" + printable(unit) + ", " +
                                    printable(axes.units[at]) + "): their numbers are taken as they are");
        }
        if (axes.units[at].empty() && image.levels.front().shape()[at] > 1) isOneUnit = false;
        const auto inFirst = [&](double length) { return own && first ? converted(length, *own, *first) : length; };
        image.spacing[a] = inFirst(placements.front().steps[at]);
        for (std::size_t level = 0; level < image.levels.size(); ++level)
            (*image.origins[level])[a] = inFirst(placements[level].offsets[at]);
    }
    if (isOneUnit) image.lengthUnit = lengthUnitNamed(unit).value_or(LengthUnit::Unknown);
    for (std::size_t level = 1; level < image.levels.size(); ++level)
        if (!placements[level].hasOwnOffsets) image.origins[level].reset();
    if (const std::size_t at = image.axes.find('t'); at != std::string::npos) {
        image.stepWidth = placements.front().steps[at];
        image.firstStep = placements.front().offsets[at];
        if (const auto seconds = secondsIn(axes.units[at])) {
            image.stepWidth *= *seconds;
            image.firstStep *= *seconds;
            image.timeUnit = "s";
        }
    }
    m_images.push_back(std::move(image));
}

void OmeZarr::addArray(const std::string& folder, const std::string& name, const ZarrNode& node,
                       const BeforeFile& before) {
    if (node.metadata.contains("shape") && node.metadata["shape"].is_array() && node.metadata["shape"].size() < 3)
        return; // coordinates, and the like
    const ZarrArray array(folder, node);
    const std::size_t axes = array.shape().size();
    const auto noVolume = [&] {
        return FileError("an array of " + std::to_string(axes) + " axes is no volume", array.file(),
                         "open another one");
    };
    std::optional<std::size_t> channels;
    std::vector<std::size_t> others;
    for (std::size_t a = 0; a < axes; ++a) {
        const std::string axis = a < array.names().size() ? lowerCase(array.names()[a]) : "";
        if (!channels && (axis == "c" || axis == "channel"))
            channels = a;
        else
            others.push_back(a);
    }
    if (others.size() < 2) throw noVolume();
    const std::string group = name.empty() ? "" : folder.substr(0, folder.rfind('/'));
    const ArrayInGroup file(array, node, channels, group, before);
    const ArrayVariable& variable = file.variables().front();
    const ArrayAxes placed = axesOf(file, variable);
    const std::size_t places = placed.places.size();
    if (places < 2 || placed.steps.size() > 1 || (channels && placed.components)) throw noVolume();
    Image image;
    image.name = name;
    image.axes.assign(axes, kOneEntry);
    if (channels) image.axes[*channels] = 'c';
    if (placed.components) image.axes[others[*placed.components]] = 'c';
    for (const std::size_t step : placed.steps) image.axes[others[step]] = 't';
    for (std::size_t n = 0; n < places; ++n) image.axes[others[placed.places[places - 1 - n]]] = kSpace[n];
    image.spacing = placed.spacing;
    image.lengthUnit = placed.lengthUnit;
    image.origins = {placed.origin};
    image.directions = placed.directions;
    image.packed = packedValuesOf(file, variable);
    if (group.empty() && !array.names().empty())
        image.notices.emplace_back(
            "the array is opened by itself, without coordinates that may lie beside it: open the "
            "folder around it");
    if (placed.times.size() <= kMostTimes) image.times = placed.times;
    image.timeUnit = printable(placed.timeUnit);
    for (const auto& notices : {file.notices(), placed.notices, image.packed->notices})
        for (const std::string& notice : notices) image.notices.push_back(printable(notice));
    image.levels.push_back(array);
    m_images.push_back(std::move(image));
}

ReaderLayout OmeZarr::layout(int step) const {
    const Image& image = m_images[m_shown];
    requireIndex("time step", step, static_cast<std::uint64_t>(image.size('t')), m_path);
    ReaderLayout answer;
    FileLayout& layout = answer.layout;
    layout.type = image.packed ? image.packed->type : image.levels.front().type();
    for (const char axis : kSpace) layout.axes.push_back({image.size(axis)});
    if (image.size('c') > 1) layout.axes.push_back({image.size('c'), true});
    layout.spacing = image.spacing;
    layout.lengthUnit = image.lengthUnit;
    layout.origin = *image.origins.front();
    layout.directions = image.directions;
    for (int a = 0; a < 3; ++a) // as axes that run the other way
        if (layout.spacing[a] < 0) {
            layout.spacing[a] = -layout.spacing[a];
            layout.directions[a] = -layout.directions[a];
        }
    layout.array = image.name;
    layout.notices = image.notices;
    if (image.packed) {
        layout.scaling = image.packed->scaling;
        answer.missing = missingAs(contentsOf(layout).type, *image.packed);
    }
    const std::size_t z = image.axes.find('z');
    const auto layersOf = [&](const ZarrArray& array) { return z == std::string::npos ? 1 : array.chunk()[z]; };
    for (std::size_t n = 1; n < image.levels.size(); ++n) {
        const Vec3 factors(image.factors(n));
        const Vec3 ofMeans = layout.origin + layout.directions * (0.5 * (factors - 1.0) * layout.spacing);
        answer.levels.push_back(
            {image.dims(n), image.factors(n), layout.spacing * factors, image.origins[n].value_or(ofMeans)});
    }
    answer.layersAtOnce = static_cast<int>(std::min(layersOf(image.levels.front()), image.size('z')));
    return answer;
}

FileContents OmeZarr::contents() const {
    const Image& shown = m_images[m_shown];
    FileContents contents = contentsOf(layout(0).layout);
    contents.steps = static_cast<int>(shown.size('t'));
    contents.times = shown.times;
    if (!shown.times.empty()) contents.timeUnit = shown.timeUnit;
    if (shown.stepWidth > 0 && contents.steps > 1 && contents.steps < 1'000'000) {
        contents.timeUnit = shown.timeUnit;
        for (int step = 0; step < contents.steps; ++step)
            contents.times.push_back(shown.firstStep + step * shown.stepWidth);
    }
    if (m_images.size() == 1) return contents;
    for (const Image& image : m_images) {
        contents.arrays.push_back(image.name);
        contents.details.push_back(dimsText(image.dims()));
    }
    return contents;
}

std::vector<std::string> OmeZarr::files() const {
    std::vector<std::string> files;
    for (const ZarrArray& array : m_images[m_shown].levels) files.push_back(array.file());
    return files;
}

std::uint64_t OmeZarr::largestImageBytes() const {
    std::uint64_t most = 0;
    for (const ZarrArray& array : m_images[m_shown].levels) most = std::max(most, array.chunkBytes());
    return most;
}

void OmeZarr::read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
                   const JobControl& job) const {
    const Image& image = m_images[m_shown];
    const std::size_t axes = image.axes.size();
    ZarrBox part{std::vector<std::int64_t>(axes), std::vector<std::int64_t>(axes)};
    std::vector<std::int64_t> strides(axes, 0);
    const Int3 size = box.region.hi - box.region.lo;
    for (std::size_t a = 0; a < axes; ++a) {
        const std::size_t space = kSpace.find(image.axes[a]);
        if (space == std::string_view::npos) {
            part.lo[a] = image.axes[a] == 't' ? step : image.axes[a] == 'c' ? box.component : 0;
            part.hi[a] = part.lo[a] + 1;
            continue;
        }
        const int s = static_cast<int>(space);
        part.lo[a] = box.region.lo[s];
        part.hi[a] = box.region.hi[s];
        strides[a] = s == 0 ? 1 : s == 1 ? size.x : std::int64_t{size.x} * size.y;
    }
    image.levels.at(static_cast<std::size_t>(box.level)).read(part, strides, voxels, before, job);
    if (image.packed) markMissing(*image.packed, voxels);
}

} // namespace pellucid
