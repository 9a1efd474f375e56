#include <catch2/catch.hpp>

#include <array>
#include <regex>
#include <vector>

#include "report/svg_plot.h"

using namespace pellucid;

namespace {

/// Reads the elements of an XML document as far as SVG files need it: every tag closed by its own, attributes quoted,
/// no bare & or <. Returns the names in order; empty where the document is no such thing.
std::vector<std::string> elementsOf(const std::string& xml) {
    static const std::regex tag(R"(<(\?xml[^?]*\?|/?[A-Za-z][A-Za-z0-9]*)((?:\s+[A-Za-z:-]+="[^"<]*")*)\s*(/?)>)");
    static const std::regex text(R"((?:[^&<]|&(?:amp|lt|gt|quot|#39);)*)");
    std::vector<std::string> names, open;
    auto at = xml.cbegin();
    for (std::sregex_iterator it(xml.begin(), xml.end(), tag), end; it != end; ++it) {
        const std::smatch& m = *it;
        if (!std::regex_match(at, m[0].first, text)) return {};
        at = m[0].second;
        const std::string name = m[1];
        if (name.front() == '?') continue;
        if (name.front() == '/') {
            if (open.empty() || open.back() != name.substr(1)) return {};
            open.pop_back();
            continue;
        }
        names.push_back(name);
        if (m[3].length() == 0) open.push_back(name);
    }
    return open.empty() && std::regex_match(at, xml.cend(), text) ? names : std::vector<std::string>{};
}

Plot plot(const std::string& name) {
    return {
        .title = "Curves of " + name,
        .x = {.label = "move", .lo = 0, .hi = 2, .whole = true},
        .y = {.label = "VWS", .lo = 0, .hi = 1},
        .series = {{.name = name, .color = Rgb{1, 0, 0}, .dotted = true, .points = {{0, 0}, {1, 1}, {2, 0.5, true}}}},
        .bands = {{0, 0.5, "along rays"}}};
}

} // namespace

TEST_CASE("an SVG file is well-formed and has the curve where it belongs", "[svg]") {
    const PlotPage page{.width = 400, .height = 200};
    const std::array plots{plot("bone"), plot("skin")};
    const std::string svg = svgOf(plots, page);
    const auto names = elementsOf(svg);
    REQUIRE_FALSE(names.empty());
    CHECK(names.front() == "svg");
    CHECK(std::count(names.begin(), names.end(), "g") == 2);
    CHECK(svg.find("viewBox=\"0 0 400 400\"") != std::string::npos);
    // The second plot lies below the first.
    CHECK(svg.find("translate(0 200)") != std::string::npos);
    // The curve goes through (left, bottom), (middle, top), (right, halfway).
    const PlotBox frame = boxOf(plots[0], page);
    const auto number = [](double v) {
        std::string text = std::to_string(std::round(v * 100) / 100);
        while (text.back() == '0') text.pop_back();
        if (text.back() == '.') text.pop_back();
        return text;
    };
    const std::string curve = number(frame.left) + "," + number(frame.bottom) + " " +
                              number((frame.left + frame.right) / 2) + "," + number(frame.top) + " " +
                              number(frame.right) + "," + number((frame.top + frame.bottom) / 2);
    INFO(svg << "\nwanted: " << curve);
    CHECK(svg.find("stroke=\"#ff0000\" stroke-width=\"1.8\" points=\"" + curve + "\"") != std::string::npos);
    CHECK(svg.find("prefers-color-scheme: dark") != std::string::npos);
}

TEST_CASE("names of features cannot leave their texts", "[svg]") {
    const std::string hostile = "\"><script>alert('x')</script>&amp;";
    const std::array plots{plot(hostile)};
    const std::string svg = svgOf(plots, {});
    CHECK_FALSE(elementsOf(svg).empty());
    CHECK(svg.find("<script") == std::string::npos);
    CHECK(svg.find("&quot;&gt;&lt;script&gt;") != std::string::npos);
}

TEST_CASE("texts for XML", "[svg]") {
    CHECK(escapedXml("a<b & \"c\" > 'd'") == "a&lt;b &amp; &quot;c&quot; &gt; &#39;d&#39;");
    CHECK(escapedXml("σ × 2") == "σ × 2");
    CHECK(escapedXml(std::string("a\x01"
                                 "b\0c",
                                 5)) == "a b c");
    // Not UTF-8: a byte alone, an overlong slash, half of a character, a surrogate.
    const std::string no = "\xEF\xBF\xBD";
    CHECK(escapedXml("\xFFz") == no + "z");
    CHECK(escapedXml("\xC0\xAF") == no + no);
    CHECK(escapedXml("\xE2\x82") == no + no);
    CHECK(escapedXml("\xED\xA0\x80") == no + no + no);
}
