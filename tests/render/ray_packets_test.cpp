// The cpu renderer against what can be derived, and its ways to one picture against each other.
#include <catch2/catch.hpp>

#include <limits>
#include <random>

#include "base/parallel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/ray_packets.h"
#include "support/picture_checks.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

RenderSettings transparent(int width, int height) {
    RenderSettings settings;
    settings.width = width, settings.height = height;
    settings.background = {};
    return settings;
}

std::shared_ptr<const Volume> rough(unsigned seed = 1) {
    std::mt19937 random(seed);
    return roughVolume(random, {41, 30, 27}, {1, 1.25, 1.5});
}
/// The same with holes.
std::shared_ptr<const Volume> withHoles() {
    const auto whole = rough();
    std::mt19937 random(2);
    return volumeFrom(whole->geometry(), [&](int i, int j, int k) {
        const Int3 n = whole->dims();
        const auto v = static_cast<std::size_t>(i + n.x * (j + n.y * k));
        return random() % 5 == 0 ? std::numeric_limits<double>::quiet_NaN() : whole->intensity(v);
    });
}

constexpr RenderMode kModes[] = {RenderMode::Composite, RenderMode::Mip, RenderMode::MinIp, RenderMode::Average,
                                 RenderMode::Surface};

/// A camera of a picture as high as the box of n³ voxels of size 1: a pixel per voxel in a picture of n × n.
Camera pixelPerVoxel(const Geometry& geometry, const Vec3& direction) {
    Camera camera = lookingAlong(geometry, direction);
    camera.height = geometry.dims.z;
    return camera;
}

} // namespace

TEST_CASE("a slab is as opaque as its thickness says, whatever the step and the spacing", "[image]") {
    // n planes apart by `spacing` along the view: 1 − (1 − α)^(n·spacing/d0).
    for (const Vec3 spacing : {Vec3(1), Vec3(1, 2.5, 1), Vec3(0.5, 0.4, 1.1)})
        for (const double alpha : {0.3, 0.05, 0.004})
            for (const double step : {1.0, 0.5, 0.25}) {
                const auto volume = slab({12, 10, 12}, 0.5, spacing);
                Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
                camera.height = 1;
                RenderSettings settings = transparent(8, 8);
                settings.stepInD0 = step;
                const double thickness = 10 * spacing.y / volume->geometry().d0();
                const Image image = makeCpuRenderer(volume)->render(camera, homogeneous(alpha), settings);
                CHECK(image.pixel(3, 5)[3] == Approx(1 - std::pow(1 - alpha, thickness)).margin(0.002));
            }
}

TEST_CASE("leaping over what is transparent changes nothing", "[image]") {
    for (const auto& volume : {rough(), withHoles()})
        for (const RenderMode mode : kModes)
            for (const bool lit : {false, true})
                for (const TransferFunction& tf : {tents(6, 0.3), tents(2, 0.05), tents(9, 0.99)}) {
                    RenderSettings settings = transparent(61, 43);
                    if (tf.features.size() == 9) settings.finestInD0 = 0.1;
                    settings.mode = mode;
                    settings.light.on = lit;
                    settings.stepInD0 = 0.7;
                    settings.jitter = lit;
                    settings.clipping.planes = {{{1, 0.3, 0.2}, 30}};
                    if (tf.features.size() == 6) settings.clipping.rest = {{{}, {1, 0.6, 1}, {{{1, -1, 0}, 3}}}, 0.2};
                    const Camera camera = cameraFromView(volume->geometry(), 40, 25, 1.2, Projection::Perspective);
                    const Image with = makeCpuRenderer(volume, {0, true})->render(camera, tf, settings),
                                without = makeCpuRenderer(volume, {0, false})->render(camera, tf, settings);
                    INFO(name(mode) << (lit ? ", lit" : ""));
                    if (mode == RenderMode::Mip || mode == RenderMode::MinIp)
                        CHECK(distance(with, without) < 1e-6); // interpolation may round beyond the largest voxel
                    else
                        CHECK((with.rgba == without.rgba));
                }
}

