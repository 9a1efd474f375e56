// The table of the formats, and what several of them say in the same words.
#include "tf/formats/tf_format.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/tf_json.h"
#include "tf/shown_tf.h"
#include "tf/tf_range.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr double kApart = 1e-6; ///< of the range

std::string rangeText(const ValueRange& range) { return exactText(range.lo) + " to " + exactText(range.hi); }

std::string numbered(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

ReadTf readPellucid(const ForeignFile& file) {
    ReadTf read;
    read.tf = tfFromJson(file.json(), file.path());
    return read;
}

WrittenTf writePellucid(const TfToWrite& tf) {
    TransferFunction written = tf.tf();
    if (tf.hasRange()) written.range = tf.range();
    return {jsonFromTf(written).dump(2) + "\n", {}};
}

bool isPellucid(const ForeignFile& file) {
    return file.isJson() && file.json().is_object() && file.json().contains("format") &&
           file.json()["format"] == "pellucid-tf";
}

} // namespace

TfFormat pellucidTfFormat() {
    return {"pellucid",    "Pellucid",    "a transfer function of Pellucid", ".tf.json", true, "nothing", &isPellucid,
            &readPellucid, &writePellucid};
}

std::span<const TfFormat> tfFormats() {
    static const std::array kFormats{pellucidTfFormat(), paraViewFormat(),  slicerFormat(),      slicerVpFormat(),
                                     voreenFormat(),     slicerXmlFormat(), paraViewXmlFormat(), inviwoFormat(),
                                     niivueFormat(),     vtkJsFormat(),     csvTfFormat(),       imageVis3DFormat(),
                                     mitkFormat(),       itkSnapFormat()};
    return kFormats;
}

const TfFormat& tfFormatNamed(const std::string& name) {
    const auto formats = tfFormats();
    const auto found = std::ranges::find_if(formats, [&](const TfFormat& f) { return lowerCase(name) == f.name; });
    if (found == formats.end())
        throw UsageError("there is no format " + inQuotes(name) + " of transfer functions", "",
                         "use " + joined(formats, ", ", &TfFormat::name));
    return *found;
}

const TfFormat& tfFormatOf(const ForeignFile& file) {
    const auto formats = tfFormats();
    const std::string path = lowerCase(file.path());
    for (const TfFormat& f : formats)
        if (f.ownSuffix && path.ends_with(f.suffix)) return f;
    const auto known = std::ranges::find_if(formats, [&](const TfFormat& f) { return f.knows(file); });
    if (known == formats.end() && trimmed(file.text()).empty())
        throw FileError("the file is empty", file.path(), "save it again in the program that it comes from");
    // What may have been meant as one of ours is told what is wrong with it.
    if (known == formats.end() && (file.isJson() || path.ends_with(".json"))) return formats.front();
    if (known == formats.end())
        throw FileError("this is no transfer function of a format that is known", file.path(),
                        "give " + joined(formats, ", ", &TfFormat::inWords));
    return *known;
}

WrittenTf writtenTf(const TfFormat& format, const TfToWrite& tf) {
    WrittenTf written = format.write(tf);
    if (std::string(format.name) != pellucidTfFormat().name) {
        const std::vector<std::string> losses = commonLosses(tf);
        written.losses.insert(written.losses.begin(), losses.begin(), losses.end());
    }
    return written;
}

std::vector<std::string> commonLosses(const TfToWrite& tf) {
    std::vector<std::string> losses;
    const std::vector<Feature>& features = tf.tf().features;
    if (!features.empty())
        losses.push_back("names and intervals of " + numbered(features.size(), "feature", "features") +
                         " are not stored: keep a *.tf.json, too");
    const auto hidden = static_cast<std::size_t>(std::ranges::count_if(features, &Feature::hidden));
    if (hidden > 0)
        losses.push_back(numbered(hidden, "feature", "features") + " that an eye hides " +
                         (hidden == 1 ? "is" : "are") + " written as transparent");
    if (!tf.hasRange()) losses.emplace_back("no data range is known: positions are written as 0 to 1; name a volume");
    if (!tf.hasVolume())
        losses.emplace_back("no volume is known: opacities are converted for 256 x 256 x 256 voxels, 1 apart");
    return losses;
}

