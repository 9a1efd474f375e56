// --profile, --along: the published definitions from the command line.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "session/refine_priority.h"
#include "session/workspace.h"
#include "volume/histogram.h"
#include "volume/loader.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kSmallDisks{"sample:disks", "--sample-size", "16", "--tf", "tents:3:0.3"};
const Words kPublished{"--profile", "published"};

} // namespace

TEST_CASE("measure, fields and optimize know the published profile", "[cli][published]") {
    const Workshop w;
    const json told = w.json(Words{"measure"} + kSmallDisks + kPublished + Words{"--along", "left"});
    CHECK(told["engine"] == "published");
    CHECK(told["profile"] == "published");
    CHECK(told["along"] == "left");
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 16;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = "tents:3:0.3";
    inputs.session.measure.edit([](MeasureSettings& m) {
        m.profile = Profile::Published;
        m.along = Along::Left;
    });
    const Measures expected = Workspace().measure(measureInput(openScene(inputs)));
    for (std::size_t f = 0; f < 3; ++f) CHECK(told["features"][f]["vws"] == expected.features[f].vws);

    const json found = w.json(Words{"optimize"} + kSmallDisks + kPublished +
                              Words{"--along", "left", "--target", "1,1,1", "--method", "newton"});
    CHECK(found["along"] == "left");
    CHECK(found["vws"][0][0] == told["features"][0]["vws"]);
    const std::size_t best = found["best"];
    CHECK(found["objective"][best].get<double>() < 0.8 * found["objective"][0].get<double>());

    const json fields = w.json(Words{"fields"} + kSmallDisks + kPublished + Words{"--out", "f"});
    CHECK(fields["along"] == "front"); // where nothing else is said
    CHECK(w.has("f/vws.nrrd"));
    CHECK_FALSE(w.json(Words{"measure", "--view", "30,20"} + kSmallDisks).contains("profile"));
}

TEST_CASE("the published profile takes no option that it fixes", "[cli][published]") {
    const Workshop w;
    const auto refused = [&](const Words& options, const std::string& message) {
        const Outcome outcome = w.run(Words{"measure"} + kSmallDisks + options);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Catch::Contains(message));
    };
    refused(kPublished + Words{"--sigma", "3"}, "--sigma");
    refused(kPublished + Words{"--engine", "gl"}, "--engine");
    refused(kPublished + Words{"--u1", "0.3"}, "--u1");
    refused({"--along", "top"}, "--along");
    refused({"--profile", "thesis"}, "--profile");
    refused(kPublished + Words{"--along", "north"}, "--along");
    // A camera is of no use, and of no harm.
    const Outcome outcome = w.run(Words{"measure", "--view", "30,20"} + kSmallDisks + kPublished);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, Catch::Contains("view \"front\" of the published profile"));
    CHECK_THAT(outcome.out, Catch::Contains("engine published (published profile, front)"));
}

TEST_CASE("commands take a transfer function of Voreen", "[cli][published]") {
    const Workshop w;
    w.write("one.tfi", R"(<VoreenData><TransFuncIntensity><domain x="0" y="100"/><Keys>
        <key><intensity value="0.2"/><colorL r="255" g="0" b="0" a="0"/></key>
        <key><intensity value="0.4"/><colorL r="255" g="0" b="0" a="102"/></key>
        <key><intensity value="0.6"/><colorL r="255" g="0" b="0" a="0"/></key>
        </Keys></TransFuncIntensity></VoreenData>)");
    const json told = w.jsonAndNotes({"measure", "sample:disks", "--sample-size", "12", "--tf", "one.tfi"});
    CHECK(told["volume"]["range"] == json({0, 100}));
    CHECK(told["features"][0]["opacity"] == Approx(0.4)); // 102/255
    w.write("bad.tfi", "<VoreenData>\n<Keys>");
    const Outcome outcome = w.run({"measure", "sample:disks", "--tf", "bad.tfi"});
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Catch::Contains("not valid XML") && Catch::Contains("bad.tfi, line 2"));
}

