// --overlay and its details: a second volume over the first.
#include <catch2/catch.hpp>

#include <cmath>

#include "cli_runner.h"
#include "image_io/image_file.h"

using namespace pellucid;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kSmall{"render", "sample:shells", "--sample-size", "16",    "--tf",     "tents:3:0.05",
                   "--view", "30,20",         "--size",        "40x40", "--engine", "cpu"};
/// Nothing tells where they lie: in the middle of the shells.
const Words kOverlay{"--overlay", "sample:disks"};

} // namespace

TEST_CASE("render draws a second volume over the first, in pictures and slices", "[cli][overlay]") {
    const Workshop w;
    const auto draw = [&](const Words& options, const std::string& file) {
        const Outcome o = w.run(kSmall + options + Words{"--out", file});
        INFO(o.err);
        REQUIRE(o.status == 0);
        return readImage(w.path(file).string()).rgba;
    };
    const auto alone = draw({}, "alone.png"), both = draw(kOverlay, "both.png");
    CHECK(alone != both);
    // Samples lie elsewhere along rays that begin at the overlay, which changes an 8-bit level or two at most.
    const auto clear = draw(kOverlay + Words{"--overlay-opacity", "0"}, "clear.png");
    for (std::size_t i = 0; i < clear.size(); ++i) REQUIRE(std::abs(clear[i] - alone[i]) < 2.5f / 255);
    CHECK(draw(kOverlay + Words{"--overlay-threshold", "0.8"}, "threshold.png") != both);
    CHECK(draw(kOverlay + Words{"--overlay-map", "sand"}, "sand.png") != both);
    CHECK(draw(kOverlay + Words{"--overlay-tf", "tents:2:0.3"}, "tf.png") != both);
    CHECK(draw({"--overlay", "none"}, "none.png") == alone);
    const Words slice{"--slice", "z:0.5"};
    CHECK(draw(slice, "slice.png") != draw(slice + kOverlay, "over.png"));
}

TEST_CASE("OpenGL asked for, the picture with an overlay is the cpu engine's, and that is said", "[cli][overlay]") {
    const Workshop w;
    const Words words{"render",  "sample:shells", "--sample-size", "16",       "--tf",
                      "tents:3", "--size",        "20x20",         "--engine", "gl",
                      "--out",   "p.png",         "--json"};
    const Outcome probe = w.run(words);
    if (probe.status != 0) return; // no OpenGL here
    const Outcome o = w.run(words + kOverlay);
    CHECK(o.status == 0);
    CHECK(o.out.find("\"engine\":\"cpu\"") != std::string::npos);
    CHECK(o.err.find("OpenGL draws no overlay") != std::string::npos);
}

TEST_CASE("what cannot be an overlay is told with its option", "[cli][overlay]") {
    const Workshop w;
    const auto refused = [&](const Words& options, const std::string& said, int status) {
        const Outcome o = w.run(kSmall + Words{"--out", "p.png"} + options);
        INFO(o.err);
        CHECK(o.status == status);
        CHECK(o.err.find(said) != std::string::npos);
        CHECK(!w.has("p.png"));
    };
    refused({"--overlay-opacity", "0.5"}, "--overlay-opacity", 2);
    refused({"--overlay-tf", "tents:2"}, "--overlay-tf", 2);
    refused({"--overlay", ""}, "--overlay", 2);
    refused(kOverlay + Words{"--overlay-map", "mud"}, "--overlay-map", 2);
    refused(kOverlay + Words{"--overlay-opacity", "2"}, "--overlay-opacity", 2);
    refused(kOverlay + Words{"--overlay-tf", "tents:2", "--overlay-top", "1"}, "--overlay-top", 2);
    refused({"--overlay", "gone.nrrd"}, "gone.nrrd", 1);
    refused(kOverlay + Words{"--field", "visibility"}, "--overlay", 2);
}

TEST_CASE("figures are of the volume alone, whatever lies over it, and that is said", "[cli][overlay]") {
    const Workshop w;
    const std::string begin = R"({"format": "pellucid-session", "version": 1, "variables": [)",
                      overlay = R"(], "overlay": {"source": {"sample": "disks"}}})";
    w.write("with.pellucid.json", begin + overlay);
    w.write("without.pellucid.json", begin + "]}");
    const auto measured = [&](const std::string& session) {
        return w.run({"measure", "sample:shells", "--sample-size", "16", "--tf", "tents:3", "--engine", "cpu", "--view",
                      "30,20", "--session", session});
    };
    const Outcome with = measured("with.pellucid.json"), without = measured("without.pellucid.json");
    INFO(with.err);
    REQUIRE(without.status == 0);
    // The last line says how long it took.
    const auto figures = [](const std::string& out) { return out.substr(0, out.find("engine")); };
    CHECK(figures(with.out) == figures(without.out));
    CHECK(figures(with.out).find("f3") != std::string::npos);
    CHECK(with.err.find("figures are of the volume alone") != std::string::npos);
    CHECK(without.err.find("overlay") == std::string::npos);
}

TEST_CASE("measure tells what part of the picture the overlay has, and each feature beside it", "[cli][overlay]") {
    const Workshop w;
    const Words measure{"measure", "sample:shells", "--sample-size", "16",       "--tf", "tents:3:0.05", "--view",
                        "30,20",   "--size",        "48x48",         "--engine", "cpu",  "--shares"};
    const auto alone = w.json(measure);
    CHECK_FALSE(alone["picture_shares"].contains("overlay"));
    const Outcome o = w.run(measure + kOverlay + Words{"--json"});
    REQUIRE(o.status == 0);
    const auto both = nlohmann::json::parse(o.out);
    double sum = both["picture_shares"]["overlay"].get<double>() + both["picture_shares"]["rest"].get<double>();
    for (std::size_t f = 0; f < 3; ++f) {
        const double share = both["features"][f]["picture_share"];
        sum += share;
        CHECK(share < alone["features"][f]["picture_share"].get<double>()); // it hides some of each
        CHECK(both["features"][f]["vws"] == alone["features"][f]["vws"]);
    }
    CHECK(both["picture_shares"]["overlay"] > 0.01);
    CHECK(sum == Approx(both["picture_shares"]["alpha"].get<double>()).margin(1e-6));
    const Outcome text = w.run(measure + kOverlay);
    CHECK(text.out.find(" of the overlay and 0.") != std::string::npos);
    const Outcome none = w.run({"measure", "sample:shells", "--sample-size", "16", "--overlay", "sample:disks"});
    CHECK(none.status == 2);
    CHECK(none.err.find("no picture is looked at, --overlay") != std::string::npos);
}
