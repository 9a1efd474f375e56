#include "gl_test.h"

#include "render/gl/gl_engines.h"
#include "render/gl/gl_resources.h"
#include "render/gl/volume_raycaster.h"
#include "render/ground.h"

using namespace pellucid;
using namespace pellucid::testing;

namespace {

struct Difference {
    double mean = 0, largest = 0;
};

Difference difference(const Image& a, const Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    Difference d;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double e = std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
        d.mean += e / static_cast<double>(a.rgba.size());
        d.largest = std::max(d.largest, e);
    }
    return d;
}

/// Colours times alpha: what is seen of a pixel. The straight colour of a nearly transparent one means nothing.
Image premultiplied(Image image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) image.rgba[i + c] *= image.rgba[i + 3];
    return image;
}

double meanAlpha(const Image& image) {
    double sum = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += static_cast<double>(image.rgba[i]);
    return 4 * sum / static_cast<double>(image.rgba.size());
}

RenderSettings smallSettings() {
    RenderSettings settings;
    settings.width = 72;
    settings.height = 56;
    settings.stepInD0 = 0.25;
    return settings;
}

} // namespace

TEST_CASE("a homogeneous block has the opacity of its length along every ray", "[gl]") {
    if (!haveGl()) return;
    // 8 × 8 × 8 voxels of spacing 0.5 seen along x: 4 world units = 8 d0 of α = 0.1: 1 − 0.9^8. Seen along the diagonal
    // (1,1,0) the middle ray is √2 times as long.
    const auto volume = volumeOf({8, 8, 8}, std::vector<std::uint8_t>(512, 200), {0.5, 0.5, 0.5});
    const auto renderer = makeGlRenderer(volume);
    RenderSettings settings = smallSettings();
    settings.width = settings.height = 33;
    settings.background = {};
    const Rgb color{0.25, 0.5, 0.75};
    for (const double step : {0.5, 1.0, 3.0}) { // no result depends on the step
        settings.stepInD0 = step;
        CAPTURE(step);
        const Image along =
            renderer->render(orthographic(volume->geometry(), {1, 0, 0}, 6), constantOpacity(0.1, color), settings);
        const float* p = along.pixel(16, 16);
        CHECK(static_cast<double>(p[3]) == Approx(1 - std::pow(0.9, 8)).margin(1e-4));
        CHECK(static_cast<double>(p[0]) == Approx(0.25).margin(1e-3)); // straight colours
        CHECK(static_cast<double>(p[2]) == Approx(0.75).margin(1e-3));
        CHECK(along.pixel(0, 16)[3] == 0.0f);
        const Image across =
            renderer->render(orthographic(volume->geometry(), {1, 1, 0}, 6), constantOpacity(0.1, color), settings);
        CHECK(static_cast<double>(across.pixel(16, 16)[3]) ==
              Approx(1 - std::pow(0.9, 8 * std::sqrt(2.0))).margin(2e-3));
    }
}

TEST_CASE("a slab has the opacity of its thickness, however its voxels lie", "[gl]") {
    if (!haveGl()) return;
    // Voxels of 1 × 0.8 × 1.5, so that d0 = 0.8. Seen along z the sixteen layers are 24 thick or, with k leaning 15°
    // toward x, 24 cos 15°: the middle ray moves by 24 sin 15° = 6.2 of 28 along i and leaves by the last layer.
    Geometry straight{{28, 24, 16}, {1, 0.8, 1.5}, {3, -2, 1}}, leaning = straight;
    const double tilt = 15 * std::acos(-1.0) / 180;
    leaning.directions[2] = {std::sin(tilt), 0, std::cos(tilt)};
    for (const auto& [geometry, thickness] : {std::pair(straight, 24.0), std::pair(leaning, 24 * std::cos(tilt))}) {
        const Volume values(geometry, Samples(std::vector<std::uint8_t>(voxelCount(geometry.dims), 200)));
        const auto renderer = makeGlRenderer(std::make_shared<const Volume>(values.withRange({0, 255})));
        RenderSettings settings = smallSettings();
        settings.width = settings.height = 33;
        settings.background = {};
        for (const double step : {1.0, 0.5, 0.25}) {
            CAPTURE(thickness, step);
            settings.stepInD0 = step;
            const Image image =
                renderer->render(orthographic(geometry, {0, 0, 1}, 40), constantOpacity(0.05), settings);
            const double found = static_cast<double>(image.pixel(16, 16)[3]);
            CHECK(found == Approx(1 - std::pow(0.95, thickness / 0.8)).margin(0.004));
            settings.clipping.planes = {{{0, 0, 1}, geometry.boxCenter().z}}; // half of it
            const Image half = renderer->render(orthographic(geometry, {0, 0, 1}, 40), constantOpacity(0.05), settings);
            CHECK(static_cast<double>(half.pixel(16, 16)[3]) ==
                  Approx(1 - std::pow(0.95, thickness / 1.6)).margin(0.004));
            settings.clipping.planes.clear();
        }
    }
}

