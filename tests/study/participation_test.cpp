#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "study/participation.h"
#include "support/full_disk.h"
#include "support/study_cases.h"

using namespace pellucid;
using pellucid::test::FullDisk;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;
using pellucid::test::writePrepared;

namespace {

void answerSome(Participation& person, int count) {
    for (int i = 0; i < count; ++i) person.answer(static_cast<int>(person.next()) % 5 + 1, {3000, 17000, 1000});
}

} // namespace

TEST_CASE("a participation goes through the plan and keeps each answer at once", "[study]") {
    const TempFolder folder;
    const Study study = writePrepared(studyOf(1, 4, 2), folder);
    Participation person(folder.path(""), "p1");
    CHECK_FALSE(person.hasBegun());
    CHECK(person.study() == study);
    person.setColorVision(ColorVision::Unsure);
    const std::string file = participantFile(folder.path(""), "p1");
    CHECK_FALSE(std::filesystem::exists(file)); // who leaves at once leaves nothing
    for (std::size_t i = 0; !person.isDone(); ++i) {
        CHECK(person.next() == i);
        if (i == 2)
            person.answer({}, {});
        else
            answerSome(person, 1);
        const Participant kept = readParticipant(file);
        REQUIRE(kept.answers.size() == i + 1);
        CHECK(kept.answers[i].stimulus == person.stimulusOf(i).id);
        CHECK(kept.answers[i].repeat == person.plan()[i].repeat);
        CHECK(kept.answers[i].training == person.plan()[i].training);
        CHECK(kept.answers[i].score.has_value() == (i != 2));
    }
    const Participant kept = readParticipant(file);
    CHECK(kept == person.participant());
    CHECK(kept.colorVision == ColorVision::Unsure);
    CHECK(kept.answers.size() == 7); // 1 of training, 4, 2 repeats
}

TEST_CASE("who comes back goes on with the first trial that has no answer", "[study]") {
    const TempFolder folder;
    writePrepared(studyOf(1, 5, 2), folder);
    {
        Participation person(folder.path(""), "p1");
        person.setColorVision(ColorVision::Deficient);
        answerSome(person, 3);
    }
    Participation person(folder.path(""), "p1");
    CHECK(person.hasBegun());
    CHECK(person.next() == 3);
    CHECK(person.participant().colorVision == ColorVision::Deficient);
    answerSome(person, 5);
    CHECK(person.isDone());
    CHECK(readParticipant(participantFile(folder.path(""), "p1")).answers.size() == 8);
}

TEST_CASE("wherever the last line is torn, the answers before it stay and the rest goes on", "[study]") {
    const TempFolder folder;
    writePrepared(studyOf(0, 4), folder);
    const std::string file = participantFile(folder.path(""), "p1");
    std::string whole;
    std::vector<std::size_t> ends; // of the lines, in bytes
    {
        Participation person(folder.path(""), "p1");
        for (int i = 0; i < 3; ++i) {
            answerSome(person, 1);
            ends.push_back(readText(file).size());
        }
        whole = readText(file);
    }
    std::vector<std::size_t> sizes;
    for (std::size_t bytes = 0; bytes <= whole.size(); bytes += 7) sizes.push_back(bytes);
    for (const std::size_t end : ends) sizes.push_back(end - 1); // the line is whole, but for its end
    for (const std::size_t bytes : sizes) {
        writeTextAtomically(file, whole.substr(0, bytes));
        const auto kept =
            static_cast<std::size_t>(std::ranges::count_if(ends, [&](std::size_t end) { return end <= bytes + 1; }));
        INFO(bytes);
        Participation person(folder.path(""), "p1");
        CHECK(person.next() == kept);
        answerSome(person, 1);
        const Participant now = readParticipant(file);
        REQUIRE(now.answers.size() == kept + 1);
        CHECK(now.answers.back().trial == static_cast<int>(kept) + 1);
    }
}

TEST_CASE("answers of another study are not mixed with these", "[study]") {
    const TempFolder folder;
    writePrepared(studyOf(0, 6), folder);
    {
        Participation person(folder.path(""), "p1");
        answerSome(person, 5);
    }
    Study other = studyOf(0, 6);
    other.seed = 2;
    writePrepared(other, folder);
    CHECK_THROWS_WITH(Participation(folder.path(""), "p1"),
                      Catch::Contains("p1.csv") && Catch::Contains("another study"));
}

TEST_CASE("two windows do not write one participant's answers", "[study]") {
    const TempFolder folder;
    writePrepared(studyOf(0, 4), folder);
    Participation first(folder.path(""), "p1"), second(folder.path(""), "p1"); // neither has begun
    answerSome(first, 1);
    CHECK_THROWS_AS(second.answer(1, {}), FileError);
    CHECK(second.next() == 0);
    CHECK_THROWS_WITH(Participation(folder.path(""), "p1"), Catch::Contains("another window"));
    CHECK(readParticipant(participantFile(folder.path(""), "p1")).answers.size() == 1);
}

TEST_CASE("an answer for which there is no room is not taken, and can be given again", "[study]") {
    const TempFolder folder;
    writePrepared(studyOf(0, 4), folder);
    Participation person(folder.path(""), "p1");
    answerSome(person, 2);
    const std::string file = participantFile(folder.path(""), "p1");
    const std::string before = readText(file);
    {
        const FullDisk disk(before.size() + 10);
        CHECK_THROWS_AS(answerSome(person, 1), FileError);
    }
    CHECK(person.next() == 2);
    CHECK(readText(file) == before); // nothing of the torn line stays
    answerSome(person, 2);
    CHECK(readParticipant(file).answers.size() == 4);
}

TEST_CASE("participants are called by what can name a file", "[study]") {
    const TempFolder folder;
    writePrepared(studyOf(0, 2), folder);
    for (const char* id : {"", "../x", "a b", "-x", "ä", "x.csv"})
        CHECK_THROWS_AS(Participation(folder.path(""), id), UsageError);
    const std::string made = newParticipantId(folder.path(""));
    CHECK(isStudyId(made));
    CHECK(newParticipantId(folder.path("")) != made);
}
