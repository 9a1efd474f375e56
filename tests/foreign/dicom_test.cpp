// DICOM through pellucid-reader, against values that are derived here from what the files are made of.
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "support/dicom_writer.h"
#include "support/notices.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/loader.h"
#include "volume/process/reader_process.h"
#include "volume/series.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

VolumeSource at(const std::string& path, const std::string& series = "") {
    VolumeSource source;
    source.path = path;
    source.array = series;
    return source;
}

/// A slice `n` of a stack along z, 1.5 mm apart; its voxels are 100 n, 100 n + 1, …
DicomSlice sliceAt(int n, double distance = 1.5) {
    DicomSlice slice;
    slice.number = n + 1;
    slice.position = "-10\\-20\\" + std::to_string(distance * n);
    std::vector<int> values;
    for (int i = 0; i < 6; ++i) values.push_back(100 * n + i);
    slice.pixels = words(values);
    return slice;
}

void writeStack(const TempFolder& folder, const std::string& name, int count) {
    fs::create_directory(folder.path(name));
    // Names in another order than the slices lie.
    for (int n = 0; n < count; ++n)
        folder.write(name + "/IM" + std::to_string((n * 7) % 10) + std::to_string(n), dicomFile(sliceAt(n)));
}

} // namespace

TEST_CASE("a folder of slices is one volume, in the order of their places", "[dicom]") {
    const TempFolder folder;
    writeStack(folder, "scan", 4);
    folder.write("scan/README.txt", "Slices of a head.");
    const SeriesListing listing = listSeries(at(folder.path("scan")));
    REQUIRE(listing.frames.size() == 1);
    CHECK(listing.title == "scan");
    const Volume volume = loadVolume(listing.frames[0].source);
    CHECK(volume.format == "DICOM");
    CHECK(volume.title == "scan");
    CHECK(volume.dims() == Int3(3, 2, 4));
    CHECK(volume.sampleType() == SampleType::U16);
    // Pixel spacing is that of rows, then of columns: "2\1" is 1 along x.
    CHECK(volume.geometry().spacing == Vec3(1, 2, 1.5));
    CHECK(volume.geometry().origin == Vec3(-10, -20, 0));
    CHECK(volume.geometry().worldAxes == WorldAxes::Patient);
    CHECK(volume.notices.empty());
    for (int z = 0; z < 4; ++z)
        for (int i = 0; i < 6; ++i) CHECK(volume.value(static_cast<std::size_t>(6 * z + i)) == 100 * z + i);
    // Any slice stands for its series, and a pattern of slices for one volume.
    CHECK(loadVolume(at(folder.path("scan/IM00"))).samples() == volume.samples());
    CHECK(listSeries(at(folder.path("scan/IM*"))).frames.size() == 1);
    CHECK(filesOf(at(folder.path("scan"))).size() == 5); // the folder and its slices
}

