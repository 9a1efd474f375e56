// Figures for print: sizes on paper against those of the picture, bars against what was measured, and files that are
// what they say.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include <catch2/catch.hpp>
#include <pugixml.hpp>

#include "base/atomic_file.h"
#include "base/text.h"
#include "figure/figure_file.h"
#include "figure/print.h"
#include "figure/svg_figure.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

Scene sampleScene(Projection projection = Projection::Orthographic) {
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = 16;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = "tents:3";
    inputs.start = SceneInputs::Start::Tents;
    inputs.view = ViewAngles{30, 20, 1};
    inputs.projection = projection;
    Scene scene = openScene(inputs);
    scene.session.display.edit([](DisplaySettings& display) { display.background = {1, 1, 1}; });
    return scene;
}

FigureTask taskOf(const Scene& scene, const std::string& parts) {
    FigureTask task{scene, pictureInput(scene, 8, 8).settings};
    task.settings.dpi = 60;
    task.settings.parts = parts;
    return task;
}

FigureContent contentOf(const FigureTask& task) {
    Workspace workspace;
    return figureContent(task, workspace);
}

const FigureGroup& groupOf(const Figure& figure, const std::string& name) {
    for (const FigureGroup& group : figure.groups)
        if (group.name == name) return group;
    FAIL("the figure has no group " << name);
    std::abort();
}

template <class Element>
std::vector<Element> elementsOf(const FigureGroup& group) {
    std::vector<Element> found;
    for (const FigureElement& element : group.elements)
        if (const auto* const one = std::get_if<Element>(&element)) found.push_back(*one);
    return found;
}

double widthOf(const FigureArea& area) {
    const PixelBox box = boxAround(area.corners);
    return box.right - box.left;
}

/// The number that follows `key` in a PDF whose dictionaries are not packed.
double numberAfter(const std::string& pdf, const std::string& key, int skipped = 0) {
    const std::size_t at = pdf.find(key);
    REQUIRE(at != std::string::npos);
    std::istringstream rest(pdf.substr(at + key.size(), 100));
    double number = 0;
    for (int n = 0; n <= skipped; ++n) rest >> number;
    return number;
}

} // namespace

TEST_CASE("the picture has as many pixels as width and resolution say, and they are square", "[figure]") {
    FigureSettings settings{.widthMm = 85, .dpi = 300};
    // 85 mm · 300 / 25.4 mm = 1003.94, and three quarters of that 752.95.
    CHECK(figurePixels(settings).width == 1004);
    CHECK(figurePixels(settings).height == 753);
    CHECK(figurePixels(settings).mmPerPixel == Approx(85.0 / 1004));
    settings.heightMm = 25.4;
    CHECK(figurePixels(settings).height == 300);
}

TEST_CASE("parts are read by their names", "[figure]") {
    CHECK(figurePartsOf("picture") == FigureParts{});
    CHECK(figurePartsOf("picture, scale,caption") == FigureParts{.scale = true, .caption = true});
    for (const FigurePartInfo& part : kFigureParts) {
        FigureParts one;
        one.*part.shown = true;
        CHECK(figurePartsOf(part.name) == one);
        CHECK(figurePartsOf(textOf(one)) == one);
    }
    FigureParts all;
    for (const FigurePartInfo& part : kFigureParts) all.*part.shown = true;
    CHECK(figurePartsOf("all") == all);
    CHECK(figurePartsOf("picture, all") == all);
    CHECK_THROWS_AS(figurePartsOf("scale,moon"), UsageError);
    CHECK_THROWS_AS(figurePartsOf("all,moon"), UsageError);
    CHECK(figurePartsOf("") == FigureParts{});
}

TEST_CASE("the scale bar is as long on paper as its length is in the picture", "[figure]") {
    const FigureTask task = taskOf(sampleScene(), "picture,scale");
    const Figure figure = layOut(contentOf(task));
    REQUIRE(figure.scale);
    // An orthographic picture is camera.height units high, and on paper 3/4 of 85 mm, as far as whole pixels go:
    // 85 · 60 / 25.4 = 200.8 → 201 of them, 150.6 → 151 high, each 85/201 mm.
    const double mmPerUnit = 151 * (85.0 / 201) / task.scene.camera.height;
    const double length = std::atof(figure.scale->text.c_str());
    REQUIRE(length > 0);
    CHECK(figure.scale->millimetres == Approx(length * mmPerUnit));
    // The bar itself: a line with four points, its ends upward.
    bool found = false;
    for (const FigureLine& line : elementsOf<FigureLine>(groupOf(figure, "annotations")))
        if (line.points.size() == 4) {
            found = true;
            CHECK(line.points[2].x - line.points[1].x == Approx(length * mmPerUnit));
        }
    CHECK(found);
}