TEST_CASE("gl and cpu draw the same picture", "[gl]") {
    if (!haveGl()) return;
    const auto volume = waves({28, 24, 16}, {1, 0.8, 1.5});
    const auto gl = makeGlRenderer(volume);
    const auto cpu = makeCpuRenderer(volume);
    const Geometry& g = volume->geometry();
    const Vec3 half = 0.5 * (g.boundsMax() - g.boundsMin());
    const std::vector<std::pair<std::string, Camera>> views{{"from afar", perspective(g, {40, -60, 20})},
                                                            {"from close", perspective(g, {2, -half.y - 1, -2})},
                                                            {"from a corner", perspective(g, half + Vec3(1, 2, 1))},
                                                            {"along an axis", orthographic(g, {0, 0, -1}, 40)},
                                                            {"at a slant", orthographic(g, {1, -0.7, 0.4}, 40)}};
    struct Case {
        std::string name;
        void (*change)(RenderSettings&);
        double largest, mean;
    };
    // Both integrate the same segments. What is left of a transparent picture is the fraction between voxels, which
    // textures round to 1/256, and entries of tables: 0.0009 at most and 0.0001 on average on llvmpipe. Ten times that
    // is still far from any other picture.
    // Shading divides by the gradient's length: where that is small the picture hangs on the last bits.
    const std::vector<Case> cases{
        {"plain", [](RenderSettings&) {}, 0.03, 1.0 / 255},
        {"transparent", [](RenderSettings& s) { s.background = {}; }, 0.01, 0.001},
        {"background",
         [](RenderSettings& s) {
             s.background = Rgb{0.2, 0.7, 1};
         },
         0.03, 1.0 / 255},
        {"shading", [](RenderSettings& s) { s.light.on = true; }, 0.1, 1.0 / 255},
        {"clipped",
         [](RenderSettings& s) {
             s.clipping.lo = {0.1, 0.3, 0.2};
             s.clipping.hi = {0.8, 1, 0.75};
         },
         0.03, 1.0 / 255},
        {"faint rest",
         [](RenderSettings& s) {
             s.clipping.hi.y = 0.9;
             s.clipping.planes = {{{1, 1, 0}, 60}};
             s.clipping.rest.within.lo = {0.1, 0.3, 0.2};
             s.clipping.rest.within.hi = {0.8, 1, 0.75};
             s.clipping.rest.within.planes = {{{1, 0.3, 0.2}, 30}};
             s.clipping.rest.density = 0.15;
         },
         0.03, 1.0 / 255},
        {"rest left out",
         [](RenderSettings& s) {
             s.clipping.rest.within = {{0.1, 0.3, 0.2}, {0.8, 1, 0.75}, {{{1, 0.3, 0.2}, 30}}};
         },
         0.03, 1.0 / 255},
        {"one feature", [](RenderSettings& s) { s.onlyFeature = 1; }, 0.03, 1.0 / 255}};
    const TransferFunction tf = tents(3, 0.25);
    for (const auto& [view, camera] : views)
        for (const Case& c : cases) {
            CAPTURE(view, c.name);
            RenderSettings settings = smallSettings();
            c.change(settings);
            Image a = gl->render(camera, tf, settings), b = cpu->render(camera, tf, settings);
            if (!settings.background) {
                a = premultiplied(a);
                b = premultiplied(b);
                CHECK(meanAlpha(a) > 0.05);
            }
            const Difference d = difference(a, b);
            CHECK(d.mean < c.mean);
            CHECK(d.largest < c.largest);
        }
}

