// What pictures are made of, pixel by pixel.
#include <catch2/catch.hpp>

#include <cmath>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "render/overlay.h"
#include "render/picture_layers.h"
#include "render/probe.h"
#include "support/random_cases.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

RenderSettings sized(int width, int height) {
    RenderSettings s;
    s.width = width;
    s.height = height;
    s.background.reset();
    return s;
}

/// The largest difference of any component of the sum of all layers from the premultiplied picture.
double largestDifference(const PictureLayers& layers) {
    double largest = 0;
    for (std::size_t p = 0; p < layers.depth.values.size(); ++p)
        for (std::size_t c = 0; c < 4; ++c) {
            double sum = layers.rest.rgba[4 * p + c];
            for (const Image& layer : layers.features) sum += layer.rgba[4 * p + c];
            const double alpha = layers.picture.rgba[4 * p + 3];
            const double whole = layers.picture.rgba[4 * p + c] * (c < 3 ? alpha : 1);
            largest = std::max(largest, std::abs(sum - whole));
        }
    return largest;
}

/// Looks along z at the middle of the volume from `distance` before it.
Camera alongZ(const Geometry& g, Projection projection, double distance) {
    Camera c;
    c.projection = projection;
    c.center = g.boxCenter();
    c.eye = c.center - Vec3(0, 0, distance);
    c.up = Vec3(0, 1, 0);
    c.height = 20;
    c.fovY = 20;
    return c;
}

float depthAt(const PictureLayers& layers, int x, int y) { return layers.depth.row(y)[x]; }
const float* normalAt(const PictureLayers& layers, int x, int y) {
    return &layers.normals[3 * static_cast<std::size_t>(y * layers.depth.width + x)];
}

} // namespace

TEST_CASE("the layers of a picture sum to it, lit or not", "[layers]") {
    Light all;
    all.on = true;
    all.gradientOpacity = 0.5;
    all.occlusion = 0.6;
    all.depthCue = 0.5;
    all.silhouettes = 0.5;
    Light shaded;
    shaded.on = true;
    for (std::uint32_t number = 0; number < 24; ++number) {
        const RandomCase c = randomCase(number, 1, {number % 3 == 1, number % 4 == 1, number % 4 == 3});
        INFO(c.describe());
        for (const Light& light : {Light(), shaded, all}) {
            RenderSettings settings = sized(40, 36);
            settings.clipping = c.clipping;
            settings.light = light;
            settings.finestInD0 = 1.0 / 16;
            const PictureLayers layers = pictureLayers(c.volume, c.camera, c.tf, settings);
            // The same rays by the same steps; compilers may round the two otherwise.
            const Image picture = makeCpuRenderer(c.volume)->render(c.camera, c.tf, settings);
            double most = 0;
            for (std::size_t i = 0; i < picture.rgba.size(); ++i)
                most = std::max(most, std::abs(static_cast<double>(picture.rgba[i]) - layers.picture.rgba[i]) *
                                          picture.rgba[i | 3]);
            CHECK(most < 1e-3);
            REQUIRE(layers.features.size() == c.tf.features.size());
            // Sums of floats in another order. Highlights are cut at white feature by feature, which makes a hair of
            // difference where one lights two features at once.
            CHECK(largestDifference(layers) < (light.on ? 4e-3 : 2e-5));
        }
    }
}

TEST_CASE("the share of a feature in a pixel is that which the probe finds there", "[layers]") {
    double largest = 0;
    for (std::uint32_t number = 0; number < 12; ++number) {
        const RandomCase c = randomCase(number);
        INFO(c.describe());
        RenderSettings settings = sized(16, 16);
        settings.stepInD0 = 0.125;
        settings.finestInD0 = 1.0 / 64;
        const PictureLayers layers = pictureLayers(c.volume, c.camera, c.tf, settings);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const RayProbe expected = probe(*c.volume, c.tf, c.camera, x + 0.5, y + 0.5, 16, 16);
                for (std::size_t f = 0; f < layers.features.size(); ++f)
                    largest = std::max(
                        largest, std::abs(static_cast<double>(layers.features[f].pixel(x, y)[3]) - expected.shares[f]));
                largest = std::max(largest, std::abs(static_cast<double>(layers.rest.pixel(x, y)[3]) - expected.rest));
            }
    }
    // The probe goes by other steps, in doubles, and by the curve itself where the picture has a table of it.
    CHECK(largest < 0.02);
}

