#include "render/ground.h"

#include <catch2/catch.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "render/ground_raster.h"
#include "render/image_renderer.h"
#include "support/volumes.h"
#include "tf/terrain.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// nx × ny heights one world unit apart.
Ground groundOf(int nx, int ny, const std::function<double(int, int)>& height) {
    Ground ground;
    ground.nx = nx;
    ground.ny = ny;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) ground.heights.push_back(static_cast<float>(height(i, j)));
    ground.colorMap = "spiral";
    ground.relief = 0;
    return ground;
}

Camera above(double height) {
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.center = {1, 1, 0};
    camera.eye = {1, 1, 10};
    camera.up = {0, 1, 0};
    camera.height = height;
    return camera;
}

/// A picture of the ground alone. A pixel's depth is the distance from the plane (perspective: the eye) from which the
/// rays of `camera` start to the first hit, in world units along the ray; infinity where there is none.
struct GroundImage {
    Image color; ///< opaque where there is ground
    std::vector<float> depth;
};
GroundImage drawGround(const Ground& ground, const Camera& camera, int width, int height) {
    camera.validate("camera");
    const GroundWindow whole{static_cast<double>(width), static_cast<double>(height), 0, 0, width, height};
    const GroundPicture drawn = rasterizeGround(ground, camera, 0, whole);
    GroundImage image{Image(width, height), drawn.depth};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float* pixel = image.color.pixel(x, y);
            const auto i = static_cast<std::size_t>((pixel - image.color.rgba.data()) / 4);
            for (int c = 0; c < 4; ++c) pixel[c] = static_cast<float>(drawn.rgba[i] >> (8 * c) & 255u) / 255;
            // From along the view to along the ray.
            const Vec3 ray = pixelRay(camera, x + 0.5, y + 0.5, width, height).direction;
            image.depth[i] /= static_cast<float>(glm::dot(ray, camera.forward()));
        }
    return image;
}

float depthAt(const GroundImage& image, int x, int y) {
    return image
        .depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.color.width) + static_cast<std::size_t>(x)];
}

void checkColor(const float* pixel, const Rgb& expected, double brightness = 1) {
    // Colours have 8 bits, and a table of 4096 entries leads to them.
    CHECK(pixel[0] == Approx(std::min(1.0, expected.r * brightness)).margin(0.003));
    CHECK(pixel[1] == Approx(std::min(1.0, expected.g * brightness)).margin(0.003));
    CHECK(pixel[2] == Approx(std::min(1.0, expected.b * brightness)).margin(0.003));
    CHECK(pixel[3] == 1);
}

/// What a pixel's ray meets of the plane z = rise·x over [0, x1] × [0, y1]: length of the way, and x; empty beside it
/// or, `unsure`, at its border.
struct Hit {
    double way = 0, x = 0;
    bool any = false, unsure = false;
};
Hit hitOf(const Camera& camera, int x, int y, int width, int height, double rise, double x1, double y1) {
    const Ray ray = pixelRay(camera, x + 0.5, y + 0.5, width, height);
    Hit hit;
    hit.way = (rise * ray.origin.x - ray.origin.z) / (ray.direction.z - rise * ray.direction.x);
    const Vec3 p = ray.origin + hit.way * ray.direction;
    hit.x = p.x;
    const double in = std::min({p.x, x1 - p.x, p.y, y1 - p.y});
    hit.any = hit.way > 0 && in > 0;
    hit.unsure = std::abs(in) < 1e-4;
    return hit;
}

} // namespace

TEST_CASE("a flat ground from above covers its rectangle, at its depth", "[ground]") {
    // 2 × 2 world units in a picture of 4 × 4: pixels 10 … 29 of 40, along both axes. The eye is 10 above.
    Ground ground = groundOf(3, 3, [](int, int) { return 0.0; });
    ground.lo = -1;
    for (const double relief : {0.0, 1.0}) { // what is flat is as bright as it is
        ground.relief = relief;
        const GroundImage image = drawGround(ground, above(4), 40, 40);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) {
                const bool in = x >= 10 && x < 30 && y >= 10 && y < 30;
                REQUIRE(std::isfinite(depthAt(image, x, y)) == in);
                REQUIRE(image.color.pixel(x, y)[3] == (in ? 1.0f : 0.0f));
                if (in) REQUIRE(depthAt(image, x, y) == Approx(10).epsilon(1e-6));
            }
        checkColor(image.color.pixel(20, 20), groundColors("spiral")(0.5));
    }
}

