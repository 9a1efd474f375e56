// Shares as bar charts: their lengths, numbers and colours, in drawings and in pictures.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "image_io/image_file.h"
#include "report/image_plot.h"
#include "report/share_bars.h"
#include "report/svg_plot.h"

using namespace pellucid;

namespace {

PlotPage page(double width) {
    return {.width = width, .fontSize = 10, .textWidth = [](const std::string& text) {
                return 6.0 * static_cast<double>(text.size());
            }};
}

/// A green feature that is seen more, and a white one that is more salient.
std::vector<ShareBar> example() {
    TransferFunction tf;
    tf.features = {{"outside", 0, 0.5, Rgb{0, 1, 0}, {}}, {"core", 0.5, 1, Rgb{1, 1, 1}, {}}};
    return shareBarsOf(tf, {{0.75, 0.4, 0.5, 0.3}, {0.25, 0.6, 0.5, 0.7}});
}

std::vector<PlotArea> ownAreas(const PlotDrawing& drawing) {
    std::vector<PlotArea> own;
    std::copy_if(drawing.areas.begin(), drawing.areas.end(), std::back_inserter(own),
                 [](const PlotArea& a) { return a.ink == PlotInk::Own; });
    return own;
}

bool hasText(const PlotDrawing& drawing, const std::string& text) {
    return std::any_of(drawing.texts.begin(), drawing.texts.end(), [&](const PlotText& t) { return t.text == text; });
}

std::string folder() {
    const auto path = std::filesystem::temp_directory_path() / "pellucid_share_bars_test";
    std::filesystem::create_directories(path);
    return path.string();
}

} // namespace

TEST_CASE("bar charts tell each share by its height and to four digits (thesis figure 4.5)", "[share_bars]") {
    const PlotDrawing drawing = chartsOf(example(), page(1000));
    for (const char* text :
         {"Feature visibility", "VWS of brightness", "VWS of saturation", "Visibility-weighted saliency", "0.7500",
          "0.2500", "0.5000", "0.3000", "0.7000", "0.4000", "0.6000", "outside", "core"})
        CHECK(hasText(drawing, text));
    CHECK_FALSE(hasText(drawing, "2D feature saliency"));
    // Visibility, brightness, saturation, VWS; two features each. All have one scale: a rim of 1 around each bar.
    const std::vector<PlotArea> bars = ownAreas(drawing);
    REQUIRE(bars.size() == 8);
    const auto height = [&](std::size_t i) { return bars[i].hi.y - bars[i].lo.y + 2; };
    const std::vector<double> shares{0.75, 0.25, 0.5, 0.5, 0.3, 0.7, 0.4, 0.6};
    for (std::size_t i = 0; i < shares.size(); ++i) {
        CHECK(height(i) == Approx(height(0) * shares[i] / 0.75));
        CHECK(bars[i].color == (i % 2 == 0 ? Rgb{0, 1, 0} : Rgb{1, 1, 1}));
        CHECK(bars[i].hi.y == Approx(bars[0].hi.y)); // side by side
        if (i > 0) CHECK(bars[i].lo.x > bars[i - 1].hi.x);
    }
}

TEST_CASE("bar charts stand below each other where there is no room beside", "[share_bars]") {
    const PlotDrawing wide = chartsOf(example(), page(1000)), narrow = chartsOf(example(), page(500)),
                      slim = chartsOf(example(), page(150));
    CHECK(narrow.height == Approx(2 * wide.height)); // two beside each other, not three and one
    CHECK(slim.height == Approx(4 * wide.height));
    for (const PlotDrawing* drawing : {&wide, &narrow, &slim})
        for (const PlotArea& a : drawing->areas) {
            CHECK(a.lo.x >= 0);
            CHECK(a.hi.x <= drawing->width);
            CHECK(a.lo.y >= 0);
            CHECK(a.hi.y <= drawing->height);
        }
}

TEST_CASE("bar charts have targets, 2D saliency and nothing that is unknown", "[share_bars]") {
    std::vector<ShareBar> bars = example();
    for (ShareBar& bar : bars) bar.vwsBrightness = bar.vwsSaturation = {};
    bars[0].target = 0.9;
    bars[0].fs = 0.125;
    const PlotDrawing drawing = chartsOf(bars, page(1000));
    CHECK_FALSE(hasText(drawing, "VWS of brightness"));
    CHECK(hasText(drawing, "2D feature saliency"));
    CHECK(hasText(drawing, "0.1250"));
    const std::vector<PlotArea> own = ownAreas(drawing);
    REQUIRE(own.size() == 5); // two of visibility, two of VWS, one of 2D saliency
    // The line of the target: 0.9 of the scale on which the VWS of 0.4 has its height.
    REQUIRE(drawing.strokes.size() == 1);
    const double bottom = own[2].hi.y + 1, unit = (bottom - (own[2].lo.y - 1)) / 0.4;
    CHECK(drawing.strokes[0].points[0].y == Approx(bottom - 0.9 * unit));
    CHECK(drawing.strokes[0].dashed);
}

TEST_CASE("nothing to see has bars of no height", "[share_bars]") {
    TransferFunction tf;
    tf.features = {{"nothing", 0, 1, Rgb{1, 0, 0}, {}}};
    const PlotDrawing drawing = chartsOf(shareBarsOf(tf, {{0, 0, 0, 0}}), page(400));
    for (const PlotArea& bar : ownAreas(drawing)) CHECK(bar.lo.y <= bar.hi.y);
    CHECK(hasText(drawing, "0.0000"));
    CHECK_THROWS_AS(writeShareCharts({}, folder() + "/none.svg"), Error);
    CHECK_FALSE(std::filesystem::exists(folder() + "/none.svg"));
}

TEST_CASE("bar charts are written as drawings and as pictures", "[share_bars]") {
    const std::string png = folder() + "/bars.png";
    writeShareCharts(example(), png);
    const Image image = readImage(png);
    CHECK(image.width == 2 * 760); // two pixels each
    std::size_t green = 0, white = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        green += image.rgba[i] == 0 && image.rgba[i + 1] == 1 && image.rgba[i + 2] == 0;
        white += image.rgba[i] == 1 && image.rgba[i + 1] == 1 && image.rgba[i + 2] == 1;
    }
    // All green bars: shares of 0.75, 0.5, 0.3, 0.4 of one scale, as wide as each other.
    const PlotDrawing drawing = chartsOf(example(), imagePage({.width = 760}));
    double area = 0;
    for (const PlotArea& bar : ownAreas(drawing))
        if (bar.color == Rgb{0, 1, 0}) area += (bar.hi.x - bar.lo.x) * (bar.hi.y - bar.lo.y);
    CHECK(static_cast<double>(green) == Approx(4 * area).epsilon(0.03));
    CHECK(white > image.rgba.size() / 8);

    CHECK_THROWS_AS(writeShareCharts(example(), folder() + "/bars.jpg"), UsageError);
    std::filesystem::remove_all(folder());
}
