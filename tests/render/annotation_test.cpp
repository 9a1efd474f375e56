// Annotations: what they say, and where.
#include <map>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "render/annotation_raster.h"
#include "render/standard_view.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

AnnotationChoice only(bool AnnotationChoice::*part) {
    AnnotationChoice show = AnnotationChoice::none();
    show.*part = true;
    return show;
}

AnnotationChoice everything() {
    AnnotationChoice show;
    for (const AnnotationPartInfo& part : kAnnotationParts) show.*part.shown = true;
    return show;
}

/// A box of 100 × 200 × 150 mm, seen from `azimuth`, `elevation`.
AnnotationInput inputOf(double azimuth, double elevation, const AnnotationChoice& show,
                        Projection projection = Projection::Perspective, WorldAxes axes = WorldAxes::Patient) {
    AnnotationInput input;
    input.show = show;
    input.geometry = geometryOf({100, 100, 100}, {1, 2, 1.5}, {-50, -100, 20});
    input.geometry.worldAxes = axes;
    input.camera = cameraFromView(input.geometry, azimuth, elevation, 1, projection);
    input.tf = tents(3);
    input.window = {-1000, 3000};
    input.title = "a volume.nrrd";
    input.picture.width = 600;
    input.picture.height = 400;
    return input;
}

std::vector<Mark> textsOf(const std::vector<Mark>& marks, AnnotationPart part) {
    std::vector<Mark> texts;
    for (const Mark& mark : marks)
        if (mark.part == part && mark.kind == Mark::Kind::Text) texts.push_back(mark);
    return texts;
}

/// The text whose extent lies nearest to the middle of an edge of the picture: 0 left, 1 right, 2 top, 3 bottom.
std::string edgeLetters(const AnnotationInput& input, int edge) {
    const double w = input.picture.width, h = input.picture.height;
    const std::array<Vec2, 4> middles{Vec2(0, h / 2), Vec2(w, h / 2), Vec2(w / 2, 0), Vec2(w / 2, h)};
    std::string nearest;
    double least = 1e9;
    for (const Mark& mark : textsOf(annotationMarks(input), AnnotationPart::Letters)) {
        const PixelBox box = extentOf(mark);
        const Vec2 middle((box.left + box.right) / 2, (box.top + box.bottom) / 2);
        const double distance = glm::length(middle - middles[static_cast<std::size_t>(edge)]);
        if (distance < least) {
            least = distance;
            nearest = mark.text;
        }
    }
    return nearest;
}

std::string allEdges(const AnnotationInput& input) {
    return edgeLetters(input, 0) + " " + edgeLetters(input, 1) + " " + edgeLetters(input, 2) + " " +
           edgeLetters(input, 3);
}

AnnotationInput standardInput(StandardView view, const AnnotationChoice& show) {
    const ViewAngles angles = anglesOf(view, WorldAxes::Patient);
    return inputOf(angles.azimuth, angles.elevation, show);
}

std::string cubeLetters(const AnnotationInput& input) {
    std::string letters;
    for (const Mark& mark : textsOf(annotationMarks(input), AnnotationPart::Cube)) letters += mark.text + " ";
    return letters;
}

} // namespace

TEST_CASE("letters at the edges: left, right, top and bottom of the six views of a patient", "[annotation]") {
    const AnnotationChoice show = only(&AnnotationChoice::letters);
    // Face to face with the patient, whose right is at our left; from behind the other way.
    CHECK(allEdges(standardInput(StandardView::Front, show)) == "R L S I");
    CHECK(allEdges(standardInput(StandardView::Back, show)) == "L R S I");
    // At the patient's left side we see the face looking to our left.
    CHECK(allEdges(standardInput(StandardView::Left, show)) == "A P S I");
    CHECK(allEdges(standardInput(StandardView::Right, show)) == "P A S I");
    // The front is up in both: from the feet the patient's right is at our left, from the head at our right.
    CHECK(allEdges(standardInput(StandardView::Bottom, show)) == "R L A P");
    CHECK(allEdges(standardInput(StandardView::Top, show)) == "L R A P");
}

TEST_CASE("an oblique edge has two letters, the main one first", "[annotation]") {
    const AnnotationChoice show = only(&AnnotationChoice::letters);
    // The eye moved by 30° toward the patient's left: right in the picture is (cos 30°, sin 30°, 0), left and back;
    // tan 30° = 0.58 is more than tan 22.5°. By 20° it is not.
    CHECK(edgeLetters(inputOf(30, 0, show), 1) == "LP");
    CHECK(edgeLetters(inputOf(30, 0, show), 0) == "RA");
    CHECK(edgeLetters(inputOf(60, 0, show), 1) == "PL");
    CHECK(edgeLetters(inputOf(20, 0, show), 1) == "L");
    // From 50° above, up in the picture is (0, sin 50°, cos 50°): back more than up.
    CHECK(edgeLetters(inputOf(0, 50, show), 2) == "PS");
}

