#include "render/slice.h"

#include <catch2/catch.hpp>

#include "base/error.h"
#include "support/volumes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// 8³ voxels; each value says where the voxel is: i + 10·j + 100·k.
std::shared_ptr<const Volume> numbered(const Geometry& geometry) {
    return volumeFrom(
        geometry, [](int i, int j, int k) { return i + 10.0 * j + 100.0 * k; }, std::nullopt);
}

SlicePlane wholePlane(const Geometry& geometry, int axis, double position, int width, int height) {
    return {axis, position, fittedSlice(geometry, axis, width, height), width, height};
}

/// Grey alone, black and white at 0 and 1000.
SliceSettings grey() {
    SliceSettings settings;
    settings.window = {0, 1000};
    settings.tfStrength = 0;
    return settings;
}

} // namespace

TEST_CASE("a pixel of a slice per voxel shows the voxels' values", "[slice]") {
    const auto volume = numbered(geometryOf({8, 8, 8}, {1, 1, 1}, {5, -3, 2}));
    const Geometry& g = volume->geometry();
    // In the file's own frame the right and upper edges of a picture are where coordinates are large: pixel (x, y) of
    // the slice across z is voxel (x, 7 − y), across y it is (x, ·, 7 − y) and across x it is (·, x, 7 − y).
    const auto expected = [](int axis, int x, int y) {
        const int up = 7 - y;
        const Int3 v = axis == 0 ? Int3(3, x, up) : axis == 1 ? Int3(x, 3, up) : Int3(x, up, 3);
        return v.x + 10.0 * v.y + 100.0 * v.z;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const bool linear : {true, false}) {
            SliceSettings settings = grey();
            settings.linear = linear;
            const SlicePlane plane = wholePlane(g, axis, 3, 8, 8);
            const Image image = renderSlice(*volume, tents(3), plane, settings);
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) {
                    const Vec2 pixel{x + 0.5, y + 0.5};
                    CHECK(image.pixel(x, y)[0] * 1000 == Approx(expected(axis, x, y)).margin(1e-3));
                    CHECK(image.pixel(x, y)[3] == 1);
                    const Vec3 voxel = voxelAtPixel(g, plane, pixel);
                    CHECK(valueAt(*volume, voxel, linear).value() == Approx(expected(axis, x, y)).margin(1e-9));
                    CHECK(glm::length(pixelOfVoxel(g, plane, voxel) - pixel) < 1e-9);
                    CHECK(glm::length(g.worldFromVoxel(voxel) - (voxel + Vec3(5, -3, 2))) < 1e-12);
                }
        }
}

TEST_CASE("between planes and pixels of a slice values are linear", "[slice]") {
    const auto volume = numbered(geometryOf({8, 8, 8}));
    const Geometry& g = volume->geometry();
    // The value is a linear function of the place, so that trilinear interpolation gives it everywhere but within half
    // a voxel of the sides, where it is clamped.
    const SlicePlane plane = wholePlane(g, 2, 2.25, 32, 32);
    const Image image = renderSlice(*volume, tents(3), plane, grey());
    for (int y = 2; y < 30; ++y)
        for (int x = 2; x < 30; ++x) {
            const Vec3 v{(x + 0.5) / 4 - 0.5, 7.5 - (y + 0.5) / 4, 2.25};
            CHECK(image.pixel(x, y)[1] * 1000 == Approx(v.x + 10 * v.y + 100 * v.z).margin(1e-3));
        }
    CHECK(image.pixel(0, 31)[1] * 1000 == Approx(225).margin(1e-3)); // voxel (−0.375, −0.375) has the edge's value
    SliceSettings nearest = grey();
    nearest.linear = false;
    CHECK(renderSlice(*volume, tents(3), plane, nearest).pixel(9, 9)[0] * 1000 ==
          Approx(252).margin(1e-3)); // (2, 5, 2)
}

TEST_CASE("slices keep the proportions of the box, and nothing is beyond it", "[slice]") {
    // 8 voxels of 1 by 4 of 3: 8 wide and 12 high. In 40 × 24 pixels that is 16 × 24, from pixel 12 to 28.
    const auto volume = slab({8, 5, 4}, 0.5, {1, 2, 3});
    const SlicePlane plane = wholePlane(volume->geometry(), 1, 2, 40, 24);
    CHECK(plane.shown == SliceRect{-6, 0, 20, 12});
    SliceSettings settings = grey();
    settings.window = {0, 1};
    const Image image = renderSlice(*volume, tents(3), plane, settings);
    for (const int y : {0, 11, 23})
        for (int x = 0; x < 40; ++x) CHECK(image.pixel(x, y)[3] == (x >= 12 && x < 28 ? 1 : 0));
    for (const double beyond : {-0.51, 4.51}) {
        const Image none = renderSlice(*volume, tents(3), wholePlane(volume->geometry(), 1, beyond, 4, 4), settings);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) CHECK(none.pixel(x, y)[3] == 0);
    }
    CHECK(slicePosition(volume->geometry(), 0, 0.5) == 3.5);
    CHECK_FALSE(valueAt(*volume, {8, 0, 0}));
}

