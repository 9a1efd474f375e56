#include <catch2/catch.hpp>

#include "study/trial_clock.h"

using pellucid::TrialClock;
using pellucid::TrialTimes;
using Screen = TrialClock::Screen;

TEST_CASE("each screen is due so long after the one before could be seen", "[study]") {
    TrialClock clock(3000, 17000);
    CHECK(clock.screen() == Screen::Task);
    CHECK_FALSE(clock.remaining(0)); // not seen yet: time does not begin
    CHECK_FALSE(clock.advance(50000));
    clock.seen(100);
    clock.seen(900); // drawn once more: still since 100
    CHECK(*clock.remaining(1100) == 2000);
    CHECK_FALSE(clock.advance(3099.9));
    REQUIRE(clock.advance(3100));
    CHECK(clock.screen() == Screen::Picture);
    CHECK_FALSE(clock.isSeen());
    clock.seen(3110); // 10 ms to draw it
    CHECK(*clock.remaining(20109) == 1);
    REQUIRE(clock.advance(20112)); // woken 2 ms late
    CHECK(clock.screen() == Screen::Question);
    clock.seen(20115);
    CHECK_FALSE(clock.remaining(99999));
    CHECK_FALSE(clock.advance(99999)); // waits for the answer
    const TrialTimes times = clock.answered(22615);
    CHECK(times.taskMs == 3010);     // 3110 − 100
    CHECK(times.imageMs == 17005);   // 20115 − 3110
    CHECK(times.responseMs == 2500); // 22615 − 20115
}

TEST_CASE("what covered the question does not count as time to answer", "[study]") {
    TrialClock clock(0, 100);
    clock.leaveOut(50); // nothing is seen yet: nothing to leave out
    clock.seen(10);
    REQUIRE(clock.advance(110));
    clock.seen(115);
    clock.leaveOut(60000);
    CHECK(clock.answered(60515).responseMs == 400); // 60515 − 115 − 60000
    CHECK(clock.answered(60515).imageMs == 105);    // 115 − 10
}

TEST_CASE("a trial without a task begins with the picture", "[study]") {
    TrialClock clock(0, 500);
    CHECK(clock.screen() == Screen::Picture);
    clock.seen(10);
    CHECK(*clock.remaining(600) == 0); // overdue
    REQUIRE(clock.advance(600));
    clock.seen(601);
    const TrialTimes times = clock.answered(701);
    CHECK(times.taskMs == 0);
    CHECK(times.imageMs == 591);
    CHECK(times.responseMs == 100);
}
