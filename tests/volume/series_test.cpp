// What a source names over time: patterns, globs, folders, files with several steps.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/file_names.h"
#include "volume/series.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

using Names = std::vector<std::string>;

VolumeSource sourceOf(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return source;
}

/// One voxel that is `letter`.
std::string oneVoxel(char letter) {
    return std::string("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\n") + letter;
}

/// Names of the files that the frames come from.
Names filesOfFrames(const SeriesListing& listing) {
    Names names;
    for (const SeriesFrame& frame : listing.frames)
        names.push_back(std::filesystem::path(frame.source.path).filename().string());
    return names;
}

Names namesOf(const SeriesListing& listing) {
    Names names;
    for (const SeriesFrame& frame : listing.frames) names.push_back(frame.name);
    return names;
}

/// The first voxel of each frame, as a letter.
std::string lettersOf(const SeriesListing& listing) {
    std::string letters;
    for (const SeriesFrame& frame : listing.frames) letters += static_cast<char>(loadVolume(frame.source).value(0));
    return letters;
}

} // namespace

TEST_CASE("numbers in names count as numbers", "[series]") {
    CHECK(countsBefore("f2.raw", "f10.raw"));
    CHECK_FALSE(countsBefore("f10.raw", "f2.raw"));
    CHECK(countsBefore("f02", "f2")); // the same number: as letters
    CHECK(countsBefore("a9b1", "a10b0"));
    CHECK(countsBefore("f", "f1"));
    CHECK(countsBefore("a/f9", "b/f1"));
    CHECK_FALSE(countsBefore("f1", "f1"));
    CHECK(countsBefore("f99999999999999999999998", "f99999999999999999999999")); // longer than any integer
}

TEST_CASE("a printf pattern has one number", "[series]") {
    CHECK(numberedName("f%03d.raw")->with(7) == "f007.raw");
    CHECK(numberedName("f%d.raw")->with(12) == "f12.raw");
    CHECK(numberedName("f%2i")->with(3) == "f 3");
    CHECK(numberedName("100%%_%02u.mhd")->with(123) == "100%_123.mhd");
    for (const char* none : {"f.raw", "f%s", "f%d%d", "f%", "f%.3d", "f%-3d", "f%03", "f%100d"}) {
        CAPTURE(none);
        CHECK_FALSE(numberedName(none));
    }
}

TEST_CASE("wildcards match names", "[series]") {
    CHECK(matchesGlob("f*.mhd", "f12.mhd"));
    CHECK(matchesGlob("f*.mhd", "f.mhd"));
    CHECK_FALSE(matchesGlob("f*.mhd", "g12.mhd"));
    CHECK(matchesGlob("*a*b*", "xxabab"));
    CHECK_FALSE(matchesGlob("*a*b", "xxaba"));
    CHECK(matchesGlob("f??", "f12"));
    CHECK_FALSE(matchesGlob("f??", "f1"));
    CHECK(matchesGlob("f[0-4]", "f3"));
    CHECK_FALSE(matchesGlob("f[0-4]", "f5"));
    CHECK(matchesGlob("f[!0-4]", "f5"));
    CHECK(matchesGlob("f[]x]", "f]"));
    CHECK(matchesGlob("f[1", "f[1")); // not closed: a bracket
}