TEST_CASE("DICOM stored numbers become values", "[dicom]") {
    const TempFolder folder;
    DicomSlice slice = sliceAt(0);
    SECTION("bits that are not used are left out; a sign is one of the bits that are") {
        // 12 of 16 bits: 0x8fff has an overlay in its highest bit; as signed 0xfff is −1, 0x7ff 2047, 0x800 −2048.
        slice.pixels = words({0x8fff, 0x07ff, 0x0800, 0, 1, 2});
        CHECK(loadVolume(at(folder.write("u.dcm", dicomFile(slice)))).value(0) == 4095);
        slice.isSigned = 1;
        slice.series = "1.2.4";
        const Volume volume = loadVolume(at(folder.write("s.dcm", dicomFile(slice))));
        CHECK(volume.sampleType() == SampleType::I16);
        CHECK(volume.value(0) == -1);
        CHECK(volume.value(1) == 2047);
        CHECK(volume.value(2) == -2048);
    }
    SECTION("a whole number is added exactly, in the smallest type that holds all") {
        slice.slope = "1";
        slice.intercept = "-1024"; // 12 bits: −1024 … 3071
        const Volume volume = loadVolume(at(folder.write("ct.dcm", dicomFile(slice))));
        CHECK(volume.sampleType() == SampleType::I16);
        CHECK(volume.value(5) == -1019);
    }
    SECTION("a slope makes floats") {
        slice.slope = "0.5";
        slice.intercept = "10";
        const Volume volume = loadVolume(at(folder.write("pet.dcm", dicomFile(slice))));
        CHECK(volume.sampleType() == SampleType::F32);
        CHECK(volume.value(5) == 12.5);
    }
    SECTION("each slice has its own scaling") {
        fs::create_directory(folder.path("pet"));
        for (int n = 0; n < 2; ++n) {
            DicomSlice one = sliceAt(n);
            one.slope = n == 0 ? "1" : "2.5";
            folder.write("pet/" + std::to_string(n), dicomFile(one));
        }
        const Volume volume = loadVolume(at(folder.path("pet")));
        CHECK(volume.value(3) == 3);
        CHECK(volume.value(6 + 3) == 2.5 * 103);
    }
    SECTION("the padding value is missing") {
        slice.more.number(0x0028, 0x0120, 3);
        slice.intercept = "-1000";
        const Volume volume = loadVolume(at(folder.write("p.dcm", dicomFile(slice))));
        CHECK(volume.invalidCount() == 1);
        CHECK_FALSE(volume.isValid(3));
        CHECK(volume.missing() == -997.0);
    }
    SECTION("8 bits of three colours are components") {
        slice.samples = 3;
        slice.bitsAllocated = slice.bitsStored = 8;
        slice.photometric = "RGB";
        slice.pixels.clear();
        for (int i = 0; i < 18; ++i) slice.pixels += static_cast<char>(10 * i);
        const std::string path = folder.write("rgb.dcm", dicomFile(slice));
        CHECK(contentsOf(at(path)).components == 3);
        VolumeSource green = at(path);
        green.component = 1;
        CHECK(loadVolume(green).value(2) == 70); // third pixel, second colour: 10 · (3 · 2 + 1)
    }
    SECTION("a segmentation has eight pixels in a byte") {
        slice.bitsAllocated = slice.bitsStored = 1;
        slice.pixels = "\x25"; // 100101, the first pixel is the lowest bit
        const Volume volume = loadVolume(at(folder.write("seg.dcm", dicomFile(slice))));
        const int expected[] = {1, 0, 1, 0, 0, 1};
        for (std::size_t i = 0; i < 6; ++i) CHECK(volume.value(i) == expected[i]);
    }
}

TEST_CASE("DICOM slices lie where the patient was", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("a"));
    SECTION("oblique: directions are those of columns, of rows, and from slice to slice") {
        // Columns go along (0.6, 0.8, 0), rows along (−0.8, 0.6, 0) and slices along z.
        for (int n = 0; n < 3; ++n) {
            DicomSlice slice = sliceAt(n);
            slice.axes = "0.6\\0.8\\0\\-0.8\\0.6\\0";
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Geometry g = loadVolume(at(folder.path("a"))).geometry();
        CHECK(glm::length(g.directions[0] - Vec3(0.6, 0.8, 0)) < 1e-12);
        CHECK(glm::length(g.directions[1] - Vec3(-0.8, 0.6, 0)) < 1e-12);
        CHECK(g.directions[2] == Vec3(0, 0, 1));
    }
    SECTION("sagittal slices ascend along the normal of their axes") {
        // Columns go back, rows down: the normal is (0,1,0) × (0,0,−1) = (−1, 0, 0), so that the first is the leftmost.
        for (int n = 0; n < 3; ++n) {
            DicomSlice slice = sliceAt(n);
            slice.axes = "0\\1\\0\\0\\0\\-1";
            slice.position = std::to_string(2 * n) + "\\0\\0";
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.geometry().origin == Vec3(4, 0, 0));
        CHECK(volume.geometry().directions[2] == Vec3(-1, 0, 0));
        CHECK(volume.value(0) == 200);
    }
    SECTION("a tilted gantry shears the grid") {
        // From slice to slice (0, 0.5, 1.2): 22.6° against the normal; 1.3 mm long.
        for (int n = 0; n < 4; ++n) {
            DicomSlice slice = sliceAt(n);
            slice.position = "0\\" + std::to_string(0.5 * n) + "\\" + std::to_string(1.2 * n);
            folder.write("a/" + std::to_string(n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.geometry().spacing.z == Approx(1.3));
        CHECK(glm::length(volume.geometry().directions[2] - Vec3(0, 0.5 / 1.3, 1.2 / 1.3)) < 1e-6);
        CHECK(hasNotice(volume, "tilted by 22.6°"));
    }
    SECTION("a slice that is missing is interpolated, and said") {
        for (const int n : {0, 1, 3, 4}) folder.write("a/" + std::to_string(n), dicomFile(sliceAt(n)));
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.dims().z == 5);
        CHECK(volume.geometry().spacing.z == Approx(1.5));
        CHECK(volume.value(12) == 200); // between 100 and 300
        CHECK(volume.value(18) == 300); // as it is
        CHECK(hasNotice(volume, "1 of 5 layers are interpolated"));
    }
    SECTION("a slice that is there twice counts once") {
        for (const int n : {0, 1, 2}) folder.write("a/" + std::to_string(n), dicomFile(sliceAt(n)));
        folder.write("a/copy", dicomFile(sliceAt(1)));
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.dims().z == 3);
        CHECK(hasNotice(volume, "1 slice is there twice"));
    }
    SECTION("pictures without a place are taken as they are numbered") {
        for (const int n : {2, 0, 1}) {
            DicomSlice slice = sliceAt(n);
            slice.position.clear();
            slice.axes.clear();
            slice.spacing.clear();
            folder.write("a/" + std::to_string(9 - n), dicomFile(slice));
        }
        const Volume volume = loadVolume(at(folder.path("a")));
        CHECK(volume.value(6) == 100);
        CHECK(volume.geometry().worldAxes == WorldAxes::File);
        CHECK(hasNotice(volume, "do not say where slices lie"));
        CHECK(hasNotice(volume, "1 mm is taken"));
    }
}

