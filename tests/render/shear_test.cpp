// The quick picture: how views become shears, against rays of pixels one by one, and its pictures against the full
// ones.
#include <catch2/catch.hpp>

#include <random>

#include <glm/geometric.hpp>

#include "base/screen_pixel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/ray_packets.h"
#include "render/projected.h"
#include "render/ssim.h"
#include "support/volumes.h"
#include "tf/presets.h"
#include "volume/procedural.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// A grid whose axes are neither the world's nor at right angles, nor of one spacing.
Geometry skewed() {
    Geometry g = geometryOf({20, 31, 26}, {1, 0.7, 1.6});
    g.origin = {3, -40, 12};
    g.directions =
        Mat3(glm::normalize(Vec3(0.8, 0.6, 0.1)), glm::normalize(Vec3(-0.6, 0.8, 0)), glm::normalize(Vec3(0.1, 0, -1)));
    return g;
}

/// From all around, so that every axis of the volume is the one that rays go along, both ways.
std::vector<Camera> around(const Geometry& geometry, int count, Projection projection, double zoom = 1) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> one(0, 1);
    std::vector<Camera> cameras;
    for (int i = 0; i < count; ++i) {
        const double elevation = std::asin(2 * one(random) - 1) * 180 / 3.14159265;
        cameras.push_back(cameraFromView(geometry, 360 * one(random), elevation, zoom, projection));
    }
    return cameras;
}

/// Three shells of different intensity around one another, of no symmetry.
std::shared_ptr<const Volume> lumps(const Int3& n, const Vec3& spacing = Vec3(1)) {
    return volumeFrom(geometryOf(n, spacing), [n](int i, int j, int k) {
        const Vec3 p = (Vec3(i, j, k) + 0.5) / Vec3(n) - 0.5;
        const double r = glm::length(p * Vec3(1, 1.3, 1.1)),
                     bump = 0.05 * std::sin(9 * p.x) * std::cos(11 * p.y + 5 * p.z);
        return std::clamp(1.1 - 2.2 * (r + bump), 0.0, 1.0);
    });
}

RenderSettings pictureOf(int width, int height) {
    RenderSettings settings;
    settings.width = width, settings.height = height;
    settings.stepInD0 = 0.5;
    return settings;
}

double largestAlphaDifference(const Image& a, const Image& b) {
    double worst = 0;
    for (std::size_t i = 3; i < a.rgba.size(); i += 4)
        worst = std::max(worst, std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i])));
    return worst;
}

} // namespace

TEST_CASE("every point of a ray of the grid lies in the pixel that it is warped to", "[sheared]") {
    for (const Geometry& g : {geometryOf({20, 31, 26}), skewed()})
        for (const Projection projection : {Projection::Orthographic, Projection::Perspective}) {
            std::array<int, 6> seen{};
            for (const Camera& camera : around(g, 40, projection, 1.3)) {
                const auto view = shearOf(camera, g, {}, 120, 90);
                REQUIRE(view);
                ++seen[static_cast<std::size_t>(2 * view->axis[2] + view->reversed)];
                const Projected project(camera, 120, 90);
                double worst = 0;
                for (const Vec2 pixel : {Vec2(10.5, 20.25), Vec2(60, 45), Vec2(111, 80)}) {
                    const Vec2 inBase = view->inBase(pixel.x, pixel.y);
                    double lastDepth = -1e30;
                    for (const double w : {-0.5, 0.0, 7.25, view->dims.z - 0.5}) {
                        const Vec2 uv = view->at(inBase, w);
                        const Vec3 world = g.worldFromVoxel(view->inVoxels({uv.x, uv.y, w}));
                        worst = std::max(worst, glm::length(project(world) - pixel));
                        CHECK(project.depth(world) > lastDepth); // from the front to the back
                        lastDepth = project.depth(world);
                    }
                }
                CHECK(worst < 1e-6);
            }
            for (const int count : seen) CHECK(count > 0);
        }
}

