// ΔE of colours and pictures.
#include <catch2/catch.hpp>

#include "base/color.h"
#include "base/error.h"
#include "base/parallel.h"
#include "tf/color_difference.h"

using namespace pellucid;

namespace {

Image filled(int width, int height, float r, float g, float b, float alpha = 1) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        image.rgba[i] = r;
        image.rgba[i + 1] = g;
        image.rgba[i + 2] = b;
        image.rgba[i + 3] = alpha;
    }
    return image;
}

} // namespace

TEST_CASE("the difference of colours is their distance in CIELAB", "[deltae]") {
    const auto deltaE = [](const Rgb& a, const Rgb& b) {
        const auto pixel = [](const Rgb& c) {
            return filled(1, 1, static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b));
        };
        return meanDeltaE(pixel(a), pixel(b));
    };
    CHECK(deltaE({0, 0, 0}, {1, 1, 1}) == Approx(100).margin(1e-3)); // L* from 0 to 100
    CHECK(deltaE({0.3, 0.5, 0.2}, {0.3, 0.5, 0.2}) == 0);
    // Red (53.24, 80.09, 67.20), green (87.73, −86.18, 83.18): √(34.49² + 166.27² + 15.98²).
    CHECK(deltaE({1, 0, 0}, {0, 1, 0}) == Approx(170.56).margin(0.05));
}

TEST_CASE("the difference of pictures is the mean over their pixels", "[deltae]") {
    const Image black = filled(8, 4, 0, 0, 0);
    Image half = black;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 3; ++c) half.pixel(x, y)[c] = 1;
    CHECK(meanDeltaE(black, black) == 0);
    CHECK(meanDeltaE(black, half) == Approx(50).margin(1e-3)); // half of the pixels differ by 100
    CHECK(meanDeltaE(half, black) == meanDeltaE(black, half));
    const Plane map = deltaEOf(black, half);
    CHECK(map.row(3)[3] == Approx(100).margin(1e-3));
    CHECK(map.row(3)[4] == 0);
    CHECK_THROWS_AS(deltaEOf(black, filled(4, 8, 0, 0, 0)), Error);
    // Transparent white is seen as the black behind it, and what 8 bits cannot tell apart is the same.
    CHECK(meanDeltaE(black, filled(8, 4, 1, 1, 1, 0)) == 0);
    CHECK(meanDeltaE(filled(8, 4, 0.5f, 0.5f, 0.5f), filled(8, 4, 0.5005f, 0.5f, 0.5f)) == 0);
    CHECK_THROWS_AS(meanDeltaE(black, filled(4, 8, 0, 0, 0)), Error);
    CHECK(labPixels(half)[0] == Approx(100).margin(1e-3));
    setThreadCount(1);
    const double one = meanDeltaE(black, half);
    setThreadCount(2);
    CHECK(meanDeltaE(black, half) == one);
    setThreadCount(0);
}
