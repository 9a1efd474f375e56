#include "render/cpu/cpu_engine.h"
#include "support/orientation_check.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("however a file stores an anatomy, the cpu measures the same", "[visibility][cpu][affine]") {
    checkOrientationsMeasure(
        OrientationCase(), [](auto v) { return makeCpuEngine(std::move(v)); }, 0.01);
}

TEST_CASE("however a file stores an anatomy, the reference measures the same", "[visibility][reference][affine]") {
    checkOrientationsMeasure(
        OrientationCase(36), [](auto v) { return makeReferenceEngine(std::move(v), 4); }, 0.01);
}

TEST_CASE("however a file stores an anatomy, it looks the same", "[image][cpu][affine]") {
    checkOrientationsLook(OrientationCase(), [](auto v) { return makeCpuRenderer(std::move(v)); });
}

TEST_CASE("left is where the file says", "[image][cpu][affine]") {
    // A dense voxel on the patient's left, stored at either end of the file's first axis. Seen from the front, as
    // azimuth 0 is in LPS, the patient's left is at the picture's right.
    for (const double sign : {1.0, -1.0}) {
        Geometry g{{9, 5, 5}};
        g.worldAxes = WorldAxes::Patient;
        g.directions[0] = Vec3(sign, 0, 0);
        g.origin = Vec3(sign > 0 ? 0 : 8, 0, 0);
        std::vector<float> values(voxelCount(g.dims), 0.0f);
        values[static_cast<std::size_t>((sign > 0 ? 7 : 1) + 9 * (2 + 5 * 2))] = 0.5f; // at x = 7 in either case
        const auto volume = std::make_shared<const Volume>(Volume(g, std::move(values)).withRange({0, 1}));
        RenderSettings settings;
        settings.width = 90;
        settings.height = 50;
        const Image image = makeCpuRenderer(volume)->render(cameraFromView(g, 0, 0, 1, Projection::Orthographic),
                                                            withFeatureOpacities(tents(1), {1}), settings);
        double left = 0, right = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                (x < image.width / 2 ? left : right) += static_cast<double>(image.pixel(x, y)[1]);
        CHECK(right > 1);
        CHECK(left == 0);
    }
}