TEST_CASE("a feature alone in front of another one takes from it what it absorbs", "[layers]") {
    // Two slabs of 8 voxels, of intensities 0.25 and 0.75, seen along z: what comes through the first is what the
    // second one divides.
    const auto volume = volumeFrom(geometryOf({24, 24, 16}), [](int, int, int k) { return k < 8 ? 0.25 : 0.75; });
    TransferFunction tf;
    const Rgb red{1, 0, 0}, blue{0, 0.5, 1};
    tf.points = {
        {0, 0.05, red, false, {}}, {0.5, 0.05, red, false, {}}, {0.5, 0.1, blue, false, {}}, {1, 0.1, blue, false, {}}};
    tf.features = {{"first", 0, 0.5, red, {}}, {"second", 0.5, 1, blue, {}}};
    const PictureLayers layers =
        pictureLayers(volume, alongZ(volume->geometry(), Projection::Orthographic, 100), tf, sized(9, 9));
    // The intensity passes 0.5 halfway between the two, 8 voxels into the box; α is that of a path of d0 = 1.
    const double first = 1 - std::pow(0.95, 8), second = (1 - first) * (1 - std::pow(0.9, 8));
    const float *a = layers.features[0].pixel(4, 4), *b = layers.features[1].pixel(4, 4);
    CHECK(a[3] == Approx(first).margin(2e-3));
    CHECK(b[3] == Approx(second).margin(2e-3));
    CHECK(a[0] == Approx(a[3]).margin(1e-3)); // red
    CHECK(a[2] == Approx(0).margin(1e-3));
    CHECK(b[1] == Approx(b[3] / 2).margin(1e-3));
    CHECK(layers.rest.pixel(4, 4)[3] == Approx(0).margin(1e-4));
}

TEST_CASE("the depth of a slab is where half of the light is absorbed, in world units along the ray", "[layers]") {
    // 20³ voxels of 2 world units, so that d0 = 2 and the box is 40 long. α = 0.1 on d0: half is absorbed after
    // ln 2 / −ln 0.9 = 6.5788 d0 = 13.158 world units.
    const auto volume = slab({20, 20, 20}, 0.5, Vec3(2));
    const double half = 2 * std::log(2.0) / -std::log(0.9);
    const Camera parallel = alongZ(volume->geometry(), Projection::Orthographic, 100);
    const PictureLayers flat = pictureLayers(volume, parallel, homogeneous(0.1), sized(9, 9));
    for (int x = 0; x < 9; ++x) CHECK(depthAt(flat, x, 3) == Approx(80 + half).margin(2e-3)); // the box begins at 80

    // A ray that is 1/cos longer meets the box that much farther away, and goes as far in it.
    const Camera perspective = alongZ(volume->geometry(), Projection::Perspective, 100);
    const PictureLayers deep = pictureLayers(volume, perspective, homogeneous(0.1), sized(9, 9));
    for (int x = 0; x < 9; ++x) {
        const double perPixel = 2 * std::tan(10 * M_PI / 180) / 9, slope = std::hypot((x - 4) * perPixel, perPixel);
        CHECK(depthAt(deep, x, 3) == Approx(80 * std::sqrt(1 + slope * slope) + half).margin(2e-3));
    }
    // There is no gradient to face anywhere, but at the sides of the box there is none either: it goes on beyond them.
    CHECK(normalAt(flat, 4, 4)[2] == 0);

    // 1 − 0.98^20 = 0.33 is less than half.
    const PictureLayers thin = pictureLayers(volume, parallel, homogeneous(0.02), sized(9, 9));
    CHECK(std::isinf(depthAt(thin, 4, 4)));
    CHECK(thin.features[0].pixel(4, 4)[3] == Approx(1 - std::pow(0.98, 20)).margin(1e-3));
}

