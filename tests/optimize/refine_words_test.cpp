#include <catch2/catch.hpp>

#include "optimize/refine/refine_words.h"

using namespace pellucid;

TEST_CASE("changes of opacity are the means over the features", "[refine][words]") {
    // tents:2 of peak ½: the mean over a tent is half its peak.
    const TransferFunction before = tents(2);
    TransferFunction after = before;
    after.points[1].opacity = 0.25;
    const auto changes = opacityChanges(before, after);
    REQUIRE(changes.size() == 2);
    CHECK(changes[0].feature == "f1");
    CHECK(changes[0].before == Approx(0.25));
    CHECK(changes[0].after == Approx(0.125));
    CHECK(changes[1].after == Approx(0.25));
    CHECK(changeText(changes) == "f1 −50 %");
}

TEST_CASE("one feature over everything is told by its points", "[refine][words]") {
    TransferFunction before = ramp(4), after = before; // points at 1/8, 3/8, 5/8, 7/8 of opacity 1/6
    after.points[0].opacity = 1.0 / 3;
    after.points[3].opacity = 0;
    CHECK(changeText(opacityChanges(before, after)) == "at 0.875 disappears, at 0.125 × 2");
    before.range = after.range = ValueRange{-1000, 3000};
    CHECK(changeText(opacityChanges(before, after)) == "at 2500 disappears, at −500 × 2");
}

TEST_CASE("changes are put into words, the largest first", "[refine][words]") {
    CHECK(changeText({}) == "nothing changed");
    CHECK(changeText({{"a", 0.5, 0.502}, {"b", 0, 0}}) == "nothing changed"); // 0.4 %
    CHECK(changeText({{"air", 0.5, 0.3}, {"enamel", 0.1, 0.3}}) == "enamel × 3, air −40 %");
    CHECK(changeText({{"a", 0.2, 0.3}, {"b", 0, 0.1}, {"c", 0.1, 0}}) == "b appears, c disappears, a +50 %");
    CHECK(changeText({{"a", 0.02, 0.5}, {"b", 0.1, 0.25}, {"c", 0.5, 0.001}, {"d", 0.5, 1e-5}}) ==
          "d disappears, c −99.8 %, a × 25, b × 2.5");
    // No more than four.
    CHECK(changeText({{"a", 1, 0.9}, {"b", 1, 0.8}, {"c", 1, 0.7}, {"d", 1, 0.6}, {"e", 1, 0.5}}) ==
          "e −50 %, d −40 %, c −30 %, b −20 %");
}