TEST_CASE("the kernels draw the same", "[image]") {
    const auto kernels = static_cast<int>(packetKernels().size());
    for (const auto& volume : {rough(), withHoles()})
        for (const RenderMode mode : kModes)
            for (int kernel = 1; kernel < kernels; ++kernel) {
                RenderSettings settings = transparent(40, 40);
                settings.finestInD0 = 1.0 / 32;
                settings.mode = mode;
                settings.light = {
                    .on = true, .gradientOpacity = 0.3, .occlusion = 0.4, .depthCue = 0.5, .silhouettes = 0.5};
                const Camera camera = cameraFromView(volume->geometry(), 40, 25, 1, Projection::Orthographic);
                const Image a = makeCpuRenderer(volume, {0, true})->render(camera, tents(3, 0.2), settings),
                            b = makeCpuRenderer(volume, {kernel, true})->render(camera, tents(3, 0.2), settings);
                CHECK(distance(a, b) < 1.5 / 255);
            }
}

TEST_CASE("any number of threads, tiles in any order: the same bits", "[image]") {
    const auto volume = rough();
    const auto renderer = makeCpuRenderer(volume);
    const Camera camera = cameraFromView(volume->geometry(), 40, 25, 1, Projection::Perspective);
    RenderSettings settings = transparent(150, 97);
    settings.light.on = true;
    settings.finestInD0 = 1.0 / 16;
    const int before = threadCount();
    setThreadCount(1);
    const Image one = renderer->render(camera, tents(3), settings);
    setThreadCount(3);
    const Image three = renderer->render(camera, tents(3), settings);
    Image grown(150, 97);
    std::size_t pixels = 0;
    ImagePart first;
    renderer->refine(camera, tents(3), settings, grown, 140, 90, [&](const ImagePart& part) {
        if (pixels == 0) first = part;
        pixels += static_cast<std::size_t>((part.x1 - part.x0) * (part.y1 - part.y0));
    });
    setThreadCount(before);
    CHECK((one.rgba == three.rgba));
    CHECK((one.rgba == grown.rgba));
    CHECK(pixels == 150 * 97);
    CHECK(first.x1 > 96); // one of the first three, near the focus
}

TEST_CASE("a preview is the picture seen through coarser pixels", "[image]") {
    // Half as many rays: pixel (i, j) of the preview lies between four of the picture, whose field is smooth, so that
    // rays 2.3 voxels apart will do.
    const auto volume = volumeFrom(geometryOf({64, 64, 64}), [](int i, int j, int k) {
        const Vec3 way = (Vec3(i, j, k) - 31.5) / 14.0;
        return 0.5 * std::exp(-0.5 * glm::dot(way, way)); // the tent's rising half
    });
    const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1, Projection::Perspective);
    const RenderSettings settings = transparent(121, 90);
    const auto renderer = makeCpuRenderer(volume);
    const Image fine = renderer->render(camera, tents(1, 0.05), settings);
    const Image coarse = renderer->preview(camera, tents(1, 0.05), settings, 0.5);
    REQUIRE(coarse.width == 61);
    REQUIRE(coarse.height == 45);
    double worst = 0;
    for (int y = 0; y < 45; ++y)
        for (int x = 0; x < 60; ++x) {
            double mean = 0;
            for (int n = 0; n < 4; ++n) mean += 0.25 * static_cast<double>(fine.pixel(2 * x + n % 2, 2 * y + n / 2)[3]);
            worst = std::max(worst, std::abs(mean - static_cast<double>(coarse.pixel(x, y)[3])));
        }
    CHECK(worst < 0.02);
}

TEST_CASE("halving the step moves no pixel by more than two levels under smooth transfer functions", "[image]") {
    const auto volume = volumeFrom(geometryOf({40, 40, 40}, {1, 1, 1.4}), [](int i, int j, int k) {
        return 0.5 + 0.24 * std::sin(0.31 * i + 0.1 * k) + 0.24 * std::cos(0.27 * j - 0.2 * k);
    });
    const Camera camera = cameraFromView(volume->geometry(), 33, 21, 1, Projection::Perspective);
    for (const bool lit : {false, true})
        for (const double peak : {0.5, 0.1, 0.02}) {
            RenderSettings settings = transparent(80, 80);
            settings.light.on = lit;
            settings.stepInD0 = peak < 0.2 ? 1 : 0.5;
            const auto renderer = makeCpuRenderer(volume);
            const Image whole = renderer->render(camera, tents(2, peak), settings);
            settings.stepInD0 /= 2;
            INFO("peak " << peak << (lit ? ", lit" : ""));
            // Light is taken in one place of each segment, and normals turn on the way.
            CHECK(distance(whole, renderer->render(camera, tents(2, peak), settings)) <= (lit ? 6.0 : 2.0) / 255);
        }
}