TEST_CASE("bars are as long as the shares that are measured, on one scale", "[figure]") {
    Scene scene = sampleScene();
    const FeatureId second = scene.tf.features[1].id;
    scene.session.goals.edit([&](FeatureGoals& goals) { goals[second].target = 1; });
    const Figure figure = layOut(contentOf(taskOf(scene, "picture,shares,targets")));

    Workspace workspace;
    const Measures measures = workspace.measure(measureInput(scene));
    const std::vector<double> targets = scene.targets();
    REQUIRE(measures.features.size() == 3);
    double most = 0;
    for (std::size_t f = 0; f < 3; ++f)
        most = std::max({most, measures.features[f].vws, measures.features[f].visibility, targets[f]});
    // The axis: an upright line, and a level one as long as the largest share.
    const auto axis = elementsOf<FigureLine>(groupOf(figure, "shares-axis"));
    const double left = axis[1].points[0].x, unit = (axis[1].points[1].x - left) / most;
    REQUIRE(unit > 0);
    for (std::size_t f = 0; f < 3; ++f) {
        const FigureGroup& row = groupOf(figure, "feature-" + std::to_string(f + 1));
        const auto areas = elementsOf<FigureArea>(row); // swatch, VWS, visibility
        REQUIRE(areas.size() == 3);
        CHECK(areas[0].color == scene.tf.features[f].color);
        CHECK(areas[1].color == scene.tf.features[f].color);
        CHECK(widthOf(areas[1]) == Approx(measures.features[f].vws * unit));
        CHECK(widthOf(areas[2]) == Approx(measures.features[f].visibility * unit));
        const auto lines = elementsOf<FigureLine>(row); // rims of the swatch and of the bar, target
        REQUIRE(lines.size() == 3);
        CHECK(lines[2].points[0].x - left == Approx(targets[f] * unit));
    }
}

TEST_CASE("targets are drawn where they are asked for", "[figure]") {
    const auto rows = contentOf(taskOf(sampleScene(), "picture,shares")).rows;
    REQUIRE(rows.size() == 3);
    for (const FigureRow& row : rows) CHECK_FALSE(row.target);
}

TEST_CASE("the legend has what is drawn, and its opacities", "[figure]") {
    Scene scene = sampleScene();
    scene.tf.features[0].hidden = true;
    FigureTask task = taskOf(scene, "picture,legend");
    auto rows = contentOf(task).rows;
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].name == scene.tf.features[1].name);
    CHECK(rows[0].opacity == Approx(0.5)); // that of tents
    task.look.mode = RenderMode::Surface;
    rows = contentOf(task).rows;
    REQUIRE(rows.size() == 2);
    CHECK_FALSE(rows[0].vws); // surfaces have no shares
    task.look.mode = RenderMode::Mip;
    CHECK(contentOf(task).rows.empty());
}

TEST_CASE("every part lies on the page, below the one before", "[figure]") {
    for (const double width : {40.0, 85.0, 174.0}) {
        FigureTask task = taskOf(sampleScene(), "title,scale,cube,axes,legend,shares,colors,caption");
        task.settings.widthMm = width;
        task.settings.title = "Two shells";
        const FigureContent content = contentOf(task);
        const Figure figure = layOut(content);
        CHECK(figure.width == width);
        double lowest = 0;
        for (const FigureGroup& group : figure.groups) {
            if (group.clip) continue; // over the picture
            INFO(group.name);
            for (const FigureElement& element : group.elements) {
                if (const auto* const text = std::get_if<FigureText>(&element)) {
                    const TextExtent extent = extentOf(*text, figure.font);
                    const double share = text->align == Align::Start ? 0 : text->align == Align::Middle ? 0.5 : 1;
                    const double room = text->width > 0 ? text->width : extent.width;
                    INFO(text->text << " at " << text->at.x << ", " << extent.width << " wide");
                    CHECK(extent.width <= room + 0.01);
                    CHECK(text->at.x - share * room >= -0.01);
                    CHECK(text->at.x + (1 - share) * room <= width + 0.15); // a rounded number at an axis' end
                    lowest = std::max(lowest, text->at.y - extent.baseline + extent.height);
                }
            }
        }
        CHECK(lowest <= figure.height + 0.5); // letters that reach below the line have their room
        CHECK(figure.height > 0.75 * width);
    }
}

