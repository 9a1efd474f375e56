#include "render/annotation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "base/round_numbers.h"
#include "render/mark_maker.h"
#include "render/named_box.h"
#include "render/overlay.h"
#include "render/projected.h"
#include "render/ruler_marks.h"
#include "volume/orientation.h"

namespace pellucid {

namespace {

constexpr Rgb kAmber{1.0, 0.83, 0.42}, kBrown{0.48, 0.27, 0.02}; // of the letters at the edges

/// What the marks lie on.
Rgb groundOf(const RenderSettings& picture) {
    const Rgb bottom = picture.background.value_or(Rgb{});
    return picture.background && picture.backgroundTop ? mixed(bottom, *picture.backgroundTop, 0.5) : bottom;
}

PixelBox joined(const PixelBox& a, const PixelBox& b) {
    return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

/// The sheet that everything is laid out on.
class Sheet : private MarkMaker {
public:
    explicit Sheet(const AnnotationInput& input, const NamedBox* box = nullptr)
        : MarkMaker(input.picture.width, input.picture.height, input.density, groundOf(input.picture)), m_in(input),
          m_width(input.picture.width), m_height(input.picture.height), m_project(input.camera, m_width, m_height),
          m_cap(capHeight), m_margin(margin), m_box(box) {}

    std::vector<Mark> marks() {
        const AnnotationChoice& show = m_in.show;
        if (!show.on) return {};
        std::vector<Mark> rulers = show.measures ? measures() : std::vector<Mark>();
        if (show.cube) addCube();
        if (show.scale) addScale();
        if (show.legend) addLegend();
        if (show.letters && m_in.geometry.worldAxes == WorldAxes::Patient) addLetters();
        for (Mark& name : m_names) place({std::move(name)}); // where they fit
        if (show.title) addTitle();
        std::vector<Mark> rest;
        std::swap(rest, m_marks);
        if (show.axes) addAxes(); // labels find room between the others; lines lie below them
        for (std::vector<Mark>* group : {&rulers, &rest})
            m_marks.insert(m_marks.end(), std::make_move_iterator(group->begin()),
                           std::make_move_iterator(group->end()));
        return std::move(m_marks);
    }

private:
    // ---- marks

    bool isInPicture(const PixelBox& box) const {
        return box.left >= 0 && box.top >= 0 && box.right <= m_width && box.bottom <= m_height;
    }
    bool isTaken(const PixelBox& box) const {
        return std::ranges::any_of(m_taken, [&](const PixelBox& t) { return t.meets(box); });
    }
    /// Adds marks that belong together, and keeps others away from them, by `apart` pixels from those that lie there
    /// now; false: there is no room.
    bool place(std::vector<Mark> group, double apart = 0) {
        if (group.empty()) return false;
        PixelBox box = extentOf(group.front());
        for (const Mark& mark : group) box = joined(box, extentOf(mark));
        if (!isInPicture(box) || isTaken(box.widened(apart))) return false;
        m_taken.push_back(box);
        std::move(group.begin(), group.end(), std::back_inserter(m_marks));
        return true;
    }

    // ---- the parts

    /// They lie where they lie, and hold no room.
    std::vector<Mark> measures() const {
        const PictureView view{m_in.camera, m_in.picture.width, m_in.picture.height};
        return rulerMarks(m_in.rulers, view, {m_in.density, m_cap});
    }

    void addCube() {
        const double radius = std::max(18 * m_in.density, 0.055 * std::min(m_width, m_height)); // to a corner
        const double half = radius / std::sqrt(3.0);
        const Vec2 middle{m_margin + radius, m_height - m_margin - radius};
        const auto onPicture = [&](const Vec3& d) { // d in half edges
            const Vec3 t = m_project.turned(d);
            return Vec2(t.x, -t.y) * half;
        };
        const auto at = [&](const Vec3& p) { return middle + onPicture(p); };
        constexpr std::array<Rgb, 3> kColors{Rgb{0.72, 0.33, 0.31}, Rgb{0.36, 0.56, 0.33}, Rgb{0.30, 0.45, 0.74}};
        const bool patient = m_in.geometry.worldAxes == WorldAxes::Patient;
        std::vector<Mark> cube;
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) {
                Vec3 normal(0);
                normal[axis] = sign;
                const double facing = m_project.turned(normal).z;
                if (facing <= 1e-6) continue;
                // Letters stand upright on the sides; above and below their top is where the views from there have it.
                const Vec3 up = axis < 2 ? Vec3(0, 0, 1) : Vec3(0, patient ? -1 : sign, 0);
                const Vec3 right = glm::cross(up, normal);
                const std::vector<Vec2> corners{at(normal - right - up), at(normal + right - up),
                                                at(normal + right + up), at(normal - right + up)};
                const Rgb color = mixed(kDarkInk, kColors[static_cast<std::size_t>(axis)], 0.45 + 0.55 * facing);
                cube.push_back(areaMark(AnnotationPart::Cube, corners, color));
                Mark edges = lineMark(AnnotationPart::Cube, corners, std::max(m_in.density, 0.09 * m_cap));
                edges.points.push_back(corners.front());
                edges.color = mixed(kLightInk, color, 0.35);
                edges.halo = 0;
                cube.push_back(edges);
                std::string text(1, patient ? patientLetter(axis, sign > 0) : "XYZ"[axis]);
                if (!patient && sign < 0) text = "−" + text;
                const double cap = text.size() == 1 ? 1.15 : 0.85; // in half edges
                Mark letter = textMark(AnnotationPart::Cube, text, {}, Align::Start, Align::Start, m_cap);
                const Vec3 start = normal - right * (0.5 * cap * textWidth(text)) - up * (0.5 * cap);
                letter.points = {at(start)};
                letter.across = onPicture(right * cap);
                letter.up = onPicture(up * cap);
                letter.color = kLightInk;
                letter.alpha = std::clamp((facing - 0.1) / 0.25, 0.0, 1.0);
                letter.width = 0.14 * cap * half;
                letter.halo = 0;
                if (letter.alpha > 0) cube.push_back(letter);
            }
        place(std::move(cube));
    }

    void addScale() {
        const double depth = m_project.depth(m_in.camera.center);
        const double units = m_project.unitsPerPixel(depth);
        const double length = roundNumberBelow(0.22 * m_width * units), pixels = length / units;
        if (!std::isfinite(pixels)) return;
        const std::string text = numberText(length, length) + " " + lengthUnit(m_in.geometry);
        const double stroke = std::max(1.2 * m_in.density, 0.17 * m_cap), end = 0.45 * m_cap;
        const double block = std::max(pixels, m_cap * textWidth(text));
        const double right = m_width - m_margin - (block - pixels) / 2, y = m_height - m_margin - end / 2;
        Mark bar = lineMark(AnnotationPart::Scale,
                            {{right - pixels, y - end}, {right - pixels, y}, {right, y}, {right, y - end}}, stroke);
        place({bar, textMark(AnnotationPart::Scale, text, {right - pixels / 2, y - end - 0.4 * m_cap}, Align::Middle,
                             Align::End, m_cap)});
    }

    struct LegendRow {
        Rgb color;
        double opacity = 0;
    };
    /// What intensity s is drawn as.
    LegendRow legendRow(const TfSampler& tf, const std::vector<double>& peaks, double s) const {
        const RenderMode mode = m_in.picture.mode;
        const Feature* alone = m_in.picture.featureAlone(m_in.tf);
        if (alone != nullptr && !alone->contains(s)) return {};
        if (mode == RenderMode::Composite) return {tf.color(s), tf.opacity(s)};
        if (mode != RenderMode::Surface) return {{s, s, s}, 1}; // grey
        const int feature = featureAt(m_in.tf.features, s);
        if (feature < 0) return {};
        const auto i = static_cast<std::size_t>(feature);
        return {m_in.tf.features[i].color, peaks[i]};
    }

    void addLegend() {
        const TfSampler tf(m_in.tf);
        const std::vector<double> peaks = featureOpacities(m_in.tf);
        addLegendOf(m_in.window, true, [&](double s) { return legendRow(tf, peaks, s); });
        if (!m_in.picture.overlay) return;
        const Overlay& overlay = *m_in.picture.overlay;
        const TfSampler over(overlay.tf);
        addLegendOf(overlay.volume->range(), false, [&](double s) {
            return LegendRow{over.color(s), over.opacity(s)};
        });
    }

    /// At the right, with the names of features; or at the left, where the overlay's is.
    template <class RowOf>
    void addLegendOf(const ValueRange& window, bool atRight, const RowOf& rowOf) {
        const double lo = window.lo, span = window.hi - lo;
        if (!(span > 0) || !std::isfinite(span)) return;
        double bottom = m_height - m_margin;
        for (const PixelBox& t : m_taken)
            if (atRight ? t.right > 0.5 * m_width : t.left < 0.5 * m_width) bottom = std::min(bottom, t.top - m_cap);
        const double top = std::round(m_margin + 0.5 * m_cap);
        const double height = std::round(std::min(bottom - top - 0.5 * m_cap, std::max(0.45 * m_height, 12 * m_cap)));
        if (height < 6 * m_cap) return;
        const auto yOf = [&](double s) { return top + (1 - s) * height; };

        std::vector<Mark> legend;
        const std::vector<double> ticks =
            axisTicks(lo, window.hi, std::clamp(static_cast<int>(height / (3.5 * m_cap)), 2, 10));
        double labels = 0;
        for (const double tick : ticks) labels = std::max(labels, m_cap * textWidth(numberText(tick, span)));
        const double strip = std::round(0.7 * m_cap), curve = std::round(2.2 * m_cap);
        const double right =
            atRight ? std::round(m_width - m_margin - labels - 0.9 * m_cap) : std::round(m_margin + strip + curve);
        const double left = right - strip - curve;
        if (atRight ? left < 0.5 * m_width : right + 0.9 * m_cap + labels > 0.5 * m_width) return;
        const double line = std::max(m_in.density, 0.09 * m_cap);
        for (const double tick : ticks) {
            const double y = yOf((tick - lo) / span);
            legend.push_back(lineMark(AnnotationPart::Legend, {{right, y}, {right + 0.45 * m_cap, y}}, line));
            legend.push_back(textMark(AnnotationPart::Legend, numberText(tick, span), {right + 0.9 * m_cap, y},
                                      Align::Start, Align::Middle, m_cap));
        }
        addLegendRows(legend, {left, top, right, top + height}, strip, rowOf);
        Mark border =
            lineMark(AnnotationPart::Legend,
                     {{left, top}, {right, top}, {right, top + height}, {left, top + height}, {left, top}}, line);
        border.alpha = 0.8;
        border.halo = 0;
        legend.push_back(border);

        if (atRight && isColored(m_in.picture.mode)) addFeatureNames(left, yOf);
        if (!place(std::move(legend)) && atRight) m_names.clear();
    }

    /// From the bottom up, each row a little into the next: no seams.
    template <class RowOf>
    void addLegendRows(std::vector<Mark>& legend, const PixelBox& box, double strip, const RowOf& rowOf) const {
        const double height = box.bottom - box.top;
        const auto yOf = [&](double s) { return box.top + (1 - s) * height; };
        const double rows = std::clamp(height / std::max(1.0, std::floor(m_in.density)), 1.0, 1000.0);
        std::vector<LegendRow> all;
        double most = 0;
        for (int i = 0; i < static_cast<int>(rows); ++i) {
            all.push_back(rowOf((i + 0.5) / std::floor(rows)));
            most = std::max(most, all.back().opacity);
        }
        legend.push_back(boxMark(AnnotationPart::Legend, box, kDarkInk, 0.55));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const LegendRow& row = all[i];
            if (!(row.opacity > 0)) continue;
            const double n = static_cast<double>(all.size());
            const double low = yOf(static_cast<double>(i) / n);
            const double high = std::max(box.top, yOf(static_cast<double>(i + 1) / n) - (i + 1 < all.size() ? 0.6 : 0));
            // The strip tells the colour of all that is drawn; the curve, by the square root, how opaque it is.
            legend.push_back(boxMark(AnnotationPart::Legend, {box.right - strip, high, box.right, low}, row.color));
            const double reach = (box.right - strip - box.left) * std::sqrt(row.opacity / most);
            legend.push_back(boxMark(AnnotationPart::Legend, {box.right - strip - reach, high, box.right - strip, low},
                                     row.color, 0.75));
        }
    }