TEST_CASE("the grid of rays reaches over all that the picture shows of the volume", "[sheared]") {
    const Geometry g = skewed();
    for (const Projection projection : {Projection::Orthographic, Projection::Perspective})
        for (const Camera& camera : around(g, 20, projection)) {
            const auto view = shearOf(camera, g, {}, 120, 90);
            REQUIRE(view);
            const Projected project(camera, 120, 90);
            for (int corner = 0; corner < 8; ++corner) {
                const Vec2 pixel = project(g.corner(corner)), inBase = view->inBase(pixel.x, pixel.y);
                const double count[2] = {static_cast<double>(view->width), static_cast<double>(view->height)};
                for (int a = 0; a < 2; ++a) {
                    const auto i = static_cast<std::size_t>(a);
                    const double ray = (inBase[a] - view->first[i]) / view->pitch[i];
                    CHECK(ray > 1); // cubic interpolation reads one ray beyond
                    CHECK(ray < count[a] - 2);
                }
            }
        }
}

TEST_CASE("rays that run beside the stack of slices or spread too far have no shear", "[sheared]") {
    const Geometry g = geometryOf({20, 20, 20}); // its box reaches from −0.5 to 19.5
    Camera camera;
    camera.center = {9.5, 9.5, 9.5};
    camera.eye = {9.5, 9.5, -40};
    camera.up = {0, 1, 0};
    // The slices lie 39.5 to 59.5 in front of the eye: at most 1.5 times as far.
    CHECK(shearOf(camera, g, {}, 64, 64));
    // Now 1 to 21: 21 times as far.
    camera.eye = {9.5, 9.5, -1.5};
    CHECK_FALSE(shearOf(camera, g, {}, 64, 64));
    // A single slice has no way through it.
    CHECK_FALSE(shearOf(cameraFromView(geometryOf({20, 20, 1}), 0, 90, 1, Projection::Orthographic),
                        geometryOf({20, 20, 1}), {}, 64, 64));
}

TEST_CASE("a homogeneous block is as opaque in the quick picture as its thickness says", "[sheared]") {
    // 1 − (1 − α)^(thickness/d0) of a ray through the middle: along an axis the thickness is that of the box; where it
    // goes half a voxel along x for each along z, it is √(1 + ¼) times as much.
    const auto volume = slab({24, 24, 24}, 0.5);
    RenderSettings settings = pictureOf(33, 33);
    settings.background = {};
    for (std::size_t kernel = 0; kernel < packetKernels().size(); ++kernel) {
        CpuRenderOptions options;
        options.kernel = static_cast<int>(kernel);
        const auto renderer = makeCpuRenderer(volume, options);
        for (const auto& [direction, thickness] :
             {std::pair{Vec3(0, 1, 0), 24.0}, std::pair{Vec3(1, 0, 0), 24.0}, std::pair{Vec3(0, 0, -1), 24.0},
              std::pair{Vec3(1, 0, -2), 24 * std::sqrt(1.25)}}) {
            Camera camera = lookingAlong(volume->geometry(), direction);
            camera.height = 24; // so that many rays around the middle meet the whole block
            REQUIRE(renderer->previewsInStorageOrder(camera, settings));
            const Image image = renderer->preview(camera, homogeneous(0.05), settings, 1);
            CHECK(image.pixel(16, 16)[3] == Approx(1 - std::pow(0.95, thickness)).margin(0.002));
        }
    }
}

TEST_CASE("the quick picture is the full one, from all around", "[sheared]") {
    for (const auto& volume : {lumps({48, 40, 44}), lumps({40, 44, 20}, {1, 1, 2.5})})
        for (const Projection projection : {Projection::Orthographic, Projection::Perspective})
            for (const bool lit : {false, true}) {
                const auto renderer = makeCpuRenderer(volume);
                RenderSettings settings = pictureOf(96, 80);
                settings.light.on = lit;
                double least = 1;
                for (const Camera& camera : around(volume->geometry(), 8, projection, 1.2)) {
                    REQUIRE(renderer->previewsInStorageOrder(camera, settings));
                    least = std::min(least, ssim(renderer->render(camera, tents(3, 0.3), settings),
                                                 renderer->preview(camera, tents(3, 0.3), settings, 1)));
                }
                CHECK(least > 0.97);
            }
}

