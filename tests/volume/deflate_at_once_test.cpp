// Streams that are unpacked in one go: the same bytes as piece by piece, and nothing of what is not sound.
#include "volume/formats/deflate_at_once.h"

#include <random>

#include <catch2/catch.hpp>

#include "loaded.h"
#include "support/temp_folder.h"
#include "volume_files.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

const JobControl kNoJob;

/// What comes out where `bytes` are wanted; "none" where they cannot be had at once.
std::string unpacked(const std::string& path, std::uint64_t bytes, bool zlib = false, bool toEnd = false,
                     std::uint64_t start = 0) {
    const auto stream = unpackedAtOnce(path, start, zlib, bytes, toEnd, kNoJob);
    if (!stream) return "none";
    CHECK(stream->soundBytes() == bytes);
    std::string all(static_cast<std::size_t>(bytes) + 5, '?');
    all.resize(stream->read(all.data(), 1));
    CHECK(stream->end() == UnpackedBytes::End::None);
    std::string rest(static_cast<std::size_t>(bytes) + 5, '?');
    rest.resize(stream->read(rest.data(), rest.size()));
    CHECK(stream->end() == UnpackedBytes::End::Whole);
    CHECK(stream->decoded() == bytes);
    return all + rest;
}

} // namespace

TEST_CASE("members and zlib streams come out at once as they went in", "[deflate-at-once]") {
    const TempFolder folder;
    std::mt19937 random(5);
    std::string bytes(300'000, ' ');
    for (char& byte : bytes) byte = static_cast<char>(random() % 7);
    const std::string gzip = folder.write("a", "head" + gzipped(bytes)), zlib = folder.write("b", zlibbed(bytes));
    CHECK(unpacked(gzip, bytes.size(), false, true, 4) == bytes);
    CHECK(unpacked(zlib, bytes.size(), true, true) == bytes);
    CHECK(unpacked(zlib, bytes.size(), false) == "none"); // only gzip was allowed
    const std::string members = gzipped("abc") + gzipped("") + gzipped("def");
    CHECK(unpacked(folder.write("c", members), 6, true, true) == "abcdef");
    CHECK(unpacked(folder.write("c", members), 3) == "abc");
    CHECK(unpacked(folder.write("c", members), 3, false, true) == "none"); // there is more
    CHECK(unpacked(folder.write("c", members), 4) == "none");              // within a member
    CHECK(unpacked(folder.write("c", members), 7) == "none");
    CHECK(unpacked(folder.write("d", members + std::string(9, '\0')), 6, false, true) == "abcdef");
    CHECK(unpacked(folder.write("d", members + "x"), 6, false, true) == "none");
    CHECK(unpacked(folder.write("d", members + "x"), 6) == "abcdef");
    CHECK(unpacked(folder.path("none"), 6) == "none");
    CHECK(unpacked(gzip, kMostAtOnce + 1) == "none");
}

TEST_CASE("skipping goes on behind what was skipped, and no further than the end", "[deflate-at-once]") {
    const TempFolder folder;
    const auto stream = unpackedAtOnce(folder.write("a", gzipped("abcdef")), 0, false, 6, true, kNoJob);
    REQUIRE(stream);
    CHECK(stream->skip(4));
    char next = 0;
    CHECK(stream->read(&next, 1) == 1);
    CHECK(next == 'e');
    CHECK_FALSE(stream->skip(2));
}

TEST_CASE("no byte comes out of a stream with one flipped bit but what went in", "[deflate-at-once]") {
    const TempFolder folder;
    const std::string text = "what was written is what is read, or nothing at all: nothing at all";
    const std::string packed = gzipped(text);
    int refused = 0;
    for (std::size_t bit = 0; bit < 8 * packed.size(); ++bit) {
        std::string damaged = packed;
        damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
        const std::string out = unpacked(folder.write("a", damaged), text.size());
        CAPTURE(bit);
        REQUIRE((out == "none" || out == text));
        refused += out == "none" ? 1 : 0;
    }
    // Time, flags and system in the header, 8 · 8 bits at most, say nothing of the bytes.
    CHECK(refused >= static_cast<int>(8 * (packed.size() - 8)));
}

TEST_CASE("a headerless file whose last member is as long as its layout is not taken for one step",
          "[deflate-at-once]") {
    const TempFolder folder;
    VolumeSource source;
    source.path = folder.write("a.raw.gz", gzipped("xyz") + gzipped("abcdef"));
    source.raw = parseRawLayout("6,1,1,u8");
    CHECK(lengthAtEnd(source.path) == 6);
    CHECK_THAT(errorOf(source), Contains("unpacks to 9 bytes, of which its layout takes 6"));
}

TEST_CASE("a claim of much more memory than a stream is likely to need is checked first", "[deflate-at-once]") {
    // 300 kB of noise do not become smaller; 300 MB are 1000 times as much, and the stream's own end says otherwise.
    const TempFolder folder;
    std::mt19937 random(5);
    std::string noise(300'000, ' ');
    for (char& byte : noise) byte = static_cast<char>(random());
    VolumeSource source;
    source.path = folder.write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 300000000\nencoding: gzip\n\n" +
                                             gzipped(noise));
    CHECK_THAT(errorOf(source), Contains("ends after 300000 of 300000000 bytes"));
}
