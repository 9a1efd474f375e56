#include <filesystem>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "study/study.h"
#include "support/study_cases.h"

using namespace pellucid;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;

namespace {

std::string errorOf(const TempFolder& folder, const std::string& json) {
    try {
        static_cast<void>(readStudy(folder.write("a.study.json", json)));
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

/// A study of these further keys, with the stimuli s1 and s2.
std::string with(const std::string& keys) {
    return R"({"format":"pellucid-study","version":1,"stimuli":[{"id":"s1","volume":"sample:knee","feature":"f1"},)"
           R"({"id":"s2","volume":"sample:knee","feature":"f2"}])" +
           keys + "}";
}
std::string withStimulus(const std::string& stimulus) {
    return R"({"format":"pellucid-study","version":1,"stimuli":[)" + stimulus + "]}";
}

} // namespace

TEST_CASE("a study comes back from its file as it was", "[study]") {
    const TempFolder folder;
    Study study = studyOf(1, 3, 2);
    study.title = "Knee, \"left\"";
    study.consent = "Line one\nline two";
    study.question = "Where is {feature}?";
    study.labels = {{1, "no"}, {4, "rather"}};
    study.taskSeconds = 0.25;
    study.imageSeconds = 1.5;
    study.pauseEvery = 0;
    study.seed = 42;
    study.background = {0.2, 0.4, 0.6};
    study.width = 640;
    study.height = 321;
    study.stimuli[1].session = folder.path("one.pellucid.json");
    study.stimuli[1].volume.clear();
    study.stimuli[1].tf = folder.path("one.tf.json");
    study.stimuli[2].view = "anterior,2";
    study.stimuli[2].tf = "auto";
    study.stimuli[3].volume = folder.path("data/one.nrrd");
    study.stimuli[3].vws = 0.25;
    study.stimuli[3].picture = folder.path("pictures/a3.png");
    study.stimuli[3].extraJson = R"({"note":"mine"})";
    study.extraJson = R"({"lab":[1,2]})";
    writeStudy(study, folder.path("a.study.json"));
    CHECK(readStudy(folder.path("a.study.json")) == study);
}

TEST_CASE("files are named from the folder of the study, so that both can be moved", "[study]") {
    const TempFolder folder;
    std::filesystem::create_directories(folder.path("old"));
    Study study = studyOf(0, 1);
    study.stimuli[0].volume = folder.path("old/one.nrrd");
    writeStudy(study, folder.path("old/a.study.json"));
    CHECK(readText(folder.path("old/a.study.json")).find("\"volume\": \"one.nrrd\"") != std::string::npos);
    std::filesystem::rename(folder.path("old"), folder.path("new"));
    CHECK(readStudy(folder.path("new/a.study.json")).stimuli[0].volume == folder.path("new/one.nrrd"));
}

TEST_CASE("a study that says little is as the thesis had it", "[study]") {
    const TempFolder folder;
    const Study study = readStudy(folder.write("a.study.json", with("")));
    CHECK(study.taskSeconds == 3); // §4.5.2
    CHECK(study.imageSeconds == 17);
    CHECK(study.repeats == 0);
    CHECK(study.background == Rgb{128.0 / 255, 128.0 / 255, 128.0 / 255});
    CHECK(study.labels.at(3) == "Neutral"); // appendix B
    CHECK(study.questionOf(study.stimuli[1]) == "How clear and distinct is the f2 feature?");
}

TEST_CASE("a study that cannot be is refused with place and reason", "[study]") {
    const TempFolder folder;
    const auto says = [&](const std::string& json, const std::string& place, const std::string& reason) {
        const std::string error = errorOf(folder, json);
        INFO(json << "\n" << error);
        CHECK(error.find("a.study.json") != std::string::npos);
        CHECK(error.find(place) != std::string::npos);
        CHECK(error.find(reason) != std::string::npos);
    };
    says("[]", "", "object");
    says(R"({"format":"pellucid-session","version":1,"stimuli":[]})", "/format", "pellucid-study");
    says(R"({"format":"pellucid-study","version":2,"stimuli":[]})", "/version", "newer");
    says(R"({"format":"pellucid-study","version":1})", "", "'stimuli' is missing");
    says(with(R"(,"task_seconds":-1)"), "/task_seconds", "-1");
    says(with(R"(,"image_seconds":0)"), "/image_seconds", "0");
    says(with(R"(,"image_seconds":"long")"), "/image_seconds", "number");
    says(with(R"(,"repeats":3)"), "/repeats", "only 2 stimuli");
    says(with(R"(,"repeats":1.5)"), "/repeats", "whole");
    says(with(R"(,"labels":{"6":"best"})"), "/labels", "'6' is no score");
    says(with(R"(,"labels":{"5":6})"), "/labels/5", "text");
    says(with(R"(,"size":[31,64])"), "/size/0", "32");
    says(with(R"(,"background":"grey")"), "/background", "");
    says(withStimulus(R"({"volume":"sample:knee","feature":"f1"})"), "/stimuli/0", "'id' is missing");
    says(withStimulus(R"({"id":"../s","volume":"sample:knee","feature":"f1"})"), "/stimuli/0/id", "'../s'");
    says(withStimulus(R"({"id":"s","feature":"f1"})"), "/stimuli/0", "either a session or a volume");
    says(withStimulus(R"({"id":"s","volume":"a.nrrd","session":"a.pellucid.json","feature":"f1"})"), "/stimuli/0",
         "either");
    says(withStimulus(R"({"id":"s","volume":"sample:knee"})"), "/stimuli/0", "'feature' is missing");
    says(withStimulus(
             R"({"id":"s","volume":"sample:knee","feature":"f"},{"id":"S","volume":"sample:knee","feature":"f"})"),
         "/stimuli/1/id", "another stimulus");
    // A single stimulus would be shown twice in a row.
    says(
        R"({"format":"pellucid-study","version":1,"repeats":1,"stimuli":[{"id":"s","volume":"sample:knee","feature":"f"}]})",
        "/repeats", "only 0");
}

TEST_CASE("a folder without a prepared study is refused", "[study]") {
    const TempFolder folder;
    CHECK_THROWS_WITH(readPreparedStudy(folder.path("")), Catch::Contains("no prepared study"));
    writeStudy(studyOf(0, 2), preparedStudyFile(folder.path("")));
    CHECK_THROWS_WITH(readPreparedStudy(folder.path("")), Catch::Contains("/stimuli/0") && Catch::Contains("picture"));
}

TEST_CASE("a new stimulus gets an id of its own", "[study]") {
    Study study;
    CHECK(freeStimulusId(study) == "s01");
    study.stimuli.emplace_back().id = "s02";
    CHECK(freeStimulusId(study) == "s03");
}
