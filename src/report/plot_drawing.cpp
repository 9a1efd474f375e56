#include "report/plot_drawing.h"

#include <algorithm>
#include <cmath>

#include "base/round_numbers.h"

namespace pellucid {

namespace {

constexpr double kEstimatedWidth = 0.58; ///< of a character, in font sizes
constexpr double kGap = 6;               ///< between texts and what they stand beside, pixels
constexpr double kSwatch = 18;           ///< length of a line in the legend
constexpr double kCurve = 1.8, kRim = 3.2, kDot = 3;

/// Bytes that begin a character.
bool beginsCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

double share(const PlotAxis& axis, double value) {
    if (!axis.logarithmic) return (value - axis.lo) / (axis.hi - axis.lo);
    return std::log(std::max(value, axis.lo) / axis.lo) / std::log(axis.hi / axis.lo);
}

double clampedShare(const PlotAxis& axis, double value) { return std::clamp(share(axis, value), 0.0, 1.0); }

/// One entry of the legend where it stands, from the left edge of the page and the top of the legend.
struct LegendEntry {
    const PlotSeries* series = nullptr; ///< null: how many found no room
    std::string text;
    double x = 0;
    int row = 0;
};

struct Legend {
    std::vector<LegendEntry> entries;
    int rows = 0;
};

double lineHeight(const PlotPage& page) { return 1.5 * page.fontSize; }

/// Row after row from `left`, in at most a quarter of the page; what finds no room there is counted.
Legend legendOf(const Plot& plot, const PlotPage& page, double left) {
    Legend legend;
    const double right = page.width - kGap;
    const int most = std::max(1, static_cast<int>(page.height / 4 / lineHeight(page)));
    double x = left;
    std::size_t named = 0;
    for (const PlotSeries& s : plot.series) named += s.name.empty() ? 0 : 1;
    for (const PlotSeries& s : plot.series) {
        if (s.name.empty()) continue;
        const std::string text = page.fitted(s.name, std::max(40.0, right - left - kSwatch - kGap));
        const double wide = kSwatch + kGap + page.widthOf(text);
        const bool last = legend.rows + 1 >= most, more = legend.entries.size() + 1 < named;
        const double reserved = last && more ? page.widthOf("+00") + 2 * kGap : 0;
        if (legend.rows == 0) legend.rows = 1;
        if (x + wide + reserved > right && x > left) {
            if (legend.rows == most) {
                legend.entries.push_back(
                    {nullptr, "+" + std::to_string(named - legend.entries.size()), x, legend.rows - 1});
                return legend;
            }
            ++legend.rows;
            x = left;
        }
        legend.entries.push_back({&s, text, x, legend.rows - 1});
        x += wide + 2 * kGap;
    }
    return legend;
}

double legendTop(const Plot& plot, const PlotPage& page) { return plot.title.empty() ? kGap : lineHeight(page) + kGap; }

int ticksAcross(const PlotPage& page) { return std::clamp(static_cast<int>(page.width / 60), 2, 12); }
int ticksUp(const PlotPage& page) { return std::clamp(static_cast<int>(page.height / 45), 2, 8); }

/// In the colour of the series, on a rim; without a colour in that of texts.
void addLine(PlotDrawing& drawing, const std::vector<Vec2>& points, const PlotSeries& s, double width) {
    if (s.color) drawing.strokes.push_back({points, PlotInk::Rim, {}, kRim, s.dashed});
    drawing.strokes.push_back(
        {points, s.color ? PlotInk::Own : PlotInk::Text, s.color.value_or(Rgb{}), width, s.dashed});
}

void addDot(PlotDrawing& drawing, const Vec2& at, const PlotSeries& s, bool hollow) {
    drawing.dots.push_back({at, kDot, s.color ? PlotInk::Own : PlotInk::Text, s.color.value_or(Rgb{}), hollow});
}

/// An upright line with a cross-line at either end.
void addSpread(PlotDrawing& drawing, const PlotPoint& p, const PlotBox& box) {
    const double x = box.xOf(p.x), low = box.yOf(p.y - p.spread), high = box.yOf(p.y + p.spread);
    drawing.strokes.push_back({{{x, low}, {x, high}}, PlotInk::Rim});
    for (const double y : {low, high}) drawing.strokes.push_back({{{x - kDot, y}, {x + kDot, y}}, PlotInk::Rim});
}

void addSeries(PlotDrawing& drawing, const PlotSeries& s, const PlotBox& box) {
    std::vector<Vec2> points;
    for (const PlotPoint& p : s.points) {
        points.emplace_back(box.xOf(p.x), box.yOf(p.y));
        if (p.spread > 0) addSpread(drawing, p, box);
    }
    if (points.size() > 1 && s.joined) addLine(drawing, points, s, s.dashed ? 1.2 : kCurve);
    if (!s.dotted) return;
    for (std::size_t i = 0; i < points.size(); ++i) addDot(drawing, points[i], s, s.points[i].preliminary);
}

using Anchor = PlotText::Anchor;

PlotText& addText(PlotDrawing& drawing, const PlotPage& page, const Vec2& at, const std::string& text, PlotInk ink,
                  Anchor anchor = Anchor::Start) {
    return drawing.texts.emplace_back(PlotText{at, text, ink, anchor, page.fontSize});
}

void addTitleAndLegend(PlotDrawing& drawing, const Plot& plot, const PlotPage& page, const PlotBox& box) {
    const double size = page.fontSize;
    if (!plot.title.empty()) {
        const std::string title = page.fitted(plot.title, page.width - 2 * kGap);
        addText(drawing, page, {kGap, kGap + size}, title, PlotInk::Text).bold = true;
    }
    for (const LegendEntry& entry : legendOf(plot, page, box.left).entries) {
        const double y = legendTop(plot, page) + (entry.row + 0.7) * lineHeight(page), middle = y - 0.35 * size;
        double x = entry.x;
        if (entry.series != nullptr) {
            if (entry.series->joined)
                addLine(drawing, {{x, middle}, {x + kSwatch, middle}}, *entry.series, kCurve);
            else
                addDot(drawing, {x + kSwatch / 2, middle}, *entry.series, false);
            x += kSwatch + kGap;
        }
        addText(drawing, page, {x, y}, entry.text, PlotInk::Text);
    }
}

void addBands(PlotDrawing& drawing, const Plot& plot, const PlotPage& page, const PlotBox& box) {
    for (const PlotBand& band : plot.bands) {
        const double from = box.xOf(band.from), to = box.xOf(band.to);
        drawing.areas.push_back({{from, box.top}, {to, box.bottom}, PlotInk::Shade, {}});
        const std::string text = page.fitted(band.text, to - from - 2);
        if (text.size() > 6 || text == band.text) // more than an ellipsis and a letter or two
            addText(drawing, page, {(from + to) / 2, box.top + page.fontSize}, text, PlotInk::Faint, Anchor::Middle)
                .size *= 0.85;
    }
}

void addBars(PlotDrawing& drawing, const Plot& plot, const PlotBox& box) {
    for (const PlotBar& bar : plot.bars)
        drawing.areas.push_back({{box.xOf(bar.from), box.yOf(bar.height)},
                                 {box.xOf(bar.to), box.bottom},
                                 bar.color ? PlotInk::Own : PlotInk::Shade,
                                 bar.color.value_or(Rgb{})});
}

void addAxes(PlotDrawing& drawing, const Plot& plot, const PlotPage& page, const PlotBox& box) {
    const double size = page.fontSize;
    const auto write = [&](const Vec2& at, const std::string& text, Anchor anchor) -> PlotText& {
        return addText(drawing, page, at, text, PlotInk::Faint, anchor);
    };
    for (const double tick : ticksOf(plot.x, ticksAcross(page))) {
        const double x = box.xOf(tick);
        drawing.strokes.push_back({{{x, box.bottom}, {x, box.bottom + 4}}, PlotInk::Faint});
        write({x, box.bottom + 4 + size}, tickText(plot.x, tick), Anchor::Middle);
    }
    for (const double tick : ticksOf(plot.y, ticksUp(page))) {
        const double y = box.yOf(tick);
        drawing.strokes.push_back({{{box.left, y}, {box.right, y}}, PlotInk::Grid});
        write({box.left - kGap, y + 0.35 * size}, tickText(plot.y, tick), Anchor::End);
    }
    drawing.strokes.push_back({{{box.left, box.top}, {box.left, box.bottom}, {box.right, box.bottom}}, PlotInk::Faint});
    if (!plot.x.label.empty())
        write({(box.left + box.right) / 2, page.height - kGap}, page.fitted(plot.x.label, box.right - box.left),
              Anchor::Middle);
    if (!plot.y.label.empty())
        write({kGap + size, (box.top + box.bottom) / 2}, page.fitted(plot.y.label, box.bottom - box.top),
              Anchor::Middle)
            .upward = true;
}

} // namespace

double PlotPage::widthOf(const std::string& text) const {
    if (textWidth) return textWidth(text);
    return kEstimatedWidth * fontSize * static_cast<double>(std::count_if(text.begin(), text.end(), beginsCharacter));
}

std::string PlotPage::fitted(const std::string& text, double most) const {
    if (widthOf(text) <= most) return text;
    const std::string dots = "…";
    std::string kept = text;
    while (!kept.empty() && widthOf(kept + dots) > most) {
        while (!beginsCharacter(kept.back())) kept.pop_back();
        kept.pop_back();
    }
    return kept + dots;
}

double PlotBox::xOf(double value) const { return left + clampedShare(x, value) * (right - left); }
double PlotBox::yOf(double value) const { return bottom - clampedShare(y, value) * (bottom - top); }

double PlotBox::valueAtX(double pixel) const {
    const double part = std::clamp((pixel - left) / std::max(1.0, right - left), 0.0, 1.0);
    return x.logarithmic ? x.lo * std::pow(x.hi / x.lo, part) : x.lo + part * (x.hi - x.lo);
}

std::vector<double> ticksOf(const PlotAxis& axis, int wanted) {
    std::vector<double> ticks;
    if (axis.logarithmic) {
        const int first = static_cast<int>(std::floor(std::log10(axis.lo))),
                  last = static_cast<int>(std::ceil(std::log10(axis.hi)));
        const int every = std::max(1, (last - first + wanted - 1) / std::max(1, wanted));
        const bool between = 3 * (last - first) <= wanted + 2;
        for (int power = first; power <= last; ++power)
            for (const double multiple : {1.0, 2.0, 5.0}) {
                if (multiple > 1 ? !between : power % every != 0) continue;
                // Division by a power of ten is rounded once, so that 0.001 is what one writes.
                const double scale = std::pow(10.0, std::abs(power));
                const double value = power < 0 ? multiple / scale : multiple * scale;
                if (value >= axis.lo * (1 - 1e-9) && value <= axis.hi * (1 + 1e-9)) ticks.push_back(value);
            }
        return ticks;
    }
    for (const double tick : axisTicks(axis.lo, axis.hi, wanted))
        if (!axis.whole || std::abs(tick - std::round(tick)) < 1e-9) ticks.push_back(tick);
    return ticks;
}

std::string tickText(const PlotAxis& axis, double value) {
    return numberText(value, axis.logarithmic ? 0 : axis.hi - axis.lo);
}

PlotBox boxOf(const Plot& plot, const PlotPage& page) {
    PlotBox box;
    box.x = plot.x;
    box.y = plot.y;
    double widest = 0;
    for (const double tick : ticksOf(plot.y, ticksUp(page)))
        widest = std::max(widest, page.widthOf(tickText(plot.y, tick)));
    box.left = kGap + (plot.y.label.empty() ? 0 : lineHeight(page)) + widest + kGap;
    box.right = std::max(box.left + 1, page.width - 2 * kGap);
    box.top = legendTop(plot, page) + legendOf(plot, page, box.left).rows * lineHeight(page) + kGap;
    box.bottom = std::max(box.top + 1, page.height - kGap - lineHeight(page) * (plot.x.label.empty() ? 1.0 : 2.0));
    return box;
}

PlotDrawing drawingOf(const Plot& plot, const PlotPage& page) {
    const PlotBox box = boxOf(plot, page);
    PlotDrawing drawing{
        .width = page.width, .height = page.height, .areas = {}, .strokes = {}, .dots = {}, .texts = {}};
    addTitleAndLegend(drawing, plot, page, box);
    addBands(drawing, plot, page, box);
    addBars(drawing, plot, box);
    addAxes(drawing, plot, page, box);
    // Dashed lines, which are what curves are compared with, lie below these.
    for (const bool dashed : {true, false})
        for (const PlotSeries& s : plot.series)
            if (s.dashed == dashed) addSeries(drawing, s, box);
    return drawing;
}

std::optional<PlotHit> hitAt(const Plot& plot, const PlotBox& box, const Vec2& at, double reach) {
    std::optional<PlotHit> best;
    double nearest = reach;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        if (!plot.series[s].dotted) continue;
        for (std::size_t i = 0; i < plot.series[s].points.size(); ++i) {
            const PlotPoint& p = plot.series[s].points[i];
            const double distance = std::hypot(box.xOf(p.x) - at.x, box.yOf(p.y) - at.y);
            if (distance > nearest || (best && distance == nearest)) continue;
            nearest = distance;
            best = PlotHit{s, i};
        }
    }
    return best;
}

} // namespace pellucid
