#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image_io/image_file.h"
#include "support/full_disk.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("images survive a file in the precision of its format", "[image]") {
    const TempFolder folder;
    Image image(5, 3);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = static_cast<float>(i % 16) / 15;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 0.2f + 0.8f * static_cast<float>(i) / 60;
    for (const auto& [suffix, tolerance] : {std::pair{"png", 0.002}, {"tif", 1e-5}, {"exr", 1e-5}}) {
        const std::string path = folder.path("image." + std::string(suffix));
        writeImage(image, path);
        const Image back = readImage(path);
        REQUIRE(back.width == 5);
        REQUIRE(back.height == 3);
        double worst = 0;
        for (std::size_t i = 0; i < image.rgba.size(); ++i)
            worst = std::max(worst, static_cast<double>(std::abs(back.rgba[i] - image.rgba[i])));
        INFO(suffix);
        CHECK(worst <= tolerance);
    }
    writeImage(image, folder.path("image.jpg"));
    CHECK(readImage(folder.path("image.jpg")).width == 5);
}

TEST_CASE("an EXR picture is linear light, premultiplied, in 32-bit floats", "[image]") {
    const TempFolder folder;
    Image image(1, 1);
    image.rgba = {0.5f, 1.0f, 0.04f, 0.25f};
    writeImage(image, folder.path("x.exr"));
    // As numbers, without what readImage() undoes: a copy under a name that does not tell the kind.
    std::filesystem::copy_file(folder.path("x.exr"), folder.path("x.picture"));
    const Image stored = readImage(folder.path("x.picture"));
    CHECK(stored.rgba[0] == Approx(0.25 * 0.21404114)); // ((0.5 + 0.055) / 1.055)^2.4
    CHECK(stored.rgba[1] == Approx(0.25));
    CHECK(stored.rgba[2] == Approx(0.25 * 0.04 / 12.92).epsilon(1e-6)); // a half has 1e-3
    CHECK(stored.rgba[3] == Approx(0.25));
}

TEST_CASE("files of pictures say what they are told, no date, and of TIFF the colour space", "[image]") {
    const TempFolder folder;
    const PictureText text{"Pellucid", "From the front: tooth", "pellucid-cli render", "{\"format\":1}"};
    Image image(4, 4);
    const std::vector<std::string> suffixes{"png", "tif", "exr", "jpg"};
    for (const std::string& suffix : suffixes) writeImage(image, folder.path("a." + suffix), text);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // dates in files go by seconds
    for (const std::string& suffix : suffixes) {
        INFO(suffix);
        writeImage(image, folder.path("b." + suffix), text);
        const std::string bytes = readText(folder.path("a." + suffix));
        CHECK(bytes == readText(folder.path("b." + suffix)));
        CHECK(bytes.find(text.description) != std::string::npos);
        CHECK((bytes.find(text.session) != std::string::npos) == (suffix == "png" || suffix == "exr"));
        CHECK((bytes.find("sRGB (IEC 61966-2-1)") != std::string::npos) == (suffix == "tif"));
    }
}

TEST_CASE("an image that cannot be written leaves nothing behind", "[image]") {
    const TempFolder folder;
    CHECK_THROWS_AS(checkImageSuffix("x.gif"), UsageError);
    CHECK_THROWS_AS(writeImage(Image(2, 2), folder.path("no/x.png")), FileError);
    std::filesystem::create_directory(folder.path("x.png"));
    CHECK_THROWS_AS(writeImage(Image(2, 2), folder.path("x.png")), FileError);
    CHECK(folder.fileCount() == 1);
    CHECK_THROWS_AS(readImage(folder.path("none.png")), FileError);
}

TEST_CASE("a full disk is told, whatever the library behind a format does about it", "[image]") {
    const TempFolder folder;
    Image noise(64, 64);
    std::minstd_rand random(1);
    for (float& v : noise.rgba) v = std::uniform_real_distribution<float>()(random);
    for (const std::string suffix : {"png", "tif", "exr", "jpg"}) {
        INFO(suffix);
        const std::string path = folder.path("image." + suffix), link = folder.path("full." + suffix);
        writeImage(noise, path);
        const std::string before = readText(path);
        const Image back = readImage(path); // larger than what the formats gather into one strip
        REQUIRE(back.rgba.size() == noise.rgba.size());
        if (suffix != "jpg") CHECK(back.pixel(63, 63)[2] == Approx(noise.pixel(63, 63)[2]).margin(5e-3));
        for (const std::size_t room : {std::size_t{0}, before.size() / 2, before.size() - 1}) {
            const FullDisk disk(room);
            CHECK_THROWS_AS(writeImage(noise, path), FileError);
        }
        CHECK((readText(path) == before)); // in brackets: it is not printed
        {
            const FullDisk disk(20); // the whole file is smaller than what stdio gathers before it writes
            CHECK_THROWS_AS(writeImage(Image(2, 2), folder.path("small." + suffix)), FileError);
        }
        std::filesystem::create_symlink("/dev/full", link);
        CHECK_THROWS_WITH(writeImage(Image(2, 2), link), Catch::Contains("No space left"));
    }
    CHECK(folder.fileCount() == 8);
}