TEST_CASE("gl and cpu draw the same in every mode, under every light, in every frame", "[gl]") {
    if (!haveGl()) return;
    struct Case {
        std::string name;
        void (*change)(RenderSettings&);
        double largest = 0.03, mean = 0.001;
    };
    // Both take the same samples. Light falls on what a ray has gathered over a few of them, not the same few on both.
    const std::vector<Case> cases{{"mip", [](RenderSettings& s) { s.mode = RenderMode::Mip; }},
                                  {"minip", [](RenderSettings& s) { s.mode = RenderMode::MinIp; }},
                                  {"average", [](RenderSettings& s) { s.mode = RenderMode::Average; }},
                                  {"mip of a feature",
                                   [](RenderSettings& s) {
                                       s.mode = RenderMode::Mip;
                                       s.onlyFeature = 1;
                                   }},
                                  {"average of a feature",
                                   [](RenderSettings& s) {
                                       s.mode = RenderMode::Average;
                                       s.onlyFeature = 1;
                                   }},
                                  // Where a ray just touches a feature, rounding decides whether it sees it.
                                  {"surface", [](RenderSettings& s) { s.mode = RenderMode::Surface; }, 0.3},
                                  {"surface of a feature",
                                   [](RenderSettings& s) {
                                       s.mode = RenderMode::Surface;
                                       s.onlyFeature = 2;
                                   },
                                   0.3},
                                  {"lit surface",
                                   [](RenderSettings& s) {
                                       s.mode = RenderMode::Surface;
                                       s.light.on = true;
                                       s.light.silhouettes = 0.8;
                                   },
                                   0.3},
                                  {"light from the side",
                                   [](RenderSettings& s) {
                                       s.light.on = true;
                                       s.light.ambient = 0.2;
                                       s.light.diffuse = 0.9;
                                       s.light.specular = 0.6;
                                       s.light.shininess = 8;
                                       s.light.direction = {-2, 1, 0.5};
                                   },
                                   0.15},
                                  {"gradient opacity", [](RenderSettings& s) { s.light.gradientOpacity = 0.8; }},
                                  {"occlusion", [](RenderSettings& s) { s.light.occlusion = 0.9; }},
                                  {"depth cue", [](RenderSettings& s) { s.light.depthCue = 0.7; }},
                                  {"silhouettes", [](RenderSettings& s) { s.light.silhouettes = 1; }, 0.1},
                                  {"all of it, transparent",
                                   [](RenderSettings& s) {
                                       s.background = {};
                                       s.light.on = true;
                                       s.light.gradientOpacity = 0.5;
                                       s.light.occlusion = 0.5;
                                       s.light.depthCue = 0.5;
                                       s.light.silhouettes = 0.5;
                                   },
                                   0.1},
                                  {"gradient behind it",
                                   [](RenderSettings& s) {
                                       s.background = Rgb{0.9, 0.1, 0.3};
                                       s.backgroundTop = Rgb{0.1, 0.8, 0.4};
                                       s.light.depthCue = 0.5;
                                   }},
                                  {"jitter", [](RenderSettings& s) { s.jitter = true; }}};
    Geometry plain{{28, 24, 16}, {1, 0.8, 1.5}, {3, -2, 1}};
    Geometry turned = plain, mirrored = plain, sheared = plain;
    const double angle = 0.6, tilt = std::tan(15 * std::acos(-1.0) / 180);
    turned.directions = {Vec3(std::cos(angle), std::sin(angle), 0), Vec3(-std::sin(angle), std::cos(angle), 0),
                         Vec3(0, 0, 1)};
    mirrored.directions = {Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0)};
    sheared.directions[2] = glm::normalize(Vec3(tilt, 0, 1));
    const auto [values, spacing] = std::pair(waves(plain.dims, plain.spacing)->samples(), plain.spacing);
    const TransferFunction tf = tents(3, 0.25);
    for (const auto& [frame, geometry] : {std::pair("plain", plain), std::pair("turned", turned),
                                          std::pair("mirrored", mirrored), std::pair("sheared", sheared)}) {
        const auto volume = std::make_shared<const Volume>(Volume(geometry, Samples(values)).withRange({0, 255}));
        const auto gl = makeGlRenderer(volume);
        const auto cpu = makeCpuRenderer(volume);
        for (const bool cut : {false, true})
            for (const Camera& camera :
                 {perspective(geometry, {40, -60, 20}), orthographic(geometry, {1, -0.7, 0.4}, 40)})
                for (const Case& c : cases) {
                    CAPTURE(frame, cut, c.name, camera.projection == Projection::Perspective);
                    RenderSettings settings = smallSettings();
                    settings.stepInD0 = 0.5;
                    if (cut) {
                        // 10 degrees off an axis, and a corner.
                        const Vec3 normal(std::sin(0.1745), std::cos(0.1745), 0), center = geometry.boxCenter();
                        settings.clipping.planes = {{normal, glm::dot(normal, center) + 2},
                                                    {{-1, 2, 3}, glm::dot(Vec3(-1, 2, 3), center) + 12}};
                        settings.clipping.lo = {0.1, 0, 0.2};
                    }
                    c.change(settings);
                    Image a = gl->render(camera, tf, settings), b = cpu->render(camera, tf, settings);
                    if (!settings.background) {
                        a = premultiplied(a);
                        b = premultiplied(b);
                    }
                    const Difference d = difference(a, b);
                    CHECK(d.mean < c.mean);
                    CHECK(d.largest < c.largest);
                }
    }
}

