#include "foreign/images/page_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "base/text.h"
#include "volume/file_names.h"
#include "volume/formats/text_header.h"
#include "volume/formats/xml_tags.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

constexpr int kMost = 1'000'000; // of slices, channels or steps

int countIn(const std::string& text, int otherwise) {
    const double number = numberIn(trimmed(text));
    return number >= 1 && number <= kMost ? static_cast<int>(number) : otherwise;
}

double lengthOf(double number, double otherwise) { return number > 0 && std::isfinite(number) ? number : otherwise; }
double lengthIn(const std::string& text, double otherwise) { return lengthOf(numberIn(trimmed(text)), otherwise); }

std::optional<double> secondsOf(const std::string& unit) {
    static const std::map<std::string, double> kUnits{
        {"s", 1},     {"sec", 1},     {"second", 1},  {"seconds", 1},  {"ms", 1e-3}, {"msec", 1e-3}, {"µs", 1e-6},
        {"us", 1e-6}, {"usec", 1e-6}, {"µsec", 1e-6}, {"ns", 1e-9},    {"min", 60},  {"minute", 60}, {"minutes", 60},
        {"h", 3600},  {"hr", 3600},   {"hour", 3600}, {"hours", 3600}, {"d", 86400}, {"day", 86400}, {"days", 86400}};
    const std::string word = withMicroSign(unit);
    const auto it = kUnits.find(word.size() > 2 ? lowerCase(word) : word);
    return it == kUnits.end() ? std::nullopt : std::optional(it->second);
}

/// `interval` 0: not known.
void setStepTime(PageOrder& order, double interval, const std::string& unit) {
    const std::optional<double> seconds = secondsOf(unit);
    if (seconds)
        order.stepSeconds = lengthOf(interval * *seconds, 0);
    else if (interval > 0 && order.steps > 1)
        order.notices.push_back("the unit of time " + inQuotes(unit) + " is not known: time steps are counted");
}

/// How far voxels are apart along x, y and z, as a file says.
struct Distances {
    Vec3 numbers{0, 0, 0}; ///< 0: it does not say
    std::array<std::string, 3> units;
};

/// All in the unit of the first that is known, and as far as that where they are not.
void setSpacing(PageOrder& order, const Distances& stated) {
    const auto& [distances, units] = stated;
    int first = 0;
    while (first < 3 && !(distances[first] > 0)) ++first;
    if (first == 3) return;
    const auto axis = [](int a) { return std::string(1, "xyz"[a]); };
    const std::optional<LengthUnit> to = lengthUnitNamed(units[static_cast<std::size_t>(first)]);
    order.lengthUnit = to.value_or(LengthUnit::Unknown);
    for (int a = 0; a < 3; ++a) {
        const std::string &unit = units[static_cast<std::size_t>(a)], &common = units[static_cast<std::size_t>(first)];
        order.spacing[a] = distances[first];
        if (!(distances[a] > 0)) {
            if (a < 2 || order.slices != 1)
                order.notices.push_back("the file does not say how far voxels are apart along " + axis(a) +
                                        ": the distance along " + axis(first) + " is used");
            continue;
        }
        const std::optional<LengthUnit> from = lengthUnitNamed(unit);
        const bool isSame = trimmed(unit) == trimmed(common) || (from && from == to);
        order.spacing[a] = lengthOf(from && to ? converted(distances[a], *from, *to) : distances[a], distances[first]);
        if (isSame || (from && to)) continue;
        order.lengthUnit = LengthUnit::Unknown;
        order.notices.push_back("distances along " + axis(a) + " are in " + inQuotes(unit) + ", those along " +
                                axis(first) + " in " + inQuotes(common) +
                                ", which cannot be converted: the numbers are taken as they are");
    }
}

using Fields = std::map<std::string, std::string>;

