#include <cmath>

#include <catch2/catch.hpp>

#include "volume/orientation.h"

using namespace pellucid;

namespace {

Geometry patient(const Mat3& directions) {
    Geometry g;
    g.dims = {4, 4, 4};
    g.directions = directions;
    g.worldAxes = WorldAxes::Patient;
    return g;
}

} // namespace

TEST_CASE("directions have the letters of LPS, the larger component first", "[orientation]") {
    CHECK(directionLetters({1, 0, 0}) == "L");
    CHECK(directionLetters({-2, 0, 0}) == "R");
    CHECK(directionLetters({0, 1, 0}) == "P");
    CHECK(directionLetters({0, -1, 0}) == "A");
    CHECK(directionLetters({0, 0, 1}) == "S");
    CHECK(directionLetters({0, 0, -1}) == "I");
    CHECK(directionLetters({1, -0.5, 0}) == "LA"); // tan 22.5° = 0.414 < 0.5
    CHECK(directionLetters({0.5, -1, 0}) == "AL");
    CHECK(directionLetters({1, -0.4, 0.4}) == "L");
    CHECK(directionLetters({0.1, 0.6, -1}) == "IP");
}

TEST_CASE("a text says how the voxels' axes run, and how oblique they are", "[orientation]") {
    CHECK(axesText(patient(Mat3(1))) == "R→L, A→P, I→S");
    // i to the right, j to the front, k up: a RAS file.
    CHECK(axesText(patient(Mat3(Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)))) == "L→R, P→A, I→S");
    // Slices from front to back.
    CHECK(axesText(patient(Mat3(Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0)))) == "R→L, S→I, A→P");
    // Turned by 10° about z.
    const double c = std::cos(std::acos(-1.0) / 18), s = std::sin(std::acos(-1.0) / 18);
    const Geometry oblique = patient(Mat3(Vec3(c, s, 0), Vec3(-s, c, 0), Vec3(0, 0, 1)));
    CHECK(obliqueAngle(oblique) == Approx(10));
    CHECK(axesText(oblique) == "R→L, A→P, I→S, 10° oblique");
    Geometry file = patient(Mat3(Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)));
    file.worldAxes = WorldAxes::File;
    CHECK(axesText(file) == "-y, +x, +z");
    CHECK(obliqueAngle(file) == Approx(0).margin(1e-6));
}
