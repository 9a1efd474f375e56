// What `reproduce` keeps and shows of a figure.
#include "report/reproduction.h"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/reproduction_page.h"
#include "support/text_parts.h"

using namespace pellucid;
using pellucid::test::contains;

namespace {

/// With everything that an item may have, and with characters that pages must escape.
Reproduction item() {
    Reproduction r;
    r.id = "4.5";
    r.shows = {"4.5", "4.6"};
    r.title = "Bars <of> disks";
    r.thesis = "bars & disks.";
    r.equations = {{"4.12", "src/saliency/vws.cpp"}, {"4.4", "src/render/sweep.cpp"}};
    r.data = {"sample:disks, 64 voxels long"};
    r.pictures = {{"4.5/left.png", "4.5 (a)", "from \"the left\""}};
    r.numbers = {{"moves", 3, 2, "moves"}, {"time", 0.5, 2, "s"}};
    r.tables = {{"Shares", {"feature", "VWS"}, {{"first_disk|", "0.5"}}}};
    r.statements = {{"A < B.", "4.3.5", true, "0.2 < 0.5"}, {"B < A.", "4.3.5", false, "0.5 > 0.2"}};
    r.remarks = {"Ours is <a sample>."};
    r.commands = {{"pellucid-cli measure sample:disks > 4.5/left.json", 1.5}};
    r.seconds = 61;
    return r;
}

} // namespace

TEST_CASE("a reproduction is read back as it was", "[report][reproduce]") {
    Reproduction r = item();
    r.error = "it failed";
    const nlohmann::json json = nlohmann::json::parse(jsonFromReproduction(r).dump());
    CHECK(reproductionFromJson(json, "item.json") == r);

    r.numbers[0].ours = std::numeric_limits<double>::quiet_NaN();
    const auto unknown = nlohmann::json::parse(jsonFromReproduction(r).dump());
    CHECK(std::isnan(reproductionFromJson(unknown, "item.json").numbers[0].ours));

    nlohmann::json wrong = json;
    wrong["statements"][1]["holds"] = "yes";
    CHECK_THROWS_WITH(reproductionFromJson(wrong, "item.json"), Catch::Contains("item.json at /statements/1/holds"));
    wrong = json;
    wrong["tables"][0]["rows"][0].push_back("one too many");
    CHECK_THROWS_AS(reproductionFromJson(wrong, "item.json"), Error);
}

TEST_CASE("items are called by all that they show", "[report][reproduce]") {
    Reproduction r;
    r.shows = {"4.1"};
    CHECK(headingOf(r) == "Figure 4.1");
    r.shows = {"3.4", "3.5"};
    CHECK(headingOf(r) == "Figures 3.4 and 3.5");
    r.shows = {"A.1", "A.2", "A.3"};
    CHECK(headingOf(r) == "Figures A.1 to A.3");
    r.shows = {"5.1", "5.2", "5.5"};
    CHECK(headingOf(r) == "Figures 5.1, 5.2 and 5.5");
    r.shows = {"table-3.2"};
    CHECK(headingOf(r) == "Table 3.2");
}

TEST_CASE("the page has contents, statements and numbers, and escapes every text", "[report][reproduce]") {
    const std::vector<Reproduction> items{item()};
    const std::string html = htmlOf({items, "Pellucid <1>", "pellucid-cli reproduce", 75});
    CHECK(contains(html, "<a href=\"#4.5\">Figures 4.5 and 4.6</a>"));
    CHECK(contains(html, "Bars &lt;of&gt; disks"));
    CHECK(contains(html, "The thesis shows bars &amp; disks."));
    CHECK(contains(html, "src=\"4.5/left.png\""));
    CHECK(contains(html, "from &quot;the left&quot;"));
    CHECK(contains(html, "A &lt; B."));
    CHECK(contains(html, "<b>Does not hold</b>: 0.5 &gt; 0.2"));
    CHECK(contains(html, "Ours is &lt;a sample&gt;."));
    CHECK(contains(html, "measure sample:disks &gt; 4.5/left.json"));
    CHECK(contains(html, "Pellucid &lt;1&gt;"));
    CHECK(contains(html, "1 of 2 statements of its text hold"));
    CHECK(contains(html, "<td>1 of 2</td>"));
    CHECK(contains(html, "1 min 15 s"));
    // 3 moves where the thesis has 2; half a second where it has two: a quarter.
    CHECK(contains(html, "<td>3 moves</td><td>2 moves</td><td>+1</td>"));
    CHECK(contains(html, "<td>× 0.25</td>"));
}

TEST_CASE("an item that failed says why, on the page and in the index", "[report][reproduce]") {
    Reproduction r = item();
    r.error = "no <file>";
    const std::vector<Reproduction> items{r};
    CHECK(contains(htmlOf({items, "", "", 0}), "It failed: no &lt;file&gt;"));
    CHECK(contains(htmlOf({items, "", "", 0}), "1 item failed"));
    CHECK(contains(indexOf(items), "It failed: no \\<file\\>"));
}

TEST_CASE("the index leads from equations to files, commands and results, without times", "[report][reproduce]") {
    const std::vector<Reproduction> items{item()};
    const std::string text = indexOf(items);
    const std::size_t first = text.find("| (4.4) | `src/render/sweep.cpp` | `reproduce 4.5` | "
                                        "[Figures 4.5 and 4.6](#figures-45-and-46) |"),
                      second = text.find("| (4.12) | `src/saliency/vws.cpp` |");
    CHECK(first != std::string::npos);
    CHECK(second != std::string::npos);
    CHECK(first < second); // by number, not by letters
    CHECK(contains(text, "\n## Figures 4.5 and 4.6\n"));
    CHECK(contains(text, "\n    pellucid-cli measure sample:disks > 4.5/left.json\n"));
    CHECK(contains(text, "| first\\_disk\\| | 0.5 |"));
    CHECK(contains(text, "**Does not hold**: 0.5 \\> 0.2."));
    CHECK_FALSE(contains(text, "time"));
    CHECK_FALSE(contains(text, "left.png"));

    Reproduction later = item();
    later.seconds = 99;
    later.commands[0].seconds = 7;
    later.numbers[1].ours = 9;
    const std::vector<Reproduction> again{later};
    CHECK(indexOf(again) == text);
}