/// What ImageJ makes of stored numbers of 8 or 16 bits; of others it takes no notice.
void setCalibration(PageOrder& order, Fields& fields, const PageShape& shape) {
    constexpr int kStraightLine = 0, kNone = 20;
    const bool isCounted = shape.type == ValueType::U8 || shape.type == ValueType::U16 || shape.type == ValueType::I16;
    if (!fields.contains("cf") || shape.samples > 1 || !isCounted) return;
    const double function = numberIn(trimmed(fields["cf"]));
    if (function == kNone) return;
    const double slope = numberIn(trimmed(fields["c1"]));
    double intercept = numberIn(trimmed(fields["c0"]));
    // To ImageJ a signed number of 16 bits is one without sign that is 32 768 larger.
    if (shape.type == ValueType::I16) intercept += 32768 * slope;
    if (function != kStraightLine || !std::isfinite(slope) || !std::isfinite(intercept) || slope == 0) {
        order.notices.push_back("ImageJ's calibration of the values (function " + inQuotes(trimmed(fields["cf"])) +
                                ") is not a straight line: the stored values are shown");
        return;
    }
    if (slope != 1 || intercept != 0) order.scaling = ValueScaling{slope, intercept};
    if (trimmed(fields["zeroclip"]) == "true")
        order.notices.emplace_back("ImageJ shows values below 0 as 0 (zeroclip): here they stay as they are");
}

/// Lines "name=value".
Fields fieldsIn(const std::string& description) {
    Fields fields;
    for (const std::string& text : splitAt('\n', description))
        if (const std::size_t sign = text.find('='); sign != std::string::npos)
            fields[text.substr(0, sign)] = text.substr(sign + 1);
    return fields;
}

/// Pixels are 1 wide where ImageJ does not say otherwise.
Distances distancesOfImageJ(Fields& fields, const FirstPage& page) {
    const auto width = [](double pixelsPerUnit) { return pixelsPerUnit > 0 ? lengthOf(1 / pixelsPerUnit, 1) : 1; };
    const auto unit = [&](const char* name) { return fields.contains(name) ? fields[name] : fields["unit"]; };
    // Negative where slices lie the other way up, which ImageJ does not show either.
    const double apart = lengthOf(std::abs(numberIn(trimmed(fields["spacing"]))), 0);
    return {{width(page.pixelsPerUnitX), width(page.pixelsPerUnitY), apart},
            {unit("unit"), unit("yunit"), unit("zunit")}};
}

PageOrder orderOfImageJ(const FirstPage& page) {
    Fields fields = fieldsIn(page.description);
    PageOrder order;
    order.software = "ImageJ";
    order.axes = "czt";
    order.images = countIn(fields["images"], 0);
    order.channels = countIn(fields["channels"], 1);
    order.slices = countIn(fields["slices"], 0);
    order.steps = countIn(fields["frames"], 1);
    if (order.slices == 0 && (order.channels > 1 || order.steps > 1)) order.slices = 1;
    Distances distances = distancesOfImageJ(fields, page);
    double& apart = distances.numbers.z;
    if (apart == 0 && distances.numbers.x != 1 && std::max(order.images, order.slices) > 1 && order.slices != 1)
        order.notices.emplace_back(
            std::string(
                "the file does not say how far slices are apart, which ImageJ leaves out where it is 1: 1 is taken") +
            kUnlessSet);
    if (apart == 0) apart = 1;
    setSpacing(order, distances);
    setStepTime(order, lengthIn(fields["finterval"], 0), fields.contains("tunit") ? fields["tunit"] : "s");
    setCalibration(order, fields, page.shape);
    return order;
}

/// The tags of an XML text, one after the other; comments and the like are passed over.
class Tags {
public:
    explicit Tags(std::string_view text) : m_text(text) {}

    bool next() {
        while ((m_at = m_text.find('<', m_at)) != std::string_view::npos) {
            if (passOver("<!--", "-->") || passOver("<![CDATA[", "]]>") || passOver("<?", "?>")) continue;
            const std::size_t begin = ++m_at;
            char quote = 0;
            for (; m_at < m_text.size() && (quote != 0 || m_text[m_at] != '>'); ++m_at) {
                const char c = m_text[m_at];
                if (quote != 0 ? c == quote : c == '"' || c == '\'') quote = quote != 0 ? '\0' : c;
            }
            m_tag = m_text.substr(begin, m_at - begin);
            return true;
        }
        return false;
    }
    /// Without the prefix of its name space; with a slash where it closes.
    std::string name() const {
        const std::string_view whole = m_tag.substr(0, m_tag.find_first_of(" \t\r\n", 0));
        const std::size_t colon = whole.find(':');
        std::string name(colon == std::string_view::npos ? whole : whole.substr(colon + 1));
        if (name.ends_with('/')) name.pop_back();
        return whole.starts_with('/') && colon != std::string_view::npos ? "/" + name : name;
    }
    /// Empty where it has none.
    std::string get(std::string_view attribute) const {
        for (std::size_t at = m_tag.find(attribute); at != std::string_view::npos; at = m_tag.find(attribute, at + 1)) {
            const std::size_t quote = at + attribute.size() + 1;
            if (at == 0 || std::string_view(" \t\r\n").find(m_tag[at - 1]) == std::string_view::npos ||
                quote >= m_tag.size() || m_tag[quote - 1] != '=' || (m_tag[quote] != '"' && m_tag[quote] != '\''))
                continue;
            const std::size_t end = m_tag.find(m_tag[quote], quote + 1);
            return withoutEntities(
                std::string(m_tag.substr(quote + 1, end == std::string_view::npos ? 0 : end - quote - 1)));
        }
        return {};
    }
    /// What stands between the tag and the next one.
    std::string text() const {
        const std::size_t begin = std::min(m_at + 1, m_text.size());
        return withoutEntities(trimmed(m_text.substr(begin, m_text.find('<', begin) - begin)));
    }

private:
    bool passOver(std::string_view begin, std::string_view end) {
        if (!m_text.substr(m_at).starts_with(begin)) return false;
        const std::size_t last = m_text.find(end, m_at + begin.size());
        m_at = last == std::string_view::npos ? m_text.size() : last + end.size();
        return true;
    }