TEST_CASE("depth and normals of a ball are those of its surface", "[layers]") {
    // The intensity falls evenly from the middle, 1 − r/40, and is drawn from 0.7 on: a ball of radius 12.
    const Geometry g = geometryOf({40, 40, 40});
    const Vec3 middle(19.5);
    const auto volume =
        volumeFrom(g, [&](int i, int j, int k) { return std::max(0.0, 1 - glm::length(Vec3(i, j, k) - middle) / 40); });
    TransferFunction tf;
    const double alpha = 0.9;
    tf.points = {{0, 0, {1, 1, 1}, false, {}},
                 {0.7, 0, {1, 1, 1}, false, {}},
                 {0.7, alpha, {1, 1, 1}, false, {}},
                 {1, alpha, {1, 1, 1}, false, {}}};
    tf.features = {{"ball", 0.7, 1, {1, 1, 1}, {}}};
    Camera camera = alongZ(g, Projection::Orthographic, 100);
    camera.height = 32; // a pixel is a world unit
    RenderSettings settings = sized(32, 32);
    settings.finestInD0 = 1.0 / 32;
    const PictureLayers layers = pictureLayers(volume, camera, tf, settings);
    int seen = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const double right = x + 0.5 - 16, up = 16 - y - 0.5, across = std::hypot(right, up);
            INFO(right << ", " << up);
            if (across > 12.1) CHECK(std::isinf(depthAt(layers, x, y)));
            if (across > 11) continue; // there the ray goes along the surface, and any error of it shows
            ++seen;
            const double toward = std::sqrt(144 - across * across);
            // Half is absorbed ln 2 / −ln(1 − α) behind the surface, which voxels bend by 1/(8 · 12) at most.
            CHECK(depthAt(layers, x, y) == Approx(100 - toward + std::log(2.0) / -std::log(1 - alpha)).margin(0.04));
            // Outward, as the radius there: right, up, toward the viewer.
            const float* n = normalAt(layers, x, y);
            CHECK(n[0] == Approx(right / 12).margin(0.04));
            CHECK(n[1] == Approx(up / 12).margin(0.04));
            CHECK(n[2] == Approx(toward / 12).margin(0.04));
        }
    CHECK(seen > 300); // π · 11² = 380
}

TEST_CASE("what is no picture by emission and absorption of one volume has no layers", "[layers]") {
    const auto volume = slab({8, 8, 8}, 0.5);
    const Camera camera = lookingAlong(volume->geometry(), Vec3(0, 0, 1));
    RenderSettings settings = sized(4, 4);
    settings.mode = RenderMode::Mip;
    CHECK_THROWS_AS(pictureLayers(volume, camera, homogeneous(0.5), settings), UsageError);
    settings = sized(4, 4);
    settings.overlay = std::make_shared<Overlay>();
    CHECK_THROWS_AS(pictureLayers(volume, camera, homogeneous(0.5), settings), UsageError);
    TransferFunction many = homogeneous(0.5);
    many.features.clear();
    for (int f = 0; f < 256; ++f) many.features.push_back({"f", f / 256.0, (f + 1) / 256.0, {}, {}});
    CHECK_THROWS_AS(pictureLayers(volume, camera, many, sized(4, 4)), UsageError);
    many.features.pop_back();
    CHECK(pictureLayers(volume, camera, many, sized(4, 4)).features.size() == 255);
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(pictureLayers(volume, camera, homogeneous(0.5), sized(4, 4), {stop.get_token(), {}}), Cancelled);
}
