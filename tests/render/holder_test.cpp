// What an object lies on: boards are found, and what runs through the data because it is the object is not.
#include <catch2/catch.hpp>

#include "render/drawn_part.h"
#include "render/holder.h"
#include "support/volumes.h"
#include "tf/opacity.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

TransferFunction solid(double alpha = 0.8) {
    TransferFunction tf;
    tf.points = {{0.4, 0, {1, 1, 1}, false, {}}, {0.4, alpha, {1, 1, 1}, false, {}}, {1, alpha, {1, 1, 1}, false, {}}};
    tf.features = {{"all", 0.4, 1, {1, 1, 1}, {}}};
    return tf;
}

using Solid = std::function<bool(const Vec3& voxel)>;
std::shared_ptr<const Volume> made(const Solid& solidAt, Int3 dims = Int3(48)) {
    return volumeFrom(geometryOf(dims), [&](int i, int j, int k) { return solidAt(Vec3(i, j, k)) ? 0.9 : 0.0; });
}

bool inBall(const Vec3& v, const Vec3& middle, double radius) { return glm::length(v - middle) < radius; }

/// A board 3 thick in y, 40 wide in x, from border to border along z, that sags by `sag` in its middle; a ball lies on
/// it.
bool onBoard(const Vec3& v, double sag) {
    const double top = 36 + sag * (1 - std::pow((v.x - 24) / 20, 2));
    return (std::abs(v.x - 24) < 20 && v.y >= top && v.y < top + 3) || inBall(v, {24, 36 + sag - 14, 24}, 14);
}

} // namespace

TEST_CASE("a board is found on its side of what lies on it, flat or sagging", "[holder]") {
    const double sag = GENERATE(0.0, 3.0);
    const auto volume = made([&](const Vec3& v) { return onBoard(v, sag); });
    const auto holder = findHolder(*volume, solid());
    REQUIRE(holder);
    CHECK(holder->along == 2);
    CHECK(holder->axis == 1);
    CHECK(holder->isHigh);
    CHECK(holder->toward == Vec3(0, 1, 0));
    CHECK(holder->lost <= 0.05);
    // Without it the ball alone is left, nearly all of it: 28 across, in the middle of x and z.
    CHECK_NOTHROW(holder->without.validate());
    Clipping left;
    left.setPart(holder->without);
    Vec3 lo(1e300), hi(-1e300);
    for (const Vec3& p : drawnPart(*volume, solid(), left)) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    CHECK(lo.z > 9);
    CHECK(hi.z < 39);
    CHECK(hi.y <= 37 + sag);
    CHECK(hi.y - lo.y > 25);
}

TEST_CASE("a board is found along any axis, on either side", "[holder]") {
    const int turn = GENERATE(0, 1, 2);
    const bool mirrored = GENERATE(false, true);
    CAPTURE(turn, mirrored);
    const auto volume = made([&](Vec3 v) {
        if (mirrored) v = Vec3(47) - v;
        return onBoard({v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]}, 0);
    });
    const auto holder = findHolder(*volume, solid());
    REQUIRE(holder);
    CHECK(holder->along == (turn + 2) % 3);
    CHECK(holder->axis == (turn + 1) % 3);
    CHECK(holder->isHigh != mirrored);
}

TEST_CASE("what is no board is none", "[holder]") {
    const auto isFound = [](const Solid& s) { return findHolder(*made(s), solid()).has_value(); };
    CHECK_FALSE(isFound([](const Vec3& v) { return inBall(v, Vec3(24), 15); }));
    // A leg with a bone runs through because it goes on, and so does its skin.
    CHECK_FALSE(isFound([](const Vec3& v) {
        const double r = glm::length(Vec3(v.x - 24, v.y - 24, 0));
        return r < 6 || (r > 17 && r < 20);
    }));
    // A thick slab under a ball is half of the object; a plate alone is the object.
    CHECK_FALSE(isFound([](const Vec3& v) { return v.y >= 30 || inBall(v, {24, 18, 24}, 12); }));
    CHECK_FALSE(isFound([](const Vec3& v) { return v.y >= 30 && v.y < 33; }));
    CHECK_FALSE(isFound([](const Vec3&) { return false; }));
    // One through the middle of the object: no box parts them.
    CHECK_FALSE(isFound([](const Vec3& v) { return (v.y >= 23 && v.y < 25) || inBall(v, Vec3(24), 18); }));
}