TEST_CASE("steps are halved until the picture changes by a level no more, as on the cpu", "[gl]") {
    if (!haveGl()) return;
    // Steep and nearly opaque: borders that steps of 1/2 d0 meet at other depths from ray to ray. The truth is the cpu
    // renderer's picture at steps of 1/32 d0.
    const auto volume = waves({28, 24, 16}, {1, 0.8, 1.5});
    const TransferFunction tf = tents(9, 0.95);
    const Camera camera = perspective(volume->geometry(), {40, -60, 20});
    const auto gl = makeGlRenderer(volume);
    const auto cpu = makeCpuRenderer(volume);
    for (const bool lit : {false, true}) {
        CAPTURE(lit);
        RenderSettings settings = smallSettings();
        settings.light.on = lit;
        settings.stepInD0 = 0.5;
        const Image plain = gl->render(camera, tf, settings);
        settings.finestInD0 = 1.0 / 32;
        const Image refined = gl->render(camera, tf, settings), same = cpu->render(camera, tf, settings);
        settings.finestInD0.reset();
        settings.stepInD0 = 1.0 / 32;
        const Image truth = cpu->render(camera, tf, settings);
        CHECK(difference(plain, truth).largest > 3.0 / 255);
        CHECK(difference(refined, truth).largest <= 1.0 / 255);
        CHECK(difference(refined, truth).mean < 0.2 * difference(plain, truth).mean);
        CHECK(difference(refined, same).largest <= 1.0 / 255);
    }
}

TEST_CASE("pixels that become opaque early look as if all had been drawn", "[gl]") {
    if (!haveGl()) return;
    // A thick wall of one colour, opaque after a few voxels (0.3^8 < 1e-4), hides one of another; the left half of the
    // front wall is missing.
    const Int3 dims(24, 30, 20);
    std::vector<std::uint8_t> values;
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                const bool front = j < 12 && i >= 12, back = j >= 18;
                values.push_back(front ? 255 : back ? 128 : 0);
            }
    const auto volume = volumeOf(dims, values);
    TransferFunction tf;
    tf.points = {{0.0, 0.0, {0, 0, 1}, false, {}},
                 {0.2, 0.0, {0, 1, 0}, false, {}},
                 {0.5, 0.7, {0, 1, 0}, false, {}},
                 {0.7, 0.7, {1, 0, 0}, false, {}},
                 {1.0, 0.7, {1, 0, 0}, false, {}}};
    RenderSettings settings = smallSettings();
    const Camera camera = orthographic(volume->geometry(), {0, 1, 0}, 26);
    const Image a = makeGlRenderer(volume)->render(camera, tf, settings);
    const Difference d = difference(a, makeCpuRenderer(volume)->render(camera, tf, settings));
    CHECK(d.mean < 1.0 / 255);
    CHECK(d.largest < 0.03);
    // x = 18 and 5 are pixels 36 + (x − 11.5)·56/26 = 50 and 22.
    CHECK(a.pixel(50, 28)[0] > 0.95f);
    CHECK(a.pixel(50, 28)[1] < 0.05f);
    CHECK(a.pixel(22, 28)[1] > 0.95f);
    CHECK(a.pixel(22, 28)[0] < 0.05f);
}

TEST_CASE("invalid voxels are not drawn", "[gl]") {
    if (!haveGl()) return;
    const Int3 dims(12, 12, 12);
    std::vector<float> values(voxelCount(dims), 1.0f);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i % 2 == 0) values[i] = 3.0f;
        if (i % static_cast<std::size_t>(dims.x) < 6) values[i] = std::nanf("");
    }
    const auto volume = std::make_shared<const Volume>(Geometry{dims, {1, 1, 1}, {0, 0, 0}}, Samples(values));
    RenderSettings settings = smallSettings();
    settings.background = {};
    const Camera camera = orthographic(volume->geometry(), {0, 1, 0}, 16);
    const Image a = makeGlRenderer(volume)->render(camera, constantOpacity(0.5), settings);
    const Image b = makeCpuRenderer(volume)->render(camera, constantOpacity(0.5), settings);
    CHECK(meanAlpha(a) == Approx(meanAlpha(b)).margin(1e-3));
    // Left of the middle everything is invalid: x = 2 is pixel 36 + (2 − 5.5)·56/16 ≈ 24.
    CHECK(a.pixel(24, 28)[3] == 0.0f);
    CHECK(a.pixel(50, 28)[3] > 0.99f);
}

