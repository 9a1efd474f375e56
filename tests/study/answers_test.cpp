#include <algorithm>
#include <filesystem>

#include <catch2/catch.hpp>

#include "base/csv.h"
#include "base/error.h"
#include "study/answers.h"
#include "support/study_cases.h"

using namespace pellucid;
using pellucid::test::TempFolder;

namespace {

Answer anAnswer() {
    Answer a;
    a.trial = 3;
    a.stimulus = "s01";
    a.feature = "bone, \"hard\"\nand =thick";
    a.repeat = true;
    a.score = 4;
    a.responseMs = 1234.5;
    a.taskMs = 3001.2;
    a.imageMs = 17000;
    a.time = "2026-11-25T03:14:15Z";
    return a;
}

} // namespace

TEST_CASE("the file of answers has its columns and a line for each answer", "[study]") {
    CHECK(answersHead() == "participant,trial,phase,stimulus,feature,repeat,score,response_ms,task_ms,image_ms,"
                           "color_vision,time\n");
    Answer a = anAnswer();
    a.feature = "bone";
    a.responseMs = 1234.56;
    CHECK(lineOf({"p1", ColorVision::NotSaid, {}}, a) ==
          "p1,3,trial,s01,bone,1,4,1234.6,3001.2,17000,not said,2026-11-25T03:14:15Z\n");
    a.score.reset();
    a.training = true;
    CHECK(lineOf({"p1", ColorVision::Deficient, {}}, a) ==
          "p1,3,training,s01,bone,1,,1234.6,3001.2,17000,deficient,2026-11-25T03:14:15Z\n");
}

TEST_CASE("answers come back from their file, whatever a feature is called", "[study]") {
    const TempFolder folder;
    Participant person{"p1", ColorVision::Unsure, {}};
    std::string text = answersHead();
    for (const char* feature : {"bone", "bone, \"hard\"", "two\nlines", "=1+1", "-dense", ""}) {
        Answer a = anAnswer();
        a.trial = static_cast<int>(person.answers.size()) + 1;
        a.feature = feature;
        if (a.trial == 2) a.score.reset();
        text += lineOf(person, a);
        person.answers.push_back(a);
    }
    CHECK(readParticipant(folder.write("p1.csv", text)) == person);
}

TEST_CASE("a file that ends anywhere has all answers whose lines are whole", "[study]") {
    const Participant person{"p1", ColorVision::Normal, {}};
    Answer first = anAnswer(), second = anAnswer();
    second.trial = 4;
    const std::string head = answersHead(), one = lineOf(person, first), two = lineOf(person, second);
    const std::string text = head + one + two;
    for (std::size_t bytes = 0; bytes <= text.size(); ++bytes) {
        INFO(bytes);
        const AnswersRead read = answersFrom(text.substr(0, bytes), "folder/p1.csv");
        // A line is whole when its last sign is there; that its end is missing is told.
        const std::size_t ends[] = {head.size(), head.size() + one.size(), text.size()};
        const std::size_t whole = bytes >= ends[2] - 1 ? 2 : bytes >= ends[1] - 1 ? 1 : 0;
        CHECK(read.participant.answers.size() == whole);
        CHECK(read.wholeBytes == (bytes < head.size() ? 0 : std::min(ends[whole], bytes)));
        CHECK(read.lacksLineEnd == (bytes == ends[1] - 1 || bytes == ends[2] - 1));
    }
}

TEST_CASE("a file of answers that cannot be is refused with its line", "[study]") {
    const auto errorOf = [](const std::string& lines) -> std::string {
        try {
            static_cast<void>(answersFrom(answersHead() + lines, "p1.csv"));
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    };
    const std::string good = "p1,1,trial,s1,f,0,3,1,1,1,normal,t\n";
    CHECK(errorOf(good).empty());
    CHECK_THAT(errorOf(good + "p2,2,trial,s1,f,0,3,1,1,1,normal,t\n"),
               Catch::Contains("p1.csv:3") && Catch::Contains("'p2'"));
    CHECK_THAT(errorOf("p1,x,trial,s1,f,0,3,1,1,1,normal,t\n"), Catch::Contains("p1.csv:2") && Catch::Contains("'x'"));
    CHECK_THAT(errorOf("p1,1,rest,s1,f,0,3,1,1,1,normal,t\n"), Catch::Contains("'rest'"));
    CHECK_THAT(errorOf("p1,1,trial,s1,f,0,6,1,1,1,normal,t\n"), Catch::Contains("'6' is no score"));
    CHECK_THAT(errorOf("p1,1,trial,s1,f,2,3,1,1,1,normal,t\n"), Catch::Contains("repeat"));
    CHECK_THAT(errorOf("p1,1,trial,s1,f,0,3,soon,1,1,normal,t\n"),
               Catch::Contains("'soon'") && Catch::Contains("response_ms"));
    CHECK_THAT(errorOf("p1,1,trial,s1,f,0,3,1,1,1,good,t\n"), Catch::Contains("'good'"));
    CHECK_THAT(errorOf("p1,1,trial,s1\n"), Catch::Contains("4 fields"));
    CHECK_THAT(errorOf(good + good), Catch::Contains("p1.csv:3") && Catch::Contains("twice"));
    CHECK_THROWS_WITH(answersFrom("participant,trial\n", "p1.csv"), Catch::Contains("phase is missing"));
}

TEST_CASE("columns are found by their names, others are let be", "[study]") {
    const std::string text = "note,participant,trial,phase,stimulus,feature,repeat,score,response_ms,task_ms,image_ms,"
                             "color_vision,time\r\nmine,p1,1,trial,s1,f,0,3,1,2,3,normal,t\r\n";
    const Participant person = answersFrom(text, "p1.csv").participant;
    REQUIRE(person.answers.size() == 1);
    CHECK(person.answers[0].imageMs == 3);
    CHECK(person.answers[0].time == "t");
}

TEST_CASE("participants are those of the folder, by id", "[study]") {
    const TempFolder folder;
    CHECK(readParticipants(folder.path("")).empty());
    std::filesystem::create_directories(participantsFolder(folder.path("")));
    for (const char* id : {"zoe", "adam"})
        folder.write(std::string("participants/") + id + ".csv",
                     answersHead() + lineOf({id, ColorVision::Normal, {}}, anAnswer()));
    folder.write("participants/.hidden.csv", "x");
    folder.write("participants/notes.txt", "x");
    const auto all = readParticipants(folder.path(""));
    REQUIRE(all.size() == 2);
    CHECK(all[0].id == "adam");
    CHECK(all[1].answers == std::vector{anAnswer()});
}
