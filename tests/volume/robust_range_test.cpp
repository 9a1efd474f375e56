// A window that wild values do not stretch.
#include "volume/robust_range.h"

#include <catch2/catch.hpp>

using namespace pellucid;

namespace {

/// n values, evenly from lo to hi.
std::vector<double> evenly(std::size_t n, double lo, double hi) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i)
        values.push_back(lo + (hi - lo) * static_cast<double>(i) / static_cast<double>(n - 1));
    return values;
}

} // namespace

TEST_CASE("values without outliers keep their whole range", "[robust-range]") {
    const RobustRange r = robustRange(evenly(5000, -3, 12), {-3, 12});
    CHECK(r.range == ValueRange{-3, 12});
    CHECK_FALSE(r.filler);
}

TEST_CASE("one wild value does not stretch the range, wherever it lies", "[robust-range]") {
    std::vector<double> values = evenly(5000, 0, 1);
    values[1234] = 1e6;
    // The percentiles are 0.0005 and 0.9995, the margin a tenth of their distance.
    const RobustRange high = robustRange(values, {0, 1e6});
    CHECK(high.range.lo == 0);
    CHECK(high.range.hi == Approx(0.9995 + 0.0999).margin(0.001));
    values[1234] = -1e6;
    const RobustRange low = robustRange(values, {-1e6, 1});
    CHECK(low.range.hi == 1);
    CHECK(low.range.lo == Approx(0.0005 - 0.0999).margin(0.001));
    // The sample need not have met it.
    const RobustRange unseen = robustRange(evenly(5000, 0, 1), {0, 1e6});
    CHECK(unseen.range.hi < 1.2);
}

TEST_CASE("a common value far from all others is a filler, a near one is not", "[robust-range]") {
    std::vector<double> values = evenly(6000, 0, 1);
    values.resize(10000, -9999);
    const RobustRange far = robustRange(values, {-9999, 1});
    REQUIRE(far.filler);
    CHECK(*far.filler == -9999);
    CHECK(far.range.lo > -0.2);
    CHECK(far.range.hi == 1);
    std::fill(values.begin() + 6000, values.end(), -1.0);
    const RobustRange near = robustRange(values, {-1, 1});
    CHECK_FALSE(near.filler);
    CHECK(near.range == ValueRange{-1, 1});
}

TEST_CASE("a range of no values, one value or everything that doubles hold", "[robust-range]") {
    CHECK(robustRange({}, {0, 1}).range == ValueRange{0, 1});
    CHECK(robustRange({5, 5, 5}, {5, 5}).range == ValueRange{5, 5});
    CHECK(robustRange({5, 5, 5}, {5, 6}).range == ValueRange{5, 6}); // the 6 was not met
    const ValueRange widest{-1.7e308, 1.7e308};
    CHECK(robustRange(evenly(100, -1, 1), widest).range.hi < 2);
    CHECK(robustRange({-1.7e308, 0, 1.7e308}, widest).range == widest);
}