TEST_CASE("a picture larger than a tile is the same picture", "[gl]") {
    if (!haveGl()) return;
    const auto volume = waves({12, 10, 8}, {1, 1, 1});
    const auto renderer = makeGlRenderer(volume);
    const auto cpu = makeCpuRenderer(volume);
    RenderSettings settings;
    settings.width = 2100; // tiles are 2048 wide
    settings.height = 40;
    settings.stepInD0 = 1;
    Camera camera = orthographic(volume->geometry(), {0.2, 1, 0.1}, 0.25);
    const Difference d =
        difference(renderer->render(camera, tents(3, 0.3), settings), cpu->render(camera, tents(3, 0.3), settings));
    CHECK(d.mean < 1.0 / 255);
    CHECK(d.largest < 0.05);
}

TEST_CASE("the ray caster draws into a part of any framebuffer, coarser where asked, and leaves the state tidy",
          "[gl]") {
    if (!haveGl()) return;
    const auto volume = waves({20, 20, 20}, {1, 1, 1});
    RenderSettings settings = smallSettings();
    settings.background = Rgb{0.1, 0.2, 0.3};
    const Camera camera = perspective(volume->geometry(), {20, -40, 15});
    const TransferFunction tf = tents(3, 0.2);
    const Image expected = makeCpuRenderer(volume)->render(camera, tf, settings);
    gl::HeadlessContext context;
    context.run([&] {
        gl::VolumeRaycaster raycaster;
        raycaster.setVolume(volume);
        raycaster.setTransferFunction(tf);
        const auto target = gl::makeColorTarget({100, 80}, GL_RGBA8, GL_NEAREST, "test");
        for (const double scale : {1.0, 0.5}) {
            glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
            glClearColor(1, 0, 1, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glEnable(GL_SCISSOR_TEST);
            glScissor(0, 0, 1, 1); // whoever was here before
            glEnable(GL_DEPTH_TEST);
            raycaster.draw(camera, settings, {target.framebuffer.id(), 10, 15, 0, 0, 0, 0, scale});
            GLint bound = 0, program = 0, array = 0;
            glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
            glGetIntegerv(GL_CURRENT_PROGRAM, &program);
            glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &array);
            CHECK(bound == static_cast<GLint>(target.framebuffer.id()));
            CHECK(program == 0);
            CHECK(array == 0);
            CHECK(glIsEnabled(GL_BLEND) == GL_FALSE);
            CHECK(glIsEnabled(GL_SCISSOR_TEST) == GL_FALSE);

            std::vector<float> pixels(100 * 80 * 4);
            glReadPixels(0, 0, 100, 80, GL_RGBA, GL_FLOAT, pixels.data());
            CHECK(glGetError() == GL_NO_ERROR);
            const auto at = [&](int x, int y) { return &pixels[static_cast<std::size_t>(4 * (y * 100 + x))]; };
            CHECK(at(9, 40)[1] == 0.0f); // outside nothing has changed
            CHECK(at(82, 40)[1] == 0.0f);
            CHECK(at(40, 71)[1] == 0.0f);
            double mean = 0;
            for (int y = 0; y < settings.height; ++y)
                for (int x = 0; x < settings.width; ++x)
                    for (int c = 0; c < 4; ++c)
                        mean += std::abs(static_cast<double>(at(10 + x, 15 + settings.height - 1 - y)[c]) -
                                         static_cast<double>(expected.pixel(x, y)[c])) /
                                (4.0 * settings.width * settings.height);
            CAPTURE(scale);
            CHECK(mean < (scale == 1.0 ? 0.004 : 0.02));
        }
    });
}

