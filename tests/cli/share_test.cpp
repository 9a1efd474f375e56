// `share`: a scene as one web page.
#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kSmallShare{"share", "sample:shells", "--sample-size", "16", "--tf", "tents:3"};

} // namespace

TEST_CASE("share writes a page, and says that the voxels are in it", "[cli][share]") {
    const Workshop w;
    const Outcome outcome =
        w.run(kSmallShare + Words{"--view", "30,20", "--title", "A & B", "--out", "page.html", "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK(outcome.err.find("note: the page holds the voxels themselves") != std::string::npos);
    const json share = json::parse(outcome.out);
    CHECK(share["command"] == "share");
    CHECK(share["bytes"] == w.read("page.html").size());
    CHECK(share["dims"] == json({16, 16, 16}));
    CHECK(share["factor"] == 1);
    CHECK(share["losses"]["coarser"] == false);
    CHECK(share["density"] == true);
    CHECK(w.read("page.html").find("<h1>A &#38; B</h1>") != std::string::npos);

    const json coarse = w.jsonAndNotes(
        kSmallShare + Words{"--voxels", "1000", "--bits", "8", "--density-slider", "off", "--out", "c.html"});
    CHECK(coarse["dims"] == json({8, 8, 8}));
    CHECK(coarse["full_dims"] == json({16, 16, 16}));
    CHECK(coarse["factor"] == 2);
    CHECK(coarse["bits"] == 8);
    CHECK(coarse["losses"]["coarser"] == true);
    CHECK(coarse["density"] == false);
}

TEST_CASE("pages that cannot be written are refused in words", "[cli][share]") {
    const Workshop w;
    const auto refused = [&](const Words& options, int status, const std::string& word) {
        const Outcome outcome = w.run(kSmallShare + options);
        INFO(outcome.err);
        CHECK(outcome.status == status);
        CHECK(outcome.out.empty());
        CHECK(outcome.err.find(word) != std::string::npos);
    };
    refused({}, 2, "--out");
    refused({"--out", "page.png"}, 2, "page.html");
    refused({"--out", "page.html", "--background", "transparent"}, 2, "--background");
    refused({"--out", "page.html", "--bits", "12"}, 2, "--bits");
    refused({"--out", "page.html", "--mode", "mip"}, 1, "emission and absorption");
    refused({"--out", "page.html", "--mb", "0.01"}, 1, "no page is as small");
    refused({"--out", "none/page.html"}, 1, "none");
    CHECK_FALSE(w.has("page.html"));
}
