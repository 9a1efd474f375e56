#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_watch.h"
#include "support/full_disk.h"
#include "support/temp_folder.h"

using namespace pellucid;
using pellucid::test::FullDisk;
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
    CHECK_THROWS_AS(writeAtomically(folder.path("a.png"),
                                    [&](OutputFile& file) {
                                        file.write("half");
                                        CHECK(folder.fileCount() == 2);
                                        throw std::runtime_error("disk on fire");
                                    }),
                    std::runtime_error);
    CHECK(readText(folder.path("a.png")) == "old");
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("places that cannot be written or read are told", "[atomic-file]") {
    const TempFolder folder;
    CHECK_THROWS_AS(writeTextAtomically(folder.path("none/a.txt"), "x"), FileError);
    CHECK_THROWS_AS(writeTextAtomically(folder.path("."), "x"), FileError);
    CHECK_THROWS_AS(writeTextAtomically(folder.path("a.txt/"), "x"), FileError);
    CHECK_THROWS_AS(writeTextAtomically(folder.path(std::string(256, 'n')), "x"), FileError);
    CHECK_THROWS_AS(writeTextAtomically("", "x"), FileError);
    CHECK(folder.fileCount() == 0);
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
    fs::create_symlink("later.txt", folder.path("ahead.txt"));
    writeTextAtomically(folder.path("ahead.txt"), "first");
    CHECK(fs::is_symlink(folder.path("ahead.txt")));
    CHECK(readText(folder.path("later.txt")) == "first");
    writeTextAtomically("/dev/null", "gone");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("a full disk is told and leaves what was there", "[atomic-file]") {
    const TempFolder folder;
    folder.write("a.txt", "old");
    CHECK_THROWS_WITH(writeTextAtomically("/dev/full", "x"), Catch::Contains("No space left"));
    {
        const FullDisk disk(1000);
        CHECK_NOTHROW(writeTextAtomically(folder.path("b.txt"), std::string(1000, 'x')));
        CHECK_THROWS_AS(writeTextAtomically(folder.path("a.txt"), std::string(1001, 'x')), FileError);
    }
    CHECK(readText(folder.path("a.txt")) == "old");
    CHECK(folder.fileCount() == 2);
}

TEST_CASE("the longest name that a file may have can be written", "[atomic-file]") {
    const TempFolder folder;
    const std::string name(255, 'n');
    writeTextAtomically(folder.path(name), "x");
    CHECK(readText(folder.path(name)) == "x");
}

TEST_CASE("a file that is replaced hands on its permissions", "[atomic-file]") {
    const TempFolder folder;
    folder.write("a.txt", "old");
    const fs::perms secret = fs::perms::owner_read | fs::perms::owner_write;
    fs::permissions(folder.path("a.txt"), secret);
    writeTextAtomically(folder.path("a.txt"), "new");
    CHECK(fs::status(folder.path("a.txt")).permissions() == secret);
}

TEST_CASE("a text that does not end is not read to its end", "[atomic-file]") {
    const TempFolder folder;
    CHECK_THROWS_WITH(readText("/dev/zero"), Catch::Contains("more than 16.8 MB"));
    CHECK(readText("/dev/null").empty());
    folder.write("a.txt", std::string(1000, 'x'));
    CHECK(readText(folder.path("a.txt"), 1000).size() == 1000);
    CHECK_THROWS_AS(readText(folder.path("a.txt"), 999), FileError);
    // A pipe, as the shell makes it for <(command).
    REQUIRE(mkfifo(folder.path("pipe").c_str(), 0600) == 0);
    std::thread writer([&] { std::ofstream(folder.path("pipe")) << std::string(200'000, 'y'); });
    const std::string text = readText(folder.path("pipe"));
    writer.join();
    CHECK(text == std::string(200'000, 'y'));
}

TEST_CASE("who watches sees what is read and written, and may refuse it", "[atomic-file]") {
    const TempFolder folder;
    const std::string path = folder.path("a");
    std::vector<std::string> seen;
    watchFiles({[&](const std::string& file) { seen.push_back("read " + file); },
                [&](const std::string& file) {
                    seen.push_back("write " + file);
                    if (seen.size() > 2) throw UsageError("once", file, "");
                }});
    writeTextAtomically(path, "text");
    CHECK(readText(path) == "text");
    CHECK_THROWS_AS(writeTextAtomically(path, "other"), UsageError);
    watchFiles({});
    CHECK(seen == std::vector<std::string>{"write " + path, "read " + path, "write " + path});
    CHECK(readText(path) == "text"); // nobody watches any more
    CHECK(seen.size() == 3);
}
