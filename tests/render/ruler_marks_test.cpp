#include "render/ruler_marks.h"

#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// From the front: x to the right and z upward, a pixel per world unit, the origin in the middle of 200 × 100 pixels.
PictureView front() {
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.eye = {0, -1000, 0};
    camera.height = 100;
    return {camera, 200, 100};
}

ShownRuler shownDistance(const Vec3& a, const Vec3& b, const std::string& label = "12.3 mm") {
    return {{.kind = RulerKind::Distance, .points = {a, b}, .number = 1}, label};
}

std::vector<Mark> ofKind(const std::vector<Mark>& marks, Mark::Kind kind) {
    std::vector<Mark> some;
    for (const Mark& mark : marks)
        if (mark.kind == kind) some.push_back(mark);
    return some;
}

/// The planes of a grid of 10³ voxels of size 1 from the origin, 100 × 100 pixels.
SlicePlane sliceAcrossZ(const Geometry& g, double position) {
    return {2, position, fittedSlice(g, 2, 100, 100), 100, 100};
}

} // namespace

TEST_CASE("a distance is drawn from end to end with a ring on each and its label above", "[ruler]") {
    const auto marks = rulerMarks({shownDistance({-50, 0, 0}, {30, 0, 0})}, front(), {});
    const auto lines = ofKind(marks, Mark::Kind::Line);
    REQUIRE(lines.size() == 3);
    // x −50 is pixel 50, z 0 is pixel 50.
    CHECK(glm::length(lines[0].points.front() - Vec2(50, 50)) < 1e-9);
    CHECK(glm::length(lines[0].points.back() - Vec2(130, 50)) < 1e-9);
    for (std::size_t end = 1; end < 3; ++end) {
        const PixelBox ring = boxAround(lines[end].points);
        CHECK((ring.left + ring.right) / 2 == Approx(end == 1 ? 50 : 130));
    }
    const auto texts = ofKind(marks, Mark::Kind::Text);
    REQUIRE(texts.size() == 1);
    CHECK(texts[0].text == "12.3 mm");
    const PixelBox label = extentOf(texts[0]);
    CHECK((label.left + label.right) / 2 == Approx(90).margin(3)); // over the middle
    CHECK(label.bottom < 50);
    for (const Mark& mark : marks) CHECK(mark.part == AnnotationPart::Measures);
    // The selected one has another colour.
    ShownRuler selected = shownDistance({-50, 0, 0}, {30, 0, 0});
    selected.isSelected = true;
    CHECK_FALSE(rulerMarks({selected}, front(), {})[0].color == lines[0].color);
}

TEST_CASE("what lies behind the eye or beside the picture is not drawn", "[ruler]") {
    PictureView view = front();
    view.camera.projection = Projection::Perspective;
    view.camera.eye = {0, -10, 0};
    CHECK(rulerMarks({shownDistance({0, -20, 0}, {1, -20, 0})}, view, {}).empty());
    const auto beside = rulerMarks({shownDistance({1e6, 0, 0}, {2e6, 0, 0})}, front(), {});
    CHECK(beside.empty());
    // Of a line that leaves the picture the part within is drawn: no mark reaches far out of it.
    for (const Mark& mark : rulerMarks({shownDistance({0, 0, 0}, {1e6, 0, 0})}, front(), {}))
        for (const Vec2& p : mark.points) CHECK(p.x <= 200 + 12);
}

TEST_CASE("a sphere is its outline, nearer and smaller in perspective", "[ruler]") {
    const ShownRuler sphere{{.kind = RulerKind::Sphere, .points = {{0, 0, 0}}, .radius = 20, .number = 1}, "mean 1"};
    const auto outline = [&](const PictureView& view) {
        return boxAround(ofKind(rulerMarks({sphere}, view, {}), Mark::Kind::Line).front().points);
    };
    const PixelBox flat = outline(front());
    CHECK(flat.left == Approx(80));
    CHECK(flat.right == Approx(120));
    // Seen under the angle whose sine is 20/100: tangents of 0.2/√(1 − 0.04) at depth 1.
    PictureView view = front();
    view.camera.projection = Projection::Perspective;
    view.camera.eye = {0, -100, 0};
    view.camera.fovY = 90; // a half height of 1 at depth 1: 50 pixels
    const PixelBox round = outline(view);
    CHECK(round.right - 100 == Approx(50 * 0.2 / std::sqrt(1 - 0.04)));
}