TEST_CASE("a volume drawn in bricks is the same picture", "[gl]") {
    if (!haveGl()) return;
    const struct Restore {
        ~Restore() { gl::limitAllocations(std::numeric_limits<double>::infinity()); }
    } restore;
    const auto volume = waves({50, 37, 41}, {1, 0.8, 1.5});
    const Geometry& g = volume->geometry();
    const Vec3 half = 0.5 * (g.boundsMax() - g.boundsMin());
    RenderSettings settings = smallSettings();
    settings.stepInD0 = 1;
    settings.clipping.lo = {0.05, 0.1, 0};
    const TransferFunction tf = tents(3, 0.3);
    gl::HeadlessContext context;
    context.run([&] {
        const auto target = gl::makeColorTarget({settings.width, settings.height}, GL_RGBA32F, GL_NEAREST, "test");
        const auto drawn = [&](gl::VolumeRaycaster& raycaster, const Camera& camera) {
            raycaster.setTransferFunction(tf);
            raycaster.draw(camera, settings, {target.framebuffer.id()});
            std::vector<float> pixels(static_cast<std::size_t>(4 * settings.width * settings.height));
            glReadPixels(0, 0, settings.width, settings.height, GL_RGBA, GL_FLOAT, pixels.data());
            return pixels;
        };
        gl::VolumeRaycaster whole, cut, streamed;
        whole.setVolume(volume);
        cut.setVolume(volume, 20);   // 16 to 20 voxels of every brick, neighbours' included
        gl::limitAllocations(100e3); // the volume takes 151 700
        streamed.setVolume(volume);
        gl::limitAllocations(std::numeric_limits<double>::infinity());
        for (const Camera& camera :
             {perspective(g, {40, -60, 20}), perspective(g, {2, -half.y - 1, -2}), perspective(g, half + Vec3(1, 2, 1)),
              orthographic(g, {0, 0, -1}, 60), orthographic(g, {1, -0.7, 0.4}, 60)})
            for (const auto& [shading, finest] :
                 {std::pair(false, 1.0), std::pair(true, 1.0), std::pair(false, 0.125)}) {
                settings.light.on = shading;
                settings.finestInD0 = finest;
                const auto expected = drawn(whole, camera);
                CHECK(*std::max_element(expected.begin(), expected.end()) > 0.2f);
                for (gl::VolumeRaycaster* other : {&cut, &streamed}) {
                    const auto found = drawn(*other, camera);
                    double mean = 0, worst = 0;
                    for (std::size_t i = 0; i < found.size(); ++i) {
                        const double e = std::abs(static_cast<double>(found[i] - expected[i]));
                        mean += e / static_cast<double>(found.size());
                        worst = std::max(worst, e);
                    }
                    CAPTURE(shading, finest, other == &cut, camera.eye.x);
                    // Light falls on what a ray gathers between two looks at the blocks, and a brick's end is another.
                    CHECK(mean < (shading ? 1.0 / 255 : 1e-5));
                    // Rounding may carry a segment over an entry of the table, or a gradient over the smallest length,
                    // or decide whether it is halved, which is worth 0.4/255.
                    CHECK(worst < (shading ? 3e-2 : finest < 1 ? 4e-3 : 1e-3));
                }
            }
    });
}

namespace {

/// Red, green and blue by place, in steps that go well beyond rounding.
std::shared_ptr<const VoxelColors> colorsByPlace(Int3 dims, int shift = 0) {
    VoxelColors colors{dims, {}};
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i)
                colors.rgba.push_back(VoxelColors::pack(static_cast<std::uint8_t>(9 * (i + shift) % 256),
                                                        static_cast<std::uint8_t>(255 - 7 * j),
                                                        static_cast<std::uint8_t>(60 + 100 * ((k / 3) % 2))));
    return std::make_shared<const VoxelColors>(std::move(colors));
}

/// Hills over the lower face of the box, along its axes i and j.
std::shared_ptr<const Ground> hills(const Geometry& g) {
    Ground ground;
    ground.nx = 15;
    ground.ny = 11;
    for (int j = 0; j < ground.ny; ++j)
        for (int i = 0; i < ground.nx; ++i)
            ground.heights.push_back(i == 3 && j == 4 ? std::nanf("")
                                                      : 0.5f + 0.5f * std::sin(0.7f * static_cast<float>(i)) *
                                                                   std::cos(0.8f * static_cast<float>(j)));
    const Vec3 extent = g.spacing * Vec3(g.dims);
    ground.origin = g.corner(0);
    ground.stepX = g.directions[0] * (extent.x / (ground.nx - 1));
    ground.stepY = g.directions[1] * (extent.y / (ground.ny - 1));
    ground.up = g.directions[2] * (0.6 * extent.z);
    return std::make_shared<const Ground>(std::move(ground));
}

} // namespace

