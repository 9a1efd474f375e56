// Volumes that are written and read back.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>

#include "base/atomic_file.h"
#include "support/full_disk.h"
#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume/orientation.h"
#include "volume/time_series.h"
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

TEST_CASE("lengths keep their unit, or it is said that they do not", "[writer]") {
    const TempFolder folder;
    for (const LengthUnit unit : {LengthUnit::Unknown, LengthUnit::Nanometre, LengthUnit::Micrometre,
                                  LengthUnit::Millimetre, LengthUnit::Metre, LengthUnit::Inch})
        for (const std::string& suffix : kSuffixes) {
            CAPTURE(suffix, sign(unit));
            Geometry g;
            g.dims = {3, 4, 5};
            g.spacing = {0.5, 0.25, 2};
            g.lengthUnit = unit;
            const std::string path = folder.path("a" + suffix);
            const std::vector<std::string> lost = writeVolume(volumeOf<std::uint8_t>(g), path);
            const Volume read = load(path);
            const Geometry again = inUnit(read.geometry(), unit);
            for (int a = 0; a < 3; ++a) CHECK(again.spacing[a] == Approx(g.spacing[a]).epsilon(1e-6));
            const bool isKept = read.geometry().lengthUnit == unit;
            CHECK(lost.empty() == isKept);
            const bool hasCode = unit == LengthUnit::Micrometre || unit == LengthUnit::Millimetre ||
                                 unit == LengthUnit::Metre || unit == LengthUnit::Unknown;
            CHECK(isKept == (suffix == ".vti" ? unit == LengthUnit::Unknown : hasCode || !suffix.starts_with(".nii")));
            if (isKept) CHECK(read.geometry().spacing == g.spacing);
            if (!isKept && suffix == ".vti") CHECK_THAT(lost.at(0), Contains("the unit of length"));
            if (!isKept && suffix != ".vti") CHECK_THAT(lost.back(), Contains("NIfTI cannot state lengths in"));
        }
}

