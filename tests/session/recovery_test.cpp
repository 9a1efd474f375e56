// Unsaved work survives its process, and is nobody else's while that lives.
#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "session/recovery.h"
#include "support/random_sessions.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// A process that writes its work and dies at once, as in a crash: nothing is destroyed.
void writeAndDie(const std::string& folder, const Session& session, const std::string& title) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        try {
            const RecoveryFile file(folder);
            file.write(session, title);
        } catch (...) {
        }
        auto* const never = new RecoveryFile(folder); // not destroyed
        never->write(session, title);
        _exit(0);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(status == 0);
}

} // namespace

TEST_CASE("a living owner's work is not offered", "[session][recovery]") {
    const TempFolder folder;
    const std::string place = folder.path("deep/recovery");
    CHECK(recoverableSessions(place).empty()); // there is no such folder yet
    const RecoveryFile mine(place);
    mine.write(randomSession(1), "mine");
    CHECK(std::filesystem::exists(mine.path()));
    CHECK(recoverableSessions(place).empty());
    const RecoveryFile other(place); // a second window of the same process
    other.write(randomSession(2), "other");
    CHECK(other.path() != mine.path());
    CHECK(recoverableSessions(place).empty());
    mine.remove();
    CHECK_FALSE(std::filesystem::exists(mine.path()));
    mine.write(randomSession(3), "again");
    CHECK(readSession(mine.path()).session == randomSession(3));
}

TEST_CASE("an owner that ends in order leaves nothing", "[session][recovery]") {
    const TempFolder folder;
    {
        const RecoveryFile file(folder.path("r"));
        file.write(randomSession(1), "done");
    }
    CHECK(std::filesystem::is_empty(folder.path("r")));
}

TEST_CASE("a dead owner's work is offered until it is discarded", "[session][recovery]") {
    const TempFolder folder;
    const std::string place = folder.path("r");
    const Session session = randomSession(4);
    writeAndDie(place, session, "knee.nrrd");
    writeAndDie(place, randomSession(5), "tooth \xff.nrrd"); // a file name that is no text
    const RecoveryFile living(place);
    living.write(randomSession(6), "living");

    auto found = recoverableSessions(place);
    REQUIRE(found.size() == 2); // one of each process: the first file was removed in order
    std::sort(found.begin(), found.end(), [](const Recovered& a, const Recovered& b) { return a.title < b.title; });
    CHECK(found[0].title == "knee.nrrd");
    CHECK(found[1].title.starts_with("tooth "));
    CHECK(found[0].when.size() == std::string("2031-05-07 14:03").size());
    CHECK(identical(readSession(found[0].path).session, session));

    discardRecovered(found[0].path);
    found = recoverableSessions(place);
    REQUIRE(found.size() == 1);
    discardRecovered(found[0].path);
    CHECK(recoverableSessions(place).empty());
    // Nothing is left but the living one's two files.
    CHECK(std::distance(std::filesystem::directory_iterator(place), {}) == 2);
}

TEST_CASE("damaged recovery files are not offered", "[session][recovery]") {
    const TempFolder folder;
    folder.write("1-1-1.recovery.pellucid.json", "{\"format\":");
    folder.write("other.json", "{}");
    CHECK(recoverableSessions(folder.path("")).empty());
    CHECK(folder.fileCount() == 2);
    folder.write("file", "x");
    CHECK_THROWS_AS(RecoveryFile(folder.path("file/r")), FileError);
}
