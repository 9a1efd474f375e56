#include "base/length_unit.h"

#include <catch2/catch.hpp>

using namespace pellucid;

TEST_CASE("files name units of length in many ways", "[length]") {
    for (const char* name : {"\u00b5m", "\u03bcm", "\\u00B5m", "\\u00b5m", "\xb5m", "um", "micron", "Microns",
                             "micrometer", "Micrometres", " um "}) {
        INFO(name);
        CHECK(lengthUnitNamed(name) == LengthUnit::Micrometre);
    }
    CHECK(lengthUnitNamed("mm") == LengthUnit::Millimetre);
    CHECK(lengthUnitNamed("MM") == LengthUnit::Millimetre);
    CHECK(lengthUnitNamed("Mm") == LengthUnit::Megametre); // of OME; one of two letters
    CHECK(lengthUnitNamed("inches") == LengthUnit::Inch);
    CHECK(lengthUnitNamed("feet") == LengthUnit::Foot);
    CHECK(lengthUnitNamed("\u00c5") == LengthUnit::Angstrom);
    CHECK(lengthUnitNamed("\u212b") == LengthUnit::Angstrom);
    for (const char* name : {"", " ", "pixel", "reference frame", "furlong", "s", "units", "degrees_north", "mmm"}) {
        INFO(name);
        CHECK_FALSE(lengthUnitNamed(name));
    }
}

TEST_CASE("each unit of length is read under all names that it is written by", "[length]") {
    for (int n = 1; n <= static_cast<int>(LengthUnit::Foot); ++n) {
        const auto unit = static_cast<LengthUnit>(n);
        INFO(sign(unit));
        CHECK(lengthUnitNamed(sign(unit)) == unit);
        CHECK(lengthUnitNamed(plainSign(unit)) == unit);
        CHECK(lengthUnitNamed(standardName(unit)) == unit);
    }
    CHECK(std::string(sign(LengthUnit::Unknown)) == "units");
    CHECK(std::string(plainSign(LengthUnit::Unknown)).empty());
}

TEST_CASE("lengths are converted between units", "[length]") {
    CHECK(converted(1500, LengthUnit::Nanometre, LengthUnit::Micrometre) == 1.5);
    CHECK(converted(0.5, LengthUnit::Micrometre, LengthUnit::Nanometre) == 500);
    CHECK(converted(2, LengthUnit::Micrometre, LengthUnit::Millimetre) == 0.002);
    CHECK(converted(3, LengthUnit::Inch, LengthUnit::Millimetre) == 3 * 25.4);
    CHECK(converted(12, LengthUnit::Inch, LengthUnit::Foot) == Approx(1));
    CHECK(converted(1000, LengthUnit::Thou, LengthUnit::Inch) == Approx(1));
    CHECK(converted(7, LengthUnit::Angstrom, LengthUnit::Angstrom) == 7);
    CHECK(converted(7, LengthUnit::Unknown, LengthUnit::Metre) == 7); // nothing is known of it
}
