#include <catch2/catch.hpp>

#include "render/image_renderer.h"
#include "render/slice.h"
#include "support/volumes.h"
#include "volume/voxel_colors.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

std::shared_ptr<const VoxelColors> colorsOf(Int3 dims, const std::function<std::uint32_t(int, int, int)>& color) {
    VoxelColors colors{dims, {}};
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) colors.rgba.push_back(color(i, j, k));
    return std::make_shared<const VoxelColors>(std::move(colors));
}

double largestDifference(const Image& a, const Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    double most = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i])));
    return most;
}

RenderSettings small() {
    RenderSettings settings;
    settings.width = 40;
    settings.height = 36;
    return settings;
}

/// Everything in one colour.
TransferFunction colored(TransferFunction tf, const Rgb& color) {
    for (ControlPoint& p : tf.points) p.color = color;
    for (Feature& f : tf.features) f.color = color;
    return tf;
}

} // namespace

TEST_CASE("voxels that have one colour look as under a transfer function of that colour", "[voxelcolors]") {
    std::mt19937 random(3);
    const auto rough = roughVolume(random, {22, 18, 20}, {1, 0.8, 1.2});
    // Some voxels without a value, too: their own colour is another, and must not be seen.
    const auto holed = volumeFrom(rough->geometry(), [&](int i, int j, int k) {
        const auto at = static_cast<std::size_t>((k * 18 + j) * 22 + i);
        return (i + 2 * j + 3 * k) % 11 == 0 ? std::nan("") : rough->intensity(at);
    });
    const Camera camera = cameraFromView(rough->geometry(), 35, 25, 1.3, Projection::Perspective);
    const TransferFunction tf = tents(3, 0.3), plain = colored(tf, {0.2, 0.8, 0.4}); // 51, 204, 102 of 255
    for (const auto& volume : {rough, holed}) {
        const auto colors = colorsOf(volume->dims(), [&](int i, int j, int k) {
            const auto at = static_cast<std::size_t>((k * 18 + j) * 22 + i);
            return volume->isValid(at) ? VoxelColors::pack(51, 204, 102) : VoxelColors::pack(255, 0, 255);
        });
        const auto renderer = makeCpuRenderer(volume);
        for (const RenderMode mode : {RenderMode::Composite, RenderMode::Surface})
            for (const bool lit : {false, true})
                for (const int feature : {-1, 1}) {
                    CAPTURE(name(mode), lit, feature, volume == holed);
                    RenderSettings settings = small();
                    settings.mode = mode;
                    settings.light.on = lit;
                    if (lit) {
                        settings.light.gradientOpacity = 0.5;
                        settings.light.occlusion = 0.4;
                        settings.light.silhouettes = 0.5;
                        settings.light.depthCue = 0.5;
                    }
                    settings.onlyFeature = feature;
                    settings.background = Rgb{0.1, 0.1, 0.3};
                    const Image expected = renderer->render(camera, plain, settings);
                    settings.colors = colors;
                    CHECK(largestDifference(renderer->render(camera, tf, settings), expected) < 1e-3);
                }
        // Grey is grey.
        RenderSettings settings = small();
        settings.mode = RenderMode::Average;
        const Image expected = renderer->render(camera, tf, settings);
        settings.colors = colors;
        CHECK(renderer->render(camera, tf, settings).rgba == expected.rgba);
    }
}

TEST_CASE("colours of voxels go linearly from one to the next", "[voxelcolors]") {
    // Red rises by 51 of 255 a voxel along x; seen along y, at 10 pixels a voxel, the colour is that of the voxel
    // coordinate, held beyond the outermost centres. Opacity is that of the transfer function.
    const auto volume = slab({6, 10, 6}, 0.5);
    Camera camera = lookingAlong(volume->geometry(), {0, 1, 0});
    camera.height = 6;
    RenderSettings settings;
    settings.width = settings.height = 60;
    settings.background = {};
    settings.colors = colorsOf(volume->dims(), [](int i, int, int k) {
        return VoxelColors::pack(static_cast<std::uint8_t>(51 * i), 102, static_cast<std::uint8_t>(51 * k));
    });
    const Image image = makeCpuRenderer(volume)->render(camera, homogeneous(0.1), settings);
    for (int x = 0; x < 60; x += 3)
        for (int y = 0; y < 60; y += 7) {
            const double i = std::clamp((x + 0.5) / 10 - 0.5, 0.0, 5.0),
                         k = std::clamp((59.5 - y) / 10 - 0.5, 0.0, 5.0);
            const float* pixel = image.pixel(x, y);
            CHECK(pixel[0] == Approx(0.2 * i).margin(1e-3));
            CHECK(pixel[1] == Approx(0.4).margin(1e-3));
            CHECK(pixel[2] == Approx(0.2 * k).margin(1e-3));
            CHECK(pixel[3] == Approx(1 - std::pow(0.9, 10)).margin(1e-3));
        }
}

TEST_CASE("slices have the colours of voxels where they have colours", "[voxelcolors][slice]") {
    // Opaque everywhere, colours alone: pixels of the slice across z are voxels, 4 × 4 pixels each. The nearest voxel's
    // colour, or between two of them what lies linearly between.
    const auto volume = slab({6, 6, 6}, 0.5);
    SlicePlane plane{2, 2, fittedSlice(volume->geometry(), 2, 24, 24), 24, 24};
    SliceSettings settings;
    settings.window = {0, 1};
    settings.tfStrength = 1;
    settings.colors = colorsOf(volume->dims(), [](int i, int j, int k) {
        return VoxelColors::pack(static_cast<std::uint8_t>(51 * i), static_cast<std::uint8_t>(51 * j),
                                 static_cast<std::uint8_t>(51 * k));
    });
    for (const bool linear : {true, false}) {
        settings.linear = linear;
        const Image image = renderSlice(*volume, homogeneous(1), plane, settings);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                Vec3 voxel = glm::clamp(voxelAtPixel(volume->geometry(), plane, {x + 0.5, y + 0.5}), Vec3(0), Vec3(5));
                if (!linear) voxel = glm::floor(voxel + 0.5);
                for (int c = 0; c < 3; ++c) REQUIRE(image.pixel(x, y)[c] == Approx(0.2 * voxel[c]).margin(1e-4));
            }
    }
    // Grey alone has none of them; a transparent transfer function shows none.
    settings.tfStrength = 0;
    CHECK(renderSlice(*volume, homogeneous(1), plane, settings).pixel(20, 3)[0] == Approx(0.5).margin(1e-4));
    settings.tfStrength = 0.5;
    CHECK(renderSlice(*volume, homogeneous(0), plane, settings).pixel(20, 3)[2] == Approx(0.5).margin(1e-4));
}