    std::string_view m_text, m_tag;
    std::size_t m_at = 0;
};

/// Pages that follow each other, as an element TiffData gives them.
struct TiffData {
    std::array<int, 3> first{0, 0, 0}; ///< slice, channel and step of the first one
    int page = 0;
    std::optional<int> count; ///< empty: up to where the next element begins
    std::string uuid, file;   ///< of the file that they are in; both empty: this one
    bool isPlain() const { return first == std::array{0, 0, 0} && page == 0 && !count; }
};

struct OmeImage {
    std::string name;
    std::optional<Tags> pixels; ///< at the first tag Pixels
    std::vector<TiffData> data;
};

/// What a text of OME says; it refers to the text.
struct OmeText {
    std::string uuid, metadataFile;
    std::vector<OmeImage> images;
    std::string fileName;       ///< the one that has the text
    bool namesThisFile = false; ///< whether any image has pages here; if none has, it may have got another name

    bool isHere(const TiffData& d) const {
        return (d.uuid.empty() && d.file.empty()) || (!d.uuid.empty() && d.uuid == uuid) ||
               (!d.file.empty() && d.file == fileName);
    }
    /// The files that images are in, besides this one.
    std::vector<std::string> otherFiles(std::span<const OmeImage> some) const {
        std::set<std::string, decltype(&countsBefore)> others(&countsBefore);
        for (const OmeImage& image : some)
            for (const TiffData& d : image.data)
                if (!isHere(d)) others.insert(d.file.empty() ? d.uuid : d.file);
        return {others.begin(), others.end()};
    }
    bool hasPagesHere(const OmeImage& image) const {
        return image.data.empty() || std::ranges::any_of(image.data, [&](const TiffData& d) { return isHere(d); });
    }
    bool isAllElsewhere(const OmeImage& image) const { return namesThisFile && !hasPagesHere(image); }
};

int wholeIn(const std::string& text, int otherwise) {
    const double number = numberIn(trimmed(text));
    return number >= 0 && number <= kMost ? static_cast<int>(number) : otherwise;
}

TiffData tiffDataIn(const Tags& tags) {
    TiffData data;
    data.first = {wholeIn(tags.get("FirstZ"), 0), wholeIn(tags.get("FirstC"), 0), wholeIn(tags.get("FirstT"), 0)};
    data.page = wholeIn(tags.get("IFD"), 0);
    std::string count = tags.get("PlaneCount");
    if (count.empty()) count = tags.get("NumPlanes"); // before 2008
    if (!count.empty())
        data.count = wholeIn(count, 0);
    else if (!tags.get("IFD").empty())
        data.count = 1;
    return data;
}

OmeText omeTextIn(const FirstPage& page) {
    OmeText text;
    text.fileName = page.fileName;
    for (Tags tags(page.description); tags.next();) {
        const std::string name = tags.name();
        if (name == "OME") text.uuid = tags.get("UUID");
        if (name == "BinaryOnly") text.metadataFile = tags.get("MetadataFile");
        if (name == "Image") text.images.emplace_back().name = trimmed(tags.get("Name"));
        if (text.images.empty()) continue;
        OmeImage& image = text.images.back();
        if (name == "Pixels" && !image.pixels) image.pixels = tags;
        if (name == "TiffData") image.data.push_back(tiffDataIn(tags));
        if (name == "UUID" && !image.data.empty()) {
            image.data.back().uuid = tags.text();
            image.data.back().file = tags.get("FileName");
        }
    }
    std::erase_if(text.images, [](const OmeImage& image) { return !image.pixels; });
    text.namesThisFile =
        std::ranges::any_of(text.images, [&](const OmeImage& image) { return text.hasPagesHere(image); });
    return text;
}

