// Handles in a picture: where they appear, and what dragging them means.
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "render/camera_motion.h"
#include "render/clip_handles.h"
#include "render/light_presets.h"

using namespace pellucid;

namespace {

/// 10 × 20 × 30 voxels of 1 × 2 × 3: the box is 10 × 40 × 90, sheared by 30° along j.
Geometry sheared() {
    Geometry g;
    g.dims = {10, 20, 30};
    g.spacing = {1, 2, 3};
    g.origin = {5, -7, 11};
    g.directions[1] = {std::sin(std::numbers::pi / 6), std::cos(std::numbers::pi / 6), 0};
    return g;
}

Geometry cube() {
    Geometry g;
    g.dims = {10, 10, 10};
    g.origin = Vec3(0.5); // the box is [0, 10]³
    return g;
}

std::vector<PictureView> views(const Geometry& geometry) {
    std::vector<PictureView> all;
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic})
        all.push_back({cameraFromView(geometry, 33, 21, 1.3, projection), 640, 480});
    return all;
}

bool near(const Vec3& a, const Vec3& b, double tolerance = 1e-9) { return glm::length(a - b) <= tolerance; }

} // namespace

TEST_CASE("a point appears where its ray leaves the eye", "[handles]") {
    const Geometry g = sheared();
    for (const PictureView& view : views(g))
        for (int n = 0; n < 8; ++n) {
            const Vec3 corner = g.corner(n);
            const auto pixel = pixelOf(view, corner);
            REQUIRE(pixel);
            const Ray ray = pixelRay(view.camera, pixel->x, pixel->y, view.width, view.height);
            // The ray's point nearest to the corner is the corner.
            const double t = glm::dot(corner - ray.origin, ray.direction);
            CHECK(near(ray.origin + t * ray.direction, corner));
        }
    const PictureView view = views(g)[0];
    CHECK_FALSE(pixelOf(view, view.camera.eye - view.camera.forward()));
}

TEST_CASE("what is dragged stays under the hand", "[handles]") {
    const Geometry g = sheared();
    for (const PictureView& view : views(g))
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 at = faceCenter({}, g, axis, true), way = faceWay(g, axis);
            // The hand goes from where the face is to where it is after three tenths of the box.
            CHECK(draggedAlong(view, at, way, *pixelOf(view, at), *pixelOf(view, at - 0.3 * way)) == Approx(-0.3));
        }
    // End-on: 10 pixels up push what points away from the viewer by ten pixels' worth of the world.
    const PictureView front{cameraFromView(cube(), 0, 0, 1, Projection::Orthographic), 100, 100};
    const double perPixel = front.camera.height / 100;
    CHECK(worldPerPixel(front, {5, 5, 5}) == Approx(perPixel));
    CHECK(draggedAlong(front, {5, 0, 5}, {0, 10, 0}, {50, 50}, {50, 40}) == Approx(perPixel));
    CHECK(draggedAlong(front, {5, 0, 5}, {0, -10, 0}, {50, 50}, {50, 40}) == Approx(-perPixel));
}

TEST_CASE("faces of the part that is left", "[handles]") {
    const Geometry g = sheared();
    const Clipping part{{0.25, 0, 0.5}, {1, 0.5, 0.75}, {}};
    // Corner 0 of the whole box plus fractions of its three edges.
    const Vec3 origin = g.corner(0);
    CHECK(near(cornerOfPart({}, g, 0), origin));
    CHECK(near(cornerOfPart(part, g, 0), origin + 0.25 * faceWay(g, 0) + 0.5 * faceWay(g, 2)));
    CHECK(near(cornerOfPart(part, g, 7), origin + faceWay(g, 0) + 0.5 * faceWay(g, 1) + 0.75 * faceWay(g, 2)));
    CHECK(near(faceCenter(part, g, 1, true),
               origin + 0.625 * faceWay(g, 0) + 0.5 * faceWay(g, 1) + 0.625 * faceWay(g, 2)));

    CHECK(withFaceMoved(part, 0, false, 0.5, false).lo.x == Approx(0.75));
    CHECK(withFaceMoved(part, 0, false, 5, false).lo.x == Approx(1 - kThinnestPart)); // something is left
    CHECK(withFaceMoved(part, 0, false, -5, false).lo.x == 0);
    CHECK(withFaceMoved(part, 2, true, 5, false).hi.z == 1);
    CHECK(withFaceMoved(part, 2, true, -5, false).hi.z == Approx(0.5 + kThinnestPart));
    const Clipping slab = withFaceMoved(part, 2, true, 5, true); // as far as it goes, as thick as before
    CHECK(slab.lo.z == Approx(0.75));
    CHECK(slab.hi.z == Approx(1));
    CHECK(slab.lo.x == part.lo.x);
}