TEST_CASE("a pattern, a glob and a folder list their files as people count", "[series]") {
    const TempFolder folder;
    for (const char* name : {"f2.nrrd", "f10.nrrd", "f1.nrrd", "g1.nrrd"})
        folder.write(name, oneVoxel(name == std::string("f2.nrrd")    ? 'b'
                                    : name == std::string("f10.nrrd") ? 'j'
                                                                      : 'a'));
    folder.write("notes.txt", "text");
    folder.write(".f3.nrrd", oneVoxel('h'));
    const Names expected{"f1.nrrd", "f2.nrrd", "f10.nrrd"};
    const SeriesListing glob = listSeries(sourceOf(folder.path("f*.nrrd")));
    CHECK(filesOfFrames(glob) == expected);
    CHECK(lettersOf(glob) == "abj");
    CHECK(namesOf(glob) == Names{"f1", "f2", "f10"});
    CHECK(glob.title == "f*.nrrd");
    CHECK_FALSE(glob.hasTimes);
    CHECK(glob.frames[2].time == 2);
    CHECK(glob.label(2) == "f10");
    CHECK(filesOfFrames(listSeries(sourceOf(folder.path("f*")))) == expected);
    CHECK(filesOfFrames(listSeries(sourceOf(folder.path("f?.nrrd")))) == Names{"f1.nrrd", "f2.nrrd"});
    CHECK(filesOfFrames(listSeries(sourceOf(folder.path("*")))) == Names{"f1.nrrd", "f2.nrrd", "f10.nrrd", "g1.nrrd"});
    CHECK(filesOfFrames(listSeries(sourceOf(folder.path(".")))) == Names{"f1.nrrd", "f2.nrrd", "f10.nrrd", "g1.nrrd"});
    CHECK(listSeries(sourceOf(folder.path("g%d.nrrd"))).frames.size() == 1);
    CHECK(listSeries(sourceOf(folder.path("g%d.nrrd"))).title == "g1.nrrd");
    for (const char* name : {"none%d.nrrd", "none*", "f%02d.nrrd.gz", "note*"}) {
        CAPTURE(name);
        CHECK_THROWS_AS(listSeries(sourceOf(folder.path(name))), FileError);
    }
    CHECK_THROWS_WITH(listSeries(sourceOf(folder.path("note*"))), Contains("no file of a known volume format"));
    std::filesystem::create_directory(folder.path("empty"));
    CHECK_THROWS_WITH(listSeries(sourceOf(folder.path("empty"))),
                      Contains("no file of a known volume format in this folder"));
}

TEST_CASE("wildcards and numbers may stand in folders", "[series]") {
    const TempFolder folder;
    for (const char* name : {"t1", "t2", "t11"}) {
        std::filesystem::create_directory(folder.path(name));
        folder.write(std::string(name) + "/p.nrrd", oneVoxel(name[1]));
    }
    std::filesystem::create_directory(folder.path("t3")); // without the file
    CHECK(lettersOf(listSeries(sourceOf(folder.path("t*/p.nrrd")))) == "121");
    CHECK(lettersOf(listSeries(sourceOf(folder.path("t[12]/p*")))) == "12");
    CHECK(listSeries(sourceOf(folder.path("t%d/p.nrrd"))).frames.size() == 3);
}

TEST_CASE("a number that is missing between others is a frame that cannot be read", "[series]") {
    const TempFolder folder;
    for (const char* name : {"d_040", "d_042", "d_044", "d_048", "d_050"})
        folder.write(name + std::string(".nrrd"), oneVoxel('x'));
    for (const char* what : {"d_%03d.nrrd", "d_*.nrrd", "."}) {
        CAPTURE(what);
        const SeriesListing listing = listSeries(sourceOf(folder.path(what)));
        CHECK(namesOf(listing) == Names{"d_040", "d_042", "d_044", "d_046", "d_048", "d_050"});
        REQUIRE(listing.notices.size() == 1);
        CHECK_THAT(listing.notices[0], Contains("1 file is missing") && Contains("d_046.nrrd"));
        CHECK_THROWS_WITH(loadVolume(listing.frames[3].source), Contains("no such file") && Contains("d_046.nrrd"));
    }
    // No even course (steps of 2 and 3), or more gaps than files (1, 2, 3, 100): those that are there.
    folder.write("d_053.nrrd", oneVoxel('x'));
    CHECK(listSeries(sourceOf(folder.path("d_%03d.nrrd"))).frames.size() == 6);
    for (const char* name : {"e1", "e2", "e3", "e100"}) folder.write(name + std::string(".nrrd"), oneVoxel('x'));
    const SeriesListing sparse = listSeries(sourceOf(folder.path("e%d.nrrd")));
    CHECK(sparse.frames.size() == 4);
    REQUIRE(sparse.notices.size() == 1);
    CHECK_THAT(sparse.notices[0], Contains("96 frame numbers are missing"));
    for (std::size_t f = 0; f < 4; ++f) CHECK(sparse.frames[f].afterGap == (f == 3));
    CHECK(sparse.fileOf(3) == "e100.nrrd");
    VolumeSource some = sourceOf(folder.path("e%d.nrrd"));
    some.frames = FrameRange{0, 3, 3}; // the gap lies between the two, whatever is left out
    CHECK(listSeries(some).frames[1].afterGap);
    VolumeSource sample;
    sample.path = "sample:vortex";
    CHECK(listSeries(sample).fileOf(2) == "sample:vortex, step 2");
}

