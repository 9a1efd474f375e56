// `figure`: figures for print.
#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kScene{"sample:shells", "--sample-size", "12", "--tf", "tents:3", "--view", "30,20"};
const Words kSmallFigure = Words{"figure"} + kScene + Words{"--dpi", "50"};

} // namespace

TEST_CASE("figure writes PDF and SVG with the shares that measure tells", "[cli][figure]") {
    const Workshop w;
    const json figure = w.json(kSmallFigure + Words{"--width-mm", "114", "--out", "a.pdf"});
    CHECK(figure["command"] == "figure");
    CHECK(figure["page_mm"][0] == 114.0);
    CHECK(figure["pixels"] == json::array({224, 168})); // 114 · 50 / 25.4 = 224.4, and 3/4 of 114 mm: 168.3
    CHECK(w.read("a.pdf").rfind("%PDF-", 0) == 0);
    const json measured = w.json(Words{"measure"} + kScene);
    REQUIRE(figure["features"].size() == 3);
    for (std::size_t f = 0; f < 3; ++f)
        for (const char* what : {"name", "vws", "visibility", "opacity"}) {
            INFO(what);
            CHECK(figure["features"][f][what] == measured["features"][f][what]);
        }
    w.json(kSmallFigure + Words{"--parts", "scale,legend,shares,colors,caption", "--out", "a.svg"});
    w.json(kSmallFigure + Words{"--parts", "scale,legend,shares,colors,caption", "--out", "b.svg"});
    CHECK(w.read("a.svg").find("<svg") != std::string::npos);
    CHECK(w.read("a.svg") == w.read("b.svg")); // by another process
    w.json(kSmallFigure + Words{"--width-mm", "114", "--out", "b.pdf"});
    CHECK(w.read("a.pdf") == w.read("b.pdf"));
}

TEST_CASE("figure has all parts where all are asked for, and says which font stands in", "[cli][figure]") {
    const Workshop w;
    const json all = w.json(kSmallFigure + Words{"--parts", "all", "--out", "a.svg"});
    CHECK_FALSE(all["caption"].get<std::string>().empty());
    CHECK(all.contains("scale"));
    for (const char* part : {"heading", "picture", "annotations", "feature-1", "shares-axis", "colors", "caption"}) {
        INFO(part);
        CHECK(w.read("a.svg").find("<g id=\"" + std::string(part) + "\"") != std::string::npos);
    }
    const auto noteOf = [&](const std::string& font) {
        const Outcome outcome = w.run(kSmallFigure + Words{"--parts", "legend", "--font", font, "--out", "b.svg"});
        INFO(outcome.err);
        CHECK(outcome.status == 0);
        return outcome.err;
    };
    CHECK(noteOf("NoSuchFontXYZ").find("the font NoSuchFontXYZ is not installed: ") != std::string::npos);
    CHECK(noteOf("NoSuchFontXYZ, sans").empty()); // any font is a sans
    const json noted =
        w.jsonAndNotes(kSmallFigure + Words{"--parts", "legend", "--font", "NoSuchFontXYZ", "--out", "b.svg"});
    REQUIRE(noted["notices"].size() == 1);
    // What stands in is there, so that it can be asked for without a note.
    const std::string notice = noted["notices"][0], before = "installed: ";
    const std::size_t at = notice.find(before) + before.size();
    CHECK(noteOf(notice.substr(at, notice.find(" is used instead") - at)).empty());
}

TEST_CASE("figures that cannot be made are refused in words", "[cli][figure]") {
    const Workshop w;
    const auto refused = [&](const Words& options, const std::string& word) {
        const Outcome outcome = w.run(Words{"figure"} + kScene + options);
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find(word) != std::string::npos);
    };
    refused({}, "--out");
    refused({"--out", "a.png"}, ".svg or .pdf");
    refused({"--out", "a.pdf", "--parts", "scale,moon"}, "moon");
    refused({"--out", "a.pdf", "--width-mm", "0"}, "--width-mm");
    refused({"--out", "a.pdf", "--dpi", "2400", "--width-mm", "500"}, "fewer dots per inch");
    CHECK(w.list().empty());
}

TEST_CASE("figure says that too little memory is left for fonts", "[cli][figure]") {
    const Workshop w;
    const Outcome refused =
        w.run(kSmallFigure + Words{"--memory", "0.09", "--out", "a.pdf"}); // 97 MB, of which 101 are needed
    CHECK(refused.status == 1);
    CHECK(refused.err.find("setting the letters of a figure needs 101 MB of memory") != std::string::npos);
    CHECK_FALSE(w.has("a.pdf"));
    CHECK(w.run(kSmallFigure + Words{"--memory", "1", "--out", "a.pdf"}).status == 0);
}
