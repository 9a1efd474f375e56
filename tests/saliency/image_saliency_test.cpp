// 2D saliency of pictures and its shares: against the reference, and where the answer is known.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "base/color.h"
#include "base/error.h"
#include "base/parallel.h"
#include "saliency/image_saliency.h"
#include "tf/lch.h"

using namespace pellucid;

namespace {

using Painter = std::function<Rgb(double x, double y)>;

Image painted(int width, int height, const Painter& color, double alpha = 1) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Rgb c = color(x + 0.5, y + 0.5);
            const double values[] = {c.r, c.g, c.b, alpha};
            std::transform(values, values + 4, image.pixel(x, y), [](double v) { return static_cast<float>(v); });
        }
    return image;
}

/// Soft blobs in the colours of three features over grey, each drawn alone too.
FeaturePictures blobs(int width, int height, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const Rgb background{0.2, 0.2, 0.2};
    FeaturePictures pictures;
    pictures.whole = painted(width, height, [&](double, double) { return background; });
    for (int f = 0; f < 3; ++f) {
        Image alone = pictures.whole;
        const Rgb color{unit(random), unit(random), unit(random)};
        const double cx = unit(random) * width, cy = unit(random) * height, r = (0.1 + 0.2 * unit(random)) * width;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double alpha = std::max(0.0, 1 - std::hypot(x - cx, y - cy) / r);
                const double parts[] = {color.r, color.g, color.b};
                for (int c = 0; c < 3; ++c)
                    for (float* p : {pictures.whole.pixel(x, y) + c, alone.pixel(x, y) + c})
                        *p = static_cast<float>(alpha * parts[c] + (1 - alpha) * static_cast<double>(*p));
                alone.pixel(x, y)[3] = static_cast<float>(alpha);
            }
        pictures.alone.push_back(std::move(alone));
    }
    return pictures;
}

double largestDifference(const Plane& a, const Plane& b) {
    REQUIRE(a.values.size() == b.values.size());
    double most = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i])));
    return most;
}

double sumOf(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

struct Pixel {
    int x = 0, y = 0;
};

Pixel placeOfMost(const Plane& map) {
    const auto at = static_cast<int>(std::max_element(map.values.begin(), map.values.end()) - map.values.begin());
    return {at % map.width, at / map.width};
}

/// A bar of 16 × 64 pixels about each centre of a grid of 5 × 5 on 512², `color` and `lying` by its number.
Image bars(const std::function<Rgb(int)>& color, const std::function<bool(int)>& lying) {
    return painted(512, 512, [&](double x, double y) {
        const int column = std::clamp(static_cast<int>((x - 6) / 100), 0, 4);
        const int row = std::clamp(static_cast<int>((y - 6) / 100), 0, 4), bar = 5 * row + column;
        double dx = std::abs(x - (56 + 100 * column)), dy = std::abs(y - (56 + 100 * row));
        if (lying(bar)) std::swap(dx, dy);
        return dx < 8 && dy < 32 ? color(bar) : Rgb{};
    });
}

/// The distance of the largest S from the box of w × h about (x, y), in pixels.
double missed(const Plane& map, double x, double y, double w, double h) {
    const Pixel p = placeOfMost(map);
    return std::hypot(std::max(0.0, std::abs(p.x + 0.5 - x) - w / 2), std::max(0.0, std::abs(p.y + 0.5 - y) - h / 2));
}

} // namespace

TEST_CASE("2D saliency is what its reference computes", "[saliency][picture]") {
    // Sizes with and without halves, and some of which levels are a single pixel.
    const Pixel sizes[] = {{128, 128}, {517, 203}, {97, 61}, {60, 131}, {17, 9}, {3, 2}, {1, 1}, {1, 40}};
    for (std::uint32_t seed = 0; seed < std::size(sizes); ++seed) {
        const auto [width, height] = sizes[seed];
        CAPTURE(width, height);
        const FeaturePictures pictures = blobs(width, height, seed);
        const FeatureSaliency fast = featureSaliency(pictures), slow = featureSaliencyReference(pictures);
        CHECK(largestDifference(fast.map, slow.map) < 1e-4);
        CHECK(largestDifference(fast.rest, slow.rest) < 1e-4);
        REQUIRE(fast.shares.size() == slow.shares.size());
        for (std::size_t f = 0; f < fast.shares.size(); ++f) {
            CHECK(fast.shares[f] == Approx(slow.shares[f]).margin(1e-4));
            CHECK(largestDifference(fast.shared[f], slow.shared[f]) < 1e-4);
            CHECK(largestDifference(fast.spread[f], slow.spread[f]) < 1e-4);
        }
    }
}