TEST_CASE("of mixed suffixes the most frequent is taken", "[series]") {
    const TempFolder folder;
    for (const char* name : {"a1.nrrd", "a2.nrrd", "b1.mha"}) folder.write(name, oneVoxel('x'));
    for (const char* name : {"a1.raw", "a2.raw", "a3.raw"}) folder.write(name, "x");
    const SeriesListing listing = listSeries(sourceOf(folder.path(".")));
    CHECK(filesOfFrames(listing) == Names{"a1.nrrd", "a2.nrrd"});
    REQUIRE(listing.notices.size() == 1);
    CHECK_THAT(listing.notices[0], Contains("1 file of another suffix") && Contains("b1.mha"));
    VolumeSource raw = sourceOf(folder.path("."));
    raw.raw = parseRawLayout("1,1,1,u8");
    CHECK(filesOfFrames(listSeries(raw)) == Names{"a1.raw", "a2.raw", "a3.raw"});
}

TEST_CASE("several files are frames in the order given, and all settings are each frame's", "[series]") {
    const TempFolder folder;
    VolumeSource source = sourceOf(folder.write("z.bin", std::string("\1\2", 2)));
    source.more = {folder.write("a.bin", std::string("\3\4", 2)), folder.path("gone.bin")};
    source.raw = parseRawLayout("2,1,1,u8");
    source.missing = 4;
    source.downsample = 1;
    source.region = VoxelRegion{{1, 0, 0}, {2, 1, 1}};
    const SeriesListing listing = listSeries(source);
    CHECK(listing.title == "z.bin and 2 more");
    REQUIRE(namesOf(listing) == Names{"z", "a", "gone"});
    CHECK(loadVolume(listing.frames[0].source).value(0) == 2);
    CHECK(loadVolume(listing.frames[1].source).invalidCount() == 1);
    CHECK_THROWS_AS(loadVolume(listing.frames[2].source), FileError);
    for (const SeriesFrame& frame : listing.frames) {
        CHECK(frame.source.more.empty());
        CHECK(frame.source.missing == 4);
        CHECK(frame.source.downsample == 1);
        CHECK(frame.source.region == source.region);
        CHECK(frame.source.raw == source.raw);
    }
}

TEST_CASE("frames are selected by their numbers", "[series]") {
    const TempFolder folder;
    for (int i = 0; i < 6; ++i) folder.write("f" + std::to_string(i) + ".nrrd", oneVoxel(static_cast<char>('a' + i)));
    VolumeSource source = sourceOf(folder.path("f%d.nrrd"));
    const auto letters = [&](FrameRange frames) {
        source.frames = frames;
        return lettersOf(listSeries(source));
    };
    CHECK(letters({1, 3, 1}) == "bcd");
    CHECK(letters({1, {}, 2}) == "bdf");
    CHECK(letters({5, 5, 1}) == "f");
    CHECK(letters({1, 5, 2147483647}) == "b");
    for (const FrameRange none :
         {FrameRange{6, {}, 1}, FrameRange{0, 6, 1}, FrameRange{3, 2, 1}, FrameRange{-1, 2, 1}, FrameRange{0, 2, 0}})
        CHECK_THROWS_WITH(letters(none), Contains("no such frames") && Contains("0 to 5"));
    VolumeSource one = sourceOf("sample:knee");
    one.frames = FrameRange{1, {}, 1};
    CHECK_THROWS_WITH(listSeries(one), Contains("it has one, number 0"));
}