TEST_CASE("of several series in a folder one is chosen", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("study"));
    for (int n = 0; n < 3; ++n) folder.write("study/a" + std::to_string(n), dicomFile(sliceAt(n)));
    for (int n = 0; n < 2; ++n) {
        DicomSlice slice = sliceAt(n);
        slice.series = "1.2.9";
        slice.seriesNumber = "7";
        slice.description = "thin\x1b[31m";
        folder.write("study/b" + std::to_string(n), dicomFile(slice));
    }
    DicomSlice german = sliceAt(0);
    german.series = "1.2.10";
    german.seriesNumber = "8";
    german.description = "Sch\xe4"
                         "del"; // ä in Latin-1
    german.more.text(0x0008, 0x0005, "CS", "ISO_IR 100");
    folder.write("study/c", dicomFile(german));
    const FileContents contents = contentsOf(at(folder.path("study")));
    REQUIRE(contents.arrays.size() == 3);
    CHECK(contents.arrays[2] == "8: Schädel");
    CHECK(contents.array == "1: head");
    CHECK(contents.details[0] == "3 × 2 pixels, 3 pictures");
    CHECK(contents.arrays[0] == "1: head");
    CHECK(contents.arrays[1].find('\x1b') == std::string::npos);
    const Volume largest = loadVolume(at(folder.path("study")));
    CHECK(largest.dims().z == 3);
    CHECK(hasNotice(largest, "series '1: head' of 3 is shown"));
    for (const std::string& name : {std::string("7"), contents.arrays[1], std::string("1.2.9")}) {
        const Volume chosen = loadVolume(at(folder.path("study"), name));
        CHECK(chosen.dims().z == 2);
        CHECK(chosen.notices.empty());
    }
    CHECK_THROWS_WITH(loadVolume(at(folder.path("study"), "9")),
                      Contains("there is no series '9'") && Contains("1: head"));
    CHECK_THROWS_AS(loadVolume(at(folder.path("study"), "9")), UsageError);
}

TEST_CASE("what a folder holds is told anew once its files have changed", "[dicom]") {
    const TempFolder folder;
    writeStack(folder, "scan", 3);
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 3);
    CHECK(contentsOf(at(folder.path("scan/IM00"))).dims.z == 3);
    folder.write("scan/IM99", dicomFile(sliceAt(3)));
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 4);
    CHECK(contentsOf(at(folder.path("scan/IM00"))).dims.z == 4);
    fs::remove(folder.path("scan/IM99"));
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 3);
    // Nothing has changed: no program is asked.
    setReaderProgram(folder.path("none"));
    CHECK(contentsOf(at(folder.path("scan"))).dims.z == 3);
    setReaderProgram({});
}