TEST_CASE("gl and cpu draw the same with colours of voxels and a ground", "[gl]") {
    if (!haveGl()) return;
    struct Case {
        std::string name;
        void (*change)(RenderSettings&);
        double largest, mean;
    };
    // A hit of a surface may be seen by one of them alone, where a ray just touches it. Colours come from the middle of
    // a step on the one, from where most of it is absorbed on the other: of steps of ¼ voxel and 100 levels a voxel.
    const std::vector<Case> cases{{"plain", [](RenderSettings&) {}, 0.05, 0.002},
                                  {"transparent", [](RenderSettings& s) { s.background = {}; }, 0.05, 0.002},
                                  {"lit",
                                   [](RenderSettings& s) {
                                       s.light.on = true;
                                       s.light.occlusion = 0.5;
                                       s.light.depthCue = 0.7;
                                       s.background = Rgb{0.2, 0.5, 0.9};
                                   },
                                   0.15, 0.003},
                                  {"surface",
                                   [](RenderSettings& s) {
                                       s.mode = RenderMode::Surface;
                                       s.light.on = true;
                                   },
                                   0.4, 0.004},
                                  {"mip", [](RenderSettings& s) { s.mode = RenderMode::Mip; }, 0.03, 0.001},
                                  {"clipped, one feature",
                                   [](RenderSettings& s) {
                                       s.clipping.lo = {0.2, 0.1, 0.3};
                                       s.onlyFeature = 1;
                                   },
                                   0.05, 0.002}};
    const Geometry plain{{28, 24, 16}, {1, 0.8, 1.5}, {3, -2, 1}};
    std::vector<float> samples;
    const auto whole = waves(plain.dims, plain.spacing);
    for (std::size_t i = 0; i < whole->size(); ++i)
        samples.push_back(i % 13 == 0 ? std::nanf("") : static_cast<float>(whole->value(i)));
    const auto holed = std::make_shared<const Volume>(Volume(plain, Samples(samples)).withRange({0, 255}));
    const TransferFunction tf = tents(3, 0.25);
    for (const auto& volume : {whole, holed}) {
        const Geometry& g = volume->geometry();
        const auto gl = makeGlRenderer(volume);
        const auto cpu = makeCpuRenderer(volume);
        for (const Camera& camera :
             {perspective(g, {40, -60, 20}), orthographic(g, {1, -0.7, 0.4}, 40), perspective(g, {-20, -30, -25})})
            for (const bool colors : {false, true})
                for (const bool ground : {false, true})
                    for (const Case& c : cases) {
                        CAPTURE(volume == holed, camera.eye.z, colors, ground, c.name);
                        RenderSettings settings = smallSettings();
                        c.change(settings);
                        if (colors) settings.colors = colorsByPlace(volume->dims());
                        if (ground) settings.ground = hills(g);
                        Image a = gl->render(camera, tf, settings), b = cpu->render(camera, tf, settings);
                        if (!settings.background) {
                            a = premultiplied(a);
                            b = premultiplied(b);
                        }
                        const Difference d = difference(a, b);
                        CHECK(d.mean < c.mean);
                        CHECK(d.largest < c.largest);
                    }
    }
}

TEST_CASE("colours of voxels lie in bricks as intensities do, and other ones take their place", "[gl]") {
    if (!haveGl()) return;
    const struct Restore {
        ~Restore() { gl::limitAllocations(std::numeric_limits<double>::infinity()); }
    } restore;
    const auto volume = waves({50, 37, 41}, {1, 0.8, 1.5});
    const Geometry& g = volume->geometry();
    RenderSettings settings = smallSettings();
    settings.stepInD0 = 1;
    gl::HeadlessContext context;
    context.run([&] {
        const auto target = gl::makeColorTarget({settings.width, settings.height}, GL_RGBA32F, GL_NEAREST, "test");
        const auto drawn = [&](gl::VolumeRaycaster& raycaster, const Camera& camera) {
            raycaster.setTransferFunction(tents(3, 0.3));
            raycaster.draw(camera, settings, {target.framebuffer.id()});
            std::vector<float> pixels(static_cast<std::size_t>(4 * settings.width * settings.height));
            glReadPixels(0, 0, settings.width, settings.height, GL_RGBA, GL_FLOAT, pixels.data());
            return pixels;
        };
        const auto distance = [](const std::vector<float>& a, const std::vector<float>& b) {
            double worst = 0;
            for (std::size_t i = 0; i < a.size(); ++i)
                worst = std::max(worst, static_cast<double>(std::abs(a[i] - b[i])));
            return worst;
        };
        gl::VolumeRaycaster whole, cut, streamed;
        whole.setVolume(volume);
        cut.setVolume(volume, 20);
        streamed.setVolume(volume);
        settings.ground = hills(g);
        for (const Camera& camera : {perspective(g, {40, -60, 20}), orthographic(g, {1, -0.7, 0.4}, 60)}) {
            settings.colors = {};
            const auto without = drawn(whole, camera);
            std::vector<float> before;
            for (const int shift : {0, 11}) {
                settings.colors = colorsByPlace(volume->dims(), shift);
                const auto expected = drawn(whole, camera);
                CHECK(distance(expected, without) > 0.1);
                if (shift > 0) CHECK(distance(expected, before) > 0.1);
                CHECK(distance(drawn(cut, camera), expected) < 2e-3);
                // Codes and colours take 152 and 303 thousand bytes: from now on there is room for parts of them. The
                // table, which is larger, is there already.
                drawn(streamed, camera);
                gl::limitAllocations(150e3);
                streamed.setVolume(volume);
                CHECK(distance(drawn(streamed, camera), expected) < 2e-3);
                gl::limitAllocations(std::numeric_limits<double>::infinity());
                before = expected;
            }
            settings.colors = {};
            CHECK(drawn(whole, camera) == without);
        }
    });
}

