// Volumes that are written and read back.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/atomic_file.h"
#include "support/full_disk.h"
#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume/volume_writer.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

const std::vector<std::string> kSuffixes{".nrrd", ".mha", ".mhd", ".nii", ".nii.gz", ".vti", ".tif", ".zarr"};

Volume load(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return loadVolume(source);
}

/// 3 x 4 x 5 voxels that turn by a quarter of their way about z: (0.6, 0.8, 0), (−0.8, 0.6, 0).
Geometry oblique(WorldAxes axes) {
    Geometry g;
    g.dims = {3, 4, 5};
    g.spacing = {0.5, 0.25, 2};
    g.origin = {-10.5, 20.25, 4};
    g.directions = Mat3(Vec3(0.6, 0.8, 0), Vec3(-0.8, 0.6, 0), Vec3(0, 0, 1));
    g.worldAxes = axes;
    return g;
}

template <class T>
Volume volumeOf(const Geometry& geometry, std::optional<double> missing = {}) {
    std::vector<T> values(voxelCount(geometry.dims));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<T>(3 * i + 1);
    values[0] = std::numeric_limits<T>::lowest();
    values[1] = std::numeric_limits<T>::max();
    return {geometry, SampleArray<T>(std::move(values)), missing};
}

/// What a format keeps of where a volume lies.
struct Kept {
    bool isRounded = false, hasOrigin = true, hasDirections = true;
};

void requireSame(const Volume& read, const Volume& written, const Kept& kept) {
    CHECK(read.samples() == written.samples());
    CHECK(read.dims() == written.dims());
    CHECK(read.dataRange() == written.dataRange());
    const Geometry &a = read.geometry(), &b = written.geometry();
    const double tolerance = kept.isRounded ? 1e-6 : 0;
    CHECK(glm::length(a.spacing - b.spacing) <= tolerance);
    if (kept.hasOrigin) CHECK(glm::length(a.origin - b.origin) <= 10 * tolerance);
    for (int axis = 0; axis < 3 && kept.hasDirections; ++axis)
        CHECK(glm::length(a.directions[axis] - b.directions[axis]) <= 1e-6);
}

} // namespace

TEMPLATE_TEST_CASE("a volume that is written is read back the same", "[writer]", std::uint8_t, std::int8_t,
                   std::uint16_t, std::int16_t, std::uint32_t, std::int32_t, float, double) {
    const TempFolder folder;
    for (const WorldAxes axes : {WorldAxes::File, WorldAxes::Patient})
        for (const std::string& suffix : kSuffixes) {
            CAPTURE(suffix, axes == WorldAxes::Patient);
            const Volume volume = volumeOf<TestType>(oblique(axes));
            const std::string path = folder.path((axes == WorldAxes::Patient ? "patient" : "file") + suffix);
            const std::vector<std::string> lost = writeVolume(volume, path);
            const Volume read = load(path);
            const bool isNifti = suffix.starts_with(".nii"), isTiff = suffix == ".tif", isZarr = suffix == ".zarr";
            const bool isOfFile = suffix == ".vti" || isTiff || isZarr; // no format for patients
            requireSame(read, volume, {isNifti, !isTiff, !isTiff && !isZarr});
            CHECK(read.notices.empty());
            // What is not the same is said.
            const bool sameWorld = read.geometry().worldAxes == axes;
            CHECK(sameWorld == (isNifti ? axes == WorldAxes::Patient : !isOfFile || axes == WorldAxes::File));
            CHECK(lost.empty() == (sameWorld && !isTiff && !isZarr));
        }
}

TEST_CASE("a plain grid has no orientation in NIfTI", "[writer]") {
    const TempFolder folder;
    Geometry g;
    g.dims = {3, 4, 5};
    const Volume volume = volumeOf<float>(g);
    CHECK(writeVolume(volume, folder.path("a.nii")).empty());
    CHECK(load(folder.path("a.nii")).geometry().worldAxes == WorldAxes::File);
    g.spacing = {0.1, 1, 1}; // which floats do not have
    CHECK_THAT(writeVolume(volumeOf<float>(g), folder.path("b.nii")).at(0), Contains("seven digits"));
}

TEST_CASE("missing values are written as what each type has for them", "[writer]") {
    const TempFolder folder;
    const Geometry g = oblique(WorldAxes::Patient);
    const Volume floats = volumeOf<float>(g, 13.0); // 3 · 4 + 1
    REQUIRE(floats.invalidCount() == 1);
    const auto said = writeVolume(floats, folder.path("f.nrrd"));
    CHECK_THAT(said.at(0), Contains("1 voxel is without a valid value, and written as NaN"));
    const Volume read = load(folder.path("f.nrrd"));
    CHECK(read.invalidCount() == 1);
    CHECK(std::isnan(read.value(4)));
    const Volume whole = volumeOf<std::int16_t>(g, 13.0);
    CHECK_THAT(writeVolume(whole, folder.path("i.mha")).at(0), Contains("does not say that 13 is missing"));
    CHECK(load(folder.path("i.mha")).samples() == whole.samples());
}