TEST_CASE("refinement and volatility go by the published profile and name it", "[cli][published]") {
    const Workshop w;
    // Three tents as a file of Voreen has them, over 8-bit data: intensities are value/255.
    w.write("three.tfi", R"(<VoreenData><TransFuncIntensity><Keys>
        <key><intensity value="0.1"/><colorL r="255" g="0" b="0" a="0"/></key>
        <key><intensity value="0.2"/><colorL r="255" g="0" b="0" a="85"/></key>
        <key><intensity value="0.3"/><colorL r="255" g="0" b="0" a="0"/></key>
        <key><intensity value="0.4"/><colorL r="0" g="255" b="0" a="0"/></key>
        <key><intensity value="0.5"/><colorL r="0" g="255" b="0" a="85"/></key>
        <key><intensity value="0.6"/><colorL r="0" g="255" b="0" a="0"/></key>
        <key><intensity value="0.7"/><colorL r="0" g="0" b="255" a="0"/></key>
        <key><intensity value="0.8"/><colorL r="0" g="0" b="255" a="85"/></key>
        <key><intensity value="0.9"/><colorL r="0" g="0" b="255" a="0"/></key>
        </Keys></TransFuncIntensity></VoreenData>)");
    const Words kRefine{"refine", "sample:shells", "--sample-size", "16", "--tf", "three.tfi"};
    const json own = w.jsonAndNotes(kRefine), told = w.jsonAndNotes(kRefine + kPublished);
    CHECK_FALSE(own.contains("profile"));
    CHECK(told["profile"] == "published");
    // By the histogram of the same data, in the same places.
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = w.path("three.tfi").string();
    inputs.session.measure.edit([](MeasureSettings& m) { m.profile = Profile::Published; });
    const Scene scene = openScene(inputs);
    CHECK(scene.volume->range() == ValueRange{0, 255});
    RefineOptions by = refineOptions(scene.session);
    CHECK(by.stepDown == 1.0 / 255);
    CHECK(by.stepUp == 1.0 / 255);
    const RefineResult expected = refine(makeHistogram(*scene.volume), scene.tf, by);
    CHECK(told["edges_before"] == json(expected.edgesBefore));
    CHECK(told["energy_movable_after"] == expected.energyMovableAfter);
    CHECK(told["edges_before"] != own["edges_before"]);
    // A hue is compared as it is, red from blue by 240 degrees, not by 120: points 1 to 9 of 11 lie at hue 0, 120, 240
    // (the ends have their neighbours' colours), distances from 0 over their sum 3/3 + 4·2/3: 11/3.
    const json byHue = w.jsonAndNotes(kRefine + kPublished + Words{"--hue", "0"});
    CHECK(byHue["priority"] == json({{"kind", "hue"}, {"hue", 0.0}}));
    CHECK(byHue["factors"][1].get<double>() == Approx(0).margin(1e-12));
    CHECK(byHue["factors"][5].get<double>() == Approx(1.0 / 11));
    CHECK(byHue["factors"][8].get<double>() == Approx(2.0 / 11));
    const Outcome text = w.run(kRefine + kPublished + Words{"--hue", "0"});
    CHECK_THAT(text.out, Catch::Contains("published") && Catch::Contains("hue 0"));
    for (const char* step : {"--step-down", "--step-up"}) {
        const Outcome refused = w.run(kRefine + kPublished + Words{step, "0.1"});
        CHECK(refused.status == 2);
        CHECK_THAT(refused.err, Catch::Contains(step));
    }

    // A series: every frame by the published definitions, and volatility by name.
    w.json({"generate", "vortex", "--size", "12", "--frames", "4", "--out", "v%02d.nrrd"});
    const Words kSeries{"sequence", "v%02d.nrrd", "--tf",     "three.tfi",   "--no-pictures",
                        "--size",   "16x16",      "--engine", "auto",        "--out",
                        "o",        "--mode",     "refine",   "--intensity", "0.5"};
    const json frames = w.json(kSeries + kPublished);
    CHECK(frames["profile"] == "published");
    const json alone =
        w.json(Words{"refine", "v%02d.nrrd", "--tf", "o/frame_0001.tf.json", "--frame", "2", "--intensity", "0.5"} +
               kPublished);
    CHECK(frames["frames"][2]["tf"]["points"] == alone["tf"]["points"]);
    CHECK(frames["frames"][2]["energy_movable_after"] == alone["energy_movable_after"]);
    const Words kInfo{"info", "v%02d.nrrd", "--variable", "s=volatility:x:3"};
    CHECK(w.json(kInfo)["definitions"]["s"].get<std::string>().find("population") == 0);
    CHECK(w.json(kInfo + kPublished)["definitions"]["s"].get<std::string>().find("sample") == 0);
    const Words kColours{"render", "v%02d.nrrd", "--frame", "3", "--hsb", "saturation=volatility:x:3",
                         "--size", "24x24"};
    const json population = w.json(kColours + Words{"--out", "a.png"}),
               sample = w.json(kColours + kPublished + Words{"--out", "b.png"});
    CHECK(sample["hsb"]["definitions"]["volatility:x:3"].get<std::string>().find("sample") == 0);
    CHECK(population["hsb"]["a"].get<double>() > 2 * sample["hsb"]["a"].get<double>()); // that is stretched to [0,1]
    CHECK(w.read("a.png") != w.read("b.png"));
}