TEST_CASE("bricks of simulations: big-endian floats with missing values, a file for each step", "[series]") {
    // 1e35 is no float: what stands in the file is the nearest one, and means missing.
    const TempFolder folder;
    const auto bigEndian = [](std::vector<float> values) {
        std::string bytes = bytesOf(values);
        for (std::size_t i = 0; i < bytes.size(); i += 4)
            std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                         bytes.begin() + static_cast<std::ptrdiff_t>(i + 4));
        return bytes;
    };
    folder.write("CLOUDf01.bin", bigEndian({1, 1e35f, 3}));
    folder.write("CLOUDf02.bin", bigEndian({1e35f, 1e35f, 4}));
    folder.write("Pf01.bin", bigEndian({7, 8, 9}));
    VolumeSource source = sourceOf(folder.path("CLOUDf%02d.bin"));
    source.raw = parseRawLayout("3,1,1,f32,big");
    source.missing = 1e35;
    const SeriesListing listing = listSeries(source);
    REQUIRE(namesOf(listing) == Names{"CLOUDf01", "CLOUDf02"});
    const Volume first = loadVolume(listing.frames[0].source), second = loadVolume(listing.frames[1].source);
    CHECK(first.invalidCount() == 1);
    CHECK(first.dataRange() == ValueRange{1, 3});
    CHECK(second.invalidCount() == 2);
    CHECK(second.value(2) == 4);
}

TEST_CASE("a headerless file of several steps needs to be asked for them", "[series]") {
    const TempFolder folder;
    VolumeSource source = sourceOf(folder.write("s.bin", "##abcdef"));
    source.raw = parseRawLayout("2,1,1,u8");
    source.raw->skipBytes = 2;
    CHECK(listSeries(source).frames.size() == 1);
    CHECK_THROWS_WITH(loadVolume(source), Contains("8 bytes"));
    source.frames = FrameRange{};
    const SeriesListing listing = listSeries(source);
    CHECK(namesOf(listing) == Names{"step 0", "step 1", "step 2"});
    CHECK(lettersOf(listing) == "ace");
    source.frames = FrameRange{1, 2, 1};
    CHECK(lettersOf(listSeries(source)) == "ce");
    // Of several files each has one step: a longer one is damaged.
    VolumeSource both = source;
    both.path = folder.write("t.bin", "##gh");
    both.more = {source.path};
    both.frames = FrameRange{};
    CHECK(listSeries(both).frames.size() == 2);
    CHECK_THROWS_AS(loadVolume(listSeries(both).frames[1].source), FileError);
    source.raw->skipBytes = 1; // 7 bytes are no multiple of 2
    source.frames = FrameRange{};
    CHECK(listSeries(source).frames.size() == 1);
}

TEST_CASE("NIfTI over time: times by pixdim in the unit of xyzt_units", "[series]") {
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {4, 2, 1, 1, 3, 1, 1, 1};
    nifti.pixdim = {1, 1, 1, 1, 2.5f, 1, 1, 1};
    const auto listed = [&](int units, bool packed) {
        nifti.units = static_cast<char>(units);
        const std::string bytes = nifti.header() + "abcdef";
        return listSeries(sourceOf(packed ? folder.write("a.nii.gz", gzipped(bytes)) : folder.write("a.nii", bytes)));
    };
    for (const bool packed : {false, true}) {
        const SeriesListing seconds = listed(2 | 8, packed);
        CHECK(lettersOf(seconds) == "ace");
        CHECK(seconds.hasTimes);
        CHECK(seconds.timeUnit == "s");
        CHECK(seconds.frames[2].time == 5);
        CHECK(seconds.label(1) == "t = 2.5 s");
        CHECK(namesOf(seconds) == Names{"step 0", "step 1", "step 2"});
        CHECK(listed(2 | 16, packed).label(1) == "t = 2.5 ms");
        CHECK(listed(2, packed).label(1) == "t = 2.5");
        CHECK_FALSE(listed(2 | 32, packed).hasTimes); // hertz is no time
    }
    nifti.pixdim[4] = 0;
    CHECK_FALSE(listed(2 | 8, false).hasTimes);
    CHECK(listed(2 | 8, false).label(1) == "step 1");
}

