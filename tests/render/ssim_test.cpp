#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "render/ssim.h"

using namespace pellucid;

namespace {

/// Grey everywhere, opaque.
template <class ValueAt>
Image grey(int width, int height, const ValueAt& valueAt) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float* const pixel = image.pixel(x, y);
            pixel[0] = pixel[1] = pixel[2] = static_cast<float>(valueAt(x, y));
            pixel[3] = 1;
        }
    return image;
}

/// The same numbers in any language: of a linear congruential generator, [0,1).
Image noise(int width, int height, std::uint32_t seed) {
    std::uint32_t state = seed;
    return grey(width, height, [&](int, int) {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) / 16777216.0;
    });
}

} // namespace

TEST_CASE("equal pictures have a structural similarity of 1", "[ssim]") {
    for (const auto& [w, h] : {std::pair{64, 48}, {11, 11}, {5, 30}, {1, 1}}) {
        INFO(w << "x" << h);
        const Image picture = noise(w, h, 1);
        CHECK(ssim(picture, picture) == Approx(1).margin(1e-12));
    }
}

TEST_CASE("the structural similarity of a constant shift is its luminance term", "[ssim]") {
    // Flat pictures of a and b: no variance, so that (2ab + C1)/(a² + b² + C1) is left, C1 = 0.0001.
    const double a = 0.4, b = 0.6;
    const auto flat = [](double value) { return grey(40, 30, [value](int, int) { return value; }); };
    CHECK(ssim(flat(a), flat(b)) == Approx((2 * a * b + 1e-4) / (a * a + b * b + 1e-4)).epsilon(1e-6));
    CHECK(ssim(flat(0), flat(1)) == Approx(1e-4 / (1 + 1e-4)).epsilon(1e-6));
}

TEST_CASE("the structural similarity of a picture and its reverse is negative", "[ssim]") {
    // Stripes of one pixel around ½: the means agree, the covariance is −the variance. In a window of weights w the
    // variance is V = ¼(1 − d²), d the difference of the weights of both kinds of columns, which is below 1e-3 of a
    // Gaussian of deviation 1.5: so (−2V + C2)/(2V + C2) with V = ¼, C2 = 0.0009, and the luminance term is 1.
    const Image stripes = grey(60, 40, [](int x, int) { return x % 2; });
    const Image reverse = grey(60, 40, [](int x, int) { return (x + 1) % 2; });
    CHECK(ssim(stripes, reverse) == Approx((-0.5 + 0.0009) / (0.5 + 0.0009)).epsilon(1e-3));
}

TEST_CASE("structural similarity as another program computes it", "[ssim]") {
    // skimage.metrics.structural_similarity(a, b, data_range=1, gaussian_weights=True, sigma=1.5,
    // use_sample_covariance=False) of scikit-image on the same numbers.
    const Image a = noise(48, 36, 7), b = noise(48, 36, 8);
    Image mixed = a;
    for (std::size_t i = 0; i < mixed.rgba.size(); ++i) mixed.rgba[i] = 0.8f * a.rgba[i] + 0.2f * b.rgba[i];
    CHECK(ssim(a, b) == Approx(0.04657012).margin(1e-6));
    CHECK(ssim(a, mixed) == Approx(0.95355506).margin(1e-6));
    CHECK(ssim(mixed, a) == Approx(ssim(a, mixed)).margin(1e-12));
}

TEST_CASE("structural similarity sees pictures over black", "[ssim]") {
    // White that covers by half is grey of ½.
    Image half = grey(20, 20, [](int, int) { return 1.0; });
    for (std::size_t p = 0; p < 400; ++p) half.rgba[4 * p + 3] = 0.5f;
    CHECK(ssim(half, grey(20, 20, [](int, int) { return 0.5; })) == Approx(1).margin(1e-12));
}

TEST_CASE("pictures of two sizes have no structural similarity", "[ssim]") {
    CHECK_THROWS_AS(ssim(Image(20, 20), Image(20, 21)), UsageError);
    CHECK_THROWS_AS(ssim(Image(), Image()), UsageError);
}
