#include "volume/ruler.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "base/parallel.h"

using namespace pellucid;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Values i + 10·j + 100·k.
Volume numbered(const Geometry& g, std::optional<double> missing = {}) {
    std::vector<float> values;
    for (int k = 0; k < g.dims.z; ++k)
        for (int j = 0; j < g.dims.y; ++j)
            for (int i = 0; i < g.dims.x; ++i) values.push_back(static_cast<float>(i + 10 * j + 100 * k));
    return Volume(g, Samples(std::move(values)), missing);
}

Geometry gridOf(Int3 dims, Vec3 spacing = Vec3(1), Vec3 origin = Vec3(0)) { return {dims, spacing, origin}; }

/// Turned by angles that no axis is spared by, and sheared.
Geometry oblique() {
    Geometry g = gridOf({9, 8, 7}, {0.7, 1.1, 1.9}, {-40.5, 12.25, 1000});
    g.directions[0] = glm::normalize(Vec3(0.8, 0.5, -0.2));
    g.directions[1] = glm::normalize(Vec3(-0.5, 0.8, 0.3));
    g.directions[2] = glm::normalize(Vec3(0.4, -0.1, 0.9));
    return g;
}

/// The definition, voxel by voxel.
BodyValues slowly(const Volume& volume, const std::function<bool(const Vec3& world)>& holds) {
    std::vector<double> values;
    BodyValues found;
    const Int3& dims = volume.dims();
    for (int k = 0; k < dims.z; ++k)
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) {
                if (!holds(volume.geometry().worldFromVoxel(Vec3(i, j, k)))) continue;
                const std::size_t index = voxelIndex(dims, i, j, k);
                volume.isValid(index) ? values.push_back(volume.value(index)) : void(++found.invalid);
            }
    found.count = values.size();
    if (values.empty()) return found;
    found.lo = *std::min_element(values.begin(), values.end());
    found.hi = *std::max_element(values.begin(), values.end());
    for (const double v : values) found.mean += v / static_cast<double>(values.size());
    for (const double v : values) found.sigma += (v - found.mean) * (v - found.mean);
    found.sigma = std::sqrt(found.sigma / static_cast<double>(values.size()));
    return found;
}

void checkSame(const BodyValues& found, const BodyValues& expected) {
    CHECK(found.count == expected.count);
    CHECK(found.invalid == expected.invalid);
    CHECK(found.mean == Approx(expected.mean).epsilon(1e-12));
    CHECK(found.sigma == Approx(expected.sigma).epsilon(1e-10).margin(1e-12));
    CHECK(found.lo == expected.lo);
    CHECK(found.hi == expected.hi);
}

} // namespace

TEST_CASE("a distance is the length between its ends, an angle that between its legs", "[ruler]") {
    const Ruler distance{.kind = RulerKind::Distance, .points = {{1, 2, 3}, {4, 6, 15}}};
    CHECK(readGeometry(distance).length == Approx(13)); // 3² + 4² + 12² = 13²
    CHECK_FALSE(readGeometry(distance).angle);
    const auto angle = [](const Vec3& a, const Vec3& corner, const Vec3& b) {
        return *readGeometry({.kind = RulerKind::Angle, .points = {a, corner, b}}).angle;
    };
    CHECK(angle({5, 1, 1}, {1, 1, 1}, {1, 9, 1}) == Approx(90));
    CHECK(angle({1, 0, 0}, {0, 0, 0}, {1, 1, 0}) == Approx(45));
    CHECK(angle({-1, 0, 0}, {0, 0, 0}, {1, 0, 0}) == Approx(180));
    CHECK(angle({1, 0, 0}, {0, 0, 0}, {2, 0, 0}) == Approx(0).margin(1e-12));
    // 1e-9 rad, for which an arc cosine would say 0: its cosine is 1 to the last bit.
    CHECK(angle({1, 0, 0}, {0, 0, 0}, {1, 1e-9, 0}) == Approx(1e-9 * 180 / 3.14159265358979).epsilon(1e-6));
}

TEST_CASE("a sphere has the voxels whose centres lie within its radius", "[ruler]") {
    const Volume volume = numbered(gridOf({5, 5, 5}));
    // Around voxel (2, 2, 2), of value 222: itself and its six neighbours, ±1, ±10, ±100.
    const BodyValues seven = valuesInSphere(volume, {2, 2, 2}, 1);
    CHECK(seven.count == 7);
    CHECK(seven.mean == Approx(222));
    CHECK(seven.sigma == Approx(std::sqrt(2 * (1 + 100 + 10000) / 7.0))); // by n, not n − 1
    CHECK(seven.lo == 122);
    CHECK(seven.hi == 322);
    CHECK(seven.outside == 0);
    // A hair less, and the middle alone is left.
    const BodyValues one = valuesInSphere(volume, {2, 2, 2}, 0.999);
    CHECK(one.count == 1);
    CHECK(one.mean == 222);
    CHECK(one.sigma == 0);
    // Between eight voxels and too small for any.
    const BodyValues none = valuesInSphere(volume, {1.5, 1.5, 1.5}, 0.5);
    CHECK(none.count == 0);
    CHECK(none.outside == 0);
}