TEST_CASE("NRRD over time: by its kind, as a list behind space, or as one axis more", "[series]") {
    const TempFolder folder;
    const auto listed = [&](const std::string& sizes, const std::string& fields) {
        return listSeries(sourceOf(folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: " + sizes +
                                                              "\n" + fields + "encoding: raw\n\nabcdef")));
    };
    const SeriesListing behind = listed("2 1 1 3", "kinds: domain domain domain time\nspacings: 1 1 1 0.5\n"
                                                   "units: \"mm\" \"mm\" \"mm\" \"ms\"\naxis mins: 0 0 0 10\n");
    CHECK(lettersOf(behind) == "ace");
    CHECK(behind.timeUnit == "ms");
    CHECK(behind.label(2) == "t = 11 ms");
    const SeriesListing before = listed("3 2 1 1", "kinds: time domain domain domain\n");
    CHECK(lettersOf(before) == "abc"); // steps lie side by side
    CHECK(loadVolume(before.frames[1].source).value(1) == 'e');
    CHECK_FALSE(before.hasTimes);
    CHECK(lettersOf(listed("2 1 1 3", "kinds: domain domain domain list\n")) == "ace");
    CHECK(lettersOf(listed("2 1 1 3", "")) == "ace");
    CHECK(listed("3 2 1 1", "kinds: list domain domain domain\n").frames.size() == 1); // components
    const SeriesListing inSpace = listed(
        "2 1 1 3", "space: scanner-xyz-time\nkinds: space space space time\nspace directions: (1,0,0,0) "
                   "(0,1,0,0) (0,0,1,0) (0,0,0,2)\nspace origin: (0,0,0,4)\nspace units: \"mm\" \"mm\" \"mm\" \"s\"\n");
    CHECK(inSpace.label(1) == "t = 6 s");
}

TEST_CASE("a header that claims endless steps takes no memory", "[series]") {
    const TempFolder folder;
    VolumeSource source = sourceOf(
        folder.write("long.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 1 1 1 2000000000\nencoding: raw\n"
                                  "kinds: domain domain domain time\n\nabcdef"));
    CHECK_THROWS_WITH(listSeries(source), Contains("a series of 2000000000 frames") && Contains("choose at most"));
    CHECK_THROWS_AS(listSeries(source), FileError); // the file's fault, unless somebody has asked for so many
    source.frames = FrameRange{0, 199999, 1};
    CHECK_THROWS_AS(listSeries(source), UsageError);
    source.frames = FrameRange{1, 5, 2};
    const SeriesListing listing = listSeries(source);
    CHECK(lettersOf(listing) == "bdf");
    CHECK(listing.frames[1].time == 3); // as it is numbered in the file
}

TEST_CASE("MetaImage of four axes: the last one is time", "[series]") {
    const TempFolder folder;
    const auto listed = [&](const std::string& fields) {
        return listSeries(sourceOf(
            folder.write("a.mha", "ObjectType = Image\nNDims = 4\nDimSize = 2 1 1 3\nElementType = MET_UCHAR\n" +
                                      fields + "ElementDataFile = LOCAL\nabcdef")));
    };
    const SeriesListing timed = listed("ElementSpacing = 1 1 1 0.25\nOffset = 0 0 0 2\n");
    CHECK(lettersOf(timed) == "ace");
    CHECK(timed.label(2) == "t = 2.5");
    CHECK(listed("").label(2) == "step 2");
}