TEST_CASE("a patient's lengths in micrometres are read in millimetres", "[writer]") {
    const TempFolder folder;
    Geometry g = oblique(WorldAxes::Patient);
    g.lengthUnit = LengthUnit::Micrometre; // as where a file without a patient is given axes of one
    for (const char* suffix : {".nrrd", ".mha", ".nii"}) {
        CAPTURE(suffix);
        const std::string path = folder.path(std::string("a") + suffix);
        CHECK(writeVolume(volumeOf<std::uint8_t>(g), path).empty());
        const Geometry read = load(path).geometry();
        CHECK(unitOf(read) == LengthUnit::Millimetre);
        CHECK(glm::length(1000.0 * read.spacing - g.spacing) < 1e-6);
        CHECK(glm::length(1000.0 * read.origin - g.origin) < 1e-5);
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
    const auto said = writeVolume(volume, folder.path("a.nrrd"), {SampleType::U8});
    REQUIRE(said.size() == 3);
    CHECK_THAT(said[0], Contains("2 voxels are rounded"));
    CHECK_THAT(said[1], Contains("3 voxels are cut"));
    // 0, 1 and 255 are values of valid voxels.
    CHECK_THAT(said[2], Contains("1 voxel is without a valid value, and written as 2: open the file with that"));
    const Volume read = load(folder.path("a.nrrd"));
    const int expected[] = {0, 0, 1, 255, 255, 255, 255, 2};
    for (std::size_t i = 0; i < 8; ++i) CHECK(read.value(i) == expected[i]);
    const std::vector<std::uint8_t> bytes{0, 1, 2, 3, 4, 5, 6, 255};
    CHECK(writeVolume(Volume(g, SampleArray<std::uint8_t>(bytes)), folder.path("b.nii"), {SampleType::F64}).empty());
    CHECK(load(folder.path("b.nii")).value(7) == 255);
}

TEST_CASE("voxels without a valid value get one that no other voxel has", "[writer]") {
    const TempFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto said = [&](const Int3& dims, std::vector<float> values, SampleType type) {
        Geometry g;
        g.dims = dims;
        return writeVolume(Volume(g, SampleArray<float>(std::move(values))), folder.path("a.nrrd"), {type}).back();
    };
    CHECK_THAT(said({2, 2, 1}, {5, 6, nan, 7}, SampleType::U8), Contains("written as 0: open"));
    CHECK_THAT(said({2, 2, 1}, {0, 1, nan, 3}, SampleType::U8), Contains("written as 2: open"));
    CHECK_THAT(said({2, 2, 1}, {-128, -127, nan, 3}, SampleType::I8), Contains("written as -126: open"));
    CHECK_THAT(said({2, 2, 1}, {-32768, 0, nan, 3}, SampleType::I16), Contains("written as -32767: open"));
    CHECK_THAT(said({2, 2, 1}, {0, 4294967040.0f, nan, 3}, SampleType::U32), Contains("written as 1: open"));
    CHECK_THAT(said({2, 2, 1}, {-2147483648.0f, 0, nan, 3}, SampleType::I32), Contains("written as -2147483647: open"));
    VolumeSource source;
    source.path = folder.path("a.nrrd");
    source.missing = -2147483647;
    CHECK(loadVolume(source).invalidCount() == 1);
    // All 256 values, and 0 twice.
    std::vector<float> all(258);
    for (std::size_t i = 0; i < 257; ++i) all[i] = static_cast<float>(i % 256);
    all.back() = nan;
    CHECK_THAT(said({258, 1, 1}, all, SampleType::U8),
               Contains("1 voxel is without a valid value, and written as 0, as 2 valid ones are: a type with more"));
    CHECK_THAT(said({258, 1, 1}, all, SampleType::U16), Contains("written as 256: open"));
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
}

namespace {

/// Three frames: voxel i of frame n is 10·i + n, at 2.5, 3 and 3.5 s (or, uneven, 2.5, 3 and 4).
std::shared_ptr<TimeSeries> threeFrames(const Geometry& geometry, const std::string& unit = "s", bool even = true) {
    SeriesListing listing;
    listing.hasTimes = true;
    listing.timeUnit = unit;
    for (const double time : {2.5, 3.0, even ? 3.5 : 4.0}) {
        listing.frames.emplace_back();
        listing.frames.back().time = time;
    }
    return std::make_shared<TimeSeries>(listing, [geometry](int frame, const JobControl&) {
        std::vector<std::int16_t> values(voxelCount(geometry.dims));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<std::int16_t>(10 * i + static_cast<std::size_t>(frame));
        return Volume(geometry, SampleArray<std::int16_t>(std::move(values)));
    });
}

VolumeSource sourceOf(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return source;
}

} // namespace

TEST_CASE("what reading lost of single frames is said where all are written", "[writer]") {
    const TempFolder folder;
    SeriesListing listing;
    listing.frames.resize(3);
    TimeSeries series(listing, [](int frame, const JobControl&) {
        Geometry g;
        g.dims = {2, 1, 1};
        Volume volume(g, SampleArray<std::uint8_t>(std::vector<std::uint8_t>{0, 1}));
        volume.notices.emplace_back("component 0 of 3 is shown");
        if (frame == 0) volume.notices.emplace_back("one layer is missing");
        if (frame == 2) volume.notices.emplace_back("two layers are missing");
        return volume;
    });
    CHECK(writeSeries(series, folder.path("a.nrrd"), {}, {}, {"component 0 of 3 is shown"}) ==
          std::vector<std::string>{"frame 0: one layer is missing", "frame 2: two layers are missing"});
}

TEST_CASE("all frames that are written into one file are read back with their times", "[writer]") {
    const TempFolder folder;
    for (const char* suffix : {".nrrd", ".mha", ".mhd", ".nii", ".nii.gz", ".pvd", ".tif", ".zarr"}) {
        CAPTURE(suffix);
        const std::string path = folder.path(std::string("a") + suffix);
        const auto written = threeFrames(oblique(WorldAxes::Patient));
        const auto lost = writeSeries(*written, path);
        const bool isTiff = std::string(suffix) == ".tif",
                   saysUnit = std::string(suffix).find(".m") != 0 && std::string(suffix) != ".pvd";
        const auto read = TimeSeries::open(sourceOf(path));
        REQUIRE(read->size() == 3);
        for (int n = 0; n < 3; ++n) {
            CHECK(read->load(n)->samples() == written->load(n)->samples());
            CHECK(read->load(n)->dims() == Int3(3, 4, 5));
            // TIFF has no place for when the first frame is.
            CHECK(read->listing().frames[static_cast<std::size_t>(n)].time == Approx((isTiff ? 0 : 2.5) + 0.5 * n));
        }
        CHECK(glm::length(read->load(2)->geometry().spacing - Vec3(0.5, 0.25, 2)) < 1e-6);
        CHECK(read->listing().timeUnit == (saysUnit ? "s" : ""));
        const auto says = [&](const char* words) {
            return std::ranges::any_of(lost, [&](const std::string& s) { return s.find(words) != std::string::npos; });
        };
        CHECK(says("unit") == !saysUnit);
        CHECK(says("times begin at 0") == isTiff);
    }
    CHECK_THROWS_WITH(writeSeries(*threeFrames(oblique(WorldAxes::File)), folder.path("a.vti")),
                      Contains("has one frame"));
}

TEST_CASE("frames at uneven times keep them where the format can", "[writer]") {
    const TempFolder folder;
    const Geometry g = oblique(WorldAxes::File);
    writeSeries(*threeFrames(g, "s", false), folder.path("a.pvd"));
    CHECK(TimeSeries::open(sourceOf(folder.path("a.pvd")))->listing().frames[2].time == 4);
    const auto lost = writeSeries(*threeFrames(g, "s", false), folder.path("a.nrrd"));
    REQUIRE(!lost.empty());
    CHECK_THAT(lost.front(), Contains("do not follow each other at one step"));
    CHECK_FALSE(TimeSeries::open(sourceOf(folder.path("a.nrrd")))->listing().hasTimes);
    // A unit that NIfTI has no code for.
    CHECK_THAT(writeSeries(*threeFrames(g, "days"), folder.path("a.nii")).back(), Contains("'days'"));
}

TEST_CASE("a frame that cannot be read leaves no file", "[writer]") {
    const TempFolder folder;
    SeriesListing listing;
    listing.frames.resize(3);
    const auto broken = std::make_shared<TimeSeries>(listing, [](int frame, const JobControl&) {
        if (frame == 2) throw FileError("broken", "c.raw", "copy it again");
        return Volume(Geometry{{2, 2, 2}}, SampleArray<std::uint8_t>(std::vector<std::uint8_t>(8, 1)));
    });
    for (const char* suffix : {".nrrd", ".mha", ".mhd", ".nii.gz", ".pvd", ".tif", ".zarr"}) {
        CAPTURE(suffix);
        CHECK_THROWS_WITH(writeSeries(*broken, folder.path(std::string("a") + suffix)), Contains("broken"));
        CHECK(folder.fileCount() == 0);
    }
}

TEST_CASE("frames of an earlier collection stay until all new ones are there", "[writer]") {
    const TempFolder folder;
    const auto frames = [](int brokenOne) {
        SeriesListing listing;
        listing.frames.resize(3);
        return std::make_shared<TimeSeries>(listing, [brokenOne](int frame, const JobControl&) {
            if (frame == brokenOne) throw FileError("broken", "c.raw", "copy it again");
            return Volume(Geometry{{2, 2, 2}}, SampleArray<std::uint8_t>(std::vector<std::uint8_t>(
                                                   8, static_cast<std::uint8_t>(frame + 10 * (brokenOne + 2)))));
        });
    };
    const std::string path = folder.path("a.pvd");
    writeSeries(*frames(-1), path); // frame n is n + 10 everywhere
    CHECK_THROWS_WITH(writeSeries(*frames(2), path), Contains("broken"));
    CHECK(folder.fileCount() == 4);
    for (int n = 0; n < 3; ++n) CHECK(load(folder.path("a_" + std::to_string(n) + ".vti")).value(0) == n + 10);
    CHECK(writtenFiles(path, 3) ==
          std::vector<std::string>{path, folder.path("a_0.vti"), folder.path("a_1.vti"), folder.path("a_2.vti")});
    CHECK(writtenFiles(folder.path("b.mhd")) == std::vector<std::string>{folder.path("b.mhd"), folder.path("b.raw")});
    CHECK(writtenFiles(folder.path("b.nii")) == std::vector<std::string>{folder.path("b.nii")});
}

TEST_CASE("a region and a coarser copy are written where they lie", "[writer]") {
    const TempFolder folder;
    Geometry g;
    g.dims = {6, 4, 4};
    g.spacing = {1, 2, 3};
    std::vector<float> values(voxelCount(g.dims));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 6); // x
    const Volume volume(g, SampleArray<float>(values));
    writeVolume(volume, folder.path("a.nrrd"), {.region = VoxelRegion{{2, 1, 0}, {6, 3, 4}}});
    const Volume region = load(folder.path("a.nrrd"));
    CHECK(region.dims() == Int3(4, 2, 4));
    CHECK(region.value(0) == 2);
    CHECK(region.geometry().origin == Vec3(2, 2, 0)); // voxel (2, 1, 0)
    writeVolume(volume, folder.path("b.nrrd"), {.type = SampleType::F64, .region = {}, .coarser = 2});
    const Volume coarser = load(folder.path("b.nrrd"));
    CHECK(coarser.dims() == Int3(3, 2, 2));
    CHECK(coarser.sampleType() == SampleType::F64);
    CHECK(coarser.value(1) == 2.5);                        // of 2 and 3
    CHECK(coarser.geometry().origin == Vec3(0.5, 1, 1.5)); // half a voxel further in
    CHECK(coarser.geometry().spacing == Vec3(2, 4, 6));
}

