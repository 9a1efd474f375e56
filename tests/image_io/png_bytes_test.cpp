// PNG files of our own, read back by OpenImageIO, which has another implementation.
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "image_io/image_file.h"
#include "image_io/png_bytes.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

Image readBack(const std::vector<unsigned char>& bytes) {
    const TempFolder folder;
    writeBytesAtomically(folder.path("x.png"), bytes);
    return readImage(folder.path("x.png"));
}

/// Chunks of this name in a PNG file.
int chunksCalled(const std::string& name, const std::vector<unsigned char>& bytes) {
    int count = 0;
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t size = bytes[at] * 16777216u + bytes[at + 1] * 65536u + bytes[at + 2] * 256u + bytes[at + 3];
        if (std::string(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                        bytes.begin() + static_cast<std::ptrdiff_t>(at) + 8) == name)
            ++count;
        at += size + 12; // length, name and checksum
    }
    return count;
}

} // namespace

TEST_CASE("a PNG file has the nearest of 256 values of each component", "[image][png]") {
    // Gradients, flat parts and noise, so that each way of filtering is the best one somewhere.
    Image image(61, 47);
    std::minstd_rand random(7);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c)
                image.pixel(x, y)[c] = y < 10   ? 0.25f
                                       : y < 20 ? static_cast<float>(x) / 60
                                       : y < 30 ? static_cast<float>(y * (c + 1)) / 200
                                       : y < 40 ? static_cast<float>(x + y + 9 * c) / 160
                                                : std::uniform_real_distribution<float>()(random);
    const std::vector<unsigned char> bytes = pngBytes(image);
    const Image back = readBack(bytes);
    REQUIRE(back.width == 61);
    REQUIRE(back.height == 47);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        REQUIRE(std::lround(back.rgba[i] * 255) == std::lround(image.rgba[i] * 255));
    CHECK(chunksCalled("sRGB", bytes) == 1);
    CHECK(pngBytes(image) == bytes);
}

TEST_CASE("what lies beyond 0 to 1 is cut in a PNG file", "[image][png]") {
    Image image(1, 1);
    image.rgba = {2.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f};
    CHECK(readBack(pngBytes(image)).rgba == std::vector<float>{1, 0, 0, 1});
}

TEST_CASE("a PNG file of noise, which does not pack, comes in several chunks", "[image][png]") {
    Image image(640, 640);
    std::minstd_rand random(1);
    for (float& v : image.rgba) v = std::uniform_real_distribution<float>()(random);
    const std::vector<unsigned char> bytes = pngBytes(image);
    // 640 · 640 · 4 bytes are 1.6 MB, and a chunk has 1 MiB.
    CHECK(chunksCalled("IDAT", bytes) == 2);
    const Image back = readBack(bytes);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        REQUIRE(std::lround(back.rgba[i] * 255) == std::lround(image.rgba[i] * 255));
}

TEST_CASE("flat pictures make small PNG files", "[image][png]") {
    Image image(512, 512);
    for (std::size_t p = 0; p < image.rgba.size(); p += 4) image.rgba[p + 3] = 1; // opaque black
    CHECK(pngBytes(image).size() < 4000); // of 1 MB; deflate packs no more than 1032 to 1
}

TEST_CASE("a map as PNG has 16 bits of each value", "[image][png]") {
    Plane plane;
    plane.width = 300;
    plane.height = 2;
    for (int i = 0; i < 600; ++i) plane.values.push_back(static_cast<float>(i) / 599);
    const std::vector<unsigned char> bytes = pngBytes(plane);
    CHECK(bytes[24] == 16); // bits, and 0 for grey
    CHECK(bytes[25] == 0);
    const Image back = readBack(bytes);
    for (std::size_t i = 0; i < 600; ++i) REQUIRE(back.rgba[4 * i] == Approx(plane.values[i]).margin(0.5001 / 65535));
}
