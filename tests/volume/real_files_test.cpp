// Real data sets, where they are at hand: what their README says is what we read.
#include <filesystem>

#include <catch2/catch.hpp>

#include "volume/loader.h"

using namespace pellucid;

namespace {

struct Expected {
    const char* file;
    Int3 dims;
    SampleType type;
    ValueRange range;
    Vec3 spacing;
};

} // namespace

TEST_CASE("real files open with the sizes, types and ranges of their documentation", "[real]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/";
    if (!std::filesystem::is_directory(folder)) {
        WARN("SKIPPED: there is no folder " << folder);
        return;
    }
    const Expected table[] = {
        {"nucleon/nucleon.mhd", {41, 41, 41}, SampleType::U8, {0, 249}, {1, 1, 1}},
        {"nucleon/nucleon.nhdr", {41, 41, 41}, SampleType::U8, {0, 249}, {1, 1, 1}},
        {"tooth/tooth.mhd", {140, 120, 161}, SampleType::U8, {0, 255}, {1, 1, 1}},
        {"walnut/walnut.mhd", {128, 96, 114}, SampleType::U16, {0, 22526}, {1, 1, 1}},
        {"vortex/vorts1.mhd", {128, 128, 128}, SampleType::U8, {0, 255}, {1, 1, 1}},
        {"cranium_ct/cranium_ct.nrrd", {256, 256, 108}, SampleType::I16, {-1024, 2986}, {0.9570312, 0.9570312, 1.5}},
        {"nifti/ch2.nii.gz", {181, 217, 181}, SampleType::U8, {0, 254}, {1, 1, 1}},
        {"nifti/mpld_asl_4d.nii.gz", {64, 64, 24}, SampleType::F32, {0, 2839}, {3.4375, 3.4375, 4.95}},
        {"nrrd/FLAIR.nrrd", {124, 160, 140}, SampleType::U8, {0, 255}, {1, 1, 1}},
        {"pvm/Lobster.pvm", {301, 324, 56}, SampleType::U8, {0, 255}, {1, 1, 1.4}},
        {"pvm/Bucky.pvm", {32, 32, 32}, SampleType::U8, {0, 255}, {1, 1, 1}},
        {"nucleon/nucleon.dat", {41, 41, 41}, SampleType::U8, {0, 249}, {1, 1, 1}},
        {"tooth/tooth.dat", {140, 120, 161}, SampleType::U8, {0, 255}, {1, 1, 1}}, // says RGB and is not
        {"walnut/walnut.dat", {128, 96, 114}, SampleType::U16, {0, 22526}, {1, 1, 1}},
        {"walnut/walnut.vvd", {128, 96, 114}, SampleType::U16, {0, 22526}, {0.015625, 0.015625, 0.015625}},
        {"hydrogenatom/hydrogenatom.dat", {128, 128, 128}, SampleType::U8, {0, 250}, {1, 1, 1}},
        {"mha/epi_short.mha", {64, 64, 37}, SampleType::I16, {0, 6690}, {3.4375, 3.4375, 3.8}},
    };
    for (const Expected& e : table) {
        CAPTURE(e.file);
        VolumeSource source;
        source.path = folder + e.file;
        if (!std::filesystem::exists(source.path)) {
            WARN("SKIPPED: there is no " << e.file);
            continue;
        }
        const Volume volume = loadVolume(source);
        CHECK(volume.dims() == e.dims);
        CHECK(volume.sampleType() == e.type);
        CHECK(volume.dataRange().lo == Approx(e.range.lo));
        CHECK(volume.dataRange().hi == Approx(e.range.hi).margin(0.5));
        for (int a = 0; a < 3; ++a) CHECK(volume.geometry().spacing[a] == Approx(e.spacing[a]).epsilon(1e-4));
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