    template <class YOf>
    void addFeatureNames(double left, const YOf& yOf) {
        const std::vector<double> peaks = featureOpacities(m_in.tf);
        const Feature* alone = m_in.picture.featureAlone(m_in.tf);
        double lowest = m_height; // text goes upward; features are ordered by their lower ends
        std::vector<std::size_t> order(m_in.tf.features.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::ranges::sort(order, {}, [&](std::size_t i) { return m_in.tf.features[i].a; });
        for (const std::size_t i : order) {
            const Feature& f = m_in.tf.features[i];
            if (!(peaks[i] > 0) || (alone != nullptr && alone != &f) || f.name.empty()) continue;
            const double y = yOf((f.a + f.b) / 2);
            if (y + 0.5 * m_cap > lowest) continue;
            const std::string name = shortenedText(f.name, 0.2 * m_width / m_cap);
            Mark text =
                textMark(AnnotationPart::Legend, name, {left - 0.7 * m_cap, y}, Align::End, Align::Middle, m_cap);
            text.color = mixed(f.color, ink, 0.35);
            m_names.push_back(text);
            lowest = y - 0.9 * m_cap;
        }
    }

    void addLetters() {
        const double cap = 1.5 * m_cap;
        const auto letter = [&](const Vec3& direction, const Vec2& at, Align horizontal, Align vertical) {
            Mark mark = textMark(AnnotationPart::Letters, directionLetters(direction), at, horizontal, vertical, cap);
            mark.color = onDark ? kAmber : kBrown;
            mark.width = 0.15 * cap;
            return mark;
        };
        const Vec3 right = m_project.right(), up = m_project.up();
        const double midX = m_width / 2, midY = m_height / 2;
        place({letter(up, {midX, m_margin}, Align::Middle, Align::Start)});
        place({letter(-up, {midX, m_height - m_margin}, Align::Middle, Align::End)});
        // Beside what stands at that edge already.
        const auto beside = [&](const Vec3& direction, bool atRight) {
            double x = atRight ? m_width - m_margin : m_margin;
            for (int tries = 0; tries < 3; ++tries) {
                const Mark mark = letter(direction, {x, midY}, atRight ? Align::End : Align::Start, Align::Middle);
                if (place({mark})) return;
                for (const PixelBox& t : m_taken)
                    if (t.meets(extentOf(mark))) x = atRight ? t.left - m_margin / 2 : t.right + m_margin / 2;
            }
        };
        beside(right, true);
        beside(-right, false);
    }

    void addTitle() {
        const double cap = 1.15 * m_cap;
        double room = m_width - 2 * m_margin;
        for (const PixelBox& t : m_taken)
            if (t.top < m_margin + 2 * cap) room = std::min(room, t.left - 2 * m_margin);
        const std::string text = shortenedText(m_in.title, room / cap);
        if (text.empty() || text == "…") return;
        place({textMark(AnnotationPart::Title, text, {m_margin, m_margin}, Align::Start, Align::Start, cap)});
    }

    // ---- axes

    /// The part of a segment in front of the eye and within the picture, or none.
    std::optional<std::array<Vec2, 2>> visiblePart(Vec3 a, Vec3 b) const {
        if (m_project.isPerspective()) {
            const double near = 1e-3 * m_in.geometry.radius();
            const double da = m_project.depth(a), db = m_project.depth(b);
            if (da < near && db < near) return {};
            if (da < near) a = a + (b - a) * ((near - da) / (db - da));
            if (db < near) b = b + (a - b) * ((near - db) / (da - db));
        }
        // A little beyond the picture, so that ends are not seen.
        return partWithin(m_project(a), m_project(b), PixelBox{0, 0, m_width, m_height}.widened(m_cap));
    }

    struct Edge {
        Vec3 from, to; ///< along its axis, toward larger coordinates
        int seen = 0;  ///< how many of the two faces that meet in it are seen
    };

    std::vector<Edge> edgesAlong(int axis, const Vec3& lo, const Vec3& hi) const {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        std::vector<Edge> edges;
        for (const bool highB : {false, true})
            for (const bool highC : {false, true}) {
                Edge edge{lo, lo, 0};
                edge.from[b] = edge.to[b] = highB ? hi[b] : lo[b];
                edge.from[c] = edge.to[c] = highC ? hi[c] : lo[c];
                edge.to[axis] = hi[axis];
                Vec3 normalB(0), normalC(0);
                normalB[b] = highB ? 1 : -1;
                normalC[c] = highC ? 1 : -1;
                edge.seen = int{m_project.faces(normalB, edge.from)} + int{m_project.faces(normalC, edge.from)};
                edges.push_back(edge);
            }
        return edges;
    }

    /// A label beyond a point of an edge, or on its other side where there is no room.
    bool placeLabel(const std::string& text, const Vec2& at, const Vec2& outward, double distance, bool otherSideToo) {
        const double halfWidth = 0.5 * m_cap * textWidth(text);
        for (const double side : {1.0, -1.0}) {
            const Vec2 way = outward * side;
            const double support = std::abs(way.x) * halfWidth + std::abs(way.y) * 0.5 * m_cap;
            if (place({textMark(AnnotationPart::Axes, text, at + way * (distance + support), Align::Middle,
                                Align::Middle, m_cap)},
                      0.5 * m_cap))
                return true;
            if (!otherSideToo) break;
        }
        return false;
    }

    void addAxes() {
        const Geometry& g = m_in.geometry;
        const Vec3 lo = m_box ? m_box->lo : g.boundsMin(), hi = m_box ? m_box->hi : g.boundsMax();
        const double line = std::max(m_in.density, 0.1 * m_cap);
        for (int axis = 0; axis < 3; ++axis)
            for (const Edge& edge : edgesAlong(axis, lo, hi))
                if (const auto part = visiblePart(edge.from, edge.to)) {
                    Mark mark = lineMark(AnnotationPart::Axes, {(*part)[0], (*part)[1]}, line);
                    mark.alpha = edge.seen == 1 ? 0.9 : edge.seen == 2 ? 0.5 : 0.2; // outline, in front, behind
                    if (edge.seen != 1) mark.halo = 0;
                    m_marks.push_back(mark);
                }
        const Vec3 middle = (lo + hi) * 0.5;
        if (m_project.isPerspective() && m_project.depth(middle) <= 0) return;
        for (int axis = 0; axis < 3; ++axis) addTicks(axis, lo, hi, m_project(middle));
    }

    std::vector<AxisTick> ticksOf(int axis, double lo, double hi, int wanted) const {
        if (m_box) return m_box->ticks[static_cast<std::size_t>(axis)];
        std::vector<AxisTick> all;
        for (const double value : axisTicks(lo, hi, wanted))
            all.push_back({value, numberText(isAgainstWorld(axis) ? 0 - value : value, hi - lo)});
        return all;
    }
    /// Whether the coordinates that people have chosen grow where those of the world fall.
    bool isAgainstWorld(int axis) const {
        Vec3 one(0);
        one[axis] = 1;
        return inAxes(m_in.axes, m_in.geometry, one)[axis] < 0;
    }
    /// "R→L  mm": where coordinates grow, and in which unit, where that is known.
    std::string captionOf(int axis) const {
        if (m_box) return m_box->captions[static_cast<std::size_t>(axis)];
        const bool hasUnit = unitOf(m_in.geometry) != LengthUnit::Unknown;
        const std::string unit = hasUnit ? std::string("  ") + lengthUnit(m_in.geometry) : "";
        if (m_in.geometry.worldAxes != WorldAxes::Patient) return "xyz"[axis] + unit;
        const bool against = isAgainstWorld(axis);
        return std::string(1, patientLetter(axis, against)) + "→" + patientLetter(axis, !against) + unit;
    }

    void addTicks(int axis, const Vec3& lo, const Vec3& hi, const Vec2& middle) {
        // Of the outline's edges the one that is farthest down, or to the left.
        std::optional<Edge> chosen;
        double best = 0;
        for (const Edge& edge : edgesAlong(axis, lo, hi)) {
            if (edge.seen != 1) continue;
            if (m_project.isPerspective() && std::min(m_project.depth(edge.from), m_project.depth(edge.to)) <= 0)
                continue;
            const Vec2 a = m_project(edge.from), b = m_project(edge.to);
            const double length = glm::length(b - a);
            if (!(length > 8 * m_cap)) continue;
            const Vec2 away = (a + b) * 0.5 - middle, along = (b - a) / length;
            const double score = away.y * std::abs(along.x) - away.x * std::abs(along.y);
            if (chosen && score <= best) continue;
            chosen = edge;
            best = score;
        }
        if (!chosen) return;
        const Vec2 a = m_project(chosen->from), b = m_project(chosen->to), along = glm::normalize(b - a);
        Vec2 outward{-along.y, along.x};
        if (glm::dot(outward, (a + b) * 0.5 - middle) < 0) outward = -outward;
        const double tick = 0.55 * m_cap;
        double widest = 0;
        const int wanted = std::clamp(static_cast<int>(glm::length(b - a) / (6 * m_cap)), 2, 10);
        for (const AxisTick& t : ticksOf(axis, lo[axis], hi[axis], wanted)) {
            Vec3 p = chosen->from;
            p[axis] = t.at;
            const Vec2 at = m_project(p);
            if (at.x < 0 || at.y < 0 || at.x > m_width || at.y > m_height) continue;
            m_marks.push_back(
                lineMark(AnnotationPart::Axes, {at, at + outward * tick}, std::max(m_in.density, 0.1 * m_cap)));
            if (placeLabel(t.text, at, outward, tick + 0.5 * m_cap, true))
                widest =
                    std::max(widest, std::abs(outward.x) * m_cap * textWidth(t.text) + std::abs(outward.y) * m_cap);
        }
        const std::string caption = captionOf(axis);
        for (const double share : {0.5, 0.35, 0.65, 0.2, 0.8})
            if (placeLabel(caption, a + (b - a) * share, outward, tick + 1.2 * m_cap + widest, false)) return;
        for (const double share : {0.5, 0.35, 0.65, 0.2, 0.8}) // within the outline, then
            if (placeLabel(caption, a + (b - a) * share, -outward, 0.9 * m_cap, false)) return;
    }

    const AnnotationInput& m_in;
    double m_width, m_height;
    Projected m_project;
    const double m_cap, m_margin; ///< of the MarkMaker
    const NamedBox* m_box;        ///< null: the axes of the world
    std::vector<PixelBox> m_taken;
    std::vector<Mark> m_names; ///< of features, beside the legend
    std::vector<Mark> m_marks;
};

} // namespace

std::vector<Polyline> strokesOf(const Mark& mark) {
    if (mark.kind != Mark::Kind::Text) return {mark.points};
    std::vector<Polyline> strokes = textStrokes(mark.text);
    for (Polyline& stroke : strokes)
        for (Vec2& p : stroke) p = mark.points.front() + mark.across * p.x + mark.up * p.y;
    return strokes;
}

PixelBox boxAround(const std::vector<Vec2>& points) {
    constexpr double kFar = 1e300;
    PixelBox box{kFar, kFar, -kFar, -kFar};
    for (const Vec2& p : points) box = joined(box, {p.x, p.y, p.x, p.y});
    return box;
}

PixelBox extentOf(const Mark& mark) {
    std::vector<Vec2> points;
    for (const Polyline& stroke : strokesOf(mark)) points.insert(points.end(), stroke.begin(), stroke.end());
    return boxAround(points).widened(mark.kind == Mark::Kind::Area ? 0 : mark.width / 2 + mark.halo);
}

std::vector<Mark> annotationMarks(const AnnotationInput& input) { return Sheet(input).marks(); }

std::vector<Mark> annotationMarks(const AnnotationInput& input, const NamedBox& box) {
    return Sheet(input, &box).marks();
}

} // namespace pellucid
