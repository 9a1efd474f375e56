#include <catch2/catch.hpp>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "render/camera.h"
#include "render/ray_box.h"
#include "render/view_text.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {
void checkEqual(const Vec3& a, const Vec3& b) {
    INFO(a.x << " " << a.y << " " << a.z << " should be " << b.x << " " << b.y << " " << b.z);
    CHECK(glm::length(a - b) < 1e-9);
}
} // namespace

TEST_CASE("the box reaches half a voxel beyond the outer centres", "[camera]") {
    const Geometry g = geometryOf({4, 2, 3}, {1, 2, 0.5}, {10, 0, -1});
    checkEqual(g.boundsMin(), {9.5, -1, -1.25});
    checkEqual(g.boundsMax(), {13.5, 3, 0.25});
    CHECK(g.d0() == 0.5);
    checkEqual(g.voxelFromWorld(g.worldFromVoxel({1, 2, 3})), {1, 2, 3});
}

TEST_CASE("view 0,0 looks along +y with z up, azimuth goes toward +x, elevation toward +z", "[camera]") {
    const Geometry g = geometryOf({10, 20, 30});
    const auto at = [&](double az, double el) { return cameraFromView(g, az, el, 1, Projection::Perspective); };
    checkEqual(at(0, 0).forward(), {0, 1, 0});
    checkEqual(at(0, 0).trueUp(), {0, 0, 1});
    checkEqual(at(0, 0).right(), {1, 0, 0});
    checkEqual(at(90, 0).forward(), {-1, 0, 0});
    checkEqual(at(0, 90).forward(), {0, 0, -1});
    checkEqual(at(0, 90).trueUp(), {0, 1, 0}); // defined at the pole too
}

TEST_CASE("zoom 1 fits the bounding sphere, zoom 2 shows it twice as large, none enters the box", "[camera]") {
    const Geometry g = geometryOf({16, 16, 16});
    const double radius = 8 * std::sqrt(3.0);
    for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
        // The ray through the middle of the image's upper edge touches the sphere: distance of its line to the centre.
        const Camera camera = cameraFromView(g, 20, 10, 1, projection);
        const Ray ray = pixelRay(camera, 50, 0, 100, 100);
        CHECK(glm::length(glm::cross(ray.direction, camera.center - ray.origin)) == Approx(radius));
        const Camera closer = cameraFromView(g, 20, 10, 200, projection);
        closer.validate(g, "test");
    }
    CHECK(cameraFromView(g, 0, 0, 2, Projection::Orthographic).height == Approx(radius));
}

TEST_CASE("a ray meets a box where it should", "[camera]") {
    const RayInterval t = intersectBox({{-5, 0.5, 0.5}, {1, 0, 0}}, {0, 0, 0}, {2, 1, 1});
    CHECK(t.enter == 5);
    CHECK(t.exit == 7);
    CHECK(intersectBox({{-5, 2, 0.5}, {1, 0, 0}}, {0, 0, 0}, {2, 1, 1}).empty());
}

TEST_CASE("a camera file keeps every number", "[camera]") {
    const Geometry g = geometryOf({10, 20, 30});
    for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera camera = cameraFromView(g, 33, -12, 1.5, projection);
        const Camera back = cameraFromJson(jsonFromCamera(camera), "test");
        CHECK(back.eye == camera.eye);
        CHECK(back.center == camera.center);
        CHECK(back.up == camera.up);
        CHECK((projection == Projection::Perspective ? back.fovY == camera.fovY : back.height == camera.height));
    }
}

TEST_CASE("cameras that cannot see are refused", "[camera]") {
    const Geometry g = geometryOf({10, 10, 10});
    const Camera good = cameraFromView(g, 0, 0, 1, Projection::Perspective);
    const auto refused = [&](auto change) {
        Camera camera = good;
        change(camera);
        CHECK_THROWS_AS(camera.validate(g, "here"), Error);
    };
    refused([&](Camera& c) { c.eye = g.boxCenter() + Vec3(1, 0, 0); }); // inside the box
    refused([](Camera& c) { c.eye = c.center; });
    refused([](Camera& c) { c.up = c.center - c.eye; });
    refused([](Camera& c) { c.fovY = 180; });
    refused([](Camera& c) { c.eye.x = std::nan(""); });
    refused([](Camera& c) {
        c.projection = Projection::Orthographic;
        c.height = 0;
    });
    auto j = jsonFromCamera(good);
    j.erase("fov_y");
    CHECK_THROWS_WITH(cameraFromJson(j, "c.json"), Catch::Contains("fov_y") && Catch::Contains("c.json"));
    j = jsonFromCamera(good);
    j["eye"] = {1, 2};
    CHECK_THROWS_WITH(cameraFromJson(j, "c.json"), Catch::Contains("/eye"));
    j["projection"] = "fisheye";
    CHECK_THROWS_AS(cameraFromJson(j, "c.json"), Error);
}

TEST_CASE("a view in words is angles or a side, with a zoom", "[camera]") {
    const auto angles = [](const std::string& text) { return std::get<ViewAngles>(viewFromText(text)); };
    CHECK(angles("30,-20").azimuth == 30);
    CHECK(angles("30,-20").elevation == -20);
    CHECK(angles("30,-20").zoom == 1);
    CHECK(angles("0,0,2.5").zoom == 2.5);
    const auto side = std::get<NamedView>(viewFromText("posterior,3"));
    CHECK(side.view == StandardView::Back);
    CHECK(side.ofPatient);
    CHECK(side.zoom == 3);
    for (const char* wrong :
         {"", "1", "1,2,3,4", "0,91", "nan,0", "0,0,0", "0,0,1e7", "up", "front,0", "front,1,2", "1,,2"}) {
        INFO(wrong);
        CHECK_THROWS_AS(viewFromText(wrong), UsageError);
    }
}
