#include "tf/formats/voreen_tfi.h"

#include <algorithm>
#include <cmath>

#include <pugixml.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostKeys = 4096;
constexpr int kChords = 16; ///< from key to key, where a gamma bends the lines

using Element = pugi::xml_node;

/// Elements of one document and where they stand in it.
class Reader {
public:
    Reader(std::string_view text, const std::string& path) : m_text(text), m_path(path) {
        const pugi::xml_parse_result parsed = m_document.load_buffer(text.data(), text.size());
        if (!parsed) {
            const std::string line = std::to_string(lineOf(static_cast<std::size_t>(parsed.offset)));
            throw FileError("this is not valid XML (" + lowerCase(parsed.description()) + ")", path + ", line " + line,
                            "give a transfer function of Voreen, *.tfi");
        }
    }

    /// The first that holds keys: its name has changed from version to version.
    Element transferFunction() const {
        for (const Element e : m_document.document_element().children())
            if (e.child("Keys")) return e;
        throw FileError("there is no transfer function with keys in it", m_path,
                        "give a transfer function of Voreen, *.tfi");
    }

    [[noreturn]] void fail(const std::string& what, const Element& element) const {
        const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(element.offset_debug(), 0));
        throw FileError(what, m_path + ", line " + std::to_string(lineOf(offset)) + ", " + inQuotes(element.name()),
                        "correct the file");
    }

    double number(const Element& element, const char* attribute) const {
        const pugi::xml_attribute a = element.attribute(attribute);
        if (!a) fail(std::string("the attribute ") + attribute + " is missing", element);
        double value = 0;
        if (!parseNumber(trimmed(a.value()), value) || !std::isfinite(value))
            fail(inQuotes(a.value()) + " is not a number", element);
        return value;
    }

    double number(const Element& element, const char* attribute, double lo, double hi) const {
        const double value = number(element, attribute);
        if (!(value >= lo && value <= hi))
            fail(inQuotes(element.attribute(attribute).value()) + " is not between " +
                     std::to_string(static_cast<int>(lo)) + " and " + std::to_string(static_cast<int>(hi)),
                 element);
        return value;
    }

    bool flag(const Element& element) const {
        const std::string text = lowerCase(trimmed(element.attribute("value").value()));
        if (text == "true" || text == "1") return true;
        if (text != "false" && text != "0") fail("true or false is expected", element);
        return false;
    }

    Element child(const Element& parent, const char* name) const {
        const Element element = parent.child(name);
        if (!element) fail(std::string("the element ") + name + " is missing", parent);
        return element;
    }

private:
    std::size_t lineOf(std::size_t offset) const {
        const std::string_view before = m_text.substr(0, std::min(offset, m_text.size()));
        return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    }

    std::string_view m_text;
    const std::string& m_path;
    pugi::xml_document m_document;
};

ControlPoint pointOf(const Reader& reader, double x, const Element& color) {
    const auto part = [&](const char* name) { return reader.number(color, name, 0, 255) / 255; };
    return {x, part("a"), {part("r"), part("g"), part("b")}, false, {}};
}

std::vector<ControlPoint> keysOf(const Reader& reader, const Element& keys) {
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

void forceOpacity(const Reader& reader, const Element& tf, std::vector<ControlPoint>& points) {
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

} // namespace

TransferFunction tfFromVoreen(std::string_view text, const std::string& path) {
    const Reader reader(text, path);
    const Element element = reader.transferFunction();
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

TransferFunction readVoreenTf(const std::string& path) { return tfFromVoreen(readText(path), path); }

} // namespace pellucid