TEST_CASE("steps are halved until the picture changes by a level no more", "[image]") {
    // Opaque features with steep sides, whose borders steps of ½ d0 meet at other depths from ray to ray: rings. The
    // truth is the picture at steps of 1/64 d0.
    const auto waves = volumeFrom(geometryOf({40, 40, 40}, {1, 1, 1.4}), [](int i, int j, int k) {
        return 0.5 + 0.24 * std::sin(0.31 * i + 0.1 * k) + 0.24 * std::cos(0.27 * j - 0.2 * k);
    });
    for (const auto& volume : {waves, rough(), withHoles()})
        for (const bool lit : {false, true})
            for (const TransferFunction& tf : {tents(12, 0.95), tents(3, 0.3)}) {
                const Camera camera = cameraFromView(volume->geometry(), 33, 21, 1, Projection::Perspective);
                RenderSettings settings = transparent(80, 80);
                settings.light.on = lit;
                const auto renderer = makeCpuRenderer(volume);
                const Image plain = renderer->render(camera, tf, settings);
                settings.finestInD0 = 1.0 / 64;
                const Image refined = renderer->render(camera, tf, settings);
                settings.finestInD0.reset();
                settings.stepInD0 = 1.0 / 64;
                const Image truth = renderer->render(camera, tf, settings);
                INFO((volume == waves ? "waves" : "rough") << (lit ? ", lit, " : ", ") << tf.features.size());
                if (tf.features.size() == 12) CHECK(distance(plain, truth) > 3.0 / 255);
                CHECK(distance(refined, truth) <= 1.0 / 255);
            }
}

TEST_CASE("how far steps may be halved", "[image]") {
    // ½ is not halved further down than 1/8: ½, ¼, 1/8. As far as no full halving fits, and where nothing is asked for,
    // or no mode asks, not at all.
    RenderSettings settings;
    CHECK(settings.halvings() == 0);
    CHECK(settings.smallestStep() == 0.5);
    settings.finestInD0 = 1.0 / 8;
    CHECK(settings.halvings() == 2);
    CHECK(settings.smallestStep() == 1.0 / 8);
    settings.finestInD0 = 0.2;
    CHECK(settings.smallestStep() == 0.25);
    settings.finestInD0 = 0.5;
    CHECK(settings.halvings() == 0);
    settings.finestInD0 = 1.0 / 8;
    settings.mode = RenderMode::Mip;
    CHECK(settings.halvings() == 0);
}

TEST_CASE("a lit sphere is as bright as Phong's formula says", "[image]") {
    // Intensity 0.5 at the radius R = 12 about the centre of 40³ voxels, linear in the radius; everything denser is
    // opaque, so that what is seen is the sphere. Parallel rays from the front, 40 pixels for 40 voxels, so that pixel
    // (20 + x, 20) looks past the centre at x + ½ voxels, and ½ voxel below.
    const auto volume = volumeFrom(geometryOf({40, 40, 40}), [](int i, int j, int k) {
        return std::clamp(0.5 + (12 - glm::length(Vec3(i, j, k) - 19.5)) / 24, 0.0, 1.0);
    });
    TransferFunction tf;
    tf.points = {{0, 0, {1, 0.6, 0.2}, false, {}},
                 {0.5, 0, {1, 0.6, 0.2}, false, {}},
                 {0.5, 0.999, {1, 0.6, 0.2}, false, {}},
                 {1, 0.999, {1, 0.6, 0.2}, false, {}}};
    tf.features = {{"ball", 0.5, 1, {1, 0.6, 0.2}, {}}};
    for (const Vec3 direction : {Vec3(0, 0, 1), Vec3(3, 0, 4)})
        for (const RenderMode mode : {RenderMode::Composite, RenderMode::Surface}) {
            RenderSettings settings = transparent(40, 40);
            settings.light = {.on = true, .specular = 0.3, .shininess = 10, .direction = direction};
            settings.stepInD0 = 0.25;
            settings.mode = mode;
            const Image image =
                makeCpuRenderer(volume)->render(pixelPerVoxel(volume->geometry(), {0, 1, 0}), tf, settings);
            for (const int x : {-8, -4, 0, 4, 8}) {
                // In the camera's axes: right, up, toward the viewer.
                const double right = (x + 0.5) / 12, up = -0.5 / 12;
                const Vec3 normal(right, up, std::sqrt(1 - right * right - up * up)), light = glm::normalize(direction);
                const double cosine = std::max(0.0, glm::dot(normal, light));
                const double mirrored = std::max(0.0, (2 * cosine * normal - light).z);
                const double highlight = cosine > 0 ? 0.3 * std::pow(mirrored, 10) : 0;
                const double scale = 0.35 + 0.65 * cosine;
                INFO(name(mode) << ", light from " << direction.x << ", pixel " << x);
                const float* pixel = image.pixel(20 + x, 20);
                CHECK(pixel[0] == Approx(std::min(1.0, scale + highlight)).margin(0.02));
                CHECK(pixel[1] == Approx(std::min(1.0, 0.6 * scale + highlight)).margin(0.02));
                CHECK(pixel[2] == Approx(std::min(1.0, 0.2 * scale + highlight)).margin(0.02));
            }
        }
}

