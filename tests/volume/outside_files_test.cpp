// Headers that name files outside their own folder.
#include <catch2/catch.hpp>

#include <filesystem>

#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume/outside_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

TEST_CASE("a header reads no file outside its folder unless the user allows it", "[bad-input]") {
    const TempFolder folder;
    std::filesystem::create_directories(folder.path("headers/data"));
    folder.write("outside.raw", std::string(8, 'o'));
    folder.write("headers/data/inside.raw", std::string(8, 'i'));
    int number = 0;
    // What a header with this name of its data reads: NRRD, MetaImage and a collection of VTK.
    const auto headersOf = [&](const std::string& data) {
        const std::string name = "headers/" + std::to_string(number++);
        return std::vector<std::string>{
            folder.write(name + ".nhdr",
                         "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: " + data + "\n"),
            folder.write(name + ".mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                        "ElementDataFile = " +
                                            data + "\n"),
            folder.write(name + ".pvd", "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>"
                                        "<DataSet timestep=\"0\" file=\"" +
                                            data + "\"/></Collection></VTKFile>")};
    };
    const auto load = [](const std::string& path) {
        VolumeSource source;
        source.path = path;
        return loadVolume(source);
    };
    for (const std::string& data : {std::string("../outside.raw"), folder.path("outside.raw"),
                                    std::string("/etc/passwd"), std::string("data/../../outside.raw")})
        for (const std::string& header : headersOf(data)) {
            CAPTURE(header, data);
            try {
                load(header);
                FAIL_CHECK("it was read");
            } catch (const FileError& error) {
                CHECK_THAT(error.problem(), Contains("outside its own folder") && Contains(data));
                CHECK(error.remedy() == Remedy::AllowOutside);
            }
        }
    for (const std::string& data : {std::string("data/inside.raw"), folder.path("headers/data/inside.raw"),
                                    std::string("data/../data/inside.raw")})
        for (const std::string& header : headersOf(data)) {
            CAPTURE(header, data);
            if (header.ends_with(".pvd")) continue; // names volumes, not raw data
            CHECK(load(header).value(7) == 'i');
        }
    const std::vector<std::string> headers = headersOf("../outside.raw");
    allowOutsideFiles(headers[0]);
    CHECK(load(headers[0]).value(0) == 'o');
    CHECK_THROWS_AS(load(headers[1]), FileError); // that header alone
}