TEST_CASE("a plane in the box", "[handles]") {
    const Geometry g = cube();
    // x = 4: a square of side 10.
    const auto square = planeInBox({{2, 0, 0}, 8}, g);
    REQUIRE(square.size() == 4);
    double around = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(square[i].x == Approx(4));
        around += glm::length(square[i] - square[(i + 1) % 4]);
    }
    CHECK(around == Approx(40)); // in order: no diagonals
    CHECK(near(planeAnchor({{2, 0, 0}, 8}, g), {4, 5, 5}));
    // x + y + z = 15 through the centre: a regular hexagon between midpoints of edges, its sides √(5² + 5²).
    const auto hexagon = planeInBox({{1, 1, 1}, 15}, g);
    REQUIRE(hexagon.size() == 6);
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(glm::length(hexagon[i] - hexagon[(i + 1) % 6]) == Approx(5 * std::sqrt(2.0)));
    // x + y + z = 3: a triangle at the corner. Beyond the far corner: nothing.
    CHECK(planeInBox({{1, 1, 1}, 3}, g).size() == 3);
    CHECK(planeInBox({{1, 1, 1}, 31}, g).empty());
    CHECK(near(planeAnchor({{1, 1, 1}, 33}, g), {11, 11, 11}));

    CHECK(planeAt({{1, 1, 1}, 15}, 100, g).offset == 30);
    CHECK(planeAt({{1, 1, 1}, 15}, -100, g).offset == Approx(30 * kThinnestPart));
    CHECK(planeAt({{1, 1, 1}, 15}, 7, g).offset == 7);
    const Camera front = cameraFromView(g, 0, 0, 1, Projection::Perspective); // looks along +y
    const ClipPlane facing = planeFacing(front, g);
    CHECK(near(facing.normal, {0, -1, 0}));
    CHECK(facing.offset == Approx(-5)); // keeps −y ≤ −5: the far half
}

TEST_CASE("a ball turns with the hand", "[handles]") {
    const double quarter = 100 * std::numbers::pi / 2; // of the ball's circumference
    CHECK(near(turnedBall({0, 0, 1}, quarter, 0, 100), {1, 0, 0}));
    CHECK(near(turnedBall({0, 0, 1}, 0, -quarter, 100), {0, 1, 0})); // y is down in pictures
    CHECK(near(turnedBall({0, 3, 0}, quarter, 0, 100), {0, 1, 0}));  // the axis of that turn
    CHECK(near(turnedBall({0, 0, -1}, quarter, 0, 100), {-1, 0, 0}));
    CHECK(near(turnedBall({0, 0, 1}, 0, 0, 100), {0, 0, 1}));
    const Camera camera = cameraFromView(cube(), 40, -20, 1, Projection::Perspective);
    const Vec3 direction = glm::normalize(Vec3(1, -2, 0.5));
    CHECK(near(worldFromCamera(camera, cameraFromWorld(camera, direction)), direction));
    CHECK(near(worldFromCamera(camera, {0, 0, 1}), -camera.forward()));
}

TEST_CASE("presets are whole lights that stay where they come from", "[light]") {
    Light light;
    light.direction = {1, 2, 3};
    light.ambient = 0.123;
    CHECK(presetOf(light) == nullptr);
    for (const LightPreset& preset : lightPresets()) {
        RenderSettings settings;
        settings.light = withPreset(light, preset);
        CHECK_NOTHROW(settings.validate());
        CHECK(settings.light.on);
        CHECK(settings.light.direction == light.direction);
        CHECK(presetOf(settings.light) == &preset);
        settings.light.on = false;
        CHECK(presetOf(settings.light) == &preset);
        CHECK(&lightPreset(preset.name) == &preset);
    }
    CHECK(presetOf(Light{}) == &lightPresets().front()); // the first is the default
    CHECK_THROWS_AS(lightPreset("gold"), UsageError);
}