TEST_CASE("the largest, smallest and mean intensity along a ray", "[image]") {
    // Intensity rises along the view from 0.2 to 0.8 over 13 planes; beyond the outer centres it is constant. The mean
    // over 13 voxels is then 0.5. Nothing lies beside the box.
    const auto volume = volumeFrom(geometryOf({12, 13, 12}), [](int, int j, int) { return 0.2 + 0.05 * j; });
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 24;
    RenderSettings settings = transparent(24, 24);
    const auto grey = [&](RenderMode mode) {
        settings.mode = mode;
        const Image image = makeCpuRenderer(volume)->render(camera, tents(3), settings);
        CHECK(image.pixel(12, 12)[3] == 1);
        CHECK(image.pixel(1, 1)[3] == 0);
        CHECK(image.pixel(12, 12)[1] == image.pixel(12, 12)[0]);
        return image.pixel(12, 12)[0];
    };
    CHECK(grey(RenderMode::Mip) == Approx(0.8).margin(1e-3));
    CHECK(grey(RenderMode::MinIp) == Approx(0.2).margin(1e-3));
    CHECK(grey(RenderMode::Average) == Approx(0.5).margin(2e-3));
    settings.clipping.hi.y = 0.5; // up to half of 13 planes, at −0.5 + 6.5 = 6: intensity 0.5
    CHECK(grey(RenderMode::Mip) == Approx(0.5).margin(1e-3));
    settings.clipping = {};
    settings.onlyFeature = 0; // [0.033, 0.3): the tent about 1/6
    settings.stepInD0 = 0.05;
    CHECK(grey(RenderMode::Mip) == Approx(tents(3).features[0].b).margin(5e-3));
}

TEST_CASE("surfaces: each feature once, where the ray enters it", "[image]") {
    // Down and up again through both features: 0.9 0.9 … 0.1 … 0.9. The front feature (green, [0.5, 1]) is where the
    // ray starts, the one behind (red, [0.05, 0.3)) is entered later; neither counts again on the way back.
    const auto volume =
        volumeFrom(geometryOf({12, 41, 12}), [](int, int j, int) { return 0.1 + 0.04 * std::abs(j - 20); });
    TransferFunction tf;
    tf.points = {{0.05, 0.5, {1, 0, 0}, false, {}}, {0.3, 0.5, {1, 0, 0}, false, {}},  {0.3, 0, {1, 0, 0}, false, {}},
                 {0.5, 0, {0, 1, 0}, false, {}},    {0.5, 0.25, {0, 1, 0}, false, {}}, {1, 0.25, {0, 1, 0}, false, {}}};
    tf.features = {{"red", 0.05, 0.3, {1, 0, 0}, {}}, {"green", 0.5, 1, {0, 1, 0}, {}}};
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 6;
    RenderSettings settings = transparent(8, 8);
    settings.background = Rgb{0, 0, 0};
    settings.mode = RenderMode::Surface;
    const Image image = makeCpuRenderer(volume)->render(camera, tf, settings);
    CHECK(image.pixel(4, 4)[1] == Approx(0.25).margin(1e-4));
    CHECK(image.pixel(4, 4)[0] == Approx(0.75 * 0.5).margin(1e-4));
    settings.onlyFeature = 0;
    CHECK(makeCpuRenderer(volume)->render(camera, tf, settings).pixel(4, 4)[0] == Approx(0.5).margin(1e-4));
}

