#include <limits>

#include <catch2/catch.hpp>

#include "base/round_numbers.h"

using namespace pellucid;

TEST_CASE("axes have round numbers inside their range", "[axis]") {
    CHECK(axisTicks(0, 255, 6) == std::vector<double>{0, 50, 100, 150, 200, 250});
    CHECK(axisTicks(-1, 1, 4) == std::vector<double>{-1, -0.5, 0, 0.5, 1});
    const auto tiny = axisTicks(1e-7, 3e-7, 4); // steps of 5e-8: 1, 1.5, 2, 2.5, 3
    REQUIRE(tiny.size() == 5);
    CHECK(tiny[1] == Approx(1.5e-7));
    CHECK(axisTicks(3, 3, 5).empty());
    CHECK(axisTicks(0, std::numeric_limits<double>::infinity(), 5).empty());
}

TEST_CASE("numbers have the digits that their range needs", "[axis]") {
    CHECK(numberText(50, 255) == "50");
    CHECK(numberText(-0.25, 2) == "-0.25");
    CHECK(numberText(2.5e-7, 2e-7) == "2.5e-07");
    CHECK(numberText(-1e-12, 100) == "0");
}

TEST_CASE("a number in full reads back as the same number, in as few digits as that takes", "[numbers]") {
    CHECK(exactText(0.1) == "0.1");
    CHECK(exactText(1.0 / 3) == "0.3333333333333333");
    CHECK(exactText(-2) == "-2");
    CHECK(exactText(1e-300) == "1e-300");
    CHECK(exactText(std::nan("")) == "nan");
    CHECK(exactText(std::numeric_limits<double>::infinity()) == "inf");
}

TEST_CASE("a round number is the largest of 1, 2, 5 times a power of ten that fits", "[axis]") {
    CHECK(roundNumberBelow(9.99) == Approx(5));
    CHECK(roundNumberBelow(10) == Approx(10));
    CHECK(roundNumberBelow(0.2) == Approx(0.2));
    CHECK(roundNumberBelow(0.19) == Approx(0.1));
    CHECK(roundNumberBelow(4.9e7) == Approx(2e7));
}