TEST_CASE("a slope has the depths and colours of its heights, from above and from below", "[ground]") {
    // z = x over [0, 2]²: at the pixel of x it lies 10 − x from the eye; its colour is that of x/2.
    Ground ground = groundOf(3, 3, [](int i, int) { return i; });
    ground.hi = 2;
    const GroundImage image = drawGround(ground, above(4), 40, 40);
    for (int x = 10; x < 30; ++x) {
        const double at = (x + 0.5) / 10 - 1;
        CHECK(depthAt(image, x, 17) == Approx(10 - at).epsilon(1e-6));
        checkColor(image.color.pixel(x, 17), groundColors("spiral")(at / 2));
    }
    // From 10 below, x to the right again: 10 + x, and darker.
    Camera below = above(4);
    below.eye.z = -10;
    below.up = {0, -1, 0};
    const GroundImage under = drawGround(ground, below, 40, 40);
    for (int x = 10; x < 30; ++x) {
        const double at = (x + 0.5) / 10 - 1;
        CHECK(depthAt(under, x, 17) == Approx(10 + at).epsilon(1e-6));
        checkColor(under.color.pixel(x, 17), groundColors("spiral")(at / 2), 0.45);
    }
}

TEST_CASE("in perspective a slope lies where rays meet it", "[ground]") {
    // Against the intersection of each pixel's ray with the plane; the second eye stands over it, and a part of it lies
    // behind the eye, where nothing may be drawn or missing.
    Ground ground = groundOf(9, 6, [](int i, int) { return 0.25 * i; });
    ground.hi = 2;
    Camera far, over;
    far.eye = {12, -14, 9};
    far.center = {4, 2.5, 1};
    over.eye = {4, 2.5, 3};
    over.center = {8, 4, 1.5};
    over.fovY = 100;
    for (const Camera& camera : {far, over}) {
        const GroundImage image = drawGround(ground, camera, 64, 48);
        int hits = 0;
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const Hit hit = hitOf(camera, x, y, 64, 48, 0.25, 8, 5);
                if (hit.unsure) continue;
                REQUIRE(std::isfinite(depthAt(image, x, y)) == hit.any);
                if (!hit.any) continue;
                ++hits;
                REQUIRE(depthAt(image, x, y) == Approx(hit.way).epsilon(1e-5));
                if (hits % 50 == 0) checkColor(image.color.pixel(x, y), groundColors("spiral")(0.25 * hit.x / 2));
            }
        CHECK(hits > 200);
    }
}

TEST_CASE("samples finer than pixels are the same plane, whatever is left out", "[ground]") {
    // 400 × 300 samples in 40 × 30 pixels.
    Ground ground = groundOf(400, 300, [](int i, int) { return 0.25 * i; });
    Camera camera;
    camera.eye = {500, -500, 400};
    camera.center = {200, 150, 40};
    const GroundImage image = drawGround(ground, camera, 40, 30);
    int hits = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const Hit hit = hitOf(camera, x, y, 40, 30, 0.25, 399, 299);
            if (hit.unsure) continue;
            REQUIRE(std::isfinite(depthAt(image, x, y)) == hit.any);
            hits += hit.any ? 1 : 0;
            if (hit.any) REQUIRE(depthAt(image, x, y) == Approx(hit.way).epsilon(1e-5));
        }
    CHECK(hits > 100);
}

TEST_CASE("the nearer of two hills hides the other", "[ground]") {
    // Walls of height 4 at x = 1 and x = 3, seen along +x from x = −10: the first is met halfway up its side. At height
    // z its slope from (0, 0) to (1, 4) is at x = z/4.
    const Ground ground = groundOf(5, 3, [](int i, int) { return i % 2 == 1 ? 4.0 : 0.0; });
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.eye = {-10, 1, 2};
    camera.center = {0, 1, 2};
    camera.height = 8;
    const GroundImage image = drawGround(ground, camera, 40, 40);
    for (int y = 11; y < 29; ++y) { // z = 2 + (20 − y − 0.5)/5
        const double z = 2 + (19.5 - y) / 5;
        CHECK(depthAt(image, 20, y) == Approx(10 + z / 4).epsilon(1e-5));
    }
}