TEST_CASE("a folder of Zarr is replaced by another one, and nothing else is", "[writer]") {
    const TempFolder folder;
    const std::string path = folder.path("a.zarr");
    writeVolume(volumeOf<std::int16_t>(oblique(WorldAxes::File)), path);
    Geometry g;
    g.dims = {2, 2, 2};
    const Volume other(g, SampleArray<std::uint8_t>(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8}));
    writeVolume(other, path);
    CHECK(load(path).samples() == other.samples());
    CHECK(folder.fileCount() == 1); // nothing is left of the first one
    // More than one image: somebody has put labels into it.
    std::filesystem::create_directories(path + "/labels");
    CHECK_THROWS_AS(writeVolume(other, path), FileError);
    CHECK(std::filesystem::exists(path + "/labels"));
    std::filesystem::create_directories(folder.path("own.zarr"));
    std::ofstream(folder.path("own.zarr/letter.txt")) << "keep me";
    CHECK_THROWS_AS(writeVolume(other, folder.path("own.zarr")), FileError);
    CHECK(std::filesystem::exists(folder.path("own.zarr/letter.txt")));
}

TEST_CASE("a unit of time with quotes stays in its place in NRRD, and one that cannot is said", "[writer]") {
    const TempFolder folder;
    const Geometry g = oblique(WorldAxes::Patient);
    const std::string path = folder.path("a.nrrd");
    for (const char* unit : {"\"", "5\" disk", "a \"b\" c", "s\" encoding: \"raw"}) {
        CAPTURE(unit);
        CHECK(writeSeries(*threeFrames(g, unit), path).empty());
        const auto read = TimeSeries::open(sourceOf(path));
        REQUIRE(read->size() == 3);
        CHECK(read->listing().timeUnit == unit);
        CHECK(read->listing().frames[2].time == 3.5);
        CHECK(read->load(2)->samples() == threeFrames(g)->load(2)->samples());
    }
    // A line end would begin another field, and a backslash take the quote that ends the unit.
    for (const char* unit :
         {"s\nencoding: raw", "s\n\n", "s\\", "\r", "a unit of more than forty bytes is no unit any more"}) {
        CAPTURE(unit);
        const auto lost = writeSeries(*threeFrames(g, unit), path);
        REQUIRE(lost.size() == 1);
        CHECK_THAT(lost.front(), Contains("NRRD cannot write the unit of time"));
        const auto read = TimeSeries::open(sourceOf(path));
        REQUIRE(read->size() == 3);
        CHECK(read->listing().timeUnit.empty());
        CHECK(read->load(2)->samples() == threeFrames(g)->load(2)->samples());
    }
}