TEST_CASE("a slice has what it cuts: strong where a line lies in it, faint beside", "[ruler]") {
    const Geometry g = geometryOf({10, 10, 10});
    const ShownRuler along = shownDistance({1, 5, 4}, {8, 5, 4}), through = shownDistance({2, 2, 0}, {2, 8, 6});
    // In the slice z = 4 lies the first one whole; the other slice of z = 7 has neither.
    const auto inside = rulerMarks({along}, g, sliceAcrossZ(g, 4), {});
    const auto lines = ofKind(inside, Mark::Kind::Line);
    REQUIRE(lines.size() == 4); // faint whole, strong whole, two rings
    CHECK(lines[0].alpha < 1);
    CHECK(lines[1].alpha == 1);
    CHECK(glm::length(lines[1].points[0] - lines[1].points[1]) == Approx(70)); // 7 voxels of 10 pixels
    CHECK(rulerMarks({along, through}, g, sliceAcrossZ(g, 7), {}).empty());
    // The second one crosses z = 3 at y = 5, and is within half a voxel of it from z 2.5 to 3.5, y 4.5 to 5.5.
    const auto crossing = ofKind(rulerMarks({through}, g, sliceAcrossZ(g, 3), {}), Mark::Kind::Line);
    REQUIRE(crossing.size() == 2); // no end lies in it
    CHECK(glm::length(crossing[1].points[0] - crossing[1].points[1]) == Approx(10));
    CHECK(ofKind(rulerMarks({through}, g, sliceAcrossZ(g, 3), {}), Mark::Kind::Text).size() == 1);
}

TEST_CASE("a slice cuts circles out of spheres and outlines out of boxes", "[ruler]") {
    const Geometry g = geometryOf({10, 10, 10});
    const ShownRuler sphere{{.kind = RulerKind::Sphere, .points = {{5, 5, 5}}, .radius = 2.5, .number = 1}};
    // 1.5 from the centre: √(2.5² − 1.5²) = 2, in pixels of a tenth of a voxel.
    const auto lines = ofKind(rulerMarks({sphere}, g, sliceAcrossZ(g, 6.5), {}), Mark::Kind::Line);
    REQUIRE(lines.size() == 1);
    const PixelBox circle = boxAround(lines[0].points);
    CHECK(circle.right - circle.left == Approx(40).margin(0.1));
    CHECK(rulerMarks({sphere}, g, sliceAcrossZ(g, 8), {}).empty());
    const ShownRuler box{boxRuler({1, 2, 3}, {4, 8, 6})};
    const auto outline = ofKind(rulerMarks({box}, g, sliceAcrossZ(g, 4), {}), Mark::Kind::Line);
    REQUIRE(outline.size() == 1);
    CHECK(outline[0].points.size() == 5);
    const PixelBox rectangle = boxAround(outline[0].points);
    CHECK(rectangle.right - rectangle.left == Approx(30));
    CHECK(rectangle.bottom - rectangle.top == Approx(60));
    CHECK(rulerMarks({box}, g, sliceAcrossZ(g, 7), {}).empty());
}

TEST_CASE("circles stay round in grids of uneven and turned voxels", "[ruler]") {
    Geometry g = geometryOf({10, 10, 10}, {1, 2, 3}, {7, -3, 5});
    const double c = std::cos(0.4), s = std::sin(0.4);
    g.directions = Mat3(Vec3(c, s, 0), Vec3(-s, c, 0), Vec3(0, 0, 1));
    const Vec3 center = g.worldFromVoxel({5, 5, 5});
    const ShownRuler sphere{{.kind = RulerKind::Sphere, .points = {center}, .radius = 3, .number = 1}};
    const SlicePlane plane{2, 5, fittedSlice(g, 2, 200, 200), 200, 200};
    const double perUnit = 200 / plane.shown.width;
    const Vec2 middle = pixelOfVoxel(g, plane, {5, 5, 5});
    const auto lines = ofKind(rulerMarks({sphere}, g, plane, {}), Mark::Kind::Line);
    REQUIRE(lines.size() == 2); // and the ring of its centre
    for (const Vec2& p : lines[0].points) CHECK(glm::length(p - middle) == Approx(3 * perUnit).epsilon(1e-9));
}