TEST_CASE("several pictures of each place are time steps", "[dicom]") {
    const TempFolder folder;
    fs::create_directory(folder.path("heart"));
    int number = 0;
    const auto write = [&](int n, int step, const auto& mark) {
        DicomSlice slice = sliceAt(n);
        slice.number = ++number;
        slice.pixels = words({1000 * step + 100 * n, 0, 0, 0, 0, 0});
        mark(slice);
        folder.write("heart/" + std::to_string(number), dicomFile(slice));
    };
    SECTION("by the time after the heart beat, which may differ from slice to slice") {
        for (int n = 0; n < 3; ++n)
            for (int step = 1; step >= 0; --step)
                write(n, step,
                      [&](DicomSlice& slice) { slice.more.text(0x0018, 0x1060, "DS", std::to_string(40 * step + n)); });
        const SeriesListing listing = listSeries(at(folder.path("heart")));
        REQUIRE(listing.frames.size() == 2);
        CHECK(listing.timeUnit == "ms");
        CHECK(listing.frames[1].time == Approx(41)); // the mean of 40, 41, 42
        CHECK(loadVolume(listing.frames[1].source).value(12) == 1200);
        CHECK(loadVolume(listing.frames[0].source).value(12) == 200);
    }
    SECTION("by b-value; a step that lacks slices is left out") {
        for (int n = 0; n < 3; ++n)
            for (const int b : {0, 500, 1000})
                if (n != 2 || b != 1000)
                    write(n, b / 500, [&](DicomSlice& slice) { slice.more.real(0x0018, 0x9087, b); });
        const FileContents contents = contentsOf(at(folder.path("heart")));
        CHECK(contents.steps == 2);
        CHECK(contents.times == std::vector<double>{0, 500});
        CHECK(contents.timeUnit == "s/mm²");
        CHECK(hasNotice(loadVolume(at(folder.path("heart"))), "1 time step lacks slices"));
    }
}

TEST_CASE("frames of one DICOM file are slices, each with its own place and scaling", "[dicom]") {
    const TempFolder folder;
    DicomSlice slice;
    slice.position.clear();
    slice.axes.clear();
    slice.spacing.clear();
    slice.more.text(0x0028, 0x0008, "IS", "3");
    DicomElements shared, orientation, measures;
    orientation.text(0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0");
    measures.text(0x0028, 0x0030, "DS", "0.5\\0.25");
    shared.items(0x0020, 0x9116, {orientation});
    shared.items(0x0028, 0x9110, {measures});
    slice.more.items(0x5200, 0x9229, {shared});
    std::vector<DicomElements> frames;
    std::vector<int> values;
    for (int n = 0; n < 3; ++n) { // from the highest down
        DicomElements frame, place, scaling;
        place.text(0x0020, 0x0032, "DS", "1\\2\\" + std::to_string(10 - 2 * n));
        scaling.text(0x0028, 0x1052, "DS", "0");
        scaling.text(0x0028, 0x1053, "DS", std::to_string(n + 1) + ".5");
        frame.items(0x0020, 0x9113, {place});
        frame.items(0x0028, 0x9145, {scaling});
        frames.push_back(frame);
        for (int i = 0; i < 6; ++i) values.push_back(10 * n + i);
    }
    slice.more.items(0x5200, 0x9230, frames);
    slice.pixels = words(values);
    const Volume volume = loadVolume(at(folder.write("enhanced.dcm", dicomFile(slice))));
    CHECK(volume.dims() == Int3(3, 2, 3));
    CHECK(volume.geometry().spacing == Vec3(0.25, 0.5, 2));
    CHECK(volume.geometry().origin == Vec3(1, 2, 6));
    CHECK(volume.value(0) == 20 * 3.5); // the lowest is the last frame
    CHECK(volume.value(17) == 5 * 1.5);
}

TEST_CASE("what is wrong with a DICOM file is told", "[dicom]") {
    const TempFolder folder;
    const auto errorOf = [&](const std::string& bytes) {
        const TempFolder own;
        try {
            loadVolume(at(own.write("x.dcm", bytes)));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    DicomSlice slice = sliceAt(0);
    const std::string whole = dicomFile(slice);
    CHECK(errorOf(whole) == "no error");
    CHECK_THAT(errorOf(whole.substr(0, whole.size() - 1)),
               Contains("the pixels have 11 of 12 bytes") && Contains("x.dcm"));
    slice.rows = 60000;
    slice.columns = 60000;
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("the pixels have 12 of 7200000000 bytes") || Contains("memory"));
    slice = sliceAt(0);
    slice.bitsAllocated = 64;
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("64 bits"));
    slice = sliceAt(0);
    slice.bitsStored = 17;
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("17 of 16 bits"));
    slice = sliceAt(0);
    slice.pixels.clear();
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("has no pictures"));
    slice = sliceAt(0);
    slice.more.text(0x0028, 0x0008, "IS", "99999999");
    CHECK_THAT(errorOf(dicomFile(slice)), Contains("99999999 frames"));
    // One broken slice of a folder is named.
    writeStack(folder, "scan", 3);
    folder.write("scan/IM71", dicomFile(sliceAt(1)).substr(0, dicomFile(sliceAt(1)).size() - 4));
    CHECK_THROWS_WITH(loadVolume(at(folder.path("scan"))), Contains("8 of 12 bytes") && Contains("IM71"));
}

