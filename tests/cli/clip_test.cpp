// --clip: the same half-spaces for pictures and figures, in every command that looks.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "session/scene.h"
#include "session/session_json.h"
#include "session/workspace.h"
#include "support/ball_on_board.h"
#include "volume/loader.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kSmall{"sample:shells", "--sample-size", "16", "--tf", "tents:3", "--view", "40,25"};

json measured(const Workshop& w, const Words& options) {
    return w.json(Words{"measure"} + kSmall + Words{"--engine", "reference"} + options)["features"];
}

} // namespace

TEST_CASE("a side of the box and the plane that it lies in are the same clip", "[cli][clip]") {
    const Workshop w;
    // 16 voxels of spacing 1 from 0: the half x:0:0.5 ends between voxels 7 and 8, at 7.5.
    const json half = measured(w, {"--clip", "x:0:0.5"});
    CHECK(half != measured(w, {}));
    CHECK(half == measured(w, {"--clip", "1,0,0,7.5"}));
    CHECK(half == measured(w, {"--clip", "4,0,0,30"})); // the normal has any length
    CHECK(measured(w, {"--clip", "z:0.5:1"}) == measured(w, {"--clip", "0,0,-1,-7.5"}));
    // Several in one list, and each with the option's name; the volume may follow.
    const json both = measured(w, {"--clip", "x:0:0.5", "0,0,-1,-7.5"});
    CHECK(both == measured(w, {"--clip", "z:0.5:1", "--clip", "1,0,0,7.5"}));
    CHECK(w.json({"measure", "--engine", "reference", "--sample-size", "16", "--tf", "tents:3", "--view", "40,25",
                  "--clip", "x:0:0.5", "0,0,-1,-7.5", "sample:shells"})["features"] == both);
    CHECK(measured(w, {"--clip", "-.5,0,0,-3.75"}) == measured(w, {"--clip", "x:0.5:1"}));
}

TEST_CASE("figures of an oblique clip are those of the reference engine", "[cli][clip]") {
    const Workshop w;
    const json told = measured(w, {"--clip", "1,2,-0.5,14", "y:0.1:0.9"});
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = "tents:3";
    inputs.view = ViewAngles{40, 25, 1};
    inputs.session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Reference; });
    inputs.session.clipping = Clipping{{0, 0.1, 0}, {1, 0.9, 1}, {{{1, 2, -0.5}, 14}}};
    Workspace workspace;
    const MeasureInput input = measureInput(openScene(inputs));
    const Measures expected = workspace.measure(input);
    REQUIRE(told.size() == expected.features.size());
    for (std::size_t i = 0; i < told.size(); ++i) {
        CHECK(told[i]["visibility"] == Approx(expected.features[i].visibility).margin(1e-12));
        CHECK(told[i]["vws"] == Approx(expected.features[i].vws).margin(1e-12));
    }
    // Something faint besides: what lies behind it is dimmed.
    inputs.session.clipping.edit([](Clipping& c) { c.rest = {{{0, 0.3, 0}, {1, 1, 1}, {}}, 0.3}; });
    writeSession(openScene(inputs).session, w.path("faint.pellucid.json").string());
    const json faint = w.json({"measure", "--session", "faint.pellucid.json", "--view", "40,25"})["features"];
    CHECK(faint != told);
    const Measures dimmed = workspace.measure(measureInput(openScene(inputs)));
    for (std::size_t i = 0; i < faint.size(); ++i)
        CHECK(faint[i]["visibility"] == Approx(dimmed.features[i].visibility).margin(1e-12));
    CHECK(w.json({"measure", "--session", "faint.pellucid.json", "--view", "40,25", "--holder", "1"})["features"] ==
          told);
    inputs.session.clipping.edit([](Clipping& c) { c.rest = {}; });
    // The command line's clips take the place of the session's; without them the session's hold.
    writeSession(openScene(inputs).session, w.path("a.pellucid.json").string());
    const Words bySession{"measure", "--session", "a.pellucid.json", "--view", "40,25"};
    CHECK(w.json(bySession)["features"] == told);
    CHECK(w.json(bySession + Words{"--clip", "x:0:1"})["features"] == measured(w, {}));
}

