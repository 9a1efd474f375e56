#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "render/box_in_image.h"
#include "render/camera_motion.h"

using namespace pellucid;

namespace {

// A box from (0,0,0) to (40,20,10): half a voxel of (2,1,1) beyond the centres.
Geometry oblong() { return {{20, 20, 10}, {2, 1, 1}, {1, 0.5, 0.5}}; }

void checkNear(const Vec3& a, const Vec3& b, double margin = 1e-9) {
    INFO("(" << a.x << ", " << a.y << ", " << a.z << ") against (" << b.x << ", " << b.y << ", " << b.z << ")");
    CHECK(glm::length(a - b) <= margin);
}

} // namespace

TEST_CASE("turning moves the eye to the right and up, at its distance", "[camera]") {
    const Geometry g = oblong();
    const Camera front = cameraFromView(g, 0, 0, 1, Projection::Perspective); // looks along +y, so right is +x, up +z
    const double d = glm::length(front.eye - front.center);
    const Camera right = rotated(front, g, 90, 0);
    checkNear(right.eye, front.center + Vec3(d, 0, 0), 1e-9 * d);
    checkNear(right.up, Vec3(0, 0, 1));
    const Camera above = rotated(front, g, 0, 90);
    checkNear(above.eye, front.center + Vec3(0, 0, d), 1e-9 * d);
    checkNear(above.up, Vec3(0, 1, 0)); // over the top the old forward is up
}

TEST_CASE("panning moves the volume with the mouse", "[camera]") {
    const Geometry g = oblong();
    Camera c = cameraFromView(g, 0, 0, 1, Projection::Orthographic);
    c.height = 100; // of 200 pixels: half a unit each
    const Camera p = panned(c, g, 10, 4, 200);
    // The volume goes 5 to the right and 2 down, so the camera 5 to the left and 2 up.
    checkNear(p.center - c.center, Vec3(-5, 0, 2));
    checkNear(p.eye - c.eye, Vec3(-5, 0, 2));
    // However far the mouse goes, the center stays within the sphere around the box.
    const Camera far = panned(c, g, 100000, 0, 200);
    CHECK(glm::length(far.center - g.boxCenter()) <= g.radius() * (1 + 1e-9));
}

TEST_CASE("zooming in and out again ends where it began", "[camera]") {
    const Geometry g = oblong();
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera start = homeCamera(g, projection);
        Camera c = start;
        for (int i = 0; i < 20; ++i) c = zoomed(c, g, 1.2);
        CHECK_NOTHROW(c.validate(g, "test")); // the eye is outside the box, however close the view
        CHECK(viewAngles(c, g).zoom == Approx(viewAngles(start, g).zoom * std::pow(1.2, 20)).epsilon(1e-6));
        for (int i = 0; i < 20; ++i) c = zoomed(c, g, 1 / 1.2);
        CHECK(viewAngles(c, g).zoom == Approx(viewAngles(start, g).zoom).epsilon(1e-6));
    }
}

TEST_CASE("no sequence of motions brings the eye into the box", "[camera]") {
    const Geometry g = oblong();
    Camera c = homeCamera(g, Projection::Perspective);
    for (int i = 0; i < 400; ++i) {
        switch (i % 5) {
        case 0:
            c = zoomed(c, g, i % 3 == 0 ? 0.6 : 1.9);
            break;
        case 1:
            c = rotated(c, g, 37.0 + i, -21.0);
            break;
        case 2:
            c = panned(c, g, 60.0 - i, 45, 300);
            break;
        case 3:
            c = withProjection(c, g, i % 2 == 0 ? Projection::Perspective : Projection::Orthographic);
            break;
        default:
            c = rotated(c, g, -3, 80);
            break;
        }
        INFO("motion " << i);
        REQUIRE_NOTHROW(c.validate(g, "test"));
    }
}

TEST_CASE("both projections show the plane of the center at one size", "[camera]") {
    const Geometry g = oblong();
    const Camera perspective = homeCamera(g, Projection::Perspective);
    const Camera parallel = withProjection(perspective, g, Projection::Orthographic);
    CHECK(parallel.projection == Projection::Orthographic);
    CHECK(viewAngles(parallel, g).zoom == Approx(viewAngles(perspective, g).zoom));
    const Camera back = withProjection(parallel, g, Projection::Perspective);
    checkNear(back.eye, perspective.eye, 1e-6);
    CHECK(back.fovY == Approx(perspective.fovY));
}

TEST_CASE("a fitted view holds the whole box, from any side", "[camera]") {
    const Geometry g = oblong();
    for (const double azimuth : {0.0, 30.0, 90.0, 200.0}) {
        for (const double elevation : {0.0, 20.0, 90.0, -60.0}) {
            for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
                const Camera c = standardCamera(g, azimuth, elevation, projection);
                const BoxInImage box = boxInImage(c, g, 400, 400);
                INFO(azimuth << ", " << elevation);
                CHECK(box.x > 0);
                CHECK(box.y > 0);
                CHECK(box.x + box.width < 400);
                CHECK(box.y + box.height < 400);
                CHECK(std::max(box.width, box.height) > 300); // and no smaller than it must be
                checkNear(fitted(c, g).eye, c.eye, 1e-6 * glm::length(c.eye));
            }
        }
    }
}

TEST_CASE("the outline of the box in the image is that of its corners", "[camera]") {
    const Geometry g = oblong();
    Camera c = cameraFromView(g, 0, 0, 1, Projection::Orthographic);
    c.height = 50; // of 100 pixels: two pixels per unit; the box is 40 wide, 10 high and 20 deep, seen from the front
    const BoxInImage box = boxInImage(c, g, 100, 100);
    CHECK(box.x == 9); // 50 − 2·20, and one pixel of margin
    CHECK(box.width == 82);
    CHECK(box.y == 39);
    CHECK(box.height == 22);
    CHECK(box.depthInD0 == Approx(20));
}

TEST_CASE("the status line names the direction of the eye", "[camera]") {
    const Geometry g = oblong();
    const ViewAngles a = viewAngles(cameraFromView(g, 40, -25, 1.5, Projection::Perspective), g);
    CHECK(a.azimuth == Approx(40));
    CHECK(a.elevation == Approx(-25));
    CHECK(a.zoom == Approx(1.5));
    const ViewAngles top = viewAngles(cameraFromView(g, 0, 90, 1, Projection::Orthographic), g);
    CHECK(top.elevation == Approx(90));
    CHECK(top.azimuth == Approx(0).margin(1e-6));
}
