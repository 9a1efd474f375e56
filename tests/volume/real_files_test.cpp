// Real data sets, where they are at hand: what other readers find in them is what we read.
// tests/tools/compare_readers.py compares each voxel, too.
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "volume/loader.h"

using namespace pellucid;

namespace {

struct Expected {
    std::string file; ///< or folder
    Int3 dims;
    SampleType type;
    ValueRange range;
    Vec3 spacing{1, 1, 1};
    Vec3 first{0, 0, 0};           ///< where the first voxel lies
    std::optional<Vec3> last = {}; ///< where the last one lies; empty: axes run along the world's
    WorldAxes axes = WorldAxes::File;
};

/// As nibabel, pydicom, tifffile, VTK and numpy read them.
std::vector<Expected> expectedFiles() {
    using enum SampleType;
    constexpr WorldAxes kPatient = WorldAxes::Patient;
    std::vector<Expected> all{
        {"nucleon/nucleon.mhd", {41, 41, 41}, U8, {0, 249}},
        {"nucleon/nucleon.nhdr", {41, 41, 41}, U8, {0, 249}},
        {"nucleon/nucleon.dat", {41, 41, 41}, U8, {0, 249}},
        {"tooth/tooth.mhd", {140, 120, 161}, U8, {0, 255}},
        {"tooth/tooth.dat", {140, 120, 161}, U8, {0, 255}}, // says RGB and is not
        {"walnut/walnut.mhd", {128, 96, 114}, U16, {0, 22526}},
        {"walnut/walnut.dat", {128, 96, 114}, U16, {0, 22526}},
        {"walnut/walnut.vvd", {128, 96, 114}, U16, {0, 22526}, Vec3(0.015625), {-1, -0.75, -0.890625}},
        {"vortex/vorts1.mhd", {128, 128, 128}, U8, {0, 255}},
        {"hydrogenatom/hydrogenatom.dat", {128, 128, 128}, U8, {0, 250}},
        {"cranium_ct/cranium_ct.nrrd",
         {256, 256, 108},
         I16,
         {-1024, 2986},
         {0.9570312, 0.9570312, 1.5},
         {0, 244.042956, 0},
         Vec3(244.042956, 0, 160.5),
         kPatient},
        {"nrrd/FLAIR.nrrd",
         {124, 160, 140},
         U8,
         {0, 255},
         {1, 1, 1},
         {64.89824, 110.43111, -27.92554},
         Vec3(-75.41071, -77.10007, 41.90601),
         kPatient},
        {"mha/epi_short.mha",
         {64, 64, 37},
         I16,
         {0, 6690},
         {3.4375, 3.4375, 3.8},
         {-108.281, 82.3795, -47.8356},
         Vec3(108.2815, -134.183, 88.9644),
         kPatient},
        {"nifti/ch2.nii.gz", {181, 217, 181}, U8, {0, 254}, {1, 1, 1}, {90, 125, -71}, Vec3(-90, -91, 109), kPatient},
        {"nifti/mpld_asl_4d.nii.gz",
         {64, 64, 24},
         F32,
         {0, 2839},
         {3.4375, 3.4375, 4.95},
         {-106.97339, 85.37604, -41.1865},
         Vec3(109.58911, -131.18646, 72.6635),
         kPatient},
        {"dicom_mr_head",
         {512, 512, 24},
         U16,
         {0, 1826},
         {0.41015625, 0.41015625, 1.5},
         {-106.32681, -123.07444, -20.00067},
         Vec3(103.26303, 86.5154, 14.49933),
         kPatient},
        {"tiff/mini-t1-head.tif", {32, 32, 32}, U16, {0, 421}, {1.500002, 1.500002, 1.5}},
        {"tiff/tooth_stack.tif", {140, 120, 161}, U8, {0, 255}},
        {"pvm/Lobster.pvm", {301, 324, 56}, U8, {0, 255}, {1, 1, 1.4}},
        {"pvm/Bucky.pvm", {32, 32, 32}, U8, {0, 255}},
    };
    // Steps 40 to 51 of one simulation.
    constexpr std::array kLargest{113.590172, 115.976883, 118.850853, 117.645119, 111.283218, 112.434662,
                                  112.1782,   113.200523, 114.401077, 112.99424,  107.936287, 106.279785};
    for (std::size_t n = 0; n < kLargest.size(); ++n)
        all.push_back(
            {"viscous_fingers/density_0" + std::to_string(40 + n) + ".mhd", {64, 64, 64}, F32, {0, kLargest[n]}});
    return all;
}

} // namespace

TEST_CASE("real files open with the sizes, types, places and ranges that other readers find in them", "[real]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/";
    if (!std::filesystem::is_directory(folder)) {
        WARN("SKIPPED: there is no folder " << folder);
        return;
    }
    for (const Expected& e : expectedFiles()) {
        CAPTURE(e.file);
        VolumeSource source;
        source.path = folder + e.file;
        if (!std::filesystem::exists(source.path)) {
            WARN("SKIPPED: there is no " << e.file);
            continue;
        }
        const Volume volume = loadVolume(source);
        const Geometry& g = volume.geometry();
        CHECK(volume.dims() == e.dims);
        CHECK(volume.sampleType() == e.type);
        CHECK(volume.dataRange().lo == Approx(e.range.lo));
        CHECK(volume.dataRange().hi == Approx(e.range.hi).epsilon(1e-7));
        for (int a = 0; a < 3; ++a) CHECK(g.spacing[a] == Approx(e.spacing[a]).epsilon(1e-6));
        CHECK(g.worldAxes == e.axes);
        const Vec3 last = e.last.value_or(e.first + Vec3(e.dims - 1) * e.spacing);
        CHECK(glm::length(g.worldFromVoxel(Vec3(0)) - e.first) < 1e-3);
        CHECK(glm::length(g.worldFromVoxel(Vec3(e.dims - 1)) - last) < 1e-3);
        CHECK(volume.invalidCount() == 0);
    }
}

TEST_CASE("the nucleon is the same through its two headers and as raw data", "[real]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/nucleon/";
    if (!std::filesystem::exists(folder + "nucleon.raw")) {
        WARN("SKIPPED: there is no nucleon.raw in " << folder);
        return;
    }
    VolumeSource mhd, nhdr, raw;
    mhd.path = folder + "nucleon.mhd";
    nhdr.path = folder + "nucleon.nhdr";
    raw.path = folder + "nucleon.raw";
    raw.raw = parseRawLayout("41,41,41,u8");
    const Volume volume = loadVolume(raw);
    CHECK(loadVolume(mhd).samples() == volume.samples());
    CHECK(loadVolume(nhdr).samples() == volume.samples());
}