Distances distancesOfOme(const Tags& pixels) {
    Distances distances;
    for (int a = 0; a < 3; ++a) {
        const std::string name = std::string("PhysicalSize") + "XYZ"[a], unit = pixels.get(name + "Unit");
        distances.numbers[a] = lengthIn(pixels.get(name), 0);
        distances.units[static_cast<std::size_t>(a)] = unit.empty() ? "µm" : unit;
    }
    return distances;
}

void readPixels(const Tags& tags, PageOrder& order) {
    order.software = "OME";
    const std::string dimensions = lowerCase(tags.get("DimensionOrder")); // "xyzct"
    order.axes = dimensions.starts_with("xy") ? dimensions.substr(2) : "";
    if (!std::ranges::is_permutation(order.axes, std::string("zct"))) order.axes = "zct"; // the most frequent one
    order.slices = countIn(tags.get("SizeZ"), 0);
    order.channels = countIn(tags.get("SizeC"), 1);
    order.steps = countIn(tags.get("SizeT"), 1);
    const std::string unit = tags.get("TimeIncrementUnit");
    setStepTime(order, lengthIn(tags.get("TimeIncrement"), 0), unit.empty() ? "s" : unit);
    setSpacing(order, distancesOfOme(tags));
}

/// Which page each picture of an image is. Says what is in other files, and which these are.
void findPages(PageOrder& order, const OmeText& text, const OmeImage& image, const FirstPage& page) {
    const long long all = static_cast<long long>(order.slices) * order.channels * order.steps;
    std::vector<TiffData> data = image.data;
    if (data.empty()) data.emplace_back();
    const std::vector<std::string> others = text.otherFiles({&image, 1});
    const bool isNamed = text.namesThisFile;
    if (const auto named = text.otherFiles(text.images); !isNamed && named.size() > 1) {
        order.notices.push_back("its OME-XML describes other files (" + someNames(named) +
                                ") but not one of this name: all pages are shown as slices");
        order.slices = 0;
        order.channels = order.steps = 1;
        return;
    }
    const bool isPlain = data.size() == 1 && data.front().isPlain();
    if (isPlain && text.images.size() < 2) return; // all pages
    // Images before this one have the first pages, and where theirs end is not said.
    const auto before = std::span(text.images).first(page.image);
    if (isPlain && std::ranges::any_of(before, [&](const OmeImage& one) { return text.hasPagesHere(one); })) return;
    if (all < 1 || all > kMostPages) return;

    // Where in the order of axes the pictures of each element begin; behind the last where there are none.
    const auto firstOf = [&](const TiffData& d) {
        const int perPage = std::max(1, page.shape.samples); // some count its samples as channels
        std::array<int, 3> at = d.first;
        if (at[1] >= order.channels) at[1] /= perPage;
        long long index = 0, width = 1;
        for (const char axis : order.axes) {
            const int n = at[axis == 'z' ? 0 : axis == 'c' ? 1 : 2], size = order.sizeAlong(axis);
            if (n >= size) return all;
            index += width * n;
            width *= size;
        }
        return index;
    };
    std::set<long long> begins{all};
    for (const TiffData& d : data) begins.insert(firstOf(d));
    order.pages.assign(static_cast<std::size_t>(all), PageOrder::kElsewhere);
    std::vector<bool> isGiven(static_cast<std::size_t>(all));
    bool isGivenTwice = false;
    for (const TiffData& d : data) {
        const bool here = text.isHere(d) || !isNamed; // the only one there is: it has got another name
        const long long first = firstOf(d);
        if (first >= all) continue;
        const long long end = d.count ? std::min(all, first + *d.count) : *begins.upper_bound(first);
        for (long long n = first; n < end; ++n) {
            const auto at = static_cast<std::size_t>(n);
            if (isGiven[at]) {
                isGivenTwice = true;
                break;
            }
            isGiven[at] = true;
            if (here) order.pages[at] = d.page + static_cast<int>(n - first);
            if (!here) ++order.elsewhere;
        }
    }
    if (isGivenTwice)
        order.notices.emplace_back("its OME-XML gives several pages for the same picture: the first one is shown");
    if (order.elsewhere > 0)
        order.notices.push_back(std::to_string(order.elsewhere) + " of " + std::to_string(all) +
                                " pictures are in other files and are not shown: " + someNames(others));
}