TEST_CASE("no letters where the file does not know", "[annotation]") {
    CHECK(annotationMarks(inputOf(0, 0, only(&AnnotationChoice::letters), Projection::Perspective, WorldAxes::File))
              .empty());
    AnnotationChoice off = everything();
    off.on = false;
    CHECK(annotationMarks(inputOf(0, 0, off)).empty());
}

TEST_CASE("the cube shows the faces that look toward the eye", "[annotation]") {
    const AnnotationChoice show = only(&AnnotationChoice::cube);
    CHECK(cubeLetters(inputOf(0, 0, show)) == "A ");
    CHECK(cubeLetters(inputOf(30, 20, show)) == "L A S "); // the eye at the left, in front, above
    CHECK(cubeLetters(inputOf(200, -40, show)) == "R P I ");
    CHECK(cubeLetters(inputOf(30, 20, show, Projection::Orthographic, WorldAxes::File)) == "X −Y Z ");
    // Upright and not mirrored from the six sides.
    for (const StandardView view : kStandardViews) {
        const auto texts = textsOf(annotationMarks(standardInput(view, show)), AnnotationPart::Cube);
        REQUIRE(texts.size() == 1);
        INFO(texts[0].text);
        CHECK(texts[0].across.x > 5);
        CHECK(std::abs(texts[0].across.y) < 1e-9);
        CHECK(texts[0].up.y == Approx(-texts[0].across.x));
    }
}

TEST_CASE("the scale bar is as long as it says, at the depth of the camera's centre", "[annotation]") {
    for (const auto projection : {Projection::Perspective, Projection::Orthographic})
        for (const double zoom : {0.3, 1.0, 7.0, 300.0}) {
            AnnotationInput input = inputOf(40, 25, only(&AnnotationChoice::scale), projection);
            input.camera = cameraFromView(input.geometry, 40, 25, zoom, projection);
            const auto marks = annotationMarks(input);
            REQUIRE(marks.size() == 2);
            REQUIRE(marks[0].kind == Mark::Kind::Line);
            REQUIRE(marks[1].text.ends_with(" mm"));
            const double length = std::stod(marks[1].text);
            // Where the rays through its ends meet the plane through the centre.
            const auto inPlane = [&](const Vec2& p) {
                const Ray ray = pixelRay(input.camera, p.x, p.y, 600, 400);
                const Vec3 f = input.camera.forward();
                const double t = glm::dot(input.camera.center - ray.origin, f) / glm::dot(ray.direction, f);
                return ray.origin + ray.direction * t;
            };
            CHECK(glm::length(inPlane(marks[0].points[2]) - inPlane(marks[0].points[1])) == Approx(length));
            const double pixels = marks[0].points[2].x - marks[0].points[1].x;
            CHECK(pixels <= 0.22 * 600 + 1e-9); // and the next round number would not have been
            CHECK(pixels > 0.22 * 600 / 2.5 - 1e-9);
        }
    const auto file =
        annotationMarks(inputOf(0, 0, only(&AnnotationChoice::scale), Projection::Perspective, WorldAxes::File));
    CHECK(file.at(1).text.ends_with(" units"));
}

TEST_CASE("the legend has the colours of the transfer function at their values", "[annotation]") {
    const AnnotationInput input = inputOf(0, 0, only(&AnnotationChoice::legend));
    const auto marks = annotationMarks(input);
    const auto texts = textsOf(marks, AnnotationPart::Legend);
    const auto yOf = [&](const std::string& text) {
        for (const Mark& mark : texts)
            if (mark.text == text) return mark.points[0].y - 0.5 * glm::length(mark.up);
        FAIL("no label " + text);
        return 0.0;
    };
    // Linear: the window's middle, 1000, is as far from 0 as from 2000.
    CHECK(yOf("1000") - yOf("2000") == Approx(yOf("0") - yOf("1000")));
    CHECK(yOf("f1") > yOf("f2"));
    // The second tent's peak is at the middle of the window: there the legend is of its colour.
    CHECK(yOf("f2") == Approx(yOf("1000")));
    Image image(600, 400);
    drawMarks(image, marks);
    PixelBox box{1e9, 1e9, 0, 0};
    for (const Mark& mark : marks)
        if (mark.kind == Mark::Kind::Area) {
            const PixelBox one = extentOf(mark);
            box = {std::min(box.left, one.left), std::min(box.top, one.top), std::max(box.right, one.right),
                   std::max(box.bottom, one.bottom)};
        }
    const float* pixel = image.pixel(static_cast<int>(box.right) - 3, static_cast<int>(yOf("1000")));
    const Rgb color = input.tf.color(0.5);
    CHECK(pixel[0] == Approx(color.r).margin(0.01));
    CHECK(pixel[1] == Approx(color.g).margin(0.01));
    CHECK(pixel[2] == Approx(color.b).margin(0.01));
    // Other modes are grey, and know no features.
    AnnotationInput grey = input;
    grey.picture.mode = RenderMode::Mip;
    for (const Mark& mark : annotationMarks(grey))
        if (mark.kind == Mark::Kind::Area && mark.alpha == 1) CHECK(mark.color.r == mark.color.b);
    AnnotationInput constant = input;
    constant.window = {7, 7};
    CHECK(annotationMarks(constant).empty());
}