TEST_CASE("another type says what it rounds and cuts", "[writer]") {
    const TempFolder folder;
    Geometry g;
    g.dims = {2, 2, 2};
    const std::vector<float> values{-1, 0.4f, 1, 254.6f, 255, 256, 1e9f, std::numeric_limits<float>::quiet_NaN()};
    const Volume volume(g, SampleArray<float>(values));
    const auto said = writeVolume(volume, folder.path("a.nrrd"), SampleType::U8);
    REQUIRE(said.size() == 3);
    CHECK_THAT(said[0], Contains("2 voxels are rounded"));
    CHECK_THAT(said[1], Contains("3 voxels are cut"));
    CHECK_THAT(said[2], Contains("1 voxel is without a valid value, and written as 0"));
    const Volume read = load(folder.path("a.nrrd"));
    const int expected[] = {0, 0, 1, 255, 255, 255, 255, 0};
    for (std::size_t i = 0; i < 8; ++i) CHECK(read.value(i) == expected[i]);
    const std::vector<std::uint8_t> bytes{0, 1, 2, 3, 4, 5, 6, 255};
    CHECK(writeVolume(Volume(g, SampleArray<std::uint8_t>(bytes)), folder.path("b.nii"), SampleType::F64).empty());
    CHECK(load(folder.path("b.nii")).value(7) == 255);
}

TEST_CASE("a volume that cannot be written leaves nothing", "[writer]") {
    const TempFolder folder;
    const Volume volume = volumeOf<float>(oblique(WorldAxes::Patient));
    CHECK_THROWS_AS(writeVolume(volume, folder.path("a.png")), UsageError);
    CHECK_THROWS_WITH(checkVolumeSuffix("a"), Contains(".nii.gz"));
    CHECK_THROWS_AS(writeVolume(volume, folder.path("none/a.nii")), FileError);
    std::stop_source stop;
    stop.request_stop();
    for (const std::string& suffix : kSuffixes)
        CHECK_THROWS_AS(writeVolume(volume, folder.path("a" + suffix), {}, {stop.get_token(), {}}), Cancelled);
    CHECK(folder.fileCount() == 0);
}

TEST_CASE("a disk that fills up leaves nothing behind, whatever the format", "[writer]") {
    const TempFolder folder;
    Geometry g;
    g.dims = {48, 40, 36};
    std::vector<std::uint16_t> noise(voxelCount(g.dims)); // which cannot be packed
    std::uint32_t state = 5;
    for (std::uint16_t& value : noise) {
        state = state * 1664525u + 1013904223u;
        value = static_cast<std::uint16_t>(state >> 16);
    }
    const Volume volume(g, SampleArray<std::uint16_t>(std::move(noise)));
    for (const std::string& suffix : kSuffixes)
        for (const std::size_t most : {0, 10, 1000, 20'000}) {
            CAPTURE(suffix, most);
            const FullDisk disk(most);
            CHECK_THROWS_WITH(writeVolume(volume, folder.path("a" + suffix)), Contains("cannot write the file"));
            CHECK(folder.fileCount() == 0);
        }
    // Data stay with their header: where the new one cannot be written, they are not replaced either.
    std::filesystem::create_directory(folder.path("a.mhd"));
    folder.write("a.raw", "older");
    CHECK_THROWS_WITH(writeVolume(volume, folder.path("a.mhd")), Contains("a folder has this name"));
    CHECK(readText(folder.path("a.raw")) == "older");
    std::filesystem::remove(folder.path("a.mhd"));
    std::filesystem::remove(folder.path("a.raw"));
    // A name as long as names can be, and one that is longer.
    const std::string longest(255 - 5, 'n');
    for (const std::string& suffix : {std::string(".nrrd"), std::string(".zarr")}) {
        CHECK(writeVolume(volume, folder.path(longest + suffix)).empty());
        CHECK(load(folder.path(longest + suffix)).samples() == volume.samples());
        CHECK_THROWS_WITH(writeVolume(volume, folder.path(longest + "n" + suffix)), Contains("shorter name"));
    }
    CHECK(folder.fileCount() == 2);
    // A folder is not replaced: something else may be in it.
    CHECK_THROWS_WITH(writeVolume(volume, folder.path(longest + ".zarr")), Contains("a folder has this name"));
}