PageOrder orderOfOme(const FirstPage& page) {
    PageOrder order;
    const OmeText text = omeTextIn(page);
    if (text.images.empty()) {
        if (!text.metadataFile.empty())
            order.notices.push_back("another file, " + inQuotes(text.metadataFile) +
                                    ", describes its pages and how far pixels are apart, and is not read: all pages "
                                    "are shown as slices, pixels 1 apart");
        return order;
    }
    const OmeImage& image = text.images.at(page.image);
    readPixels(*image.pixels, order);
    // Channels that the pixels have beside each other are not pages.
    if (page.shape.samples > 1 && order.channels % page.shape.samples == 0) order.channels /= page.shape.samples;
    findPages(order, text, image, page);
    return order;
}

bool isOfImageJ(const FirstPage& page) { return page.description.starts_with("ImageJ="); }
bool isOfOme(const FirstPage& page) { return !isOfImageJ(page) && page.description.find("OME") != std::string::npos; }

/// "3 × 2 × 4, u16, 2 channels, 5 steps".
std::string detailsOf(const Tags& pixels) {
    static const std::map<std::string, std::string> kTypes{{"uint8", "u8"},  {"uint16", "u16"}, {"uint32", "u32"},
                                                           {"int8", "i8"},   {"int16", "i16"},  {"int32", "i32"},
                                                           {"float", "f32"}, {"double", "f64"}};
    const auto size = [&](const char* name) { return std::to_string(countIn(pixels.get(name), 1)); };
    std::string text = size("SizeX") + " × " + size("SizeY") + " × " + size("SizeZ");
    for (const char* name : {"Type", "PixelType"}) // the latter before 2008
        if (const std::string type = pixels.get(name); !type.empty()) {
            const auto known = kTypes.find(type);
            text += ", " + (known != kTypes.end() ? known->second : printable(type.substr(0, 20)));
            break;
        }
    if (size("SizeC") != "1") text += ", " + size("SizeC") + " channels";
    if (size("SizeT") != "1") text += ", " + size("SizeT") + " steps";
    return text;
}

} // namespace

PageOrder pageOrderIn(const FirstPage& page) {
    if (isOfImageJ(page)) return orderOfImageJ(page);
    return isOfOme(page) ? orderOfOme(page) : PageOrder();
}

std::vector<ImageInFile> imagesNamedIn(const FirstPage& page) {
    std::vector<ImageInFile> all;
    if (!isOfOme(page)) return all;
    const OmeText text = omeTextIn(page);
    std::set<std::string> taken;
    std::map<std::string, int> numbers; // the last one that was given to images of a name
    for (const OmeImage& image : text.images) {
        ImageInFile& one = all.emplace_back();
        const std::string name = image.name.empty() ? "image " + std::to_string(all.size()) : printable(image.name);
        one.name = name;
        int& number = numbers.try_emplace(name, 1).first->second;
        while (!taken.insert(one.name).second) one.name = name + " (" + std::to_string(++number) + ")";
        one.details = detailsOf(*image.pixels);
        if (text.isAllElsewhere(image)) {
            one.elsewhere = someNames(text.otherFiles({&image, 1}));
            one.details += ", in " + one.elsewhere;
        }
        for (const TiffData& data : image.data)
            if (text.isHere(data) || !text.namesThisFile) {
                one.firstPage = data.page;
                break;
            }
    }
    return all;
}

SliceMetadata sliceMetadataIn(const FirstPage& page) {
    PageOrder order;
    order.slices = 1; // nothing is said of slices whose distance is not known
    Distances distances;
    if (isOfImageJ(page)) {
        Fields fields = fieldsIn(page.description);
        distances = distancesOfImageJ(fields, page);
        setCalibration(order, fields, page.shape);
    } else if (isOfOme(page)) {
        const OmeText text = omeTextIn(page);
        const auto image =
            std::ranges::find_if(text.images, [&](const OmeImage& one) { return !text.isAllElsewhere(one); });
        if (image != text.images.end()) distances = distancesOfOme(*image->pixels);
    }
    const bool isApartKnown = distances.numbers.z > 0;
    setSpacing(order, distances);
    if (!isApartKnown) order.spacing.z = 1;
    return {order.spacing, order.lengthUnit, isApartKnown, order.scaling, std::move(order.notices)};
}

} // namespace pellucid
