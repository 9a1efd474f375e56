#include "tf/formats/voreen_tfi.h"

#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/tf_format.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostKeys = 4096;
constexpr int kChords = 16; ///< from key to key, where a gamma bends the lines

using Element = XmlElement;

/// The first that holds keys: its name has changed from version to version.
Element transferFunctionIn(const XmlDocument& document, const std::string& path) {
    for (const Element e : document.root().children())
        if (e.child("Keys")) return e;
    throw FileError("there is no transfer function with keys in it", path, "give a transfer function of Voreen, *.tfi");
}

ControlPoint pointOf(const XmlDocument& reader, double x, const Element& color) {
    const auto part = [&](const char* name) { return reader.number(color, name, 0, 255) / 255; };
    return {x, part("a"), {part("r"), part("g"), part("b")}, false, {}};
}

std::vector<ControlPoint> keysOf(const XmlDocument& reader, const Element& keys) {
    std::vector<ControlPoint> points;
    std::size_t count = 0;
    for (const Element key : keys.children("key")) {
        if (++count > kMostKeys) reader.fail("there are more than " + std::to_string(kMostKeys) + " keys", keys);
        const double x = reader.number(reader.child(key, "intensity"), "value", 0, 1);
        points.push_back(pointOf(reader, x, reader.child(key, "colorL")));
        const Element split = key.child("split");
        if (split && reader.flag(split)) points.push_back(pointOf(reader, x, reader.child(key, "colorR")));
    }
    if (points.empty()) reader.fail("there are no keys", keys);
    std::ranges::stable_sort(points, {}, &ControlPoint::x);
    return points;
}

/// The outer keys' opacities hold beyond them; opacity 0 goes without saying.
void holdEnds(std::vector<ControlPoint>& points) {
    ControlPoint first = points.front(), last = points.back();
    if (first.x > 0 && first.opacity > 0) {
        first.x = 0;
        points.insert(points.begin(), first);
    }
    if (last.x < 1 && last.opacity > 0) {
        last.x = 1;
        points.push_back(last);
    }
}

void forceOpacity(const XmlDocument& reader, const Element& tf, std::vector<ControlPoint>& points) {
    int mode = 1;
    if (const Element e = tf.child("alphaMode"))
        mode = static_cast<int>(reader.number(e, "value", 0, 2));
    else if (const Element ignore = tf.child("ignoreAlpha"))
        mode = reader.flag(ignore) ? 2 : 1;
    if (mode == 1) return;
    for (ControlPoint& p : points) p.opacity = mode == 0 ? 0 : 1;
}

/// Opacity 0 below `lo` and above `hi`, with a step at either.
void applyThreshold(std::vector<ControlPoint>& points, double lo, double hi) {
    TransferFunction tf;
    tf.points = points;
    const auto at = [&](double x) { return ControlPoint{x, tf.opacity(x), tf.color(x), false, {}}; };
    const auto transparent = [](ControlPoint p) {
        p.opacity = 0;
        return p;
    };
    std::vector<ControlPoint> kept;
    for (const ControlPoint& p : points) kept.push_back(p.x < lo || p.x > hi ? transparent(p) : p);
    if (lo > 0) {
        const auto place = std::ranges::lower_bound(kept, lo, {}, &ControlPoint::x);
        const bool there = place != kept.end() && place->x == lo;
        const auto step = kept.insert(place, transparent(at(lo)));
        if (!there) kept.insert(step + 1, at(lo));
    }
    if (hi < 1) {
        auto place = std::ranges::upper_bound(kept, hi, {}, &ControlPoint::x);
        if (place == kept.begin() || (place - 1)->x != hi) place = kept.insert(place, at(hi)) + 1;
        kept.insert(place, transparent(at(hi)));
    }
    points = std::move(kept);
}

/// From f(t) to f(s^γ).
void applyGamma(std::vector<ControlPoint>& points, double gamma) {
    TransferFunction tf;
    tf.points = points;
    const TfSampler sampler(tf);
    const std::vector<ControlPoint> all = tf.pointsWithEnds();
    points.clear();
    const auto placed = [gamma](double t) { return std::pow(t, 1 / gamma); };
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i > 0 && (all[i].opacity != all[i - 1].opacity || !(all[i].color == all[i - 1].color))) {
            const double from = placed(all[i - 1].x), to = placed(all[i].x);
            for (int n = 1; n < kChords; ++n) {
                const double s = from + (to - from) * n / kChords, t = std::pow(s, gamma);
                if (s <= from || s >= to || t <= all[i - 1].x || t >= all[i].x) continue;
                points.push_back({s, sampler.opacity(t), sampler.color(t), false, {}});
            }
        }
        points.push_back(all[i]);
        points.back().x = placed(all[i].x);
    }
}

