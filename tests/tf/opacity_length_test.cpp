#include <catch2/catch.hpp>

#include <cmath>

#include "tf/formats/opacity_length.h"

using namespace pellucid;

namespace {

Geometry volume(Int3 dims, Vec3 spacing) {
    Geometry g;
    g.dims = dims;
    g.spacing = spacing;
    return g;
}

} // namespace

TEST_CASE("opacities of longer paths follow the power law, and 1 stays 1", "[tf][length]") {
    // 1 − (1 − a)^r
    CHECK(opacityPer(0.5, 2) == Approx(0.75));
    CHECK(opacityPer(0.75, 0.5) == Approx(0.5));
    CHECK(opacityPer(0.05, 20) == Approx(0.6415).margin(1e-4));
    CHECK(opacityPer(1, 0.01) == 1);
    CHECK(opacityPer(0, 100) == 0);
    CHECK(opacityPer(opacityPer(0.3, 1.7), 1 / 1.7) == Approx(0.3));
}

TEST_CASE("lengths of other programs in world units", "[tf][length]") {
    using Kind = OpacityLength::Kind;
    const Geometry cube = volume(Int3(41), Vec3(1)), slabs = volume({101, 201, 51}, {0.5, 1, 2});
    CHECK(OpacityLength{Kind::Reference, 1}.inWorld(slabs) == 0.5);
    CHECK(OpacityLength{Kind::World, 3}.inWorld(slabs) == 3);
    // A cube of cells of size 1: n·√3 over n.
    CHECK(OpacityLength{Kind::ParaView, 1}.inWorld(cube) == Approx(std::sqrt(3.0)));
    // Edges 50, 200, 100 between centres; 100·200·50 cells of 1.
    CHECK(OpacityLength{Kind::ParaView, 1}.inWorld(slabs) == Approx(std::sqrt(2500 + 40000 + 10000) / 100));
    CHECK(OpacityLength{Kind::Texture, 1.0 / 200}.inWorld(cube) == Approx(41.0 / 200));
    CHECK(OpacityLength{Kind::Texture, 1.0 / 150}.inWorld(slabs) ==
          Approx(std::cbrt(50.5 * 201 * 102) / 150)); // the cube of the same volume
    // One slice has no cells along z: its diagonal over the root of what there is.
    CHECK(OpacityLength{Kind::ParaView, 1}.inWorld(volume({11, 11, 1}, Vec3(1))) ==
          Approx(std::sqrt(200.0) / std::cbrt(100.0)));
}

TEST_CASE("lines between points are bent as the power law bends them", "[tf][length]") {
    TransferFunction tf;
    tf.points = {{0.2, 0, {1, 0, 0}, true, {}}, {0.6, 0.9, {0, 0, 1}, false, {}}, {0.8, 0, {0, 0, 1}, true, {}}};
    tf.features = deriveFeatures(tf);
    for (const double ratio : {0.2, 1 / 1.7320508, 1.0, 1.7320508, 5.0}) {
        const TransferFunction other = withOpacitiesPer(tf, ratio);
        other.validate();
        double most = 0;
        for (int i = 0; i <= 1000; ++i) {
            const double x = i / 1000.0;
            most = std::max(most, std::abs(other.opacity(x) - opacityPer(tf.opacity(x), ratio)));
        }
        INFO(ratio);
        CHECK(most < 0.003); // probed at quarters, 0.002 there
        CHECK(other.color(0.4).r == Approx(0.5));
        CHECK(other.features == tf.features);
        CHECK(other.points.front().x == 0.2); // ends that go without saying stay so
        CHECK(other.points.back().x == 0.8);
    }
    CHECK(withOpacitiesPer(tf, 1) == tf);
}

TEST_CASE("a step stays a step of the same place", "[tf][length]") {
    TransferFunction tf;
    tf.points = {
        {0, 0.1, {}, false, {}}, {0.5, 0.1, {}, false, {}}, {0.5, 0.4, {}, false, {}}, {1, 0.4, {}, false, {}}};
    const TransferFunction other = withOpacitiesPer(tf, 2);
    REQUIRE(other.points.size() == 4);
    CHECK(other.points[1].opacity == Approx(0.19)); // 1 − 0.9²
    CHECK(other.points[2].opacity == Approx(0.64)); // 1 − 0.6²
}
