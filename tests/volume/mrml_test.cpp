// Scenes of 3D Slicer, and paths as other programs copy them.
#include <catch2/catch.hpp>

#include "support/notices.h"
#include "support/temp_folder.h"
#include "volume/file_contents.h"
#include "volume/file_names.h"
#include "volume/loader.h"
#include "volume/outside_files.h"
#include "volume/volume_writer.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

VolumeSource at(const std::string& path, const std::string& array = "") {
    VolumeSource source;
    source.path = path;
    source.array = array;
    return source;
}

void writeOf(const std::string& path, std::uint8_t value) {
    Geometry g;
    g.dims = {2, 2, 2};
    writeVolume(Volume(g, SampleArray<std::uint8_t>(std::vector<std::uint8_t>{value, 1, 2, 3, 4, 5, 6, 7})), path);
}

const std::string kScene =
    "<MRML version=\"Slicer 5.2.2\">\n"
    "<Volume id=\"vtkMRMLScalarVolumeNode1\" name=\"CT &amp; chest\" "
    "references=\"display:vtkMRMLScalarVolumeDisplayNode1;storage:vtkMRMLVolumeArchetypeStorageNode1;\"></Volume>\n"
    "<Volume id=\"vtkMRMLScalarVolumeNode2\" name=\"MR\" "
    "storageNodeRef=\"vtkMRMLVolumeArchetypeStorageNode2\"></Volume>\n"
    "<Volume id=\"vtkMRMLScalarVolumeNode3\" name=\"never saved\" references=\"display:x;\"></Volume>\n"
    "<VolumeArchetypeStorage id=\"vtkMRMLVolumeArchetypeStorageNode1\" "
    "fileName=\"CT%20chest.nrrd\"></VolumeArchetypeStorage>\n"
    "<VolumeArchetypeStorage id=\"vtkMRMLVolumeArchetypeStorageNode2\" "
    "fileName=\"Data/mr.mha\"></VolumeArchetypeStorage>\n"
    "</MRML>\n";

} // namespace

TEST_CASE("the volumes of a scene of 3D Slicer open", "[mrml]") {
    const TempFolder folder;
    std::filesystem::create_directories(folder.path("Data"));
    writeOf(folder.path("CT chest.nrrd"), 100);
    writeOf(folder.path("Data/mr.mha"), 200);
    const std::string path = folder.write("scene.mrml", kScene);
    const FileContents contents = contentsOf(at(path));
    CHECK(contents.arrays == std::vector<std::string>{"CT & chest", "MR"});
    CHECK(contents.array == "CT & chest");
    CHECK(contents.details == std::vector<std::string>{"CT chest.nrrd", "mr.mha"});
    CHECK(mayHoldSeveral(path));
    const Volume first = loadVolume(at(path));
    CHECK(first.value(0) == 100);
    CHECK_THAT(first.notices.back(), Contains("of 2 in the scene is shown"));
    CHECK(loadVolume(at(path, "MR")).value(0) == 200);
    CHECK(loadMiddleSlice(at(path, "MR")).dims() == Int3(2, 2, 1));
    CHECK_THROWS_WITH(loadVolume(at(path, "PET")), Contains("PET") && Contains("MR"));
    CHECK(filesOf(at(path)).size() == 3);
}