TEST_CASE("of a file that is cut off, the steps that are there can be read", "[series]") {
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {4, 2, 1, 1, 3, 1, 1, 1};
    const SeriesListing plain = listSeries(sourceOf(folder.write("a.nii", nifti.header() + "abcd")));
    REQUIRE(plain.frames.size() == 3);
    CHECK(loadVolume(plain.frames[1].source).value(0) == 'c');
    CHECK_THROWS_WITH(loadVolume(plain.frames[2].source), Contains("4 of 6 bytes"));
    const SeriesListing meta = listSeries(sourceOf(
        folder.write("a.mha", "NDims = 4\nDimSize = 2 1 1 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nabcd")));
    CHECK(loadVolume(meta.frames[1].source).value(1) == 'd');
    CHECK_THROWS_AS(loadVolume(meta.frames[2].source), FileError);
}

TEST_CASE("steps of packed files are the same in any order of reading", "[series]") {
    // 40 steps of 64 KiB: more than the places that are kept at first. What each holds follows from its number.
    const TempFolder folder;
    constexpr int kSteps = 40, kVoxels = 1 << 16;
    std::string all(static_cast<std::size_t>(kSteps) * kVoxels, '\0');
    std::uint32_t state = 1;
    for (char& c : all) c = static_cast<char>((state = state * 1664525u + 1013904223u) >> 28);
    Nifti nifti;
    nifti.dim = {4, 64, 64, 16, kSteps, 1, 1, 1};
    const std::string path = folder.write("a.nii.gz", gzipped(nifti.header() + all));
    const SeriesListing listing = listSeries(sourceOf(path));
    REQUIRE(listing.frames.size() == kSteps);
    for (const int step : {39, 0, 17, 18, 3, 38, 17}) {
        CAPTURE(step);
        const Volume volume = loadVolume(listing.frames[static_cast<std::size_t>(step)].source);
        const auto& samples = std::get<SampleArray<std::uint8_t>>(volume.samples());
        CHECK(std::string(samples.begin(), samples.end()) ==
              all.substr(static_cast<std::size_t>(step) * kVoxels, kVoxels));
    }
    // Another file under the same name is another file; of one that is cut off no step is known to be sound.
    std::string packed = gzipped(nifti.header() + all);
    packed.resize(packed.size() / 2);
    folder.write("a.nii.gz", packed);
    CHECK_THROWS_WITH(loadVolume(listing.frames[30].source), Contains("compressed data ends after"));
    for (const std::size_t step : {5u, 15u})
        CHECK_THROWS_WITH(loadVolume(listing.frames[step].source), Contains("before its checksum"));
}

TEST_CASE("contents of a file are told by its header", "[series]") {
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {4, 2, 3, 4, 5, 1, 1, 1};
    nifti.datatype = 4;
    nifti.slope = 2;
    const FileContents contents = contentsOf(sourceOf(folder.write("a.nii", nifti.header()))); // no data at all
    CHECK(contents.dims == Int3(2, 3, 4));
    CHECK(contents.type == SampleType::F32); // scaled
    CHECK(contents.steps == 5);
    CHECK(contents.components == 1);
    CHECK(contents.arrays.empty());
    CHECK_THROWS_AS(contentsOf(sourceOf(folder.path("gone.nii"))), FileError);
    CHECK_THROWS_AS(contentsOf(sourceOf(folder.write("b.nii", "no header"))), FileError);
}

TEST_CASE("the files of a series are those of all its frames that are there", "[series]") {
    const TempFolder folder;
    const auto header = [](const std::string& data) {
        return "NDims = 3\nDimSize = 1 1 1\nElementType = MET_UCHAR\nElementDataFile = " + data + "\n";
    };
    const std::string one = folder.write("f1.mhd", header("f1.raw")), three = folder.write("f3.mhd", header("f3.raw"));
    const std::string two = folder.write("f2.mhd", header("f2.raw"));
    CHECK(filesOf(sourceOf(folder.path("f%d.mhd"))) ==
          Names{one, folder.path("f1.raw"), two, folder.path("f2.raw"), three, folder.path("f3.raw")});
    VolumeSource both = sourceOf(three);
    both.more = {one};
    CHECK(filesOf(both) == Names{three, folder.path("f3.raw"), one, folder.path("f1.raw")});
    CHECK(filesOf(sourceOf(folder.path("none%d.mhd"))) == Names{folder.path("none%d.mhd")});
}