TEST_CASE("lines around boxes lie within the page, clear of its edges", "[figure]") {
    // A stroke that begins at the edge is cut where a viewer rounds the page to whole pixels: at 100 dots per inch, one
    // is 0.254 mm wide.
    for (const double points : {7.0, 14.0})
        for (const char* parts : {"legend", "legend,shares,targets", "shares,colors"}) {
            FigureTask task = taskOf(sampleScene(), parts);
            task.settings.fontPt = points;
            const Figure figure = layOut(contentOf(task));
            int lines = 0;
            for (const FigureGroup& group : figure.groups) {
                if (group.clip) continue; // over the picture
                INFO(parts << ", " << points << " pt: " << group.name);
                const auto check = [&](const std::vector<Vec2>& corners, double width) {
                    const PixelBox box = boxAround(corners);
                    CHECK(box.left - width / 2 >= 0.254);
                    CHECK(box.right + width / 2 <= figure.width - 0.254);
                    CHECK(box.bottom + width / 2 <= figure.height);
                };
                for (const FigureLine& line : elementsOf<FigureLine>(group)) {
                    check(line.points, line.width);
                    ++lines;
                }
                for (const FigureArea& area : elementsOf<FigureArea>(group)) check(area.corners, 0);
            }
            CHECK(lines >= 3); // at least around the colour of each feature
        }
}

TEST_CASE("a font that is not installed is named with the one that stands in", "[figure]") {
    const std::string standIn = familyOf("NoSuchFontXYZ").front();
    CHECK(fontNotice("NoSuchFontXYZ") == "the font NoSuchFontXYZ is not installed: " + standIn + " is used instead");
    CHECK(fontNotice("NoSuchFontXYZ, NoSuchEither") ==
          "none of the fonts NoSuchFontXYZ, NoSuchEither is installed: " + standIn + " is used instead");
    CHECK(fontNotice(standIn).empty());
    CHECK(fontNotice(lowerCase(standIn)).empty());
    CHECK(fontNotice("NoSuchFontXYZ, " + standIn).empty()); // the first that is there counts
    for (const char* any : {"Sans", "sans-serif", "Serif", "Monospace", ""}) CHECK(fontNotice(any).empty());
    // Nor does a name from elsewhere control a terminal.
    CHECK(fontNotice("No\x1b[31mSuch").find('\x1b') == std::string::npos);

    const TempFolder folder;
    FigureTask task = taskOf(sampleScene(), "picture,legend");
    task.settings.font = "NoSuchFontXYZ";
    task.path = folder.path("a.svg");
    CHECK(makeFigure(task).notices == std::vector{fontNotice("NoSuchFontXYZ")});
    task.settings.font = standIn;
    CHECK(makeFigure(task).notices.empty());
}

