// Curves of VTK: opacities against VTK 9.1 (vtkPiecewiseFunction), and the straight lines that follow them.
#include <catch2/catch.hpp>

#include <array>

#include "tf/formats/read_curves.h"
#include "tf/formats/tf_curves.h"
#include "tf/lch.h"

using namespace pellucid;

namespace {

constexpr std::array kAt{-1.0, 0.0, 2.0, 4.0, 5.0, 6.0, 8.0, 10.0, 11.0};

TfCurves rising(double midpoint, double sharpness) {
    TfCurves curves;
    curves.opacities = {{0, 0.2, {midpoint, sharpness}}, {10, 0.8, {}}};
    curves.colors = {{0, {1, 1, 1}, {}}, {10, {1, 1, 1}, {}}};
    return curves;
}

TransferFunction tfOf(const TfCurves& curves) {
    TransferFunction tf;
    tf.points = pointsOf(curves, curves.range()).points;
    return tf;
}

} // namespace

TEST_CASE("midpoint and sharpness bend opacities as in VTK", "[tf][curves]") {
    struct Golden {
        double midpoint, sharpness;
        std::array<double, 9> at;
    };
    const Golden all[] = {{0.5, 0, {0.2, 0.2, 0.32, 0.44, 0.5, 0.56, 0.68, 0.8, 0.8}},
                          {0.25, 0, {0.2, 0.2, 0.44, 0.56, 0.6, 0.64, 0.72, 0.8, 0.8}},
                          {0.5, 0.5, {0.2, 0.2, 0.200618, 0.253432, 0.5, 0.746568, 0.799382, 0.8, 0.8}},
                          {0.7, 0.3, {0.2, 0.2, 0.201405, 0.223871, 0.263019, 0.345609, 0.753598, 0.8, 0.8}},
                          {0.5, 1, {0.2, 0.2, 0.2, 0.2, 0.8, 0.8, 0.8, 0.8, 0.8}}};
    for (const Golden& golden : all) {
        const TfCurves curves = rising(golden.midpoint, golden.sharpness);
        const TransferFunction tf = tfOf(curves);
        for (std::size_t i = 0; i < kAt.size(); ++i) {
            INFO(golden.midpoint << ", " << golden.sharpness << " at " << kAt[i]);
            CHECK(opacityAt(curves, kAt[i]) == Approx(golden.at[i]).margin(1e-6));
            // Straight lines come as close as is promised, also to the step.
            CHECK(tf.opacity(kAt[i] / 10) == Approx(golden.at[i]).margin(kOpacityTolerance));
        }
    }
}

TEST_CASE("straight curves stay what they are, point by point", "[tf][curves]") {
    const CurvePoints points = pointsOf(rising(0.5, 0), {0, 10});
    CHECK(!points.areResampled);
    REQUIRE(points.points.size() == 2);
    CHECK(points.points[0] == ControlPoint{0, 0.2, {1, 1, 1}, false, {}});
    CHECK(points.points[1] == ControlPoint{1, 0.8, {1, 1, 1}, false, {}});
}

TEST_CASE("a sharp curve is a step of two points at the midpoint", "[tf][curves]") {
    const std::vector<ControlPoint> points = pointsOf(rising(0.25, 1), {0, 10}).points;
    REQUIRE(points.size() == 4);
    CHECK((points[1].x == 0.25 && points[2].x == 0.25));
    CHECK((points[1].opacity == 0.2 && points[2].opacity == 0.8));
}

TEST_CASE("colours of other spaces are followed to within delta E 1", "[tf][curves]") {
    for (const ColorSpace space : {ColorSpace::Hsv, ColorSpace::HsvWrapped, ColorSpace::Lab, ColorSpace::Diverging,
                                   ColorSpace::Ciede2000, ColorSpace::ProLab}) {
        TfCurves curves = rising(0.5, 0);
        curves.space = space;
        curves.colors = {{0, {0.23, 0.3, 0.75}, {}}, {4, {0.9, 0.8, 0.1}, {}}, {10, {0.7, 0.02, 0.15}, {}}};
        const CurvePoints points = pointsOf(curves, {0, 10});
        TransferFunction tf;
        tf.points = points.points;
        CHECK(points.areResampled);
        double most = 0;
        for (int i = 0; i <= 1000; ++i)
            most = std::max(most, deltaE(labFromSrgb(tf.color(i / 1000.0)), labFromSrgb(colorAt(curves, i / 100.0))));
        INFO(static_cast<int>(space));
        CHECK(most < kCurveTolerance);
    }
}

TEST_CASE("a step space has the right colour from the left point on", "[tf][curves]") {
    TfCurves curves = rising(0.5, 0);
    curves.space = ColorSpace::Step;
    curves.colors = {{0, {1, 0, 0}, {}}, {5, {0, 1, 0}, {}}, {10, {0, 0, 1}, {}}};
    const TransferFunction tf = tfOf(curves);
    CHECK(tf.color(0.001) == Rgb{0, 1, 0});
    CHECK(tf.color(0.499) == Rgb{0, 1, 0});
    CHECK(tf.color(0.501) == Rgb{0, 0, 1});
}

TEST_CASE("between nodes of a logarithmic scale the logarithm counts", "[tf][curves]") {
    TfCurves curves;
    curves.isLogarithmic = true;
    curves.opacities = {{1, 0, {}}, {1000, 0.9, {}}};
    curves.colors = {{1, {0, 0, 0}, {}}, {1000, {1, 1, 1}, {}}};
    CHECK(opacityAt(curves, 10) == Approx(0.3)); // a third of the way
    const TransferFunction tf = tfOf(curves);
    for (const double x : {2.0, 10.0, 50.0, 100.0, 700.0}) {
        INFO(x);
        CHECK(tf.opacity((x - 1) / 999) == Approx(0.3 * std::log10(x)).margin(kOpacityTolerance + 1e-9));
    }
}

TEST_CASE("nodes that share an x are a step, or the last of them counts", "[tf][curves]") {
    TfCurves curves = rising(0.5, 0);
    curves.opacities = {{0, 0, {}}, {5, 0.2, {}}, {5, 0.7, {}}, {5, 0.4, {}}, {10, 0.4, {}}};
    CHECK(tfOf(curves).opacity(0.4999) == Approx(0.2).margin(1e-4));
    CHECK(tfOf(curves).opacity(0.5) == 0.4);
    curves.keepLastOfEach();
    CHECK(curves.opacities.size() == 3);
    CHECK(opacityAt(curves, 2.5) == Approx(0.2)); // half way from 0 to 0.4
}

TEST_CASE("curves with something missing are read and said", "[tf][curves]") {
    TfCurves curves;
    curves.colors = {{2, {1, 0, 0}, {}}, {4, {0, 0, 1}, {}}};
    const ReadTf colors = tfOfCurves(curves, {}, "a");
    CHECK(!colors.hasOpacities);
    CHECK(colors.tf.range == ValueRange{2, 4});
    CHECK(colors.tf.opacity(0.5) == Approx(0.5)); // from 0 to 1
    CHECK(colors.notices.size() == 1);

    TfCurves one;
    one.opacities = {{7, 0.3, {}}};
    const ReadTf point = tfOfCurves(one, {}, "a");
    CHECK(!point.tf.range);
    CHECK(point.tf.opacity(0) == 0.3);
    CHECK(point.tf.opacity(1) == 0.3);
    CHECK(point.notices.size() == 2); // white, and one point

    CHECK_THROWS_AS(tfOfCurves({}, {}, "a"), Error);
}