TfToWrite::TfToWrite(const TransferFunction& tf, const std::optional<ValueRange>& window,
                     const std::optional<Geometry>& volume, std::string name, const std::optional<ValueRange>& data)
    : m_tf(tf), m_name(std::move(name)), m_geometry(volume.value_or(unknownVolume())), m_hasVolume(volume.has_value()) {
    const std::optional<ValueRange> range = tf.range ? tf.range : window;
    m_hasRange = range.has_value() && range->lo < range->hi;
    if (m_hasRange) m_range = *range;
    if (data && data->lo < data->hi) m_data = data;
}

TfToWrite TfToWrite::overData() const {
    if (!m_hasRange || !m_data || *m_data == m_range) return *this;
    TfToWrite over = *this;
    TransferFunction shown = shownTf(m_tf); // before features go: an eye hides by them
    shown.features.clear();
    shown.range = m_range;
    over.m_tf = inRange(shown, *m_data);
    over.m_range = *m_data;
    return over;
}

std::vector<ControlPoint> TfToWrite::points(const OpacityLength& length) const {
    return pointsPer(shownTf(m_tf).pointsWithEnds(), length.inWorld(m_geometry) / m_geometry.d0());
}

std::vector<ControlPoint> TfToWrite::pointsApart(const OpacityLength& length) const {
    std::vector<ControlPoint> all = points(length);
    // Steps give way upward, and those that no longer fit below 1 downward from there.
    for (std::size_t i = 1; i < all.size(); ++i) all[i].x = std::max(all[i].x, all[i - 1].x + kApart);
    for (std::size_t i = all.size(); i-- > 0;)
        all[i].x = std::min(all[i].x, 1 - kApart * static_cast<double>(all.size() - 1 - i));
    return all;
}

std::string TfToWrite::keptOf(const char* format) const {
    if (m_tf.extraJson.empty()) return {};
    const json extra = json::parse(m_tf.extraJson, nullptr, false);
    return extra.is_object() && extra.contains(format) && extra[format].is_object() ? extra[format].dump() : "";
}

void keepAs(TransferFunction& tf, const char* key, const std::string& text) {
    if (text.empty()) return;
    json extra = tf.extraJson.empty() ? json::object() : json::parse(tf.extraJson);
    extra[key] = json::parse(text);
    tf.extraJson = extra.dump();
}

int eightBits(double value) { return static_cast<int>(std::floor(255 * std::clamp(value, 0.0, 1.0) + 0.5)); }

void addEightBitLosses(std::vector<std::string>& losses, const std::vector<ControlPoint>& points) {
    losses.emplace_back("opacities and colours are rounded to 256 steps");
    const auto gone = static_cast<std::size_t>(std::ranges::count_if(
        points, [](const ControlPoint& p) { return p.opacity > 0 && eightBits(p.opacity) == 0; }));
    if (gone > 0)
        losses.push_back(numbered(gone, "opacity", "opacities") + " below 0.002 " + (gone == 1 ? "becomes" : "become") +
                         " 0");
}

void addVtkLosses(std::vector<std::string>& losses, const std::vector<ControlPoint>& points) {
    constexpr double kTransparent = 1e-4;
    const auto gone = static_cast<std::size_t>(std::ranges::count_if(
        points, [](const ControlPoint& p) { return p.opacity > 0 && p.opacity <= kTransparent; }));
    if (gone > 0)
        losses.push_back(numbered(gone, "opacity", "opacities") + " of at most 0.0001 " + (gone == 1 ? "is" : "are") +
                         " drawn as 0 there");
}

void addNoDomainLoss(std::vector<std::string>& losses, const TfToWrite& tf, const char* program) {
    std::string loss =
        std::string("the format has no data range: ") + program + " lays the curve over all values of the data, ";
    if (tf.dataRange())
        loss += rangeText(*tf.dataRange());
    else if (tf.hasRange())
        loss += "which are assumed to be " + rangeText(tf.range());
    else
        loss += "which are assumed to be those at 0 and 1";
    if (tf.dataRange() && !tf.dataOf().empty())
        loss += ", the range of " + tf.dataOf() + " alone: other frames were not read";
    losses.push_back(loss + (tf.dataRange() || tf.hasVolume() ? "" : "; name a volume"));
}

std::string noDomainNotice(const ValueRange& positions, const std::optional<ValueRange>& values) {
    return "the file gives no data range: its positions " + rangeText(positions) +
           (values ? " are put on the values " + rangeText(*values) : " become the ends of the range of the data");
}

} // namespace pellucid
