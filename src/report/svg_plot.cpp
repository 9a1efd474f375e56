#include "report/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/round_numbers.h"

namespace pellucid {

namespace {

/// Hundredths of a pixel, the same in every locale.
std::string number(double value) { return exactText(std::round(value * 100) / 100 + 0.0); }

struct Ink {
    const char *name, *light, *dark;
};

const Ink& inkOf(PlotInk ink) {
    static constexpr std::array<Ink, 7> kInks{{{"text", "#1b1d20", "#e4e5e7"},
                                               {"faint", "#585c62", "#9a9da3"},
                                               {"grid", "#dfe1e5", "#35373a"},
                                               {"shade", "#eef0f3", "#26282b"},
                                               {"rim", "#8a8d92", "#6a6d72"},
                                               {"ground", "#ffffff", "#1c1d1f"},
                                               {"", "", ""}}};
    return kInks[static_cast<std::size_t>(ink)];
}

/// `class="plot-text" fill="#1b1d20"`; the attribute counts where there is no style.
std::string painted(const char* attribute, PlotInk ink, const Rgb& color) {
    if (ink == PlotInk::Own) return std::string(attribute) + "=\"" + hexFromRgb(color) + "\"";
    const Ink& known = inkOf(ink);
    return "class=\"plot-" + std::string(known.name) + (attribute[0] == 's' ? "-line" : "") + "\" " + attribute +
           "=\"" + known.light + "\"";
}

void addArea(std::string& svg, const PlotArea& a) {
    svg += "<rect x=\"" + number(a.lo.x) + "\" y=\"" + number(a.lo.y) + "\" width=\"" + number(a.hi.x - a.lo.x) +
           "\" height=\"" + number(a.hi.y - a.lo.y) + "\" " + painted("fill", a.ink, a.color) + "/>\n";
}

void addStroke(std::string& svg, const PlotStroke& s) {
    svg += "<polyline fill=\"none\" stroke-linejoin=\"round\" " + painted("stroke", s.ink, s.color) +
           " stroke-width=\"" + number(s.width) + "\"" + (s.dashed ? " stroke-dasharray=\"5 4\"" : "") + " points=\"";
    for (std::size_t i = 0; i < s.points.size(); ++i)
        svg += (i > 0 ? " " : "") + number(s.points[i].x) + "," + number(s.points[i].y);
    svg += "\"/>\n";
}

void addDot(std::string& svg, const PlotDot& d) {
    const std::string place =
        "cx=\"" + number(d.at.x) + "\" cy=\"" + number(d.at.y) + "\" r=\"" + number(d.radius) + "\"";
    if (d.hollow) // the ground below, then the ring: an element has one class
        svg += "<circle " + place + " " + painted("fill", PlotInk::Ground, {}) + "/>\n<circle " + place +
               " fill=\"none\" stroke-width=\"1.5\" " + painted("stroke", d.ink, d.color) + "/>\n";
    else
        svg += "<circle " + place + " " + painted("fill", d.ink, d.color) + "/>\n";
}

void addText(std::string& svg, const PlotText& t) {
    static constexpr std::array<const char*, 3> kAnchors{"start", "middle", "end"};
    svg += "<text x=\"" + number(t.at.x) + "\" y=\"" + number(t.at.y) + "\" font-size=\"" + number(t.size) +
           "\" text-anchor=\"" + kAnchors[static_cast<std::size_t>(t.anchor)] + "\" " + painted("fill", t.ink, {}) +
           (t.bold ? " font-weight=\"bold\"" : "") +
           (t.upward ? " transform=\"rotate(-90 " + number(t.at.x) + " " + number(t.at.y) + ")\"" : "") + ">" +
           escapedXml(t.text) + "</text>\n";
}

std::string elementsOf(const PlotDrawing& drawing) {
    std::string svg;
    for (const PlotArea& a : drawing.areas) addArea(svg, a);
    for (const PlotStroke& s : drawing.strokes) addStroke(svg, s);
    for (const PlotDot& d : drawing.dots) addDot(svg, d);
    for (const PlotText& t : drawing.texts) addText(svg, t);
    return svg;
}

constexpr const char* kFont = "font-family=\"system-ui, sans-serif\"";

} // namespace

Rgb inkOnLight(PlotInk ink) { return rgbFromHex(inkOf(ink).light); }

std::string plotStyle() {
    std::string dark;
    for (const PlotInk ink :
         {PlotInk::Text, PlotInk::Faint, PlotInk::Grid, PlotInk::Shade, PlotInk::Rim, PlotInk::Ground}) {
        const Ink& known = inkOf(ink);
        dark += ".plot-" + std::string(known.name) + "{fill:" + known.dark + "}.plot-" + known.name +
                "-line{stroke:" + known.dark + "}";
    }
    return "@media screen and (prefers-color-scheme: dark){" + dark + "}";
}

std::string svgElement(const PlotDrawing& drawing, const std::string& label) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(drawing.width) + " " +
           number(drawing.height) + "\" width=\"" + number(drawing.width) + "\" height=\"" + number(drawing.height) +
           "\" role=\"img\" aria-label=\"" + escapedXml(label) + "\" " + kFont + ">\n" + elementsOf(drawing) +
           "</svg>\n";
}

std::string svgOf(std::span<const PlotDrawing> drawings) {
    double wide = 0, high = 0;
    std::string groups;
    for (const PlotDrawing& drawing : drawings) {
        groups += "<g transform=\"translate(0 " + number(high) + ")\">\n" + elementsOf(drawing) + "</g>\n";
        wide = std::max(wide, drawing.width);
        high += drawing.height;
    }
    const std::string width = number(wide), height = number(high);
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
           width + " " + height + "\" width=\"" + width + "\" height=\"" + height + "\" " + kFont + ">\n<style>" +
           plotStyle() + "</style>\n<rect width=\"" + width + "\" height=\"" + height + "\" " +
           painted("fill", PlotInk::Ground, {}) + "/>\n" + groups + "</svg>\n";
}

std::string svgOf(std::span<const Plot> plots, const PlotPage& page) {
    std::vector<PlotDrawing> drawings;
    for (const Plot& plot : plots) drawings.push_back(drawingOf(plot, page));
    return svgOf(drawings);
}

} // namespace pellucid
