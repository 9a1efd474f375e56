// How the axes of a grid run, and how far its voxels are apart, where the user says it.
#include <catch2/catch.hpp>

#include "base/error.h"
#include "volume/grid_axes.h"
#include "volume/loader.h"
#include "volume/orientation.h"

using namespace pellucid;

namespace {

VolumeSource wholeSample() {
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 24;
    return source;
}

void checkNear(const Vec3& a, const Vec3& b) {
    for (int axis = 0; axis < 3; ++axis) CHECK(a[axis] == Approx(b[axis]).margin(1e-9));
}

} // namespace

TEST_CASE("axes are written as letters of a patient, or along x, y and z", "[orientation]") {
    const GridAxes lps = parseGridAxes("LPS");
    CHECK(lps.patient);
    CHECK(lps.along == std::array<int, 3>{1, 2, 3}); // the world is LPS
    CHECK(parseGridAxes("RAS").along == std::array<int, 3>{-1, -2, 3});
    CHECK(parseGridAxes("SAL").along == std::array<int, 3>{3, -2, 1});
    const GridAxes file = parseGridAxes("+y-x+z");
    CHECK_FALSE(file.patient);
    CHECK(file.along == std::array<int, 3>{2, -1, 3});
    for (const char* text : {"LPS", "RAS", "IRP", "+x+y+z", "-z+x-y"}) CHECK(gridAxesText(parseGridAxes(text)) == text);
    for (const char* text : {"", "LP", "LRS", "lps", "LPSX", "+x+y", "+x+y+x", "xyzxyz", "+x+y+w", "++x-y+"})
        CHECK_THROWS_AS(parseGridAxes(text), UsageError);
}

TEST_CASE("the axes nearest to an oblique grid are those that a reader would name", "[orientation]") {
    Geometry g;
    g.dims = {4, 4, 4};
    // i and j both lean more toward x than toward any other axis; together they can only be x and y.
    g.directions = {Vec3(0.9, 0.43589, 0), Vec3(0.75, -0.66144, 0), Vec3(0, 0, -1)};
    CHECK(gridAxesText(nearestAxes(g)) == "+x-y-z");
    g.worldAxes = WorldAxes::Patient;
    CHECK(gridAxesText(nearestAxes(g)) == "LAI");
}

TEST_CASE("four quarter turns and two mirrors change nothing, and one turns as a screw does", "[orientation]") {
    const GridAxes start = parseGridAxes("+x+y+z");
    CHECK(gridAxesText(turned(start, 2)) == "+y-x+z"); // around z what pointed to +x points to +y
    CHECK(gridAxesText(turned(start, 0)) == "+x+z-y");
    CHECK(gridAxesText(turned(start, 1)) == "-z+y+x");
    for (int axis = 0; axis < 3; ++axis) {
        GridAxes axes = start;
        for (int n = 0; n < 4; ++n) {
            axes = turned(axes, axis);
            CHECK_FALSE(isMirrored(axes));
            CHECK(isComplete(axes));
        }
        CHECK(axes == start);
        CHECK(isMirrored(mirrored(start, axis)));
        CHECK(mirrored(mirrored(start, axis), axis) == start);
    }
    CHECK_FALSE(isComplete(GridAxes{{1, -1, 3}, false}));
}

TEST_CASE("data that are turned keep their values, their middle and their spacing", "[orientation]") {
    VolumeSource source = wholeSample();
    const Volume before = loadVolume(source);
    source.axes = parseGridAxes("ILA");
    const Volume after = loadVolume(source);
    CHECK(axesText(after.geometry()) == "S→I, R→L, P→A");
    CHECK(after.geometry().spacing == before.geometry().spacing);
    checkNear(after.geometry().boxCenter(), before.geometry().boxCenter());
    CHECK(after.samples() == before.samples());
    CHECK(after.range() == before.range());
    REQUIRE(after.inFile);
    CHECK(after.inFile->directions == before.geometry().directions);

    const Volume back = withPlacement(after, {}, {});
    CHECK(back.geometry().directions == before.geometry().directions);
    CHECK(back.geometry().worldAxes == before.geometry().worldAxes);
    checkNear(back.geometry().origin, before.geometry().origin);
    CHECK_FALSE(back.inFile);
    // Said twice it is as said once.
    const Volume twice = withPlacement(after, source.axes, {});
    checkNear(twice.geometry().origin, after.geometry().origin);
    checkNear(withPlacement(twice, {}, {}).geometry().origin, before.geometry().origin);
}

