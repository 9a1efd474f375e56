#include <filesystem>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image_io/image_file.h"
#include "optimize/measure.h"
#include "session/session_json.h"
#include "session/workspace.h"
#include "study/participation.h"
#include "study/preparation.h"
#include "support/study_cases.h"

using namespace pellucid;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;

namespace {

/// A session of a small volume in which three shells are features.
std::string smallSession(const TempFolder& folder) {
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    Session session = sessionOf(source);
    session.setTf(tents(3));
    session.measure.edit([](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    session.display.edit([](DisplaySettings& d) { d.background = {1, 0, 0}; });
    writeSession(session, folder.path("small.pellucid.json"));
    return folder.path("small.pellucid.json");
}

Study smallStudy(const TempFolder& folder, int count) {
    Study study = studyOf(0, count);
    for (Stimulus& s : study.stimuli) {
        s.volume.clear();
        s.tf.clear();
        s.session = smallSession(folder);
    }
    return study;
}

} // namespace

TEST_CASE("a prepared study has the picture and the figures of each stimulus", "[study]") {
    const TempFolder folder;
    Study study = smallStudy(folder, 3);
    study.background = {0, 0, 1};
    study.stimuli[1].feature = "f2";
    study.stimuli[2].view = "90,0";
    study.stimuli[2].tf = "tents:2";
    const std::string out = folder.path("new/prepared");
    const PreparedStudy prepared = prepareStudy(study, out);
    CHECK(readPreparedStudy(out) == prepared.study);
    for (const Stimulus& s : prepared.study.stimuli) {
        INFO(s.id);
        CHECK(s.picture == out + "/pictures/" + s.id + ".png");
        const Image image = readImage(s.picture);
        CHECK(image.width == 32);
        CHECK(image.height == 32);
        CHECK(image.pixel(0, 0)[0] == 0); // the study's background, not the session's
        CHECK(image.pixel(0, 0)[2] == 1);
        CHECK(s.engine == "cpu");
        CHECK(s.data == "shells");
        CHECK(s.fs.has_value());
    }
    // The same figures as everywhere else.
    SceneInputs inputs;
    inputs.session = readSession(study.stimuli[0].session).session;
    Workspace workspace;
    const Measures measures = workspace.measure(measureInput(openScene(inputs)));
    CHECK(prepared.study.stimuli[0].vws == measures.features[0].vws);
    CHECK(prepared.study.stimuli[0].visibility == measures.features[0].visibility);
    CHECK(prepared.study.stimuli[1].vws == measures.features[1].vws);
    CHECK(prepared.study.stimuli[1].color == tents(3).features[1].color);
    CHECK(prepared.study.stimuli[2].vws != measures.features[0].vws); // another transfer function and view
}

TEST_CASE("what is wrong with a stimulus is told with its id, and nothing is written", "[study]") {
    const TempFolder folder;
    const auto fails = [&](const auto& change, const std::string& reason) {
        Study study = smallStudy(folder, 2);
        change(study.stimuli[1]);
        INFO(reason);
        CHECK_THROWS_WITH(prepareStudy(study, folder.path("out")),
                          Catch::Contains("stimulus a2") && Catch::Contains(reason));
        CHECK_FALSE(std::filesystem::exists(folder.path("out")));
    };
    fails([](Stimulus& s) { s.feature = "bone"; }, "no feature 'bone', stimulus a2, name one of f1, f2, f3");
    fails([](Stimulus& s) { s.view = "up"; }, "'up' is not a view");
    fails([&](Stimulus& s) { s.session = folder.path("none.pellucid.json"); }, "no such file");
    fails([](Stimulus& s) { s.tf = "none.tf.json"; }, "none.tf.json");
}

TEST_CASE("a folder with answers keeps its pictures", "[study]") {
    const TempFolder folder;
    const std::string out = folder.path("out");
    const Study study = smallStudy(folder, 2);
    prepareStudy(study, out);
    prepareStudy(study, out); // nobody has answered: as often as one likes
    Participation(out, "p1").answer(3, {});
    CHECK_THROWS_WITH(prepareStudy(study, out), Catch::Contains("answers of 1 participant"));
}

TEST_CASE("preparing can be stopped, and tells how far it is", "[study]") {
    const TempFolder folder;
    std::stop_source stop;
    const JobControl job{stop.get_token(), [&](double done) {
                             if (done > 0.6) stop.request_stop(); // one of three is drawn
                         }};
    CHECK_THROWS_AS(prepareStudy(smallStudy(folder, 3), folder.path("out"), {}, job), Cancelled);
    CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}
