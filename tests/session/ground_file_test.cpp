#include "session/ground_file.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>

#include "base/error.h"
#include "session/scene.h"
#include "support/temp_folder.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// A box of 10 × 8 × 4 voxels of 1 × 2 × 5: from (−0.5, −1, −2.5), 10 × 16 × 20 world units.
const Geometry kBox = geometryOf({10, 8, 4}, {1, 2, 5});

/// Heights as little-endian floats.
std::string rawFile(const TempFolder& folder, const std::vector<float>& heights) {
    std::string bytes;
    for (const float h : heights)
        for (int b = 0; b < 4; ++b) bytes += static_cast<char>(std::bit_cast<std::uint32_t>(h) >> (8 * b) & 255u);
    return folder.write("heights.raw", bytes);
}

GroundView viewOf(const std::string& path, const std::string& layout) {
    GroundView view;
    view.path = path;
    view.raw = parseRawLayout(layout);
    return view;
}

void checkVec(const Vec3& found, const Vec3& expected) { CHECK(glm::length(found - expected) < 1e-9); }

} // namespace

TEST_CASE("a ground lies under the whole box, from side to side", "[ground]") {
    const TempFolder folder;
    const std::string path = rawFile(folder, {0, 1, 2, 3, 4, 5});
    const Ground ground = readGround(viewOf(path, "3,2,1,f32"), kBox);
    CHECK((ground.nx == 3 && ground.ny == 2));
    CHECK(ground.heights == std::vector<float>{0, 1, 2, 3, 4, 5});
    checkVec(ground.origin, {-0.5, -1, -2.5});
    checkVec(ground.origin + 2.0 * ground.stepX, {9.5, -1, -2.5}); // the last of three along i
    checkVec(ground.origin + ground.stepY, {-0.5, 15, -2.5});
    CHECK((ground.lo == 0 && ground.hi == 5));
    // The other axes of a layer across y or x lie along i and j, in their order.
    for (const char* layout : {"3,1,2,f32", "1,3,2,f32"}) {
        const Ground other = readGround(viewOf(path, layout), kBox);
        CHECK((other.nx == 3 && other.ny == 2));
        CHECK(other.heights == ground.heights);
        checkVec(other.stepY, ground.stepY);
    }
    // Turned with the box.
    Geometry turned = kBox;
    turned.directions = {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
    const Ground along = readGround(viewOf(path, "3,2,1,f32"), turned);
    checkVec(along.stepX, {0, 5, 0});
    checkVec(along.stepY, {0, 0, 16});
    checkVec(glm::normalize(along.up), {1, 0, 0});
}

TEST_CASE("heights are world units where they fit the box, else the highest rises to a tenth", "[ground]") {
    const TempFolder folder;
    const auto up = [&](const std::vector<float>& heights, std::optional<double> scale = {}) {
        GroundView view = viewOf(rawFile(folder, heights), "2,2,1,f32");
        view.scale = scale;
        return glm::length(readGround(view, kBox).up);
    };
    // The box is 20 high.
    CHECK(up({0, 5, 7, 20}) == Approx(1));
    CHECK(up({0, 0, 0, 0.2f}) == Approx(1));
    CHECK(up({0, 500, 700, 1000}) == Approx(2.0 / 1000));
    CHECK(up({0, 0, 0.01f, 0.1f}) == Approx(2 / 0.1));
    CHECK(up({-40, -10, 0, 4}) == Approx(2.0 / 40)); // the deepest is the largest
    CHECK(up({0, 500, 700, 1000}, 0.5) == Approx(0.5));
    CHECK(up({0, 0, 0, 0}) == Approx(1));
    // Depths: what is 30 deep lies lowest.
    GroundView view = viewOf(rawFile(folder, {0, 10, 20, 30}), "2,2,1,f32");
    view.scale = -0.5;
    const Ground sea = readGround(view, kBox);
    CHECK(sea.heights == std::vector<float>{0, -10, -20, -30});
    CHECK((sea.lo == -30 && sea.hi == 0));
    checkVec(sea.up, {0, 0, 0.5});
}

TEST_CASE("the terrain begins at the sea, other colours at the lowest height", "[ground]") {
    const TempFolder folder;
    GroundView view = viewOf(rawFile(folder, {-300, 0, 200, 999}), "2,2,1,f32");
    view.missing = 999;
    view.relief = 0.4;
    const Ground terrain = readGround(view, kBox);
    CHECK((terrain.lo == 0 && terrain.hi == 200));
    CHECK(std::isnan(terrain.heights[3]));
    CHECK(terrain.relief == 0.4);
    view.colorMap = "grey";
    const Ground grey = readGround(view, kBox);
    CHECK((grey.lo == -300 && grey.hi == 200 && grey.colorMap == "grey"));
    // Dressed in another way it is what it would have been read as.
    Ground dressed = terrain;
    dressGround(dressed, view);
    CHECK((dressed.lo == grey.lo && dressed.hi == grey.hi && dressed.colorMap == grey.colorMap));
    view.colorMap = "terrain";
    dressGround(dressed, view);
    CHECK((dressed.lo == 0 && dressed.hi == 200));
    const Ground flat = readGround(viewOf(rawFile(folder, {7, 7, 7, 7}), "2,2,1,f32"), kBox);
    CHECK(flat.lo < flat.hi);
}

TEST_CASE("what is no ground is an error that says so", "[ground]") {
    const TempFolder folder;
    const std::string path = rawFile(folder, std::vector<float>(8, 1.0f));
    CHECK_THROWS_WITH(readGround(viewOf(path, "2,2,2,f32"), kBox), Catch::Contains("one layer"));
    CHECK_THROWS_AS(readGround(viewOf(path, "8,1,1,f32"), kBox), FileError);
    CHECK_THROWS_AS(readGround(viewOf(folder.path("none"), "2,2,1,f32"), kBox), FileError);
    CHECK_THROWS_WITH(readGround(viewOf(rawFile(folder, std::vector<float>(4, std::nanf(""))), "2,2,1,f32"), kBox),
                      Catch::Contains("no height"));
    GroundView view = viewOf(rawFile(folder, {1, 2, 3, 4}), "2,2,1,f32");
    view.colorMap = "mud";
    CHECK_THROWS_WITH(readGround(view, kBox), Catch::Contains("terrain"));
}

TEST_CASE("a session's ground is in the picture, and in no figure", "[ground]") {
    const TempFolder folder;
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.start = SceneInputs::Start::Tents;
    const Scene without = openScene(inputs);
    CHECK(pictureInput(without, 8, 8).settings.ground == nullptr);
    inputs.session.ground = viewOf(rawFile(folder, {0, 1, 2, 3}), "2,2,1,f32");
    const Scene scene = openScene(inputs);
    REQUIRE(scene.ground != nullptr);
    CHECK(pictureInput(scene, 8, 8).settings.ground == scene.ground);
    CHECK(plainPictureInput(scene, 8, 8).settings.ground == nullptr);
    CHECK(measureInput(scene).tf == measureInput(without).tf);
    // Another look takes what is there; hidden it is gone.
    Session turned = scene.session;
    turned.camera = cameraFromView(scene.volume->geometry(), 10, 20, 1, Projection::Perspective);
    CHECK(resolve(turned, scene).ground == scene.ground);
    turned.ground.edit([](GroundView& view) { view.shown = false; });
    CHECK(resolve(turned, scene).ground == nullptr);
}
