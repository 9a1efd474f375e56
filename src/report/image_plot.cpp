#include "report/image_plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/annotation_raster.h"
#include "report/svg_plot.h"

namespace pellucid {

namespace {

constexpr double kCapital = 0.66; ///< height of a capital, of the size of the font
constexpr double kDash = 5, kGap = 4;

/// Draws what stands on one page, `top` pixels of pages below the upper edge.
class Painter {
public:
    Painter(double scale, double top) : m_scale(scale), m_top(top) {}

    void add(const PlotArea& a) {
        addPolygon({a.lo, {a.hi.x, a.lo.y}, a.hi, {a.lo.x, a.hi.y}}, colorOf(a.ink, a.color));
    }
    void add(const PlotStroke& s) {
        const Rgb color = colorOf(s.ink, s.color);
        if (!s.dashed) {
            addLine(s.points, color, s.width);
            return;
        }
        double done = 0; // along the whole line
        for (std::size_t i = 0; i + 1 < s.points.size(); ++i) {
            const Vec2 a = s.points[i], way = s.points[i + 1] - a;
            const double length = std::hypot(way.x, way.y);
            for (double from = 0; from < length;) {
                const double phase = std::fmod(done + from, kDash + kGap);
                const bool drawn = phase < kDash;
                const double to = std::min(length, from + std::max(0.01, (drawn ? kDash : kDash + kGap) - phase));
                if (drawn) addLine({a + way * (from / length), a + way * (to / length)}, color, s.width);
                from = to;
            }
            done += length;
        }
    }
    void add(const PlotDot& d) {
        std::vector<Vec2> round;
        for (int i = 0; i < 16; ++i) {
            const double angle = i * std::numbers::pi / 8;
            round.push_back(d.at + d.radius * Vec2(std::cos(angle), std::sin(angle)));
        }
        const Rgb color = colorOf(d.ink, d.color);
        addPolygon(round, d.hollow ? colorOf(PlotInk::Ground, {}) : color);
        if (!d.hollow) return;
        round.push_back(round.front());
        addLine(round, color, 1.5);
    }
    void add(const PlotText& t) {
        Mark mark;
        mark.kind = Mark::Kind::Text;
        mark.text = t.text;
        mark.color = colorOf(t.ink, {});
        const double capital = kCapital * t.size;
        const double width = textWidth(t.text) * capital;
        const double before = t.anchor == PlotText::Anchor::Start ? 0
                              : t.anchor == PlotText::Anchor::End ? width
                                                                  : width / 2;
        const Vec2 along = t.upward ? Vec2(0, -1) : Vec2(1, 0), up = t.upward ? Vec2(-1, 0) : Vec2(0, -1);
        mark.points = {placed(t.at - along * before)};
        mark.across = along * (capital * m_scale);
        mark.up = up * (capital * m_scale);
        mark.width = (t.bold ? 1.6 : 1.0) * m_scale;
        m_marks.push_back(std::move(mark));
    }
    const std::vector<Mark>& marks() const { return m_marks; }

private:
    static Rgb colorOf(PlotInk ink, const Rgb& own) { return ink == PlotInk::Own ? own : inkOnLight(ink); }
    Vec2 placed(const Vec2& p) const { return m_scale * Vec2(p.x, p.y + m_top); }
    void addPolygon(const std::vector<Vec2>& corners, const Rgb& color) {
        Mark mark;
        mark.kind = Mark::Kind::Area;
        for (const Vec2& p : corners) mark.points.push_back(placed(p));
        mark.color = color;
        m_marks.push_back(std::move(mark));
    }
    void addLine(const std::vector<Vec2>& points, const Rgb& color, double width) {
        if (points.size() < 2) return;
        Mark mark;
        for (const Vec2& p : points) mark.points.push_back(placed(p));
        mark.color = color;
        mark.width = width * m_scale;
        m_marks.push_back(std::move(mark));
    }

    double m_scale, m_top;
    std::vector<Mark> m_marks;
};

} // namespace

PlotPage imagePage(const PlotPage& page) {
    PlotPage own = page;
    own.textWidth = [size = page.fontSize](const std::string& text) { return textWidth(text) * kCapital * size; };
    return own;
}

Image imageOf(std::span<const PlotDrawing> drawings, double scale) {
    double width = 0, height = 0;
    for (const PlotDrawing& drawing : drawings) {
        width = std::max(width, drawing.width);
        height += drawing.height;
    }
    const auto pixels = [&](double length) { return static_cast<int>(std::lround(scale * length)); };
    Image image(pixels(width), pixels(height));
    const Rgb ground = inkOnLight(PlotInk::Ground);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        image.rgba[i] = static_cast<float>(ground.r);
        image.rgba[i + 1] = static_cast<float>(ground.g);
        image.rgba[i + 2] = static_cast<float>(ground.b);
        image.rgba[i + 3] = 1;
    }
    double top = 0;
    for (const PlotDrawing& drawing : drawings) {
        Painter painter(scale, top);
        for (const PlotArea& a : drawing.areas) painter.add(a);
        for (const PlotStroke& s : drawing.strokes) painter.add(s);
        for (const PlotDot& d : drawing.dots) painter.add(d);
        for (const PlotText& t : drawing.texts) painter.add(t);
        drawMarks(image, painter.marks());
        top += drawing.height;
    }
    return image;
}

Image imageOf(std::span<const Plot> plots, const PlotPage& page, double scale) {
    const PlotPage own = imagePage(page);
    std::vector<PlotDrawing> drawings;
    for (const Plot& plot : plots) drawings.push_back(drawingOf(plot, own));
    return imageOf(drawings, scale);
}

} // namespace pellucid
