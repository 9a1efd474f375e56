// --axes: how data lie whose file does not say it.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "session/scene.h"
#include "session/session_json.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// As `info` prints them.
std::string axesOf(const Workshop& w, const Words& info) {
    const std::string out = w.run(info).out, key = "\naxes";
    const auto at = out.find(key);
    if (at == std::string::npos) return {};
    const auto from = out.find_first_not_of(' ', at + key.size());
    return out.substr(from, out.find('\n', from) - from);
}

} // namespace

TEST_CASE("axes are what the user says of them", "[axes]") {
    const Workshop w;
    const Words what{"info", "sample:shells", "--sample-size", "16"};
    CHECK(axesOf(w, what) == "+x, +y, +z");
    CHECK(axesOf(w, what + Words{"--axes", "LPS"}) == "R→L, A→P, I→S");
    CHECK(axesOf(w, what + Words{"--axes", "-z+x+y"}) == "-z, +x, +y");

    const Outcome wrong = w.run(what + Words{"--axes", "LRS"});
    CHECK(wrong.status == 2);
    CHECK_THAT(wrong.err, Catch::Contains("--axes LRS") && Catch::Contains("where i, j and k point"));
}

TEST_CASE("data that are turned show from a view turned with them what they showed before", "[axes]") {
    const Workshop w;
    const Words measure{"measure", "sample:shells", "--sample-size", "24", "--tf", "tents:3"};
    const json before = w.json(measure + Words{"--view", "20,10,1"});
    // What pointed to +x points to +y, and the eye, at azimuth 20 from −y toward +x, goes along: toward azimuth 110.
    const json after = w.json(measure + Words{"--axes", "+y-x+z", "--view", "110,10,1"});
    const json still = w.json(measure + Words{"--axes", "+y-x+z", "--view", "20,10,1"});
    REQUIRE(before["features"].size() == after["features"].size());
    bool differs = false;
    for (std::size_t f = 0; f < before["features"].size(); ++f) {
        const double vws = before["features"][f]["vws"];
        CHECK(after["features"][f]["vws"].get<double>() == Approx(vws).epsilon(1e-3));
        differs = differs || std::abs(still["features"][f]["vws"].get<double>() - vws) > 0.01 * vws;
    }
    CHECK(differs);
}

TEST_CASE("a session keeps how the axes run", "[axes]") {
    const Workshop w;
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    source.axes = parseGridAxes("ILA");
    writeSession(sessionOf(source), w.path("s.pellucid.json").string());
    CHECK(axesOf(w, {"info", "--session", "s.pellucid.json"}) == "S→I, R→L, P→A");
    CHECK(axesOf(w, {"info", "--session", "s.pellucid.json", "--axes", "RAS"}) == "L→R, P→A, I→S");
    std::string text = w.read("s.pellucid.json");
    const auto at = text.find("\"ILA\"");
    REQUIRE(at != std::string::npos);
    w.write("bad.pellucid.json", text.replace(at, 5, "\"ILL\""));
    const Outcome bad = w.run({"info", "--session", "bad.pellucid.json"});
    CHECK(bad.status == 1);
    CHECK_THAT(bad.err, Catch::Contains("/axes") && Catch::Contains("where i, j and k point"));
}
