#include "render/mark_maker.h"

#include <algorithm>

namespace pellucid {

namespace {

constexpr double kSmallestText = 7;       // pixels of the screen, height of a capital
constexpr double kTextOfPicture = 0.0115; // the same, of the picture's shorter side

double shareOf(Align align) { return align == Align::Start ? 0.0 : align == Align::Middle ? 0.5 : 1.0; }

} // namespace

Rgb mixed(const Rgb& a, const Rgb& b, double share) {
    return {a.r + (b.r - a.r) * share, a.g + (b.g - a.g) * share, a.b + (b.b - a.b) * share};
}

MarkMaker::MarkMaker(double width, double height, double density, const Rgb& background)
    : capHeight(std::max(kSmallestText * density, kTextOfPicture * std::min(width, height))), margin(1.3 * capHeight),
      onDark(0.3 * background.r + 0.59 * background.g + 0.11 * background.b < 0.5), ink(onDark ? kLightInk : kDarkInk),
      haloInk(onDark ? kDarkInk : kLightInk) {}

Mark MarkMaker::lineMark(AnnotationPart part, std::vector<Vec2> points, double width) const {
    return {.part = part,
            .points = std::move(points),
            .color = ink,
            .width = width,
            .halo = 0.14 * capHeight,
            .haloColor = haloInk};
}

Mark MarkMaker::areaMark(AnnotationPart part, std::vector<Vec2> corners, const Rgb& color, double alpha) const {
    return {.part = part, .kind = Mark::Kind::Area, .points = std::move(corners), .color = color, .alpha = alpha};
}

Mark MarkMaker::boxMark(AnnotationPart part, const PixelBox& b, const Rgb& color, double alpha) const {
    return areaMark(part, {{b.left, b.top}, {b.right, b.top}, {b.right, b.bottom}, {b.left, b.bottom}}, color, alpha);
}

Mark MarkMaker::textMark(AnnotationPart part, const std::string& words, const Vec2& at, Align horizontal,
                         Align vertical, double capital) const {
    Mark mark = lineMark(part, {}, 0.14 * capital);
    mark.kind = Mark::Kind::Text;
    mark.points = {{at.x - shareOf(horizontal) * capital * textWidth(words), at.y + (1 - shareOf(vertical)) * capital}};
    mark.text = words;
    mark.across = {capital, 0};
    mark.up = {0, -capital};
    return mark;
}

std::optional<std::array<Vec2, 2>> partWithin(const Vec2& from, const Vec2& to, const PixelBox& box) {
    const Vec2 way = to - from;
    double t0 = 0, t1 = 1;
    const auto keep = [&](double p, double q) { // p·t ≤ q
        if (p == 0) return q >= 0;
        (p < 0 ? t0 : t1) = p < 0 ? std::max(t0, q / p) : std::min(t1, q / p);
        return t0 < t1;
    };
    if (!keep(-way.x, from.x - box.left) || !keep(way.x, box.right - from.x) || !keep(-way.y, from.y - box.top) ||
        !keep(way.y, box.bottom - from.y))
        return {};
    return std::array<Vec2, 2>{from + way * t0, from + way * t1};
}

} // namespace pellucid