TEST_CASE("where heights are missing there is a hole", "[ground]") {
    // The middle one of 5 × 5: the triangles at it are left out, all within one unit of it.
    const Ground ground = groundOf(5, 5, [](int i, int j) { return i == 2 && j == 2 ? std::nan("") : 0.0; });
    Camera camera = above(8);
    camera.eye = {2, 2, 10};
    camera.center = {2, 2, 0};
    const GroundImage image = drawGround(ground, camera, 80, 80); // 10 pixels a unit, x = 0 at pixel 20
    CHECK(std::isinf(depthAt(image, 39, 39)));
    CHECK(std::isinf(depthAt(image, 42, 41)));
    CHECK(depthAt(image, 28, 40) == Approx(10)); // x = 0.85
    CHECK(depthAt(image, 51, 40) == Approx(10));
}

TEST_CASE("slopes toward the upper left are brighter, by their angle to the sun", "[ground]") {
    // z = s·x has the normal (−s, 0, 1)/√(1 + s²); the sun stands at (−½, ½, 1/√2). What is flat has the cosine 1/√2
    // and the brightness 1, what is turned away 0.4: 0.4 + 0.6·√2·cos.
    for (const double s : {1.0, 0.4, -0.5}) {
        Ground ground = groundOf(3, 3, [s](int i, int) { return s * i; });
        ground.lo = -1000; // about the same colour everywhere: that of 1/2
        ground.hi = 1000;
        ground.relief = 1;
        const double cosine = (s / 2 + std::sqrt(0.5)) / std::sqrt(1 + s * s);
        const double brightness = 0.4 + 0.6 * std::sqrt(2.0) * cosine;
        checkColor(drawGround(ground, above(4), 40, 40).color.pixel(20, 20), groundColors("spiral")(0.5), brightness);
        ground.relief = 0.5;
        checkColor(drawGround(ground, above(4), 40, 40).color.pixel(20, 20), groundColors("spiral")(0.5),
                   (1 + brightness) / 2);
    }
}

TEST_CASE("terrain goes from the sea over green and brown to white", "[ground]") {
    const Rgb sea = terrainColor(0), low = terrainColor(0.1), high = terrainColor(0.6), top = terrainColor(1);
    CHECK(sea.b > std::max(sea.r, sea.g));
    CHECK(low.g > std::max(low.r, low.b));
    CHECK((high.r > high.g && high.g > high.b));
    CHECK(std::min({top.r, top.g, top.b}) > 0.95);
    CHECK(terrainColor(-3) == sea);
    CHECK(terrainColor(7) == top);
    CHECK_THROWS_AS(groundColors("mud"), UsageError);
    CHECK_THROWS_AS(groundColors("categorical"), UsageError); // heights have no categories
    for (const std::string& name : groundColorNames()) CHECK_NOTHROW(groundColors(name));
}

TEST_CASE("the ground has the same bits with any number of threads, whole or in parts", "[ground]") {
    Ground ground =
        groundOf(70, 60, [](int i, int j) { return 4 * std::sin(0.3 * i) * std::cos(0.4 * j) + 0.01 * (i * j % 7); });
    ground.lo = -5;
    ground.hi = 5;
    ground.relief = 1;
    Camera camera;
    camera.eye = {90, -50, 40};
    camera.center = {35, 30, 0};
    const GroundWindow whole{150, 110, 0, 0, 150, 110};
    const int before = threadCount();
    setThreadCount(1);
    const GroundPicture one = rasterizeGround(ground, camera, 50, whole);
    setThreadCount(4);
    const GroundPicture four = rasterizeGround(ground, camera, 50, whole);
    setThreadCount(before);
    CHECK(one.rgba == four.rgba);
    CHECK(one.depth == four.depth);
    // A part: single precision counts from another corner there, a hair of a pixel.
    const GroundPicture part = rasterizeGround(ground, camera, 50, {150, 110, 40, 30, 60, 50});
    int different = 0, drawn = 0;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 60; ++x) {
            const float a = part.depth[static_cast<std::size_t>(60 * y + x)],
                        b = one.depth[static_cast<std::size_t>(150 * (y + 30) + x + 40)];
            drawn += std::isfinite(b) ? 1 : 0;
            different += a == b || std::abs(a - b) < 1e-3f ? 0 : 1;
        }
    CHECK(drawn > 500);
    CHECK(different < 10);
}

namespace {

/// 10³ voxels of α, the box from −0.5 to 9.5; and a ground 5 above its lower face, of one colour.
struct Block {
    std::shared_ptr<const Volume> volume = slab({10, 10, 10}, 0.5);
    std::shared_ptr<const Ground> ground;
    RenderSettings settings;
    Camera camera;

