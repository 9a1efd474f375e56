#include "figure/svg_figure.h"

#include <algorithm>
#include <cmath>

#include "base/base64.h"
#include "base/round_numbers.h"
#include "base/xml_text.h"
#include "figure/print.h"
#include "image_io/image_file.h"

namespace pellucid {

namespace {

/// A length in millimetres, to a ten-thousandth.
std::string number(double value) {
    std::string text = fixedText(value, 4);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string attribute(const char* name, const std::string& value) {
    return " " + std::string(name) + "=\"" + value + "\"";
}

std::string painted(const char* what, const Rgb& color, double alpha) {
    std::string text = attribute(what, hexFromRgb(color));
    if (alpha < 1) text += attribute((std::string(what) + "-opacity").c_str(), number(alpha));
    return text;
}

std::string pointsText(const std::vector<Vec2>& points) {
    std::string text;
    for (const Vec2& p : points) text += (text.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
    return text;
}

class Writer {
public:
    explicit Writer(const Figure& figure) : m_figure(figure) {}

    std::string text() {
        std::string body;
        for (const FigureGroup& group : m_figure.groups) body += groupText(group);
        const std::string width = number(m_figure.width), height = number(m_figure.height);
        return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
               "xmlns:xlink=\"http://www.w3.org/1999/xlink\"" +
               attribute("width", width + "mm") + attribute("height", height + "mm") +
               attribute("viewBox", "0 0 " + width + " " + height) +
               " role=\"img\" aria-labelledby=\"title desc\">\n<title id=\"title\">" + escapedXml(m_figure.title) +
               "</title>\n<desc id=\"desc\">" + escapedXml(m_figure.description) + "</desc>\n" +
               (m_definitions.empty() ? "" : "<defs>\n" + m_definitions + "</defs>\n") + body + "</svg>\n";
    }

    void operator()(const FigurePicture& picture) {
        m_elements += "<image" + attribute("x", number(picture.at.x)) + attribute("y", number(picture.at.y)) +
                      attribute("width", number(picture.width)) + attribute("height", number(picture.height)) +
                      " preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64," +
                      base64(pngOf(*picture.image)) + "\"/>\n";
    }

    void operator()(const FigureArea& area) {
        std::string fill = painted("fill", area.color, area.alpha);
        if (!area.stops.empty()) {
            fill = attribute("fill", "url(#" + gradient(area) + ")");
            if (area.alpha < 1) fill += attribute("fill-opacity", number(area.alpha));
        }
        m_elements += "<polygon" + attribute("points", pointsText(area.corners)) + fill + "/>\n";
    }

    void operator()(const FigureLine& line) {
        m_elements += "<polyline" + attribute("points", pointsText(line.points)) + " fill=\"none\"" +
                      painted("stroke", line.color, line.alpha) + attribute("stroke-width", number(line.width)) +
                      kRound + "/>\n";
    }

    void operator()(const FigureText& text) {
        const std::string d = attribute("d", outlineOf(text, m_figure.font));
        m_elements += "<g role=\"img\"" + attribute("aria-label", escapedXml(text.text)) + ">";
        if (text.halo > 0)
            m_elements += "<path" + d + " fill=\"none\"" + painted("stroke", text.haloColor, kHaloAlpha * text.alpha) +
                          attribute("stroke-width", number(2 * text.halo)) + kRound + "/>";
        m_elements += "<path" + d + painted("fill", text.color, text.alpha) + "/></g>\n";
    }

private:
    static constexpr const char* kRound = " stroke-linecap=\"round\" stroke-linejoin=\"round\"";

    std::string groupText(const FigureGroup& group) {
        m_elements.clear();
        for (const FigureElement& element : group.elements) std::visit(*this, element);
        std::string open = "<g" + attribute("id", group.name);
        if (!group.label.empty()) open += attribute("aria-label", escapedXml(group.label));
        if (group.clip) open += attribute("clip-path", "url(#" + clip(*group.clip) + ")");
        return open + ">\n" + m_elements + "</g>\n";
    }

    std::string clip(const PixelBox& box) {
        const std::string id = "clip" + std::to_string(++m_clips);
        m_definitions += "<clipPath" + attribute("id", id) + "><rect" + attribute("x", number(box.left)) +
                         attribute("y", number(box.top)) + attribute("width", number(box.right - box.left)) +
                         attribute("height", number(box.bottom - box.top)) + "/></clipPath>\n";
        return id;
    }

    std::string gradient(const FigureArea& area) {
        const std::string id = "gradient" + std::to_string(++m_gradients);
        m_definitions += "<linearGradient" + attribute("id", id) + ">";
        for (const FigureStop& stop : area.stops)
            m_definitions +=
                "<stop" + attribute("offset", number(stop.at)) + attribute("stop-color", hexFromRgb(stop.color)) + "/>";
        m_definitions += "</linearGradient>\n";
        return id;
    }

    const Figure& m_figure;
    std::string m_elements, m_definitions;
    int m_clips = 0, m_gradients = 0;
};

} // namespace

std::string svgOf(const Figure& figure) { return Writer(figure).text(); }

} // namespace pellucid