TEST_CASE("nothing jumps where rays begin to go along another axis", "[sheared]") {
    // A hundredth of a degree to both sides of the diagonal: the pictures differ by no more than each from the full
    // one.
    const auto volume = lumps({48, 48, 48});
    const auto renderer = makeCpuRenderer(volume);
    const RenderSettings settings = pictureOf(96, 80);
    const auto at = [&](double azimuth) {
        return cameraFromView(volume->geometry(), azimuth, 0, 1, Projection::Orthographic);
    };
    const auto before = shearOf(at(44.99), volume->geometry(), {}, 96, 80),
               after = shearOf(at(45.01), volume->geometry(), {}, 96, 80);
    REQUIRE((before && after && before->axis[2] != after->axis[2]));
    CHECK(ssim(renderer->preview(at(44.99), tents(3, 0.3), settings, 1),
               renderer->preview(at(45.01), tents(3, 0.3), settings, 1)) > 0.98);
}

TEST_CASE("what is clipped away is missing or faint in the quick picture, too", "[sheared]") {
    const auto volume = lumps({48, 40, 44});
    const auto renderer = makeCpuRenderer(volume);
    RenderSettings settings = pictureOf(96, 80);
    settings.clipping.lo = {0.2, 0, 0.31};
    settings.clipping.planes = {{{1, 1, 0.3}, 48}};
    for (const double density : {0.0, 0.1}) {
        if (density > 0) settings.clipping.rest = {settings.clipping.part(), density};
        if (density > 0) settings.clipping.setPart({{0, 0.1, 0}, {1, 1, 1}, {}});
        double least = 1;
        for (const Camera& camera : around(volume->geometry(), 10, Projection::Perspective))
            least = std::min(least, ssim(renderer->render(camera, tents(3, 0.3), settings),
                                         renderer->preview(camera, tents(3, 0.3), settings, 1)));
        CAPTURE(density);
        CHECK(least > 0.96);
    }
}

TEST_CASE("invalid voxels are transparent in the quick picture", "[sheared]") {
    const auto whole = lumps({40, 36, 44});
    const auto volume = volumeFrom(whole->geometry(), [&](int i, int j, int k) {
        const bool hole = glm::length(Vec3(i, j, k) - Vec3(14, 18, 14)) < 9;
        return hole ? std::numeric_limits<double>::quiet_NaN() : whole->intensity(voxelIndex(whole->dims(), i, j, k));
    });
    const auto renderer = makeCpuRenderer(volume);
    RenderSettings settings = pictureOf(96, 80);
    double least = 1;
    for (const bool lit : {false, true})
        for (const Camera& camera : around(volume->geometry(), 8, Projection::Perspective)) {
            settings.light.on = lit;
            least = std::min(least, ssim(renderer->render(camera, tents(3, 0.2), settings),
                                         renderer->preview(camera, tents(3, 0.2), settings, 1)));
        }
    CHECK(least > 0.96);
}

TEST_CASE("leaping and the choice of instructions change nothing of the quick picture", "[sheared]") {
    const auto volume = lumps({48, 40, 44});
    CpuRenderOptions straight;
    straight.leap = false;
    const auto renderer = makeCpuRenderer(volume), unleaping = makeCpuRenderer(volume, straight);
    std::vector<std::unique_ptr<TileRenderer>> others;
    for (std::size_t kernel = 1; kernel < packetKernels().size(); ++kernel) {
        CpuRenderOptions options;
        options.kernel = static_cast<int>(kernel);
        others.push_back(makeCpuRenderer(volume, options));
    }
    for (const bool lit : {false, true})
        for (const Camera& camera : around(volume->geometry(), 4, Projection::Perspective)) {
            RenderSettings settings = pictureOf(72, 60);
            settings.background = {};
            settings.light.on = lit;
            const Image expected = renderer->preview(camera, tents(2, 0.3), settings, 1);
            CHECK(largestAlphaDifference(expected, unleaping->preview(camera, tents(2, 0.3), settings, 1)) < 1e-4);
            for (const auto& other : others)
                CHECK(ssim(expected, other->preview(camera, tents(2, 0.3), settings, 1)) > 0.9999);
        }
}

