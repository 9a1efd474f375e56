// --profile, --along: the published definitions from the command line.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "session/workspace.h"
#include "volume/loader.h"

using namespace pellucid;
using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kSmall{"sample:disks", "--sample-size", "16", "--tf", "tents:3:0.3"};
const Words kPublished{"--profile", "published"};

} // namespace

TEST_CASE("measure, fields and optimize know the published profile", "[cli][published]") {
    const Workshop w;
    const json told = w.json(Words{"measure"} + kSmall + kPublished + Words{"--along", "left"});
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

    const json found = w.json(Words{"optimize"} + kSmall + kPublished +
                              Words{"--along", "left", "--target", "1,1,1", "--method", "newton"});
    CHECK(found["along"] == "left");
    CHECK(found["vws"][0][0] == told["features"][0]["vws"]);
    const std::size_t best = found["best"];
    CHECK(found["objective"][best].get<double>() < 0.8 * found["objective"][0].get<double>());

    const json fields = w.json(Words{"fields"} + kSmall + kPublished + Words{"--out", "f"});
    CHECK(fields["along"] == "front"); // where nothing else is said
    CHECK(w.has("f/vws.nrrd"));
    CHECK_FALSE(w.json(Words{"measure", "--view", "30,20"} + kSmall).contains("profile"));
}

TEST_CASE("the published profile takes no option that it fixes", "[cli][published]") {
    const Workshop w;
    const auto refused = [&](const Words& options, const std::string& message) {
        const Outcome outcome = w.run(Words{"measure"} + kSmall + options);
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
    const Outcome outcome = w.run(Words{"measure", "--view", "30,20"} + kSmall + kPublished);
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
    const json told = w.json({"measure", "sample:disks", "--sample-size", "12", "--tf", "one.tfi"});
    CHECK(told["volume"]["range"] == json({0, 100}));
    CHECK(told["features"][0]["opacity"] == Approx(0.4)); // 102/255
    w.write("bad.tfi", "<VoreenData>\n<Keys>");
    const Outcome outcome = w.run({"measure", "sample:disks", "--tf", "bad.tfi"});
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.err, Catch::Contains("not valid XML") && Catch::Contains("bad.tfi, line 2"));
}