TransferFunction tfOf(const XmlDocument& reader, const Element& element) {
    TransferFunction tf;
    tf.points = keysOf(reader, element.child("Keys"));
    holdEnds(tf.points);
    forceOpacity(reader, element, tf.points);
    if (const Element threshold = element.child("threshold")) {
        const double lo = reader.number(threshold, "x", 0, 1), hi = reader.number(threshold, "y", 0, 1);
        if (lo > hi) reader.fail("the threshold ends before it begins", threshold);
        if (lo > 0 || hi < 1) applyThreshold(tf.points, lo, hi);
    }
    if (const Element gamma = element.child("gammaValue")) {
        const double value = reader.number(gamma, "value");
        if (!(value >= 0.01 && value <= 100)) reader.fail("the gamma is not between 0.01 and 100", gamma);
        if (value != 1) applyGamma(tf.points, value);
    }
    if (const Element domain = element.child("domain")) {
        const ValueRange range{reader.number(domain, "x"), reader.number(domain, "y")};
        if (!(range.lo < range.hi) || !std::isfinite(range.hi - range.lo))
            reader.fail("the domain ends before it begins", domain);
        if (range != ValueRange{0, 1}) tf.range = range; // 0..1 is whatever the window is
    }
    for (ControlPoint& p : tf.points) p.fixed = p.opacity == 0;
    tf.features = deriveFeatures(tf);
    tf.validate();
    return tf;
}

// ---- as the other formats

/// In files of ours: its opacities hold for Voreen's length. The thesis takes those of other files for opacities of one
/// voxel, whatever Voreen makes of them.
constexpr const char* kMark = "pellucid";
constexpr OpacityLength kVoreenLength{OpacityLength::Kind::Texture, 1.0 / 200};

bool knowsVoreen(const ForeignFile& file) {
    return file.isXml() && std::string_view(file.xml().root().name()) == "VoreenData";
}

ReadTf readVoreen(const ForeignFile& file) {
    const Element element = transferFunctionIn(file.xml(), file.path());
    ReadTf read;
    read.tf = tfOf(file.xml(), element);
    read.length = kVoreenLength;
    read.opensAsItIs = !element.child(kMark);
    if (!read.tf.range) read.positions = ValueRange{0, 1};
    return read;
}

std::string colorText(const char* name, const ControlPoint& p) {
    std::string text = std::string("<") + name;
    const std::initializer_list<std::pair<const char*, double>> parts{
        {"r", p.color.r}, {"g", p.color.g}, {"b", p.color.b}, {"a", p.opacity}};
    for (const auto& [part, value] : parts)
        text += std::string(" ") + part + "=\"" + std::to_string(eightBits(value)) + "\"";
    return text + " />";
}

/// All points that share an x.
std::string keyText(const ControlPoint& left, const ControlPoint& right) {
    const bool isSplit = colorText("c", left) != colorText("c", right);
    return "            <key type=\"TransFuncMappingKey\">\n                <intensity value=\"" + exactText(left.x) +
           "\" />\n                <split value=\"" + (isSplit ? "true" : "false") + "\" />\n                " +
           colorText("colorL", left) + "\n" + (isSplit ? "                " + colorText("colorR", right) + "\n" : "") +
           "            </key>\n";
}

WrittenTf writeVoreen(const TfToWrite& tf) {
    const std::vector<ControlPoint> points = tf.points(kVoreenLength);
    WrittenTf written;
    std::string keys;
    for (std::size_t i = 0; i < points.size();) {
        std::size_t last = i;
        while (last + 1 < points.size() && points[last + 1].x == points[i].x) ++last;
        keys += keyText(points[i], points[last]);
        i = last + 1;
    }
    written.text = "<?xml version=\"1.0\" ?>\n<VoreenData version=\"1\">\n"
                   "    <TransFuncIntensity type=\"TransFuncIntensity\">\n"
                   "        <alphaMode value=\"1\" />\n        <texDimensions x=\"256\" y=\"1\" z=\"1\" />\n"
                   "        <filter value=\"0\" />\n        <dataType value=\"5121\" />\n"
                   "        <gammaValue value=\"1\" />\n        <domain x=\"" +
                   exactText(tf.range().lo) + "\" y=\"" + exactText(tf.range().hi) +
                   "\" />\n        <threshold x=\"0\" y=\"1\" />\n        <" + kMark +
                   " opacity=\"converted\" />\n        <Keys>\n" + keys +
                   "        </Keys>\n    </TransFuncIntensity>\n</VoreenData>\n";
    addEightBitLosses(written.losses, points);
    const Vec3 edges = Vec3(tf.geometry().dims) * tf.geometry().spacing;
    if (tf.hasVolume() && !(edges.x == edges.y && edges.y == edges.z))
        written.losses.emplace_back("in Voreen the length that an opacity holds for depends on the direction where the "
                                    "volume is no cube: that of the mean edge is taken");
    return written;
}

} // namespace

TransferFunction tfFromVoreen(std::string_view text, const std::string& path) {
    const XmlDocument document(text, path);
    return tfOf(document, transferFunctionIn(document, path));
}

TransferFunction readVoreenTf(const std::string& path) { return tfFromVoreen(readText(path), path); }

TfFormat voreenFormat() {
    return {"voreen",     "Voreen",    "a transfer function of Voreen",
            ".tfi",       true,        "features; opacities and colours have 256 steps",
            &knowsVoreen, &readVoreen, &writeVoreen};
}

} // namespace pellucid