TEST_CASE("transforms of a scene of 3D Slicer put its volumes in their places", "[mrml]") {
    const TempFolder folder;
    Geometry g;
    g.dims = {2, 2, 2};
    g.spacing = {1, 2, 3};
    g.origin = {10, 20, 30};
    g.worldAxes = WorldAxes::Patient;
    const Volume volume(g, SampleArray<std::uint8_t>(std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    writeVolume(volume, folder.path("a.nrrd"));
    const auto loaded = [&](const std::string& attributes, const std::string& transforms) {
        return loadVolume(
            at(folder.write("a.mrml", "<MRML><Volume name=\"a\" storageNodeRef=\"s\" " + attributes +
                                          "/><Storage id=\"s\" fileName=\"a.nrrd\"/>" + transforms + "</MRML>")));
    };
    const auto transform = [](const std::string& id, const std::string& matrix, const std::string& more = "") {
        return "<LinearTransform id=\"" + id + "\" name=\"T " + id + "\" matrixTransformToParent=\"" + matrix + "\" " +
               more + "/>";
    };
    // By 100 to the right and 50 to the front, which are −100 and −50 of ours.
    const std::string shift = transform("1", "1 0 0 100  0 1 0 50  0 0 1 5  0 0 0 1");
    const Volume shifted = loaded("transformNodeRef=\"1\"", shift);
    CHECK(shifted.geometry().origin == Vec3(-90, -30, 35));
    CHECK(shifted.geometry().spacing == g.spacing);
    CHECK(shifted.geometry().directions == Mat3(1));
    CHECK(hasNotice(shifted, "lies where that puts it"));
    CHECK(loaded("references=\"storage:s;transform:1;\"", shift).geometry().origin == Vec3(-90, -30, 35));
    // x of the scene to y, y to z, z to 2 x: where signs turn round, x of ours (−x) to −y (y), y (−y) to −z, z to −2 x.
    const std::string turn = transform("2", "0 0 2 0  1 0 0 0  0 1 0 0  0 0 0 1", "transformNodeRef=\"1\"");
    const Geometry turned = loaded("transformNodeRef=\"2\"", turn + shift).geometry();
    CHECK(turned.spacing == Vec3(1, 2, 6));
    CHECK(turned.directions == Mat3(Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(-1, 0, 0)));
    CHECK(turned.origin == Vec3(-60 - 100, 10 - 50, -20 + 5)); // then shifted
    // Without a transform, and what cannot be applied.
    CHECK(loaded("", shift).notices.empty());
    for (const std::string& other : {std::string("<GridTransform id=\"1\" name=\"T 1\"/>"), transform("1", "1 2 3"),
                                     transform("1", "1 0 0 1  0 1 0 1  0 0 1 1  0 0 0 1", "transformNodeRef=\"1\"")}) {
        INFO(other);
        const Volume unmoved = loaded("transformNodeRef=\"1\"", other);
        CHECK(unmoved.geometry().origin == g.origin);
        CHECK(hasNotice(unmoved, "'T 1', which is not applied"));
    }
    CHECK(hasNotice(loaded("transformNodeRef=\"gone\"", shift), "'gone', which is not applied"));
    CHECK(hasNotice(loaded("transformNodeRef=\"7\"", "<GridTransform id=\"7\"/>"), "'7', which is not applied"));
    CHECK_THROWS_WITH(loaded("transformNodeRef=\"1\"", transform("1", "1 0 0 0  1 0 0 0  0 0 1 0  0 0 0 1")),
                      Contains("cannot be used"));
    writeOf(folder.path("a.nrrd"), 1); // of no patient
    CHECK(hasNotice(loaded("transformNodeRef=\"1\"", shift), "not in a patient's world"));
}

TEST_CASE("what a scene cannot name is refused", "[mrml]") {
    const TempFolder folder;
    const auto errorOf = [&](const std::string& text) {
        try {
            static_cast<void>(loadVolume(at(folder.write("a.mrml", text))));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    const auto scene = [](const std::string& file) {
        return "<MRML><Volume name=\"a\" storageNodeRef=\"s\"/><S_VolumeArchetypeStorage id=\"s\" fileName=\"" + file +
               "\"/></MRML>";
    };
    CHECK_THAT(errorOf(scene("../x.nrrd")), Contains("outside") || Contains("folder"));
    CHECK_THAT(errorOf(scene("%2e%2e/x.nrrd")), Contains("outside") || Contains("folder"));
    CHECK_THAT(errorOf(scene("a.mrml")), Contains("names another scene"));
    folder.write("itself.nrrd", scene("itself.nrrd")); // read as what it is, not as what it is called
    CHECK_THAT(errorOf(scene("itself.nrrd")), Contains("names another scene"));
    folder.write("round.nrrd",
                 "<VTKFile type=\"Collection\"><Collection><DataSet file=\"a.mrml\"/></Collection></VTKFile>");
    CHECK_THAT(errorOf(scene("round.nrrd")), Contains("names another collection"));
    CHECK_THAT(errorOf(scene("gone.nrrd")), Contains("no such file") && Contains("gone.nrrd"));
    CHECK_THAT(errorOf("<MRML><Volume name=\"a\"/></MRML>"), Contains("no volumes that have been saved"));
    CHECK_THAT(errorOf("<html></html>"), Contains("not a scene of 3D Slicer"));
}

TEST_CASE("file addresses are paths", "[mrml]") {
    CHECK(pathOfUrl("file:///a/b%20c%C3%A9.nrrd") == "/a/b cé.nrrd");
    CHECK(pathOfUrl("file://localhost/a.nrrd") == "/a.nrrd");
    CHECK(pathOfUrl("file:/a/b%20c.nrrd") == "/a/b c.nrrd");
    CHECK(pathOfUrl("file:a") == "file:a");
    CHECK(pathOfUrl("/a/b%20c") == "/a/b%20c"); // a name may have a percent sign
    CHECK(pathOfUrl("file:///100%") == "/100%");
    CHECK(pathOfUrl("file:///a%zz") == "/a%zz");
}
