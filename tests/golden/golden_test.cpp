// Small pictures of every mode and of light, kept beside this file: what users see stays what it is, on both renderers.
// After a change that is meant, look at what it does and write them anew:
//   PELLUCID_WRITE_GOLDEN=1 build/release/bin/test_golden
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "engines/engines.h"
#include "image_io/image_file.h"
#include "render/gl/gl_engines.h"
#include "render/ground.h"
#include "volume/procedural.h"

using namespace pellucid;

namespace {

// What gl may differ by from the kept picture, which cpu drew, in a value of one pixel. A bound is two to four times
// what llvmpipe and zink differ by, which is given beside it.
constexpr double kSame = 4.0 / 255; // 0.002, half a level: the kept picture has 8 bits, all else agrees to 1e-4
constexpr double kLit = 0.05;       // 0.021, from the side 0.033: gl lights what a ray has gathered up to an opacity
                                    // of 1/64 as one, with the normal in its middle (raycast.frag)
constexpr double kLitOverGround = 0.02; // 0.007: the same, where the depth cue leaves less of it

struct Golden {
    const char* name;
    std::function<void(RenderSettings&)> change;
    double glLargest = kSame;
};

/// Saturated along a spiral, dark to one side: as the mapping of several variables colours voxels.
std::shared_ptr<const VoxelColors> spirals(Int3 dims) {
    VoxelColors colors{dims, {}};
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                const double x = 2.0 * i / (dims.x - 1) - 1, y = 2.0 * j / (dims.y - 1) - 1;
                const double turn = std::sin(2 * std::atan2(y, x) + 6 * std::hypot(x, y) + 0.1 * k);
                const Rgb c = rgbFromHsv(20, 0.5 + 0.5 * turn, 1 - 0.6 * j / (dims.y - 1));
                const auto byte = [](double v) { return static_cast<std::uint8_t>(v * 255 + 0.5); };
                colors.rgba.push_back(VoxelColors::pack(byte(c.r), byte(c.g), byte(c.b)));
            }
    return std::make_shared<const VoxelColors>(std::move(colors));
}

/// A mountain in the sea under the box of a sample of n³ voxels.
std::shared_ptr<const Ground> island(int n) {
    Ground ground;
    ground.nx = ground.ny = 48;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 48; ++i) {
            const double x = (i - 22) / 20.0, y = (j - 26) / 20.0;
            const double h = 1 - x * x - y * y + 0.15 * std::sin(5 * x + 1) * std::sin(6 * y);
            ground.heights.push_back(static_cast<float>(std::max(0.0, h)));
        }
    const Geometry g = makeSample("shells", n).geometry();
    ground.origin = g.corner(0);
    ground.stepX = (g.corner(1) - g.corner(0)) / 47.0;
    ground.stepY = (g.corner(2) - g.corner(0)) / 47.0;
    ground.up = 0.3 * (g.corner(4) - g.corner(0));
    return std::make_shared<const Ground>(std::move(ground));
}

const std::vector<Golden>& goldens() {
    static const std::vector<Golden> all{
        {"composite", [](RenderSettings&) {}},
        {"lit", [](RenderSettings& s) { s.light.on = true; }, kLit},
        {"lit_from_the_side",
         [](RenderSettings& s) {
             s.light = Light{.on = true, .specular = 0.6, .direction = {1, 0.5, 0.4}};
             s.backgroundTop = Rgb{0.2, 0.3, 0.5};
         },
         kLit},
        {"depth",
         [](RenderSettings& s) {
             s.light = Light{.on = true, .gradientOpacity = 0.6, .occlusion = 0.8, .depthCue = 0.7, .silhouettes = 0.8};
         },
         kLit},
        {"clipped",
         [](RenderSettings& s) {
             s.light.on = true;
             s.clipping.hi.x = 0.7;
             s.clipping.planes = {{{0, -1, 1}, 0}};
         },
         kLit},
        {"mip", [](RenderSettings& s) { s.mode = RenderMode::Mip; }},
        {"minip_of_a_feature",
         [](RenderSettings& s) {
             s.mode = RenderMode::MinIp;
             s.onlyFeature = 1;
         }},
        {"average", [](RenderSettings& s) { s.mode = RenderMode::Average; }},
        {"surface",
         [](RenderSettings& s) {
             s.mode = RenderMode::Surface;
             s.light.on = true;
         }},
        {"voxel_colors_over_a_ground",
         [](RenderSettings& s) {
             s.light = Light{.on = true, .depthCue = 0.4};
             s.background = Rgb{0.85, 0.88, 0.92};
             s.clipping.lo = {0.5, 0, 0};
             s.colors = spirals({40, 40, 40});
             s.ground = island(40);
         },
         kLitOverGround},
        {"surface_over_a_ground", [](RenderSettings& s) {
             s.mode = RenderMode::Surface;
             s.light.on = true;
             s.background.reset();
             s.clipping.hi.z = 0.6;
             s.colors = spirals({40, 40, 40});
             s.ground = island(40);
         }}};
    return all;
}

struct Difference {
    double mean = 0, largest = 0;
};
/// Of colours as they cover what is behind them: where next to nothing does, 8 bits keep no colour.
Difference differenceOf(const Image& a, const Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    const auto covering = [](const Image& image, std::size_t i) {
        const double alpha = image.rgba[i / 4 * 4 + 3];
        return i % 4 == 3 ? alpha : alpha * image.rgba[i];
    };
    Difference d;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double way = std::abs(covering(a, i) - covering(b, i));
        d.mean += way / static_cast<double>(a.rgba.size());
        d.largest = std::max(d.largest, way);
    }
    return d;
}

} // namespace

TEST_CASE("every mode looks as it should", "[golden]") {
    const auto volume = std::make_shared<const Volume>(makeSample("shells", 40));
    TransferFunction tf = withFeatureOpacities(tents(3), {0.1, 0.3, 0.8});
    const Camera camera = cameraFromView(volume->geometry(), 30, 20, 1.4, Projection::Perspective);
    const auto info = probeGl();
    if (!info) WARN("no OpenGL: only the cpu renderer is compared");
    for (const Golden& golden : goldens()) {
        RenderSettings settings;
        settings.width = settings.height = 96;
        golden.change(settings);
        const std::string path = std::string(PELLUCID_SOURCE_DIR) + "/tests/golden/images/" + golden.name + ".png";
        const Image cpu = makeRenderer(EngineChoice::Cpu, volume)->render(camera, tf, settings);
        if (std::getenv("PELLUCID_WRITE_GOLDEN") != nullptr) writeImage(cpu, path);
        const Image kept = readImage(path);
        const Difference now = differenceOf(cpu, kept);
        INFO(golden.name);
        CHECK(now.mean < 0.25 / 255 + 1e-3); // 8 bits round by a quarter of a level in the mean
        CHECK(now.largest < 4.0 / 255);
        if (!info) continue;
        const Difference gl = differenceOf(makeRenderer(EngineChoice::Gl, volume)->render(camera, tf, settings), kept);
        CHECK(gl.mean < 0.004);
        CHECK(gl.largest < golden.glLargest);
    }
}