TEST_CASE("a board under an object is faint, and in no figure", "[cli][clip]") {
    const Workshop w;
    w.write("onboard.raw", test::ballOnBoard());
    const Words data{"onboard.raw", "--raw", "40,40,40,u8"};
    // Of the features, and whether a note says that something is faint.
    const auto measured = [&](const Words& options, bool told) {
        const Outcome o = w.run(Words{"measure"} + data + Words{"--engine", "cpu", "--json"} + options);
        INFO(o.err);
        REQUIRE(o.status == 0);
        CHECK((o.err.find("--holder 1") != std::string::npos) == told);
        return json::parse(o.out)["features"];
    };
    const json faint = measured({}, true), gone = measured({"--holder", "0"}, false);
    const json counted = measured({"--holder", "1"}, false);
    // It lies behind the ball, and hides next to nothing of it; but where it counts there is more of its values.
    const auto apart = [&](const json& a, const json& b) {
        return std::abs(a[0]["visibility"].get<double>() - b[0]["visibility"].get<double>());
    };
    CHECK(apart(gone, faint) < 1e-4);
    CHECK(apart(counted, faint) > 1e-3);
    const auto alpha = [&](const Words& options) { // on average; the board is larger than the ball
        const Words picture{"--view", "0,0", "--size", "40x40", "--background", "transparent", "--out", "a.png"};
        REQUIRE(w.run(Words{"render", "--engine", "cpu"} + data + options + picture).status == 0);
        const Image image = readImage(w.path("a.png").string());
        double sum = 0;
        for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += static_cast<double>(image.rgba[i]);
        return sum / (40 * 40);
    };
    const double usual = alpha({}), none = alpha({"--holder", "0"}), whole = alpha({"--holder", "1"});
    CHECK(none > 0.05);
    CHECK(usual > none + 0.02);
    CHECK(whole > usual + 0.02);
    // Whoever has a transfer function gets what it draws.
    const Outcome tents = w.run(Words{"measure"} + data + Words{"--tf", "tents:3", "--holder", "0"});
    CHECK(tents.status == 2);
    CHECK(tents.err.find("automatic start") != std::string::npos);
    const json found = w.json(Words{"propose"} + data)["holder"];
    CHECK(found["along"] == "z");
    CHECK(found["toward"] == json{0.0, -1.0, 0.0});
    CHECK(found["density"] > 0);
    CHECK(found["density"] < 0.5);
}

TEST_CASE("what is cut away has no visibility", "[cli][clip]") {
    const Workshop w;
    w.json(Words{"fields"} + kSmall + Words{"--engine", "reference", "--clip", "1,1,0,12", "--out", "f"});
    VolumeSource source;
    source.path = w.path("f/visibility.nrrd").string();
    const Volume visibility = loadVolume(source);
    int left = 0;
    for (int z = 0; z < 16; ++z)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const double v = visibility.value(static_cast<std::size_t>(x + 16 * (y + 16 * z)));
                if (x + y > 12) REQUIRE(v == 0);
                left += v > 0;
            }
    CHECK(left > 100);
}

TEST_CASE("every command with a camera takes clips", "[cli][clip]") {
    const Workshop w;
    const Words clips{"--clip", "x:0:0.9", "1,0,0,12"};
    w.json(Words{"measure"} + kSmall + clips);
    w.json(Words{"render"} + kSmall + clips + Words{"--size", "20x20", "--out", "a.png"});
    w.json(Words{"fields"} + kSmall + clips + Words{"--out", "g"});
    w.json(Words{"optimize"} + kSmall + clips + Words{"--target", "1,1,1", "--max-iterations", "1"});
    w.json(Words{"bench"} + kSmall + clips + Words{"--only", "refine", "--repeat", "1", "--threads", "1"});
    const Words nothing{"refine", "sample:shells", "--clip", "x:0:0.9"}; // it looks at no view
    CHECK(w.run(nothing).status == 2);
}

TEST_CASE("wrong clips are wrong usage", "[cli][clip][errors]") {
    const Workshop w;
    const auto fails = [&](const Words& clips, const std::string& part) {
        const Outcome o = w.run(Words{"measure"} + kSmall + Words{"--clip"} + clips);
        INFO(o.err);
        CHECK(o.status == 2);
        CHECK(o.out.empty());
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
        CHECK(o.err.find("--clip") != std::string::npos);
        CHECK(o.err.find(part) != std::string::npos);
    };
    fails({"0,0,0,1"}, "normal");
    fails({"1,2,3"}, "NX,NY,NZ,D");
    fails({"1,0,0,nan"}, "nan");
    fails({"1,0,0,0,0"}, "NX,NY,NZ,D");
    fails({"x:0.5:0.5"}, "A < B");
    fails({"half"}, "x:A:B");
    fails({"x:0:0.2", "x:0.5:1"}, "let them overlap");
    fails(Words(7, "1,0,0,3"), "at most 6");
    const Outcome tooDense = w.run(Words{"measure"} + kSmall + Words{"--holder", "1.5"});
    CHECK(tooDense.status == 2);
    CHECK(tooDense.err.find("--holder") != std::string::npos);
}