TEST_CASE("an SVG figure is XML of the size that was asked for, and fetches nothing", "[figure]") {
    FigureTask task = taskOf(sampleScene(), "title,scale,axes,legend,shares,colors,caption");
    const FigureContent content = contentOf(task);
    const Figure figure = layOut(content);
    const std::string svg = svgOf(figure);
    pugi::xml_document document;
    REQUIRE(document.load_buffer(svg.data(), svg.size()));
    const pugi::xml_node root = document.child("svg");
    CHECK(std::string(root.attribute("width").value()) == "85mm");
    CHECK(std::string(root.attribute("role").value()) == "img");
    CHECK(std::string(root.child("title").text().get()) == content.title);
    CHECK(std::string(root.child("desc").text().get()) == content.caption);
    const pugi::xml_node image = root.find_node([](pugi::xml_node n) { return std::string(n.name()) == "image"; });
    CHECK(image.attribute("width").as_double() == Approx(85));
    // The picture has its own width in its header, which begins at byte 16: base64 of the bytes 15 to 17 stands at 20.
    const std::string data = image.attribute("xlink:href").value();
    CHECK(data.rfind("data:image/png;base64,iVBORw0KGgo", 0) == 0);
    // Letters are outlines: no font is needed, and nothing refers to anything outside.
    CHECK(svg.find("<text") == std::string::npos);
    CHECK(svg.find("font-family") == std::string::npos);
    CHECK(svg.find("<script") == std::string::npos);
    std::string withoutNames = svg;
    for (const char* name : {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"})
        withoutNames.erase(withoutNames.find(name), std::string(name).size());
    CHECK(withoutNames.find("http") == std::string::npos);
    // Groups carry what they show, for screen readers.
    const pugi::xml_node row = root.find_child_by_attribute("g", "id", "feature-1");
    CHECK(std::string(row.attribute("aria-label").value()).find("of the saliency") != std::string::npos);
    CHECK(svg == svgOf(layOut(contentOf(task)))); // the same bytes again
}

TEST_CASE("a PDF figure is a page of the size that was asked for, with the picture's pixels", "[figure]") {
    FigureTask task = taskOf(sampleScene(), "picture,scale,legend,shares");
    const Figure figure = layOut(contentOf(task));
    const std::string pdf = pdfOf(figure);
    CHECK(pdf.rfind("%PDF-1.", 0) == 0);
    CHECK(pdf.substr(pdf.size() - 6) == "%%EOF\n");
    // 85 mm are 85 · 72 / 25.4 = 240.945 points.
    CHECK(numberAfter(pdf, "/MediaBox [", 2) == Approx(85 * 72 / 25.4).margin(0.01));
    CHECK(numberAfter(pdf, "/MediaBox [", 3) == Approx(figure.height * 72 / 25.4).margin(0.01));
    CHECK(numberAfter(pdf, "/Subtype /Image\n   /Width ") == 201); // 85 · 60 / 25.4
    CHECK(pdf.find("/SMask") == std::string::npos);
    CHECK(pdf.find("/FontFile") != std::string::npos); // embedded
    CHECK(pdf.find("/CreationDate") == std::string::npos);
    CHECK(pdf == pdfOf(layOut(contentOf(task))));

    task.look.background.reset();
    CHECK(pdfOf(layOut(contentOf(task))).find("/SMask") != std::string::npos);
}

TEST_CASE("names are texts, whatever is in them", "[figure]") {
    const std::string marked = "</g><script>alert(1)</script>&\"'", control = "a\x01\x1b[31mb\nc",
                      turned = "bone\xe2\x80\xaegnp", broken = "\xff\xfe";
    Scene scene = sampleScene();
    scene.tf.features[0].name = marked;
    scene.tf.features[1].name = control + turned + broken;
    scene.tf.features[2].name = std::string(10'000, 'm');
    FigureTask task = taskOf(scene, "title,legend,shares,caption");
    task.settings.title = marked + turned;
    const FigureContent content = contentOf(task);
    CHECK(content.rows[0].name == marked);
    CHECK(content.rows[2].name.size() < 300);
    const Figure figure = layOut(content);
    CHECK(figure.height < 300); // mm
    const std::string svg = svgOf(figure);
    pugi::xml_document document;
    REQUIRE(document.load_buffer(svg.data(), svg.size()));
    CHECK(svg.find("<script") == std::string::npos);
    CHECK(svg.find("\xe2\x80\xae") == std::string::npos);
    CHECK(svg.find('\x1b') == std::string::npos);
    bool isNamed = false;
    for (const auto node : document.child("svg").children("g"))
        isNamed = isNamed || std::string(node.attribute("aria-label").value()).rfind(marked, 0) == 0;
    CHECK(isNamed);
    CHECK(pdfOf(figure).rfind("%PDF", 0) == 0);
}

TEST_CASE("more features than there is room for are counted", "[figure]") {
    FigureContent content = contentOf(taskOf(sampleScene(), "picture,legend,shares"));
    const double few = layOut(content).height;
    while (content.rows.size() < kMostFigureRows + 7) content.rows.push_back(content.rows.front());
    const Figure figure = layOut(content);
    CHECK(figure.height > few);
    CHECK(elementsOf<FigureText>(groupOf(figure, "others")).front().text == "and 7 others");
}

TEST_CASE("a figure is a file that is whole or absent, and says what it holds", "[figure]") {
    const TempFolder folder;
    FigureTask task = taskOf(sampleScene(Projection::Perspective), "picture,scale,legend,shares,caption");
    for (const char* name : {"a.svg", "a.PDF"}) {
        task.path = folder.path(name);
        const FigureFile file = makeFigure(task);
        CHECK(file.bytes == std::filesystem::file_size(task.path));
        CHECK(file.pixels.width == 201);
        CHECK(file.width == 85);
        CHECK(file.rows.size() == 3);
        CHECK(file.scale);
        CHECK(file.caption.find("of the saliency") != std::string::npos);
    }
    task.path = folder.path("a.png");
    CHECK_THROWS_AS(makeFigure(task), UsageError);
    task.path = folder.path("none/a.svg");
    CHECK_THROWS_AS(makeFigure(task), FileError);
    task.path = folder.path("b.svg");
    task.settings.dpi = 2400;
    task.settings.widthMm = 1000; // 94 488 pixels
    CHECK_THROWS_AS(makeFigure(task), UsageError);
    task.settings = {};
    task.scene.session.field.edit([](FieldView& view) { view.kind = FieldKind::Visibility; });
    CHECK_THROWS_AS(makeFigure(task), Error);
    CHECK_FALSE(std::filesystem::exists(folder.path("b.svg")));
}

TEST_CASE("a figure can be stopped", "[figure]") {
    const TempFolder folder;
    FigureTask task = taskOf(sampleScene(), "picture,shares");
    task.path = folder.path("a.svg");
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(makeFigure(task, {stop.get_token(), {}}), Cancelled);
    CHECK_FALSE(std::filesystem::exists(task.path));
}