TEST_CASE("colours of the transfer function lie over the grey by their strength", "[slice]") {
    const auto volume = slab({4, 4, 4}, 0.5);
    TransferFunction tf = homogeneous(0.1); // red
    const double k = 1 - std::pow(0.9, 16); // a slab of 16 d0
    const Rgb red = tf.color(0.5);
    for (const double w : {0.0, 0.25, 0.5, 0.8, 1.0}) {
        SliceSettings settings;
        settings.window = {0, 2}; // grey 0.25
        settings.tfStrength = w;
        const Image image = renderSlice(*volume, tf, wholePlane(volume->geometry(), 2, 1, 2, 2), settings);
        const double under = (1 - w * k) * std::min(1.0, 2 - 2 * w) * 0.25;
        CHECK(image.pixel(1, 1)[0] == Approx(under + w * k * red.r).margin(1e-5));
        CHECK(image.pixel(1, 1)[2] == Approx(under + w * k * red.b).margin(1e-5));
    }
}

TEST_CASE("invalid voxels and what is clipped away are transparent in slices", "[slice]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto volume = volumeFrom(geometryOf({4, 4, 4}), [&](int i, int, int) { return i == 1 ? nan : 0.5; });
    SliceSettings settings = grey();
    settings.window = {0, 1};
    settings.clipping.hi.x = 0.75; // voxels 0, 1, 2 are left
    const Image image = renderSlice(*volume, tents(3), wholePlane(volume->geometry(), 2, 1, 16, 16), settings);
    // A voxel is four pixels wide; one that is invalid has more than half the weight where it is the nearest.
    for (int x = 0; x < 16; ++x) {
        CHECK(image.pixel(x, 5)[3] == (x < 4 || (x >= 8 && x < 12) ? 1 : 0));
        if (image.pixel(x, 5)[3] > 0) CHECK(image.pixel(x, 5)[0] == Approx(0.5f));
    }
    CHECK_FALSE(valueAt(*volume, {1, 1, 1}));
    CHECK(valueAt(*volume, {0.4, 1, 1}).value() == 0.5);
}

TEST_CASE("slices of a patient are turned as radiologists are used to, however the file stores them", "[slice]") {
    // A bright voxel at the patient's left, front and top: world (+, −, +) of LPS.
    Geometry g = geometryOf({6, 6, 6});
    g.worldAxes = WorldAxes::Patient;
    const auto value = [](const Vec3& world) { return world == Vec3(5, 0, 5) ? 1.0 : 0.1 + 0.05 * world.x; };
    const auto make = [&](const Geometry& geometry) {
        return volumeFrom(geometry, [&](int i, int j, int k) {
            return value(glm::round(geometry.worldFromVoxel({i, j, k})));
        });
    };
    const auto plain = make(g);
    CHECK(std::string(sliceName(g, 0)) == "sagittal");
    CHECK(std::string(sliceName(g, 1)) == "coronal");
    CHECK(std::string(sliceName(g, 2)) == "axial");
    SliceSettings settings = grey();
    settings.window = {0, 1};
    const auto slice = [&](const Volume& v, int axis, double position) {
        return renderSlice(v, tents(3), wholePlane(v.geometry(), axis, position, 6, 6), settings);
    };
    CHECK(slice(*plain, 2, 5).pixel(5, 0)[0] == 1); // axial, at the top: left at the right, anterior up
    CHECK(slice(*plain, 1, 0).pixel(5, 0)[0] == 1); // coronal, at the front: left at the right, superior up
    CHECK(slice(*plain, 0, 5).pixel(0, 0)[0] == 1); // sagittal, at the left side: anterior at the left, superior up

    // The same patient with every axis stored backwards, and with axes in another order.
    Geometry flipped = g;
    flipped.directions = Mat3(-1);
    flipped.origin = {5, 5, 5};
    Geometry turned = g; // i runs to S, j to R, k to P
    turned.directions = {Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, 1, 0)};
    turned.origin = {5, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
        const Image expected = slice(*plain, axis, 4);
        CHECK(slice(*make(flipped), axis, 1).rgba == expected.rgba);
        const int stored = axis == 0 ? 1 : axis == 1 ? 2 : 0;
        CHECK(std::string(sliceName(turned, stored)) == sliceName(g, axis));
        CHECK(slice(*make(turned), stored, axis == 0 ? 1 : 4).rgba == expected.rgba);
    }
}

TEST_CASE("settings of slices that make no sense are wrong usage", "[slice]") {
    SliceSettings settings = grey();
    settings.tfStrength = 1.5;
    CHECK_THROWS_AS(settings.validate(), UsageError);
    settings.tfStrength = 1;
    settings.window = {1, 0};
    CHECK_THROWS_AS(settings.validate(), UsageError);
}
