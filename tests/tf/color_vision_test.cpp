// Colours as viewers with a colour-vision deficiency see them.
#include "tf/color_vision.h"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tf/color_spaces.h"

using namespace pellucid;

namespace {

double sumOf(const std::array<double, 3>& row) { return row[0] + row[1] + row[2]; }

/// CIEDE2000 of two colours as a viewer sees them.
double apart(const Rgb& a, const Rgb& b, VisionKind vision, double severity = 1) {
    const LightMatrix m = visionMatrix(vision, severity);
    return ciede2000(labFromSrgb(seenColor(a, m)), labFromSrgb(seenColor(b, m)));
}

void checkIsIdentity(const LightMatrix& m) {
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t c = 0; c < 3; ++c) CHECK(m[row][c] == Approx(row == c ? 1 : 0).margin(1e-15));
}

} // namespace

TEST_CASE("a deficiency of severity 0 changes nothing", "[vision]") {
    for (const VisionKind vision : allOf<VisionKind>()) checkIsIdentity(visionMatrix(vision, 0));
    checkIsIdentity(visionMatrix(VisionKind::Normal, 1));
}

TEST_CASE("greys stay as they are for every viewer", "[vision]") {
    for (const VisionKind vision : allOf<VisionKind>())
        for (int tenth = 0; tenth <= 20; ++tenth) {
            const LightMatrix m = visionMatrix(vision, tenth / 20.0);
            for (const auto& row : m) CHECK(sumOf(row) == Approx(1).margin(1e-12));
            for (const double grey : {0.0, 0.02, 0.5, 1.0}) {
                const Rgb seen = seenColor({grey, grey, grey}, m);
                CHECK(seen.r == Approx(grey).margin(1e-9));
                CHECK(seen.g == Approx(grey).margin(1e-9));
                CHECK(seen.b == Approx(grey).margin(1e-9));
            }
        }
}

TEST_CASE("severities have the published numbers at tenths and lie on lines between", "[vision]") {
    // Machado, Oliveira and Fernandes 2009, first row of protanomaly 0.6 and of deuteranomaly 0.3.
    CHECK(visionMatrix(VisionKind::Protanopia, 0.6)[0][0] == Approx(0.385450).margin(2e-6));
    CHECK(visionMatrix(VisionKind::Deuteranopia, 0.3)[0][1] == Approx(0.433850).margin(2e-6));
    CHECK(visionMatrix(VisionKind::Tritanopia, 1)[2][1] == Approx(0.691367).margin(2e-6));
    // (0.539009 + 0.458064) / 2
    CHECK(visionMatrix(VisionKind::Protanopia, 0.45)[0][0] == Approx(0.4985365).margin(2e-6));
}

TEST_CASE("who lacks cones sees less of the colours that these tell apart", "[vision]") {
    // Red and green lie 86.6 apart; along the reds and greens dichromats lose at least half of it. Blue and yellow are
    // as far apart to them.
    const Rgb red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, yellow{1, 1, 0};
    const double normal = apart(red, green, VisionKind::Normal);
    CHECK(normal == Approx(86.6).margin(0.1));
    CHECK(apart(red, green, VisionKind::Deuteranopia) < normal / 2);
    CHECK(apart(blue, yellow, VisionKind::Deuteranopia) > 80);
    CHECK(apart(blue, yellow, VisionKind::Protanopia) > 80);
    // Reds are dark without the cones for long waves, as bright as ever without those for short ones.
    const auto lightness = [&](VisionKind vision) {
        return labFromSrgb(seenColor(red, visionMatrix(vision))).lightness;
    };
    CHECK(lightness(VisionKind::Protanopia) < 0.9 * lightness(VisionKind::Normal));
    CHECK(lightness(VisionKind::Tritanopia) > 0.95 * lightness(VisionKind::Normal));
    // The stronger the deficiency, the less they differ.
    double before = normal;
    for (const double severity : {0.2, 0.4, 0.6, 0.8}) {
        const double now = apart(red, green, VisionKind::Deuteranopia, severity);
        CHECK(now < before);
        before = now;
    }
}

TEST_CASE("in grey a colour keeps its luminance and no more", "[vision]") {
    const Rgb color{0.9, 0.3, 0.1};
    const Rgb grey = seenColor(color, visionMatrix(VisionKind::Grey));
    CHECK(grey.r == Approx(grey.g).margin(1e-12));
    CHECK(grey.r == Approx(grey.b).margin(1e-12));
    CHECK(labFromSrgb(grey).lightness == Approx(labFromSrgb(color).lightness).margin(1e-3));
}

TEST_CASE("a picture is seen pixel by pixel, and stays as transparent as it was", "[vision]") {
    Image image(2, 1);
    const float pixels[] = {0.9F, 0.2F, 0.1F, 0.25F, 0.5F, 0.5F, 0.5F, 1.0F};
    std::copy(std::begin(pixels), std::end(pixels), image.rgba.begin());
    const LightMatrix m = visionMatrix(VisionKind::Deuteranopia);
    simulateVision(image, m);
    const Rgb seen = seenColor({0.9F, 0.2F, 0.1F}, m);
    CHECK(image.pixel(0, 0)[0] == Approx(seen.r));
    CHECK(image.pixel(0, 0)[1] == Approx(seen.g));
    CHECK(image.pixel(0, 0)[2] == Approx(seen.b).margin(1e-6));
    CHECK(image.pixel(0, 0)[3] == 0.25F);
    CHECK(image.pixel(1, 0)[0] == Approx(0.5).margin(1e-6));
}