TEST_CASE("parts and coarser copies of turned data lie where they lay in the whole", "[orientation]") {
    VolumeSource source = wholeSample();
    source.axes = parseGridAxes("-z+x-y");
    const Geometry whole = loadVolume(source).geometry();
    source.region = VoxelRegion{{3, 2, 5}, {19, 12, 18}};
    const Geometry part = loadVolume(source).geometry();
    checkNear(part.worldFromVoxel({0, 0, 0}), whole.worldFromVoxel({3, 2, 5}));
    checkNear(part.worldFromVoxel({15, 9, 12}), whole.worldFromVoxel({18, 11, 17}));
    source.downsample = 2;
    const Geometry coarse = loadVolume(source).geometry();
    // Voxel 1 along each axis is the mean of voxels 2 and 3 of the part, 5 and 6 of the whole along i.
    checkNear(coarse.worldFromVoxel({1, 1, 1}), whole.worldFromVoxel({5.5, 4.5, 7.5}));
    source.region = VoxelRegion{{3, 2, 5}, {19, 12, 6}}; // of its one layer each voxel is one voxel thick
    checkNear(loadVolume(source).geometry().worldFromVoxel({1, 1, 0}), whole.worldFromVoxel({5.5, 4.5, 5}));
}

TEST_CASE("lengths of a patient stay millimetres where the axes are called the file's", "[orientation]") {
    Geometry g;
    g.dims = {2, 2, 2};
    g.worldAxes = WorldAxes::Patient;
    const Volume volume(g, SampleArray<float>(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
    const Volume other = withPlacement(volume, parseGridAxes("+x+y+z"), {});
    CHECK(other.geometry().worldAxes == WorldAxes::File);
    CHECK(unitOf(other.geometry()) == LengthUnit::Millimetre);
    CHECK(unitOf(withPlacement(other, {}, {}).geometry()) == LengthUnit::Millimetre);
    g.worldAxes = WorldAxes::File;
    CHECK(unitOf(withPlacement(volume.withGeometry(g), parseGridAxes("+y+x-z"), {}).geometry()) == LengthUnit::Unknown);
}

TEST_CASE("a spacing is written as three distances and a unit", "[orientation]") {
    CHECK(parseGridSpacing("0.2,0.25,1") == GridSpacing{{0.2, 0.25, 1}});
    CHECK(parseGridSpacing("0.2,0.25,1,um") == GridSpacing{{0.2, 0.25, 1}, LengthUnit::Micrometre});
    CHECK(parseGridSpacing("1,1,2,inches").unit == LengthUnit::Inch);
    CHECK(parseGridSpacing("1, 2, 3, um") == parseGridSpacing("1,2,3,um"));
    for (const char* text : {"0.1,2,3e-09", "1,1,1,nm", "0.5,0.25,2,in"})
        CHECK(gridSpacingText(parseGridSpacing(text)) == text);
    for (const char* text :
         {"", "1,1", "1,1,1,1,1", "1,0,1", "1,-1,1", "1,nan,1", "1,1e-13,1", "a,b,c", "1,1,1,", "1,1,1,ells"})
        CHECK_THROWS_AS(parseGridSpacing(text), UsageError);
}

TEST_CASE("data whose spacing the user says keep values and first voxel, in all parts of them", "[orientation]") {
    VolumeSource source = wholeSample();
    const Volume before = loadVolume(source);
    source.spacing = GridSpacing{{0.5, 2, 3}, LengthUnit::Micrometre};
    const Volume after = loadVolume(source);
    const Geometry& whole = after.geometry();
    CHECK(whole.spacing == Vec3(0.5, 2, 3));
    CHECK(whole.d0() == 0.5);
    CHECK(unitOf(whole) == LengthUnit::Micrometre);
    checkNear(whole.worldFromVoxel({0, 0, 0}), before.geometry().worldFromVoxel({0, 0, 0}));
    CHECK(after.samples() == before.samples());
    CHECK(spacingOfData(after) == *source.spacing);
    const Geometry back = withPlacement(after, {}, {}).geometry();
    CHECK(back.spacing == before.geometry().spacing);
    CHECK(back.lengthUnit == before.geometry().lengthUnit);

    source.region = VoxelRegion{{3, 2, 5}, {19, 12, 6}};
    const Geometry part = loadVolume(source).geometry();
    checkNear(part.worldFromVoxel({15, 9, 0}), whole.worldFromVoxel({18, 11, 5}));
    source.downsample = 2; // but for the one layer of voxels, which is as thin as it was
    const Volume coarse = loadVolume(source);
    checkNear(coarse.geometry().spacing, {1, 4, 3});
    checkNear(coarse.geometry().worldFromVoxel({1, 1, 0}), whole.worldFromVoxel({5.5, 4.5, 5}));
    checkNear(spacingOfData(coarse).distances, {0.5, 2, 3});

    // Turned besides: the middle of the box that these distances make stays.
    source.region.reset();
    source.downsample = 0;
    source.axes = parseGridAxes("-z+x-y");
    const Volume turned = loadVolume(source);
    checkNear(turned.geometry().boxCenter(), whole.boxCenter());
    CHECK(turned.geometry().spacing == Vec3(0.5, 2, 3));
    REQUIRE(turned.inFile);
    CHECK(turned.inFile->spacing == before.geometry().spacing);
    CHECK(turned.inFile->directions == before.geometry().directions);
}

TEST_CASE("a spacing is in the unit of the file unless it names one", "[orientation]") {
    Geometry g;
    g.dims = {2, 2, 2};
    g.origin = {3, 0, 0};
    g.lengthUnit = LengthUnit::Millimetre;
    const SampleArray<float> samples(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
    const auto placed = [&](const char* spacing) {
        return withPlacement(Volume(g, samples), {}, parseGridSpacing(spacing)).geometry();
    };
    CHECK(unitOf(placed("1,2,3")) == LengthUnit::Millimetre);
    // Whatever a coordinate is measured in, the first voxel is at the same place.
    const Geometry fine = placed("1,2,3,um");
    CHECK(unitOf(fine) == LengthUnit::Micrometre);
    CHECK(fine.spacing == Vec3(1, 2, 3));
    CHECK(fine.origin.x == Approx(3000));
    // Those of a patient are millimetres, also where the user says that the data are one's.
    const Geometry named =
        withPlacement(Volume(g, samples), parseGridAxes("LPS"), parseGridSpacing("200,200,1000,um")).geometry();
    CHECK(unitOf(named) == LengthUnit::Millimetre);
    checkNear(named.spacing, {0.2, 0.2, 1});
    checkNear(named.boxCenter(), {3 + 0.1, 0.1, 0.5});
    g.worldAxes = WorldAxes::Patient;
    g.lengthUnit = LengthUnit::Unknown;
    const Geometry patient = placed("1,2,3,cm");
    CHECK(unitOf(patient) == LengthUnit::Millimetre);
    CHECK(patient.spacing == Vec3(10, 20, 30));
    CHECK(patient.origin.x == 3);
    CHECK_THROWS_WITH(placed("1,1e-11,1,nm"), Catch::Contains("too small"));
}