TEST_CASE("voxels on the surface belong to a sphere, whatever their last bits say", "[ruler]") {
    // 0.1 · 3 > 0.3 in doubles; 7 · 0.1 < 0.7.
    const Volume volume = numbered(gridOf({21, 3, 3}, Vec3(0.1)));
    for (int n = 1; n < 10; ++n) {
        INFO(n);
        const BodyValues found = valuesInSphere(volume, volume.geometry().worldFromVoxel({10, 1, 1}), n / 10.0);
        CHECK(found.hi - found.lo >= 2 * n); // voxels 10 − n and 10 + n are in it
    }
}

TEST_CASE("what of a sphere lies beyond the volume is told", "[ruler]") {
    const Volume volume = numbered(gridOf({5, 5, 5}));
    // Around the corner voxel (0, 0, 0): of seven places three neighbours lie beyond the grid.
    const BodyValues corner = valuesInSphere(volume, {0, 0, 0}, 1);
    CHECK(corner.count == 4);
    CHECK(corner.outside == Approx(3.0 / 7));
    CHECK(corner.mean == Approx((0 + 1 + 10 + 100) / 4.0));
    // Far away from it.
    const BodyValues away = valuesInSphere(volume, {100, 100, 100}, 3);
    CHECK(away.count == 0);
    CHECK(away.outside == 1);
    CHECK(valuesInSphere(volume, {100, 100.5, 100.5}, 0.1).outside == 1); // which holds no place at all
    // So large that places are not counted one by one: 4/3·π·r³ of them, and 125 are there.
    const double r = 5000;
    CHECK(valuesInSphere(volume, {2, 2, 2}, r).outside == Approx(1 - 125 / (4.0 / 3 * M_PI * r * r * r)).epsilon(1e-9));
    CHECK(valuesInSphere(volume, {2, 2, 2}, r).count == 125);
}

TEST_CASE("invalid voxels do not count, and are told", "[ruler]") {
    Geometry g = gridOf({3, 1, 1});
    // NaN by itself, and the declared missing value.
    const Volume volume(g, Samples(std::vector<float>{4, static_cast<float>(kNaN), -999}), -999.0);
    const BodyValues found = valuesInSphere(volume, {1, 0, 0}, 1.5);
    CHECK(found.count == 1);
    CHECK(found.invalid == 2);
    CHECK(found.mean == 4);
    const BodyValues box = valuesInBox(volume, {0.5, -1, -1}, {2.5, 1, 1});
    CHECK(box.count == 0);
    CHECK(box.invalid == 2);
}

TEST_CASE("a box has the voxels between its corners along the axes of the world", "[ruler]") {
    const Volume volume = numbered(gridOf({5, 5, 5}, {2, 1, 1}, {10, 0, 0}));
    // x from 12 to 16 are voxels 1 to 3, y from 1 to 2, z 4 alone: 2 ± 1 in i, 15 ± 5 from j, 400.
    const BodyValues found = valuesInBox(volume, {12, 1, 4}, {16, 2, 4});
    CHECK(found.count == 6);
    CHECK(found.mean == Approx(2 + 15 + 400));
    CHECK(found.sigma == Approx(std::sqrt(2.0 / 3 + 25)));
    CHECK(found.lo == 411);
    CHECK(found.hi == 423);
    CHECK(found.outside == 0);
    // Half of it beyond the end: z 4 and 5, of which there is no 5.
    CHECK(valuesInBox(volume, {12, 1, 4}, {16, 2, 5}).outside == Approx(0.5));
    CHECK(valuesInBox(volume, {-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}).count == 125);
}

TEST_CASE("bodies in oblique, sheared grids hold what the definition says", "[ruler]") {
    const Volume volume = numbered(oblique());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    const Vec3 lo = volume.geometry().boundsMin(), size = volume.geometry().boundsMax() - lo;
    for (int n = 0; n < 50; ++n) {
        const Vec3 at = lo + size * Vec3(unit(random), unit(random), unit(random));
        const Vec3 other = lo + size * Vec3(unit(random), unit(random), unit(random));
        const double r = 0.3 + 6 * unit(random);
        checkSame(valuesInSphere(volume, at, r),
                  slowly(volume, [&](const Vec3& p) { return glm::length(p - at) <= r; }));
        const Ruler box = boxRuler(at, other);
        checkSame(valuesInBox(volume, box.points[0], box.points[1]), slowly(volume, [&](const Vec3& p) {
                      return glm::all(glm::lessThanEqual(box.points[0], p)) &&
                             glm::all(glm::lessThanEqual(p, box.points[1]));
                  }));
    }
}