TEST_CASE("handles lie on what they change, and bring it where the hand goes", "[ruler]") {
    const std::vector<Ruler> rulers{
        {.kind = RulerKind::Angle, .points = {{10, 0, 0}, {0, 0, 0}, {0, 0, 10}}, .number = 3},
        {.kind = RulerKind::Sphere, .points = {{-40, 0, 0}}, .radius = 20, .number = 4},
        [] {
            Ruler box = boxRuler({1, 2, 3}, {4, 8, 6});
            box.number = 5;
            return box;
        }()};
    const auto handles = rulerHandles(rulers, front());
    REQUIRE(handles.size() == 3 + 2 + 7);
    for (const RulerHandle& handle : handles) {
        const auto at = pixelOf(front(), handle.world);
        CHECK(std::hypot(at->x - handle.at.x, at->y - handle.at.y) < 1e-9);
    }
    const auto moved = [&](std::size_t n, const Vec3& world) {
        const Ruler& ruler = rulers[n < 3 ? 0 : n < 5 ? 1 : 2];
        return withHandleAt(ruler, handles[n], world);
    };
    CHECK(moved(2, {0, 5, 5}).points[2] == Vec3(0, 5, 5));
    CHECK(moved(2, {0, 0, 0}) == rulers[0]); // a leg without length is no angle
    CHECK(moved(3, {1, 1, 1}).points[0] == Vec3(1, 1, 1));
    CHECK(moved(3, {1, 1, 1}).radius == 20);
    CHECK(moved(4, {-40, 0, 33}).radius == Approx(33));
    // The middle of the box is (2.5, 5, 4.5).
    CHECK(moved(5, {3.5, 5, 4.5}).points[0] == Vec3(2, 2, 3));
    CHECK(moved(6, {0, 9, 9}).points[0] == Vec3(0, 2, 3));  // the lower face along x, whatever y and z are
    CHECK(moved(7, {9, 0, 0}).points[1] == Vec3(9, 8, 6));  // the upper one
    CHECK(moved(7, {-9, 0, 0}).points[1] == Vec3(1, 8, 6)); // not beyond the lower one
    Ruler hidden = rulers[0];
    hidden.shown = false;
    CHECK(rulerHandles({hidden}, front()).empty());
}

TEST_CASE("in a slice, what lies in it has handles", "[ruler]") {
    const Geometry g = geometryOf({10, 10, 10});
    const SlicePlane plane = sliceAcrossZ(g, 4);
    const auto handlesOf = [&](const Ruler& ruler) { return rulerHandles({ruler}, g, plane); };
    CHECK(handlesOf({.kind = RulerKind::Distance, .points = {{1, 5, 4.4}, {8, 5, 6}}, .number = 1}).size() == 1);
    // The rim is at the circle's right: 1 from the centre's layer, √(2² − 1²).
    const Ruler sphere{.kind = RulerKind::Sphere, .points = {{5, 5, 5}}, .radius = 2, .number = 2};
    const auto rim = handlesOf(sphere);
    REQUIRE(rim.size() == 1);
    CHECK(glm::length(rim[0].world - Vec3(5 + std::sqrt(3), 5, 4)) < 1e-9);
    // Dragged there to 3 from the middle of the circle: √(3² + 1²) from the centre.
    CHECK(withHandleAt(sphere, rim[0], {8, 5, 4}).radius == Approx(std::sqrt(10)));
    // A box: its middle and the four faces that are seen from the side.
    const Ruler box = boxRuler({1, 2, 3}, {4, 8, 6});
    const auto faces = handlesOf(box);
    REQUIRE(faces.size() == 5);
    CHECK(glm::length(faces[1].world - Vec3(1, 5, 4)) < 1e-9);
    CHECK(glm::length(faces[4].world - Vec3(2.5, 8, 4)) < 1e-9);
}

TEST_CASE("a point beside another one faces the viewer at its depth", "[ruler]") {
    // A pixel per world unit: 30 to the right and 20 up, whatever the depth.
    CHECK(glm::length(besideInView(front(), {0, 7, 0}, {130, 30}) - Vec3(30, 7, 20)) < 1e-9);
}

TEST_CASE("measures are part of the annotations, and coordinates are those that people have chosen", "[ruler]") {
    Geometry g = geometryOf({10, 10, 10}, Vec3(10), {20, 20, 20});
    g.worldAxes = WorldAxes::Patient;
    AnnotationInput input;
    input.show = AnnotationChoice::none();
    input.geometry = g;
    input.camera = lookingAlong(g, {0, 1, 0});
    input.picture.width = 400;
    input.picture.height = 300;
    input.rulers = {shownDistance({20, 20, 20}, {110, 20, 20})};
    CHECK(annotationMarks(input).empty());
    input.show.measures = true;
    CHECK(ofKind(annotationMarks(input), Mark::Kind::Text).front().text == "12.3 mm");
    input.show = AnnotationChoice::none();
    input.show.axes = true;
    const auto texts = [&] {
        std::string all;
        for (const Mark& mark : ofKind(annotationMarks(input), Mark::Kind::Text)) all += mark.text + "|";
        return all;
    };
    CHECK(texts().find("R→L  mm") != std::string::npos);
    CHECK(texts().find("-") == std::string::npos); // all places are positive
    input.axes = PatientAxes::Ras;
    CHECK(texts().find("L→R  mm") != std::string::npos);
    CHECK(texts().find("I→S  mm") != std::string::npos); // as before
    CHECK(texts().find("-50") != std::string::npos);
}