TEST_CASE("what light adds acts where it should", "[image]") {
    const auto homogeneousVolume = slab({20, 20, 20}, 0.5);
    Camera camera = pixelPerVoxel(homogeneousVolume->geometry(), {0, 1, 0});
    RenderSettings settings = transparent(20, 20);
    const auto pixel = [&](const Light& light) {
        settings.light = light;
        const Image image = makeCpuRenderer(homogeneousVolume)->render(camera, homogeneous(0.1), settings);
        return std::array<float, 2>{image.pixel(10, 10)[0], image.pixel(10, 10)[3]};
    };
    const auto plain = pixel({});
    // No gradient: no surface to light or to outline, and all of the opacity goes.
    CHECK(pixel({.on = true}) == plain);
    CHECK(pixel({.silhouettes = 1}) == plain);
    CHECK(pixel({.gradientOpacity = 1})[1] == 0);
    // (1 − ½): exp(−½·20·0.105)
    CHECK(pixel({.gradientOpacity = 0.5})[1] == Approx(1 - std::pow(0.9, 10)).margin(2e-3));
    // The box reaches from −10 to 10 about the middle of a depth of 2·10·√3. Nearly all of the light comes from the
    // front: 7.3 to 8.3 deep behind the foremost place, of 34.6 (black, weighted by exp(−0.105·z): mean z = 9.5·0.69).
    const double mean = [] { // ∫ z·e^{−kz} / ∫ e^{−kz} over [0, 20]
        const double k = -std::log(0.9), e = std::exp(-20 * k);
        return (1 - e * (1 + 20 * k)) / (k * (1 - e));
    }();
    const double radius = 10 * std::sqrt(3.0);
    CHECK(pixel({.depthCue = 1})[0] == Approx(1 - (radius - 10 + mean) / (2 * radius)).margin(0.01));
    CHECK(pixel({.depthCue = 1})[1] == plain[1]);
    const auto occluded = pixel({.occlusion = 1});
    CHECK(occluded[0] < 0.8f * plain[0]);
    CHECK(occluded[1] == plain[1]);
}

TEST_CASE("a background may change from bottom to top", "[image]") {
    const auto volume = slab({4, 4, 4}, 0.5);
    RenderSettings settings = transparent(10, 20);
    settings.background = Rgb{0, 0, 0};
    settings.backgroundTop = Rgb{1, 0.5, 0};
    const Image image =
        makeCpuRenderer(volume)->render(lookingAlong(volume->geometry(), {0, 1, 0}), homogeneous(0), settings);
    CHECK(image.pixel(0, 0)[0] == Approx(39.0 / 40).margin(1e-5)); // the middle of the first of 20 rows
    CHECK(image.pixel(0, 0)[1] == Approx(0.5 * 39 / 40).margin(1e-5));
    CHECK(image.pixel(9, 19)[0] == Approx(1.0 / 40).margin(1e-5));
}

TEST_CASE("volumes one voxel thick are drawn", "[image]") {
    for (const Int3 dims : {Int3(1, 9, 9), Int3(9, 1, 9), Int3(9, 9, 1), Int3(1, 1, 1)}) {
        const auto volume = slab(dims, 0.5);
        for (const Vec3 direction : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
            Camera camera = lookingAlong(volume->geometry(), direction);
            camera.height = 0.5;
            RenderSettings settings = transparent(4, 4);
            settings.light.on = true;
            const double thickness = glm::dot(direction, Vec3(dims));
            const Image image = makeCpuRenderer(volume)->render(camera, homogeneous(0.1), settings);
            CHECK(image.pixel(2, 2)[3] == Approx(1 - std::pow(0.9, thickness)).margin(1e-3));
        }
    }
}