TEST_CASE("large values keep the digits of a small spread, and threads change no bit", "[ruler]") {
    // 1e8 ± 1 in turn: the mean of squares less the square of the mean would have no digit left.
    Geometry g = gridOf({8, 8, 8});
    std::vector<double> values(512);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1e8 + (i % 2 == 0 ? 1 : -1);
    const Volume volume(g, Samples(std::move(values)));
    const BodyValues found = valuesInBox(volume, {0, 0, 0}, {7, 7, 7});
    CHECK(found.sigma == Approx(1).epsilon(1e-9));
    CHECK(found.mean == Approx(1e8).epsilon(1e-15));
    setThreadCount(1);
    const BodyValues alone = valuesInSphere(numbered(oblique()), {-38, 14, 1003}, 5);
    setThreadCount(3);
    const BodyValues three = valuesInSphere(numbered(oblique()), {-38, 14, 1003}, 5);
    setThreadCount(0);
    CHECK(alone.count > 20);
    CHECK(alone.mean == three.mean);
    CHECK(alone.sigma == three.sigma);
}

TEST_CASE("what cannot be measured is named", "[ruler]") {
    CHECK(rulerProblem({.kind = RulerKind::Distance, .points = {{0, 0, 0}, {0, 0, 0}}}).empty()); // it is 0 long
    CHECK(rulerProblem({.kind = RulerKind::Distance, .points = {{0, 0, 0}}}).find("2 points") != std::string::npos);
    CHECK(rulerProblem({.kind = RulerKind::Angle, .points = {{1, 0, 0}, {1, 0, 0}, {2, 0, 0}}}).find("leg") !=
          std::string::npos);
    CHECK(rulerProblem({.kind = RulerKind::Sphere, .points = {{0, 0, 0}}}).find("radius") != std::string::npos);
    CHECK(rulerProblem({.kind = RulerKind::Sphere, .points = {{0, kNaN, 0}}, .radius = 1}).find("finite") !=
          std::string::npos);
    CHECK(rulerProblem(boxRuler({3, 0, 5}, {1, 2, 4})).empty());
    CHECK(boxRuler({3, 0, 5}, {1, 2, 4}).points[0] == Vec3(1, 0, 4));
}

TEST_CASE("measures get numbers and names of their own", "[ruler]") {
    std::vector<Ruler> rulers;
    const Ruler distance{.kind = RulerKind::Distance, .points = {{0, 0, 0}, {1, 0, 0}}};
    CHECK(addRuler(rulers, distance) == 1);
    CHECK(addRuler(rulers, distance) == 2);
    CHECK(addRuler(rulers, boxRuler({0, 0, 0}, {1, 1, 1})) == 3);
    CHECK(rulers[0].name == "Distance 1");
    CHECK(rulers[1].name == "Distance 2");
    CHECK(rulers[2].name == "Box 1");
    rulers.erase(rulers.begin());
    CHECK(addRuler(rulers, distance) == 4); // no number is used again while later ones are there
    CHECK(rulers.back().name == "Distance 1");
}

TEST_CASE("texts say what was found, with units", "[ruler]") {
    Geometry g = gridOf({5, 5, 5});
    CHECK(textOf({.length = 12.3456789}, g, 1) == "12.3457 units");
    CHECK(labelOf({.length = 12.3456789}, g, 1) == "12.35 units");
    g.worldAxes = WorldAxes::Patient;
    CHECK(labelOf({.length = 12.3456789}, g, 1) == "12.35 mm");
    CHECK(labelOf({.angle = 45.04}, g, 1) == "45.0°");
    const RulerReading reading{.values = valuesInSphere(numbered(g), {0, 0, 0}, 1)};
    // Values 0, 1, 10, 100 of a range of 444: mean 27.75, sigma² = (27.75² + 26.75² + 17.75² + 72.25²)/4 = 41.89².
    INFO(textOf(reading, g, 444));
    CHECK(labelOf(reading, g, 444).starts_with("27.8 ± 41.9"));
    CHECK(textOf(reading, g, 444).find(", 0 to 100, ") != std::string::npos);
    CHECK(textOf(reading, g, 444).find("4 voxels") != std::string::npos);
    CHECK(textOf(reading, g, 444).find("42.9 % outside the volume") != std::string::npos);
}

TEST_CASE("places of a patient can be given as RAS", "[ruler][orientation]") {
    Geometry g = gridOf({5, 5, 5});
    CHECK(inAxes(PatientAxes::Ras, g, Vec3(1, 2, 3)) == Vec3(1, 2, 3)); // the file's own axes
    CHECK(coordinatesText(PatientAxes::Ras, g).empty());
    g.worldAxes = WorldAxes::Patient;
    CHECK(inAxes(PatientAxes::Ras, g, Vec3(1, 2, 3)) == Vec3(-1, -2, 3));
    CHECK(inAxes(PatientAxes::Lps, g, Vec3(1, 2, 3)) == Vec3(1, 2, 3));
    CHECK(coordinatesText(PatientAxes::Ras, g) == "RAS");
    // A box keeps its corners in order, and turns back.
    const Ruler box = boxRuler({1, 2, 3}, {4, 5, 6}), turned = inAxes(PatientAxes::Ras, g, box);
    CHECK(turned.points[0] == Vec3(-4, -5, 3));
    CHECK(inAxes(PatientAxes::Ras, g, turned) == box);
}
