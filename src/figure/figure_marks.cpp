#include "figure/figure_marks.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "figure/print.h"

namespace pellucid {

namespace {

constexpr double kRoomForText = 1.1; // of the width of its strokes: fonts may be wider

class Translator {
public:
    Translator(double mmPerPixel, const Vec2& corner, const std::string& font)
        : m_scale(mmPerPixel), m_corner(corner), m_font(font) {}

    void add(const Mark& mark) {
        switch (mark.kind) {
        case Mark::Kind::Area:
            m_elements.push_back(FigureArea{.corners = placed(mark.points), .color = mark.color, .alpha = mark.alpha});
            break;
        case Mark::Kind::Line:
            addLine(mark);
            break;
        case Mark::Kind::Text:
            if (!mark.text.empty()) m_elements.push_back(textOf(mark));
        }
    }
    std::vector<FigureElement> elements() { return std::move(m_elements); }

private:
    Vec2 placed(const Vec2& p) const { return m_corner + p * m_scale; }
    std::vector<Vec2> placed(const std::vector<Vec2>& points) const {
        std::vector<Vec2> all;
        for (const Vec2& p : points) all.push_back(placed(p));
        return all;
    }

    void addLine(const Mark& mark) {
        const std::vector<Vec2> points = placed(mark.points);
        if (mark.halo > 0)
            m_elements.push_back(FigureLine{.points = points,
                                            .color = mark.haloColor,
                                            .width = (mark.width + 2 * mark.halo) * m_scale,
                                            .alpha = kHaloAlpha * mark.alpha});
        m_elements.push_back(
            FigureLine{.points = points, .color = mark.color, .width = mark.width * m_scale, .alpha = mark.alpha});
    }

    /// Its capitals are as high as the mark says, unless it would be wider than its room.
    FigureText textOf(const Mark& mark) const {
        FigureText text{.text = mark.text, .align = Align::Middle, .color = mark.color, .alpha = mark.alpha};
        text.halo = mark.halo * m_scale;
        text.haloColor = mark.haloColor;
        const double strokes = textWidth(mark.text);
        const double capital = glm::length(mark.up) * m_scale; // mm
        const TextExtent usual = extentOf(text, m_font);
        const double wanted = capital / usual.capital, room = kRoomForText * strokes * capital / usual.width;
        const double grown = std::min(wanted, std::max(room, 0.8 * wanted));
        // Letters of the font are `usual.capital` high at its usual size; across and up bring them to what the mark
        // says.
        const double points = text.points * grown;
        text.points = points;
        text.across = mark.across * m_scale / capital;
        text.up = mark.up * m_scale / capital;
        const double lift = 0.5 * (1 - grown / wanted); // smaller ones stay in the middle of the line
        text.at = placed(mark.points.front() + mark.across * (0.5 * strokes) + mark.up * lift);
        return text;
    }

    double m_scale;
    Vec2 m_corner;
    const std::string& m_font;
    std::vector<FigureElement> m_elements;
};

} // namespace

std::vector<FigureElement> figureElements(const std::vector<Mark>& marks, double mmPerPixel, const Vec2& corner,
                                          const std::string& font) {
    Translator translator(mmPerPixel, corner, font);
    for (const Mark& mark : marks) translator.add(mark);
    return translator.elements();
}

std::optional<FigureScale> scaleOf(const std::vector<Mark>& marks, double mmPerPixel) {
    FigureScale scale;
    for (const Mark& mark : marks) {
        if (mark.part != AnnotationPart::Scale) continue;
        if (mark.kind == Mark::Kind::Text)
            scale.text = mark.text;
        else
            scale.millimetres = glm::length(mark.points[2] - mark.points[1]) * mmPerPixel; // its ends point upward
    }
    return scale.millimetres > 0 ? std::optional(scale) : std::nullopt;
}

} // namespace pellucid
