#include <limits>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "volume/volume.h"

using namespace pellucid;

namespace {

const Geometry kLine{{4, 1, 1}, {1, 1, 1}, {0, 0, 0}};

} // namespace

TEST_CASE("intensity is linear in the window and clamped outside", "[volume]") {
    const Volume volume = Volume(kLine, std::vector<std::int16_t>{-100, 0, 50, 300}).withRange({0, 200});
    CHECK(volume.intensity(0) == 0.0);
    CHECK(volume.intensity(1) == 0.0);
    CHECK(volume.intensity(2) == 0.25); // 50 / 200
    CHECK(volume.intensity(3) == 1.0);
    CHECK(volume.valueOfIntensity(0.25) == 50.0);
    CHECK(volume.dataRange() == ValueRange{-100, 300});
}

TEST_CASE("NaN and infinity are invalid and outside the range", "[volume]") {
    const Volume volume(kLine, std::vector<float>{NAN, 2, INFINITY, -1});
    CHECK(volume.invalidCount() == 2);
    CHECK(volume.dataRange() == ValueRange{-1, 2});
    CHECK(!volume.isValid(0));
    CHECK(volume.isValid(1));
    CHECK(std::isnan(volume.intensity(2)));
    CHECK(volume.intensity(1) == 1.0);
    CHECK(volume.hasValidVoxels());
    CHECK(!volume.isConstant());
}

TEST_CASE("values further apart than the largest double have intensities", "[volume]") {
    // hi − lo = 3.4e308 is infinite in double precision; 0 lies in the middle.
    const Volume volume(kLine, std::vector<double>{-1.7e308, 0, 0.85e308, 1.7e308});
    CHECK(volume.intensity(0) == 0.0);
    CHECK(volume.intensity(1) == 0.5);
    CHECK(volume.intensity(2) == Approx(0.75));
    CHECK(volume.intensity(3) == 1.0);
}

TEST_CASE("another window shares the samples", "[volume]") {
    const Volume volume(kLine, std::vector<double>{1, 2, 3, 4});
    const Volume other = volume.withRange({2, 3});
    CHECK(&volume.samples() == &other.samples());
    CHECK(volume.range() == ValueRange{1, 4});
    CHECK(other.dataRange() == ValueRange{1, 4});
    for (const ValueRange& bad : {ValueRange{3, 2}, ValueRange{2, 2}, ValueRange{NAN, 1}, ValueRange{0, INFINITY}})
        CHECK_THROWS_AS(volume.withRange(bad), UsageError);
}

TEST_CASE("geometry and samples must agree", "[volume]") {
    const std::vector<std::uint8_t> four(4);
    CHECK_THROWS_AS(Volume({{5, 1, 1}, {1, 1, 1}, {0, 0, 0}}, four), Error);
    CHECK_THROWS_AS(Volume({{4, 1, 0}, {1, 1, 1}, {0, 0, 0}}, std::vector<std::uint8_t>()), Error);
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL})
        CHECK_THROWS_AS(Volume({{4, 1, 1}, {1, bad, 1}, {0, 0, 0}}, four), Error);
    CHECK_THROWS_AS(Volume({{4, 1, 1}, {1, 1, 1}, {0, NAN, 0}}, four), Error);
}

TEST_CASE("the box reaches half a voxel beyond the outer centres", "[volume]") {
    const Geometry g{{4, 3, 2}, {1, 2, 4}, {10, 20, 30}};
    CHECK(g.boundsMin() == Vec3(9.5, 19, 28));
    CHECK(g.boundsMax() == Vec3(13.5, 25, 36)); // 10 + 3.5·1, 20 + 2.5·2, 30 + 1.5·4
    CHECK(g.boxCenter() == Vec3(11.5, 22, 32));
    CHECK(g.d0() == 1.0);
    CHECK(g.worldFromVoxel({1, 2, 1}) == Vec3(11, 24, 34));
    CHECK(g.voxelFromWorld({11, 24, 34}) == Vec3(1, 2, 1));
}

TEST_CASE("sample types have the names of the command line", "[volume]") {
    std::size_t bytes = 0;
    for (const char* text : {"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"}) {
        const auto type = findNamed<SampleType>(text);
        REQUIRE(type);
        CHECK(std::string(name(*type)) == text);
        bytes += bytesPerSample(*type);
    }
    CHECK(bytes == 1 + 1 + 2 + 2 + 4 + 4 + 4 + 8);
    CHECK(!findNamed<SampleType>("u64"));
    CHECK(!findNamed<SampleType>(""));
    CHECK(Volume(kLine, std::vector<std::uint32_t>(4)).sampleType() == SampleType::U32);
    CHECK(Volume(kLine, std::vector<std::uint32_t>(4)).memoryBytes() == 16);
}