TEST_CASE("axes have the world's coordinates where they are", "[annotation]") {
    // From the front, parallel: x = −50.5 … 49.5 goes from left to right, and 0 lies 50.5 of 100 mm from the left.
    AnnotationInput input = inputOf(0, 0, only(&AnnotationChoice::axes), Projection::Orthographic);
    const double perMm = 400 / input.camera.height;
    const auto texts = textsOf(annotationMarks(input), AnnotationPart::Axes);
    const auto middleOf = [&](const std::string& text) {
        for (const Mark& mark : texts)
            if (mark.text == text) return mark.points[0].x + 0.5 * mark.across.x * textWidth(text);
        FAIL("no label " + text);
        return 0.0;
    };
    CHECK(middleOf("0") == Approx(300 + perMm * 0.5)); // the box's middle is at −0.5
    CHECK_NOTHROW(middleOf("R→L  mm"));
    CHECK_NOTHROW(middleOf("I→S  mm"));
    for (const Mark& mark : texts) CHECK(mark.text != "A→P  mm"); // seen end-on
    const auto captionsIn = [&](WorldAxes axes, LengthUnit unit) {
        input.geometry.worldAxes = axes;
        input.geometry.lengthUnit = unit;
        std::set<std::string> captions;
        for (const Mark& mark : textsOf(annotationMarks(input), AnnotationPart::Axes)) captions.insert(mark.text);
        return captions;
    };
    CHECK(captionsIn(WorldAxes::Patient, LengthUnit::Micrometre).contains("R→L  µm"));
    CHECK(captionsIn(WorldAxes::File, LengthUnit::Micrometre).contains("x  µm"));
    CHECK(captionsIn(WorldAxes::File, LengthUnit::Unknown).contains("x"));
}

TEST_CASE("nothing overlaps and nothing is lost, from 300x200 to 4K", "[annotation]") {
    for (const auto& [width, height] : {std::pair{300, 200}, {200, 300}, {512, 512}, {1600, 970}, {3840, 2160}})
        for (const double density : {1.0, 2.0})
            for (const auto projection : {Projection::Perspective, Projection::Orthographic})
                for (const auto& [azimuth, elevation] : {std::pair{0, 0}, {30, 20}, {-130, 70}, {90, -90}}) {
                    if (density > 1 && std::min(width, height) < 400) continue; // 150 x 100 of the screen
                    AnnotationInput input = inputOf(azimuth, elevation, everything(), projection);
                    input.picture.width = width;
                    input.picture.height = height;
                    input.density = density;
                    input.title = "a rather long name of a volume that somebody has thought of.nii.gz";
                    input.tf.features[1].name = "a feature of a long name, too";
                    const auto marks = annotationMarks(input);
                    INFO(width << "x" << height << " density " << density << " view " << azimuth << "," << elevation);
                    std::map<AnnotationPart, std::vector<PixelBox>> boxes;
                    for (const Mark& mark : marks) {
                        if (mark.part == AnnotationPart::Axes && mark.kind != Mark::Kind::Text) continue;
                        const PixelBox box = extentOf(mark);
                        CHECK((box.left >= 0 && box.top >= 0 && box.right <= width && box.bottom <= height));
                        boxes[mark.part].push_back(box);
                    }
                    CHECK(boxes.size() >= 5);
                    for (const AnnotationPartInfo& part : kAnnotationParts)
                        if (part.part != AnnotationPart::Axes && part.part != AnnotationPart::Measures) {
                            INFO(part.name);
                            CHECK_FALSE(boxes[part.part].empty());
                        }
                    CHECK(boxes[AnnotationPart::Letters].size() == 4);
                    bool apart = true;
                    for (const auto& [a, inA] : boxes)
                        for (const auto& [b, inB] : boxes)
                            for (const PixelBox& one : inA)
                                for (const PixelBox& other : inB) apart = apart && (a == b || !one.meets(other));
                    CHECK(apart);
                }
}

TEST_CASE("text grows with the picture, and stays readable in a small one", "[annotation]") {
    const auto capital = [](int size, double density) {
        AnnotationInput input = inputOf(0, 0, only(&AnnotationChoice::scale));
        input.picture.width = input.picture.height = size;
        input.density = density;
        return glm::length(annotationMarks(input).at(1).up);
    };
    CHECK(capital(300, 1) == 7);
    CHECK(capital(300, 2) == 14);
    CHECK(capital(2000, 1) == Approx(2 * capital(1000, 1)));
}

