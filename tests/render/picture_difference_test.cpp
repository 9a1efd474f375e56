// How much two pictures differ.
#include <algorithm>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "render/picture_difference.h"

using namespace pellucid;

namespace {

/// Black, and from column `from` on a grey of `value`.
Image halved(int width, int height, int from, float value) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::fill_n(image.pixel(x, y), 3, x < from ? 0.0f : value);
            image.pixel(x, y)[3] = 1;
        }
    return image;
}

} // namespace

TEST_CASE("a difference tells mean, largest and the share that is noticed", "[picture_difference]") {
    const Image black = halved(20, 10, 20, 0);
    const PictureDifference none = differenceOf(black, black, "both");
    CHECK(none.ssim == 1);
    CHECK((none.mean == 0 && none.largest == 0 && none.noticed == 0));
    // L* of white is 100, of black 0: of 5 of 20 columns ΔE is 100, the mean 25.
    const PictureDifference quarter = differenceOf(black, halved(20, 10, 15, 1), "both");
    CHECK(quarter.mean == Approx(25).margin(1e-3));
    CHECK(quarter.largest == Approx(100).margin(1e-3));
    CHECK(quarter.noticed == 0.25);
    CHECK(quarter.map.row(3)[14] == 0);
    CHECK(quarter.map.row(3)[15] == Approx(100).margin(1e-3));
    CHECK(quarter.ssim < 1);
    // Of an 8-bit grey g below the linear part, L* = 903.3·g/(255·12.92): 0.82 of 3 is not noticed, 2.74 of 10 is.
    CHECK(differenceOf(black, halved(20, 10, 0, 3 / 255.0f), "both").noticed == 0);
    CHECK(differenceOf(black, halved(20, 10, 0, 10 / 255.0f), "both").noticed == 1);
    CHECK_THROWS_AS(differenceOf(black, halved(10, 10, 0, 1), "both"), Error);
}

TEST_CASE("pictures stand side by side, and files of a difference have its unit or white at 100",
          "[picture_difference]") {
    const Image both = sideBySide(halved(4, 3, 4, 0), halved(5, 3, 0, 1));
    REQUIRE((both.width == 9 && both.height == 3));
    CHECK(both.pixel(3, 2)[0] == 0);
    CHECK(both.pixel(4, 2)[0] == 1);
    Plane map(2, 1);
    map.values = {25, 140};
    CHECK(storedDifference(map, true).values == std::vector<float>{25, 140});
    CHECK(storedDifference(map, false).values == std::vector<float>{0.25f, 1});
}