TEST_CASE("2D saliency has the same bits with any number of threads", "[saliency][picture]") {
    const FeaturePictures pictures = blobs(130, 90, 8);
    setThreadCount(1);
    const FeatureSaliency one = featureSaliency(pictures);
    setThreadCount(3);
    const FeatureSaliency three = featureSaliency(pictures);
    setThreadCount(0);
    CHECK(one.map.values == three.map.values);
    CHECK(one.shares == three.shares);
    CHECK(one.spread[2].values == three.spread[2].values);
}

TEST_CASE("a picture of one colour has no saliency", "[saliency][picture]") {
    const Plane map = saliencyMap(painted(64, 48, [](double, double) { return Rgb{0.3, 0.6, 0.1}; }));
    CHECK(*std::max_element(map.values.begin(), map.values.end()) < 1e-9f);
    CHECK(saliencyMap(Image()).values.empty());
}

TEST_CASE("what is odd is most salient", "[saliency][picture]") {
    SECTION("a bright disc on grey") {
        const Plane map = saliencyMap(painted(512, 512, [](double x, double y) {
            const double v = std::hypot(x - 350, y - 180) < 24 ? 1 : 0.4;
            return Rgb{v, v, v};
        }));
        CHECK(missed(map, 350, 180, 48, 48) <= 16);
    }
    SECTION("a red bar among green ones") {
        const Plane map = saliencyMap(bars(
            [](int bar) {
                return bar == 8 ? Rgb{0.8, 0, 0} : Rgb{0, 0.8, 0};
            },
            [](int) { return false; }));
        CHECK(missed(map, 356, 156, 16, 64) <= 16);
    }
    SECTION("a lying bar among upright ones") {
        const Plane map = saliencyMap(bars([](int) { return Rgb{0.8, 0.8, 0.8}; }, [](int bar) { return bar == 16; }));
        CHECK(missed(map, 156, 356, 64, 16) <= 16);
    }
}

TEST_CASE("2D saliency is shared by the distance of colours", "[saliency][picture]") {
    // Two features over the left half; the picture there is nearer to the first one. The third is drawn nowhere.
    const Rgb seen{0.7, 0.2, 0.1}, first{0.8, 0.2, 0.1}, second{0.1, 0.3, 0.9};
    const auto leftHalf = [](const Rgb& color) {
        return painted(64, 64, [color](double x, double) { return x < 32 ? color : Rgb{}; });
    };
    FeaturePictures pictures{leftHalf(seen), {leftHalf(first), leftHalf(second), leftHalf(Rgb{})}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            for (int f = 0; f < 2; ++f) pictures.alone[static_cast<std::size_t>(f)].pixel(x, y)[3] = x < 32 ? 0.5f : 0;
            pictures.alone[2].pixel(x, y)[3] = 0;
        }
    const FeatureSaliency s = featureSaliency(pictures);
    CHECK(sumOf(s.shares) == Approx(1));
    CHECK(s.shares[2] == 0);
    // w₁ = (1/d₁)/(1/d₁ + 1/d₂) = d₂/(d₁ + d₂) in each pixel. What is dealt out of the rest follows the same ratio,
    // since S₁ and S₂ have it everywhere.
    const double d1 = deltaE(labFromSrgb(seen), labFromSrgb(first));
    const double d2 = deltaE(labFromSrgb(seen), labFromSrgb(second));
    CHECK(s.shares[0] == Approx(d2 / (d1 + d2)).margin(1e-5));
    SECTION("a feature whose colour is that of the picture has all") {
        pictures.alone[1] = pictures.whole;
        for (std::size_t i = 3; i < pictures.alone[1].rgba.size(); i += 4)
            pictures.alone[1].rgba[i] = pictures.alone[0].rgba[i];
        const FeatureSaliency all = featureSaliency(pictures);
        CHECK(all.shares[1] == 1);
        CHECK(all.shares[0] == 0);
    }
    SECTION("two of the same colour share equally") {
        pictures.alone[0] = pictures.alone[1];
        const FeatureSaliency half = featureSaliency(pictures);
        CHECK(half.shares[0] == Approx(0.5).margin(1e-6));
    }
    SECTION("where nothing is drawn nobody has anything") {
        for (Image& image : pictures.alone)
            for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 0;
        CHECK(featureSaliency(pictures).shares == std::vector<double>{0, 0, 0});
    }
    SECTION("pictures of different sizes are refused") {
        pictures.alone[1] = Image(64, 63);
        CHECK_THROWS_AS(featureSaliency(pictures), Error);
    }
}
