// What a file is, is told by what is in it, whatever its name says.
#include <catch2/catch.hpp>

#include <filesystem>

#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/formats/content.h"
#include "volume/loader.h"
#include "volume/series.h"
#include "volume_files.h"
#include "vtk_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;
using namespace std::string_literals;

namespace {

VolumeSource sourceOf(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return source;
}

std::string errorOf(const std::string& path) {
    try {
        loadVolume(sourceOf(path));
    } catch (const FileError& e) {
        return e.what();
    }
    return "no error";
}

struct Sample {
    std::string format, bytes;
};

/// One file of each format: 2 x 3 x 1 voxels.
std::vector<Sample> samples() {
    Nifti nifti;
    nifti.dim = {3, 2, 3, 1, 1, 1, 1, 1};
    Nifti second = nifti;
    return {
        {"NRRD", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 3 1\nencoding: raw\n\nabcdef"},
        {"MetaImage",
         "ObjectType = Image\nNDims = 3\nElementType = MET_UCHAR\nDimSize = 2 3 1\nElementDataFile = LOCAL\n"
         "abcdef"},
        {"MetaImage", "Comment = something\r\nNDims = 3\r\nDimSize = 2 3 1\r\nElementType = MET_UCHAR\r\n"
                      "ElementDataFile = LOCAL\nabcdef"},
        {"NIfTI", nifti.header() + "abcdef"},
        {"NIfTI", gzipped(nifti.header() + "abcdef")},
        {"NIfTI", second.header2() + "abcdef"},
        {"NIfTI", gzipped(second.header2() + "abcdef")},
        {"VTK image data", vti({}, {{"type=\"UInt8\" Name=\"a\"", "1 2 3 4 5 6", ""}})},
        {"VTK legacy file", "# vtk DataFile Version 2.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 1\n"
                            "POINT_DATA 6\nSCALARS a int\nLOOKUP_TABLE default\n1 2 3 4 5 6\n"},
        {"PVM", "PVM\n2 3 1\n1\nabcdef"},
        {"Voreen or Inviwo header", "Resolution: 2 3 1\nFormat: UINT8\nRawFile: data.bytes\n"},
        {"Voreen volume",
         "<?xml version=\"1.0\"?>\n<VoreenData version=\"1\"><Volumes><Volume><RawData "
         "filename=\"data.bytes\" format=\"uint8\" x=\"2\" y=\"3\" z=\"1\"/></Volume></Volumes></VoreenData>"},
    };
}

} // namespace

TEST_CASE("a file of each format opens under any name", "[content]") {
    const TempFolder folder;
    folder.write("data.bytes", "abcdef");
    for (const Sample& sample : samples())
        for (const char* name : {"foo.bin", "foo", "foo.mha", "foo.nrrd", "foo.nii", "foo.vti", "foo.dcm", "foo.tif",
                                 "foo.pvm", "foo.raw", "foo.dat", "foo.vtk", "foo.img"}) {
            CAPTURE(sample.format, name);
            const std::string path = folder.write(name, sample.bytes);
            CHECK(loadVolume(sourceOf(path)).format == sample.format);
            CHECK(contentsOf(sourceOf(path)).dims == Int3(2, 3, 1));
            CHECK_FALSE(mayBeHeaderless(path));
            CHECK(hasVolumeSuffix(path));
            std::filesystem::remove(path);
        }
}

TEST_CASE("VTK's files that name others open under any name", "[content]") {
    const TempFolder folder;
    const std::string image = "WholeExtent=\"0 1 0 2 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
    folder.write("one.bin", vti({}, {{"type=\"UInt8\" Name=\"a\"", "1 2 3 4 5 6", ""}}));
    const std::string whole =
        folder.write("whole.vti", pvti(image, {"type=\"UInt8\" Name=\"a\""}, {{"0 1 0 2 0 0", "one.bin"}}));
    CHECK(loadVolume(sourceOf(whole)).format == "VTK image data in pieces");
    const std::string times = folder.write(
        "times.txt",
        "<VTKFile type='Collection'><Collection><DataSet timestep=\"3\" file=\"one.bin\"/></Collection></VTKFile>");
    CHECK(contentsOf(sourceOf(times)).times == std::vector<double>{3});
    CHECK(loadVolume(sourceOf(times)).dims() == Int3(2, 3, 1));
}

TEST_CASE("where the content tells nothing the suffix does", "[content]") {
    const TempFolder folder;
    for (const char* name : {"a.nrrd", "a.mhd", "a.nii", "a.vti", "a.pvti", "a.pvd", "a.vtk", "a.pvm", "a.vvd"})
        CHECK_THAT(errorOf(folder.write(name, "Dear reader, this is a letter")), Contains("but text"));
    for (const char* name : {"a.raw", "a.dat", "a.img"}) {
        const std::string path = folder.write(name, std::string(6, '\3'));
        CHECK_THAT(errorOf(path), Contains("headerless data needs its layout"));
        CHECK(mayBeHeaderless(path));
        CHECK_FALSE(hasVolumeSuffix(path));
    }
    // A layout that is given counts, whatever the file is.
    VolumeSource source = sourceOf(folder.write("a.bin", "NRRD0004"));
    source.raw = parseRawLayout("8,1,1,u8");
    CHECK(loadVolume(source).value(0) == 'N');
}

TEST_CASE("texts that mention fields of a format are not taken for one", "[content]") {
    for (const std::string& text :
         {"NDims is a field\n"s, "Dear reader,\nNDims = 3\n"s, "see RawFile: a.raw"s, "RawFile = a.raw\n"s,
          "PVM is a format"s, "NRRD is a format"s, "<VTKFile type=\"PolyData\">"s, "\x5c\1\0\0 and nothing more"s,
          "\x1f\x8b\x08 cut off"s})
        CHECK_THAT(describeContent(text), Contains("text") || Contains("data"));
}

TEST_CASE("the data file of a pair opens by its own name", "[content]") {
    const TempFolder folder;
    Nifti nifti;
    nifti.dim = {3, 2, 3, 1, 1, 1, 1, 1};
    nifti.magic = "ni1";
    nifti.voxOffset = 0;
    const std::string header = folder.write("a.hdr", nifti.header().substr(0, 348)),
                      image = folder.write("a.img", "abcdef");
    const Volume volume = loadVolume(sourceOf(image));
    CHECK(volume.format == "NIfTI");
    CHECK(volume.title == "a.img");
    CHECK(volume.value(5) == 'f');
    CHECK(contentsOf(sourceOf(image)).dims == Int3(2, 3, 1));
    CHECK_FALSE(mayBeHeaderless(image));
    CHECK_FALSE(hasVolumeSuffix(image)); // in a folder its header stands for it
    CHECK(filesOf(sourceOf(image)) == std::vector<std::string>{image, header});

    folder.write("B.HDR", nifti.header().substr(0, 348));
    CHECK(loadVolume(sourceOf(folder.write("B.IMG", "abcdef"))).value(0) == 'a');
    folder.write("c.hdr.gz", gzipped(nifti.header().substr(0, 348)));
    CHECK(loadVolume(sourceOf(folder.write("c.img.gz", gzipped("abcdef")))).value(0) == 'a');

    // Beside a header of Analyze it says so; beside one of something else the data are headerless.
    nifti.magic = std::string(3, '\0');
    folder.write("d.hdr", nifti.header().substr(0, 348));
    CHECK_THAT(errorOf(folder.write("d.img", "abcdef")), Contains("convert an Analyze file"));
    folder.write("e.hdr", "ENVI\nsamples = 2\nlines = 3\n");
    CHECK(mayBeHeaderless(folder.write("e.img", "abcdef")));
}
