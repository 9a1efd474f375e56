// `study`: pictures and figures beforehand, and the window for a participant.
#include <array>
#include <cstdlib>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "session/scene.h"
#include "session/session_json.h"

using namespace pellucid;
using namespace pellucid::test;
using nlohmann::json;

namespace {

/// Three pictures of a small volume; two are counted, one of them twice.
const char* const kStudy = R"({"format": "pellucid-study", "version": 1, "title": "Shells", "size": [48, 32],
    "repeats": 1, "stimuli": [
    {"id": "s1", "session": "small.pellucid.json", "feature": "f1", "label": "RED", "training": true},
    {"id": "s2", "session": "small.pellucid.json", "feature": "f2"},
    {"id": "s3", "session": "small.pellucid.json", "tf": "tents:3:0.2", "view": "90,0", "feature": "f2"}]})";
const Words kPrepare{"study", "prepare", "my.study.json", "--out", "prepared"};

/// The study, and a session of the shells with 16³ voxels.
void writeStudyInto(const Workshop& w) {
    w.write("my.study.json", kStudy);
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    Session session = sessionOf(source);
    session.setTf(tents(3));
    writeSession(session, w.path("small.pellucid.json").string());
}

/// No display for as long as it lives.
class NoDisplay {
public:
    NoDisplay() {
        for (std::size_t i = 0; i < kNames.size(); ++i)
            if (const char* value = std::getenv(kNames[i]); value != nullptr) m_values[i] = value;
        for (const char* name : kNames) unsetenv(name);
    }
    ~NoDisplay() {
        for (std::size_t i = 0; i < kNames.size(); ++i)
            if (m_values[i]) setenv(kNames[i], m_values[i]->c_str(), 1);
    }
    NoDisplay(const NoDisplay&) = delete;
    NoDisplay& operator=(const NoDisplay&) = delete;

private:
    static constexpr std::array kNames{"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"};
    std::array<std::optional<std::string>, kNames.size()> m_values;
};

} // namespace

TEST_CASE("study prepare draws and measures what render and measure do", "[cli][study]") {
    const Workshop w;
    writeStudyInto(w);
    const json j = w.json(kPrepare + Words{"--engine", "cpu"});
    CHECK(j["command"] == "study prepare");
    CHECK(j["trials"] == 3); // two stimuli, one of them twice
    REQUIRE(j["stimuli"].size() == 3);
    CHECK(j["stimuli"][0]["training"] == true);
    const Words view{"--session", "small.pellucid.json", "--tf", "tents:3:0.2", "--view", "90,0", "--engine", "cpu"};
    const Words picture{"--size", "48x32", "--background", "#808080"};
    const json measured = w.json(Words{"measure", "--2dfs"} + view + picture);
    for (const char* figure : {"vws", "visibility", "fs"})
        CHECK(j["stimuli"][2][figure] == measured["features"][1][figure]);
    w.json(Words{"render"} + view + picture + Words{"--out", "one.png"});
    CHECK(readImage(w.path("one.png").string()).rgba == readImage(w.path("prepared/pictures/s3.png").string()).rgba);

    const json kept = json::parse(w.read("prepared/study.json"));
    CHECK(kept["stimuli"][2]["picture"] == "pictures/s3.png");
    CHECK(kept["stimuli"][2]["vws"] == j["stimuli"][2]["vws"]);
    CHECK(kept["stimuli"][2]["engine"] == "cpu");
    CHECK(kept["stimuli"][2]["session"] == "../small.pellucid.json");
    const Outcome text = w.run(kPrepare);
    CHECK(text.status == 0);
    CHECK(text.out.find("wrote prepared/study.json and 3 pictures of 48 x 32 pixels") != std::string::npos);
}

TEST_CASE("study prepare refuses what cannot be shown", "[cli][study]") {
    const Workshop w;
    writeStudyInto(w);
    const auto refused = [&](const Words& words, int status, const std::string& why) {
        const Outcome r = w.run(words);
        INFO(r.err);
        CHECK(r.status == status);
        CHECK(r.out.empty());
        CHECK(r.err.find(why) != std::string::npos);
    };
    refused({"study"}, 2, "no command is given, pellucid-cli study");
    refused({"study", "look"}, 2, "unknown command 'look'");
    refused({"study", "prepare", "my.study.json"}, 2, "--out is required, pellucid-cli study prepare");
    refused({"study", "prepare", "none.study.json", "--out", "x"}, 1, "none.study.json");
    refused({"study", "prepare", "small.pellucid.json", "--out", "x"}, 1, "pellucid-study");
    refused(kPrepare + Words{"--engine", "cuda"}, 2, "cuda");
    std::string wrong = kStudy;
    wrong.replace(wrong.find("\"f1\""), 4, "\"f9\"");
    w.write("my.study.json", wrong);
    refused(kPrepare, 1, "there is no feature 'f9', stimulus s1, name one of f1, f2, f3");
    CHECK_FALSE(w.has("prepared"));
    w.write("my.study.json", kStudy);
    w.json(kPrepare);
    std::filesystem::create_directories(w.path("prepared/participants"));
    w.write("prepared/participants/p1.csv", "participant,trial,phase,stimulus,feature,repeat,score,response_ms,task_ms,"
                                            "image_ms,color_vision,time\n"
                                            "p1,1,training,s1,f1,0,3,1,1,1,normal,t\n");
    refused(kPrepare, 1, "the answers of 1 participant");
}

TEST_CASE("study run tells where nothing can be shown", "[cli][study]") {
    const Workshop w;
    writeStudyInto(w);
    w.json(kPrepare);
    const NoDisplay none;
    const auto refused = [&](const Words& words, int status, const std::string& why) {
        const Outcome r = w.run(Words{"study", "run"} + words);
        INFO(r.err);
        CHECK(r.status == status);
        CHECK(r.err.find(why) != std::string::npos);
    };
    refused({}, 2, "DIR is required");
    refused({"."}, 1, "no prepared study");
    refused({"prepared", "--participant", "../x"}, 2, "--participant");
    // Without the window, that is what is wrong; with it, the display.
    const Outcome r = w.run({"study", "run", "prepared"});
    CHECK(r.status == 1);
    CHECK((r.err.find("no display") != std::string::npos || r.err.find("not installed") != std::string::npos));
    CHECK_FALSE(w.has("prepared/participants"));
}