TEST_CASE("pixels for a window are the quick picture in bytes, whichever way it is drawn", "[sheared]") {
    const auto volume = lumps({34, 30, 32});
    const Camera camera = cameraFromView(volume->geometry(), 30, 25, 1.2, Projection::Perspective);
    CpuRenderOptions other;
    other.kernel = static_cast<int>(packetKernels().size()) - 1;
    for (const auto& renderer : {makeCpuRenderer(volume), makeCpuRenderer(volume, other)})
        for (const RenderMode mode : {RenderMode::Composite, RenderMode::Mip}) // in storage order, and by rays
            for (const double scale : {1.0, 0.6}) {
                RenderSettings settings = pictureOf(53, 41);
                settings.mode = mode;
                settings.backgroundTop = Rgb{0.2, 0.7, 1};
                const Image image = renderer->preview(camera, tents(3, 0.3), settings, scale);
                const TileRenderer::PreviewSize size = TileRenderer::previewSize(settings, scale);
                REQUIRE(size.width == image.width);
                REQUIRE(size.height == image.height);
                std::vector<std::uint32_t> pixels(image.rgba.size() / 4);
                renderer->previewOnScreen(camera, tents(3, 0.3), settings, scale, pixels.data());
                std::size_t different = 0;
                for (std::size_t p = 0; p < pixels.size(); ++p)
                    different += pixels[p] != screenPixel(&image.rgba[4 * p]);
                CHECK(different == 0);
            }
}

TEST_CASE("beside the volume the quick picture is background", "[sheared]") {
    const auto volume = lumps({34, 30, 32});
    const auto renderer = makeCpuRenderer(volume);
    const RenderSettings settings = pictureOf(53, 41);
    const std::uint32_t background = screenPixel(renderer->preview({}, tents(3, 0), settings, 1).rgba.data());
    for (const Projection projection : {Projection::Orthographic, Projection::Perspective})
        for (const double aside : {3.0, 20.0}) { // radii: of the volume none is in the picture, or it looks beside it
            Camera camera = cameraFromView(volume->geometry(), 30, 25, 1, projection);
            const Vec3 away = aside * volume->geometry().radius() * camera.right();
            camera.eye += away;
            camera.center += away;
            if (!renderer->previewsInStorageOrder(camera, settings)) continue;
            std::vector<std::uint32_t> pixels(53 * 41);
            renderer->previewOnScreen(camera, tents(3, 0.3), settings, 1, pixels.data());
            CHECK(std::count(pixels.begin(), pixels.end(), background) == 53 * 41);
        }
}

TEST_CASE("what cannot be drawn in storage order is drawn by rays", "[sheared]") {
    const auto volume = lumps({24, 20, 22});
    const auto renderer = makeCpuRenderer(volume);
    const Camera camera = cameraFromView(volume->geometry(), 20, 30, 1, Projection::Perspective);
    for (const RenderMode mode : {RenderMode::Mip, RenderMode::MinIp, RenderMode::Average, RenderMode::Surface}) {
        RenderSettings settings = pictureOf(40, 30);
        settings.mode = mode;
        CHECK_FALSE(renderer->previewsInStorageOrder(camera, settings));
        CHECK((renderer->preview(camera, tents(2), settings, 1).rgba ==
               renderer->render(camera, tents(2), settings).rgba));
    }
}