TEST_CASE("a DICOMDIR names the files of a study", "[dicom]") {
    const TempFolder folder;
    writeStack(folder, "IMAGES", 3);
    std::vector<DicomElements> records;
    for (const auto& entry : fs::directory_iterator(folder.path("IMAGES"))) {
        DicomElements record;
        record.text(0x0004, 0x1430, "CS", "IMAGE");
        record.text(0x0004, 0x1500, "CS", "IMAGES\\" + entry.path().filename().string());
        records.push_back(record);
    }
    DicomElements outside; // a name that leaves the folder is not followed
    outside.text(0x0004, 0x1500, "CS", "..\\..\\etc\\passwd");
    records.push_back(outside);
    DicomElements directory;
    directory.items(0x0004, 0x1220, records);
    const std::string path = folder.write("DICOMDIR", dicomFile(directory));
    const Volume volume = loadVolume(at(path));
    CHECK(volume.dims() == Int3(3, 2, 3));
    CHECK(volume.notices.empty());
}

TEST_CASE("what happens to the process that reads is told in a sentence", "[dicom]") {
    const TempFolder folder;
    const std::string path = folder.write("a.dcm", dicomFile(sliceAt(0)));
    const struct Restore {
        ~Restore() { setReaderProgram({}); }
    } restore;
    const auto with = [&](const std::string& script) {
        const std::string program = folder.write("reader.sh", "#!/bin/sh\n" + script + "\n");
        fs::permissions(program, fs::perms::owner_all);
        setReaderProgram(program);
    };
    with("read line; kill -SEGV $$");
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("crashed on it (signal 11)") && Contains("a.dcm"));
    // A file that takes too long is not tried twice.
    with("echo once >> '" + folder.path("count") + "'; read line; kill -XCPU $$");
    CHECK_THROWS_WITH(listSeries(at(path)), Contains("takes too long") && Contains("a.dcm"));
    CHECK(fs::file_size(folder.path("count")) == 5);  // "once" and a line end
    CHECK_THROWS_AS(filesOf(at(path)), TakesTooLong); // with which commands begin
    with("read line; echo nonsense");
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("can be understood"));
    with("read line; echo '{\"layout\":{\"axes\":[]}}'; sleep 100");
    CHECK_THROWS_AS(loadVolume(at(path)), Error);
    // More than any memory has: before anything is allocated.
    with("read line; echo '{\"layout\":{\"axes\":[{\"size\":2000000000,\"components\":false,\"time\":false},"
         "{\"size\":1000000000,\"components\":false,\"time\":false}],\"type\":0,\"spacing\":[1,1,1],\"origin\":[0,0,0],"
         "\"directions\":[[1,0,0],[0,1,0],[0,0,1]],\"patient\":false,\"array\":\"\",\"layers_at_once\":1,\"notices\":[]"
         "}}'; sleep 100");
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("would take hours"));
    setReaderProgram(folder.path("none"));
    CHECK_THROWS_WITH(loadVolume(at(path)), Contains("cannot be started"));
    // Cancelled: the process is ended, and nobody waits for it.
    with("read line; sleep 100");
    std::stop_source stop;
    JobControl job;
    job.stop = stop.get_token();
    stop.request_stop();
    CHECK_THROWS_AS(loadVolume(at(path), job), Cancelled);
}