    Block() {
        Ground made = groundOf(2, 2, [](int, int) { return 5.0; });
        made.origin = {-0.5, -0.5, -0.5};
        made.stepX = {10, 0, 0};
        made.stepY = {0, 10, 0};
        made.lo = 0;
        made.hi = 10;
        ground = std::make_shared<const Ground>(std::move(made));
        settings.width = settings.height = 21;
        settings.background = {};
        settings.ground = ground;
        camera = lookingAlong(volume->geometry(), {0, 0, -1});
        camera.height = 8;
    }
    Image drawn(const TransferFunction& tf) const { return makeCpuRenderer(volume)->render(camera, tf, settings); }
};

} // namespace

TEST_CASE("the ground hides what lies behind it, and shows through what lies before it", "[ground]") {
    // Half of the ten planes of α = 0.1 lie before it from either side: 0.9⁵ of it is seen through red.
    Block block;
    const Rgb color = groundColors("spiral")(0.5);
    const double clear = std::pow(0.9, 5);
    checkColor(block.drawn(homogeneous(0.1)).pixel(10, 10),
               {1 - clear + clear * color.r, clear * color.g, clear * color.b});
    block.camera = lookingAlong(block.volume->geometry(), {0, 0, 1});
    block.camera.height = 8;
    const Rgb dark{0.45 * color.r, 0.45 * color.g, 0.45 * color.b};
    checkColor(block.drawn(homogeneous(0.1)).pixel(10, 10),
               {1 - clear + clear * dark.r, clear * dark.g, clear * dark.b});

    // Clipping the upper half but for one plane leaves the ground as it is.
    block.camera = lookingAlong(block.volume->geometry(), {0, 0, -1});
    block.camera.height = 8;
    block.settings.clipping.lo.z = 0.6;
    block.settings.clipping.hi.z = 0.7;
    checkColor(block.drawn(homogeneous(0.1)).pixel(10, 10), {0.1 + 0.9 * color.r, 0.9 * color.g, 0.9 * color.b});
    block.settings.clipping = {};

    // Beside it there is nothing, and intensities as grey have none.
    block.camera.height = 20;
    CHECK(block.drawn(homogeneous(0.1)).pixel(0, 10)[3] == 0);
    block.settings.mode = RenderMode::Mip;
    CHECK(block.drawn(homogeneous(0.1)).pixel(10, 10)[0] == Approx(0.5).margin(1e-3));

    // A surface of opacity 0.1, and of the ground what that leaves.
    block.settings.mode = RenderMode::Surface;
    checkColor(block.drawn(homogeneous(0.1)).pixel(10, 10), {0.1 + 0.9 * color.r, 0.9 * color.g, 0.9 * color.b});
}

TEST_CASE("the ground fades into the background as what is at its depth does", "[ground]") {
    // Its plane goes through the middle of the box: halfway of the depth cue, which is 0.6 in the farthest.
    Block block;
    block.settings.background = Rgb{0, 0, 1};
    block.settings.light.depthCue = 0.6;
    const Rgb color = groundColors("spiral")(0.5);
    checkColor(block.drawn(homogeneous(0)).pixel(10, 10), {0.7 * color.r, 0.7 * color.g, 0.7 * color.b + 0.3});
}

TEST_CASE("previews and pictures that grow have the ground, too", "[ground]") {
    Block block;
    block.camera = cameraFromView(block.volume->geometry(), 30, 35, 1, Projection::Perspective);
    block.settings.width = 70;
    block.settings.height = 50;
    block.settings.background = Rgb{0, 0, 0};
    const auto renderer = makeCpuRenderer(block.volume);
    const TransferFunction tf = homogeneous(0.05);
    const Image whole = renderer->render(block.camera, tf, block.settings);
    Image grown(70, 50);
    renderer->refine(block.camera, tf, block.settings, grown, 20, 20, [](const ImagePart&) {});
    CHECK(grown.rgba == whole.rgba);
    // A pixel of the preview is 2.5 × 2.5 of the picture: alike but at edges.
    const Image preview = renderer->preview(block.camera, tf, block.settings, 0.4);
    REQUIRE((preview.width == 28 && preview.height == 20));
    int different = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 28; ++x) {
            const float* a = preview.pixel(x, y);
            const float* b = whole.pixel(static_cast<int>((x + 0.5) * 2.5), static_cast<int>((y + 0.5) * 2.5));
            different += std::abs(a[1] - b[1]) > 0.1f ? 1 : 0;
        }
    CHECK(different < 60); // of 560
    CHECK(preview.pixel(14, 10)[1] > 0.1f);
}
