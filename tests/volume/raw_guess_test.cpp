// Layouts of headerless files, told by name, size and voxels.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "support/temp_folder.h"
#include "volume/procedural.h"
#include "volume/raw_guess.h"
#include "volume/voxel_loops.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Some balls in the box, and noise, as values of T. (Waves would do no good: they repeat themselves.)
template <class T>
std::string fieldBytes(const Int3& dims, double offset, double amplitude, bool swap) {
    std::string bytes;
    std::uint32_t noise = 1;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                noise = noise * 1664525u + 1013904223u;
                double sum = 0;
                for (const auto& [cx, cy, cz, r] : {std::array{0.3, 0.4, 0.3, 14.0},
                                                    {0.7, 0.6, 0.5, 9.0},
                                                    {0.5, 0.2, 0.8, 6.0},
                                                    {0.8, 0.8, 0.2, 4.0}}) {
                    const double dx = x - cx * dims.x, dy = y - cy * dims.y, dz = z - cz * dims.z;
                    sum += std::exp(-(dx * dx + dy * dy + dz * dz) / (r * r));
                }
                const double value = offset + amplitude * (sum - 0.3 + 0.02 * (noise >> 16) / 65536.0);
                const T stored = static_cast<T>(value);
                char piece[sizeof stored];
                std::memcpy(piece, &stored, sizeof stored);
                if (swap) std::reverse(piece, piece + sizeof stored);
                bytes.append(piece, sizeof stored);
            }
    return bytes;
}

RawLayout best(const std::string& path) {
    const RawLook look = lookAtRaw(path);
    REQUIRE_FALSE(look.guesses.empty());
    for (const RawGuess& guess : look.guesses)
        CHECK(look.bytes == voxelCount(guess.layout.dims) * bytesPerSample(guess.layout.type));
    return look.guesses.front().layout;
}

} // namespace

TEST_CASE("the voxels of a headerless file tell how they are laid out", "[guess]") {
    const TempFolder folder;
    const Int3 dims(60, 44, 35);
    const auto layoutOf = [&](const std::string& bytes) { return best(folder.write("a.bin", bytes)); };
    const auto textOf = [](const std::string& type, bool isBig) { return "60,44,35," + type + (isBig ? ",big" : ""); };
    CHECK(rawLayoutText(layoutOf(fieldBytes<std::uint8_t>(dims, 60, 80, false))) == textOf("u8", false));
    CHECK(rawLayoutText(layoutOf(fieldBytes<std::uint16_t>(dims, 2000, 900, false))) == textOf("u16", false));
    CHECK(rawLayoutText(layoutOf(fieldBytes<std::uint16_t>(dims, 2000, 900, true))) == textOf("u16", true));
    CHECK(rawLayoutText(layoutOf(fieldBytes<std::int16_t>(dims, 0, 900, false))) ==
          textOf("i16", false)); // some below zero
    CHECK(rawLayoutText(layoutOf(fieldBytes<float>(dims, 0.5, 3, false))) == textOf("f32", false));
    CHECK(rawLayoutText(layoutOf(fieldBytes<float>(dims, 0.5, 3, true))) == textOf("f32", true));
    CHECK(rawLayoutText(layoutOf(fieldBytes<double>(dims, 0.5, 3, false))) == textOf("f64", false));
}

TEST_CASE("a name that speaks of a layout is believed where it fits the file", "[guess]") {
    const TempFolder folder;
    const std::string bytes = fieldBytes<std::uint8_t>({60, 44, 35}, 60, 80, false);
    // As many bytes, and named otherwise than the voxels look.
    CHECK(best(folder.write("a_44x60x35_uint8.raw", bytes)).dims == Int3(44, 60, 35));
    CHECK(best(folder.write("a_10x10x10_uint8.raw", bytes)).dims == Int3(60, 44, 35));
    CHECK(best(folder.write("b_int16.raw", bytes)).type == SampleType::I16);
    CHECK(rawLayoutInName("/x/foo_16x8x4_int16.raw", 1024).type == SampleType::I16);
    CHECK(rawLayoutInName("/x/4x4x4/plain.raw", 27).dims == Int3(3)); // a folder does not count
    CHECK(rawLayoutInName("/x/1999999x2x3.raw", 27).dims == Int3(3));
}

TEST_CASE("where nothing fits there is no guess", "[guess]") {
    const TempFolder folder;
    CHECK(lookAtRaw(folder.write("a.bin", std::string(1009, 'x'))).guesses.empty()); // a prime number
    CHECK(lookAtRaw(folder.write("b.bin", "")).guesses.empty());
    std::string noise;
    std::uint32_t state = 7;
    for (int i = 0; i < 64 * 64 * 64; ++i) {
        state = state * 1664525u + 1013904223u;
        noise += static_cast<char>(state >> 24);
    }
    CHECK(lookAtRaw(folder.write("c.bin", noise)).guesses.empty());
    CHECK(rawLayoutText({{3, 4, 5}, SampleType::U16, true}) == "3,4,5,u16,big");
    CHECK(parseRawLayout("3,4,5,u16,big") == RawLayout{{3, 4, 5}, SampleType::U16, true});
}