TEST_CASE("the ground fits the picture in parts of it and at any resolution", "[gl]") {
    if (!haveGl()) return;
    const auto volume = waves({20, 20, 20}, {1, 1, 1});
    RenderSettings settings = smallSettings();
    settings.background = Rgb{0.9, 0.9, 0.9};
    settings.ground = hills(volume->geometry());
    const Camera camera = perspective(volume->geometry(), {20, -40, 25});
    const TransferFunction tf = tents(3, 0.05);
    const Image expected = makeCpuRenderer(volume)->render(camera, tf, settings);
    gl::HeadlessContext context;
    context.run([&] {
        gl::VolumeRaycaster raycaster;
        raycaster.setVolume(volume);
        raycaster.setTransferFunction(tf);
        const auto target = gl::makeColorTarget({100, 80}, GL_RGBA32F, GL_NEAREST, "test");
        for (const double scale : {1.0, 0.7}) {
            // In four tiles, at (10, 15) of the framebuffer.
            for (const int x : {0, 32})
                for (const int y : {0, 17}) {
                    const int width = x == 0 ? 32 : settings.width - 32, height = y == 0 ? 17 : settings.height - 17;
                    raycaster.draw(camera, settings,
                                   {target.framebuffer.id(), 10 + x, 15 + settings.height - y - height, x, y, width,
                                    height, scale});
                }
            std::vector<float> pixels(100 * 80 * 4);
            glReadPixels(0, 0, 100, 80, GL_RGBA, GL_FLOAT, pixels.data());
            double mean = 0;
            int wrong = 0;
            for (int y = 0; y < settings.height; ++y)
                for (int x = 0; x < settings.width; ++x) {
                    double worst = 0;
                    for (int c = 0; c < 3; ++c) {
                        const auto at =
                            static_cast<std::size_t>(4 * ((15 + settings.height - 1 - y) * 100 + 10 + x) + c);
                        worst = std::max(worst, static_cast<double>(std::abs(pixels[at] - expected.pixel(x, y)[c])));
                    }
                    mean += worst / (settings.width * settings.height);
                    wrong += worst > 0.1 ? 1 : 0;
                }
            CAPTURE(scale);
            CHECK(mean < (scale == 1.0 ? 0.003 : 0.03));
            CHECK(wrong <= (scale == 1.0 ? 0 : 400)); // of 4032: at edges, and in hills of a pixel or two
        }
    });
}

TEST_CASE("wrong requests for a picture are errors, and stopping stops", "[gl]") {
    if (!haveGl()) return;
    const auto volume = noise({6, 6, 6}, {1, 1, 1}, 1);
    const auto renderer = makeGlRenderer(volume);
    const Camera camera = perspective(volume->geometry(), {0, -20, 0});
    RenderSettings settings = smallSettings();
    for (const int index : {3, -2}) {
        settings.onlyFeature = index;
        CHECK_THROWS_MATCHES(renderer->render(camera, tents(3), settings), UsageError,
                             Catch::Message("there is no feature number " + std::to_string(index) +
                                            ", transfer function, it has 3, counted from 0"));
    }
    settings.onlyFeature = -1;
    settings.width = 0;
    CHECK_THROWS_AS(renderer->render(camera, tents(3), settings), UsageError);
    settings.width = 72;
    std::stop_source stop;
    stop.request_stop();
    JobControl job;
    job.stop = stop.get_token();
    CHECK_THROWS_AS(renderer->render(camera, tents(3), settings, job), Cancelled);
    CHECK(renderer->render(camera, tents(3), settings).width == 72);
}