TEST_CASE("what NIfTI-1 cannot count is written as NIfTI-2", "[writer]") {
    const TempFolder folder;
    Geometry g;
    g.dims = {40'000, 2, 2};
    g.spacing = {0.1, 0.2, 3}; // which single precision does not have
    g.origin = {1.1, -2.2, 3.3};
    g.directions = Mat3(Vec3(0.6, 0.8, 0), Vec3(-0.8, 0.6, 0), Vec3(0, 0, 1));
    g.worldAxes = WorldAxes::Patient;
    const Volume volume = volumeOf<std::int16_t>(g);
    for (const char* name : {"a.nii", "a.nii.gz"}) {
        CAPTURE(name);
        const auto said = writeVolume(volume, folder.path(name));
        REQUIRE(said.size() == 1);
        CHECK_THAT(said[0], Contains("the file is NIfTI-2"));
        const Volume read = load(folder.path(name));
        CHECK(read.samples() == volume.samples());
        CHECK(read.dims() == g.dims);
        CHECK(read.geometry().spacing == g.spacing);
        CHECK(read.geometry().origin == g.origin);
        for (int a = 0; a < 3; ++a) CHECK(glm::length(read.geometry().directions[a] - g.directions[a]) < 1e-15);
        CHECK(read.geometry().worldAxes == WorldAxes::Patient);
    }
    // 540 bytes of header, 4 that say that no extensions follow, and two for each voxel.
    CHECK(std::filesystem::file_size(folder.path("a.nii")) == 544 + 2 * voxelCount(g.dims));
    // The longest axis that NIfTI-1 has.
    g.dims = {32'767, 1, 1};
    writeVolume(volumeOf<std::int16_t>(g), folder.path("b.nii"));
    CHECK(std::filesystem::file_size(folder.path("b.nii")) == 352 + 2 * voxelCount(g.dims));
}

TEST_CASE("a great many frames are written as NIfTI-2, with their times", "[writer]") {
    const TempFolder folder;
    SeriesListing listing;
    listing.hasTimes = true;
    listing.timeUnit = "ms";
    listing.frames.resize(32'768);
    for (std::size_t n = 0; n < listing.frames.size(); ++n) listing.frames[n].time = 0.1 * static_cast<double>(n);
    TimeSeries series(listing, [](int frame, const JobControl&) {
        return Volume(Geometry{{1, 1, 1}}, SampleArray<std::int32_t>(std::vector<std::int32_t>{frame}));
    });
    CHECK(writeSeries(series, folder.path("a.nii")).size() == 1);
    const auto read = TimeSeries::open(sourceOf(folder.path("a.nii")));
    REQUIRE(read->size() == 32'768);
    CHECK(read->load(32'767)->value(0) == 32'767);
    CHECK(read->listing().timeUnit == "ms");
    CHECK(read->listing().frames[32'767].time == Approx(3276.7));
}
