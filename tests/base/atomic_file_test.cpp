#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/temp_folder.h"

using namespace pellucid;
using pellucid::test::TempFolder;
namespace fs = std::filesystem;

TEST_CASE("a written file is whole and alone", "[atomic-file]") {
    const TempFolder folder;
    writeTextAtomically(folder.path("a.txt"), "one");
    writeTextAtomically(folder.path("a.txt"), "two\n");
    CHECK(readText(folder.path("a.txt")) == "two\n");
    CHECK(folder.fileCount() == 1);
    writeTextAtomically(folder.path("empty.txt"), "");
    CHECK(readText(folder.path("empty.txt")).empty());
}

TEST_CASE("a write that fails leaves the old file and nothing else", "[atomic-file]") {
    const TempFolder folder;
    folder.write("a.png", "old");
    std::string temporary;
    CHECK_THROWS_AS(writeAtomically(folder.path("a.png"),
                                    [&](const std::string& path) {
                                        temporary = path;
                                        std::ofstream(path) << "half";
                                        throw std::runtime_error("disk on fire");
                                    }),
                    std::runtime_error);
    CHECK(readText(folder.path("a.png")) == "old");
    CHECK(folder.fileCount() == 1);
    CHECK(fs::path(temporary).extension() == ".png"); // image libraries choose the format by it
    CHECK(fs::path(temporary).parent_path() == fs::path(folder.path("x")).parent_path());
}

TEST_CASE("places that cannot be written or read are told", "[atomic-file]") {
    const TempFolder folder;
    CHECK_THROWS_AS(writeTextAtomically(folder.path("none/a.txt"), "x"), FileError);
    CHECK_THROWS_AS(writeTextAtomically(folder.path("."), "x"), FileError);
    CHECK_THROWS_AS(readText(folder.path("none.txt")), FileError);
    CHECK_THROWS_AS(readText(folder.path(".")), FileError);
}

TEST_CASE("a link stays a link, a device stays a device", "[atomic-file]") {
    const TempFolder folder;
    folder.write("real.txt", "old");
    fs::create_symlink(folder.path("real.txt"), folder.path("link.txt"));
    writeTextAtomically(folder.path("link.txt"), "new");
    CHECK(fs::is_symlink(folder.path("link.txt")));
    CHECK(readText(folder.path("real.txt")) == "new");
    writeTextAtomically("/dev/null", "gone");
    CHECK(fs::is_character_file("/dev/null"));
}