TEST_CASE("a tiny picture and an eye close by are no trouble", "[annotation]") {
    for (const int size : {1, 7, 40}) {
        AnnotationInput input = inputOf(30, 20, everything());
        input.picture.width = input.picture.height = size;
        Image image(size, size);
        CHECK_NOTHROW(drawMarks(image, annotationMarks(input)));
    }
    // Beside an oblique box the eye may be within the box along the world's axes.
    AnnotationInput input = inputOf(0, 0, everything());
    const double c = std::sqrt(0.5);
    input.geometry.directions = Mat3(Vec3(c, c, 0), Vec3(-c, c, 0), Vec3(0, 0, 1));
    input.camera.center = input.geometry.boxCenter();
    input.camera.eye = input.geometry.boundsMin() + Vec3(1, 1, 10);
    Image image(600, 400);
    CHECK_NOTHROW(drawMarks(image, annotationMarks(input)));
}

TEST_CASE("marks are drawn where they are, and nowhere else", "[annotation]") {
    Image image(40, 30);
    for (float& v : image.rgba) v = 0.25f;
    const Image before = image;
    Mark line;
    line.points = {{5, 10}, {25, 10}}; // covers the rows from 8 to 12: width 4
    line.width = 4;
    line.color = {1, 0, 0.5};
    drawMarks(image, {line});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const float* now = image.pixel(x, y);
            if (y >= 8 && y < 12 && x >= 5 && x < 25) {
                CHECK(now[0] == 1.0f);
                CHECK(now[2] == 0.5f);
                CHECK(now[3] == 1.0f);
            } else if (y < 7 || y > 12 || x < 2 || x > 27) {
                CHECK(std::equal(now, now + 4, before.pixel(x, y)));
            }
        }
    // Half a colour over nothing: the colour whole, alpha a half. Straight colours are not mixed with what is not
    // there.
    Image clear(10, 10);
    Mark area;
    area.kind = Mark::Kind::Area;
    area.points = {{2, 2}, {8, 2}, {8, 8}, {2, 8}};
    area.color = {0.2, 0.4, 0.6};
    area.alpha = 0.5;
    drawMarks(clear, {area});
    CHECK(clear.pixel(5, 5)[1] == Approx(0.4));
    CHECK(clear.pixel(5, 5)[3] == Approx(0.5));
    CHECK(clear.pixel(1, 5)[3] == 0);
}

TEST_CASE("texts are measured, cut and drawn for any bytes", "[annotation]") {
    CHECK(textWidth("") == 0);
    CHECK(textWidth("H") == Approx(0.72));             // as its path says
    CHECK(textWidth("HH") == Approx(2 * 0.72 + 0.25)); // and what lies between
    CHECK(textWidth("Ä") == textWidth("A"));
    CHECK(textStrokes("ä").size() == textStrokes("a").size() + 2); // two dots
    CHECK(textStrokes("\xE2\x82").size() == 2);                    // no UTF-8: two boxes
    CHECK(textStrokes("日").size() == 1);                          // not in the font: a box
    CHECK(shortenedText("volume", 100) == "volume");
    const std::string cut = shortenedText("äöüäöüäöü", 3);
    CHECK(cut.ends_with("…"));
    CHECK(textWidth(cut) <= 3);
    for (char32_t c = 33; c < 127; ++c) {
        const std::string text(1, static_cast<char>(c));
        for (const Polyline& stroke : textStrokes(text))
            for (const Vec2& p : stroke) {
                INFO(text);
                CHECK((p.x >= -0.03 && p.x <= textWidth(text) + 0.03 && p.y >= -0.32 && p.y <= 1.15));
            }
    }
}

TEST_CASE("views by name", "[annotation]") {
    CHECK(namedView("anterior")->view == StandardView::Front);
    CHECK(namedView("anterior")->ofPatient);
    CHECK_FALSE(namedView("left")->ofPatient);
    CHECK_FALSE(namedView("sideways"));
    // The patient's left is at +x, where positive azimuths lead; the file's left is the picture's left from the front.
    CHECK(anglesOf(*namedView("left"), WorldAxes::Patient).azimuth == 90);
    CHECK(anglesOf(*namedView("left"), WorldAxes::File).azimuth == -90);
    CHECK(anglesOf(*namedView("front"), WorldAxes::Patient).azimuth == 0);
    CHECK_THROWS_AS(anglesOf(*namedView("superior"), WorldAxes::File), UsageError);
    CHECK(std::string(name(StandardView::Top, WorldAxes::Patient)) == "superior");
    CHECK(std::string(name(StandardView::Top, WorldAxes::File)) == "top");
}