TEST_CASE("a faint board is as transparent as it should be, whatever its opacity", "[holder]") {
    // 3 voxels of opacity α across: of the depth 3·τ(α) that part is kept with which 15 % are opaque. Where it is
    // hardly seen anyway, no more than a half. The box takes a sliver of the ball along.
    const auto volume = made([&](const Vec3& v) { return onBoard(v, 0); });
    const auto holder = findHolder(*volume, solid());
    REQUIRE(holder);
    for (const double alpha : {0.1, 0.5, 0.9}) {
        const FaintRest rest = faintRest(*holder, *volume, solid(alpha));
        CHECK(rest.within == holder->without);
        CHECK(3 * rest.density * opticalDepthOfOpacity(alpha) ==
              Approx(opticalDepthOfOpacity(kFaintHolder)).epsilon(0.05));
    }
    CHECK(faintRest(*holder, *volume, solid(0.001)).density == 0.5);
}

TEST_CASE("a head rest that bends around a head is found, and planes part it from the head", "[holder]") {
    // A head of radius 15, a shell of radius 21 and thickness 1.5 under it, which follows the head down by 6 voxels on
    // its way along z, as scanners that are tilted have it. Its bottom may lie outside the data.
    const double down = GENERATE(0.0, 8.0);
    CAPTURE(down);
    const auto isHead = [&](const Vec3& v) { return inBall(v, {32, 26 + down, 32}, 15); };
    const auto isRest = [&](const Vec3& v) {
        const double middle = 26 + down + 6 * (v.z / 63 - 0.5), r = std::hypot(v.x - 32, v.y - middle);
        return r > 21 && r < 22.5 && v.y > middle + 8;
    };
    const auto volume = made([&](const Vec3& v) { return isHead(v) || isRest(v); }, Int3(64));
    const auto holder = findHolder(*volume, solid());
    REQUIRE(holder);
    CHECK(holder->along == 2);
    CHECK(holder->axis == 1);
    CHECK(holder->isHigh);
    CHECK(holder->toward.y > 0.9);
    CHECK(holder->lost == 0);
    CHECK_NOTHROW(holder->without.validate());
    int cut = 0, head = 0, left = 0, rest = 0;
    const auto planes = planesInVoxels(holder->without, volume->geometry());
    for (int k = 0; k < 64; ++k)
        for (int j = 0; j < 64; ++j)
            for (int i = 0; i < 64; ++i) {
                const Vec3 v(i, j, k);
                head += isHead(v);
                rest += isRest(v);
                cut += isHead(v) && !keeps(planes, v);
                left += isRest(v) && keeps(planes, v);
            }
    CHECK(cut == 0);
    CHECK(left < 0.05 * rest);
    CHECK(head > 10000); // there is something to compare
    CHECK(rest > 1000);
}

TEST_CASE("what is thin and beside something is no head rest by that alone", "[holder]") {
    const auto isFound = [](const Solid& s) { return findHolder(*made(s, Int3(64)), solid()).has_value(); };
    // A wire from border to border; a shell that ends inside the data; two on opposite sides of the head, neither of
    // which it lies on.
    CHECK_FALSE(isFound([](const Vec3& v) { return inBall(v, Vec3(32), 18) || std::hypot(v.x - 8, v.y - 8) < 1.5; }));
    CHECK_FALSE(isFound([](const Vec3& v) {
        const double r = std::hypot(v.x - 32, v.y - 30);
        return inBall(v, {32, 30, 32}, 15) || (r > 21 && r < 22.5 && v.y > 34 && v.z > 12 && v.z < 52);
    }));
    CHECK_FALSE(isFound([](const Vec3& v) {
        const double r = std::hypot(v.x - 31.5, v.y - 31.5);
        return inBall(v, Vec3(31.5), 18) || (r > 21 && r < 22.2 && std::abs(v.y - 31.5) > 13);
    }));
    // Nor is anything where all is thin.
    CHECK_FALSE(isFound([](const Vec3& v) { return std::abs(glm::length(v - Vec3(32, 32, v.z)) - 20) < 0.8; }));
}
