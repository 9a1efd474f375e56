// Compressed data that are damaged, cut off, or go on: what is read is what was written, or an error.
#include <catch2/catch.hpp>

#include "flipped_bits.h"
#include "volume/series.h"

using namespace pellucid;
using namespace pellucid::test;
using Catch::Matchers::Contains;

namespace {

std::string letters(const Volume& volume) {
    const auto& samples = std::get<SampleArray<std::uint8_t>>(volume.samples());
    return {samples.begin(), samples.end()};
}

VolumeSource sourceOf(const std::string& path, int step = 0) {
    VolumeSource source;
    source.path = path;
    source.step = step;
    return source;
}

std::string errorOf(const VolumeSource& source) {
    try {
        loadVolume(source);
    } catch (const FileError& e) {
        return e.what();
    }
    return "no error";
}

/// `bytes` in members of `each` bytes.
std::string inMembers(const std::string& bytes, std::size_t each) {
    std::string packed;
    for (std::size_t at = 0; at < bytes.size(); at += each) packed += gzipped(bytes.substr(at, each));
    return packed;
}

/// NRRD of six letters; where `steps`, of three steps of two letters.
std::string nrrd(const std::string& packed, bool steps = false, const std::string& fields = "") {
    return "NRRD0004\ntype: uint8\n" +
           std::string(steps ? "dimension: 4\nsizes: 2 1 1 3\n" : "dimension: 1\nsizes: 6\n") + fields +
           "encoding: gzip\n\n" + packed;
}

} // namespace

TEST_CASE("no flipped bit of compressed data gives other values without a word", "[damaged-data]") {
    for (const PackedFile& file : packedFiles(20)) {
        CAPTURE(file.format);
        BitFlips flips(file, 22);
        int refused = 0;
        for (int n = 0; n < 60; ++n) {
            const Reading reading = flips.next();
            CAPTURE(n, flips.lastOther());
            REQUIRE(reading != Reading::Other);
            refused += reading == Reading::Refused ? 1 : 0;
        }
        CHECK(refused > 0); // most bits matter: in members before the one that is wanted, and in all of one stream
    }
}

TEST_CASE("a wrong checksum or length is refused though all data unpack", "[damaged-data]") {
    // Of gzip the last eight bytes are CRC-32 and length, of zlib the last four Adler-32.
    const TempFolder folder;
    const std::string packed = gzipped("abcdef"), zlib = zlibbed("abcdef");
    const auto without = [](std::string bytes, std::size_t fromEnd) {
        bytes[bytes.size() - fromEnd] = static_cast<char>(bytes[bytes.size() - fromEnd] ^ 1);
        return bytes;
    };
    const std::string meta = "NDims = 1\nDimSize = 6\nElementType = MET_UCHAR\nCompressedData = True\n"
                             "ElementDataFile = LOCAL\n";
    for (const std::size_t fromEnd : {1u, 4u, 5u, 8u})
        CHECK_THAT(errorOf(sourceOf(folder.write("a.nrrd", nrrd(without(packed, fromEnd))))), Contains("checksum"));
    for (const std::size_t fromEnd : {1u, 4u})
        CHECK_THAT(errorOf(sourceOf(folder.write("a.mha", meta + without(zlib, fromEnd)))), Contains("checksum"));
    // Two letters more than the header speaks of: they belong to what the checksum is of.
    const std::string more = gzipped("abcdefgh"), moreZlib = zlibbed("abcdefgh");
    CHECK(letters(loadVolume(sourceOf(folder.write("b.nrrd", nrrd(more))))) == "abcdef");
    CHECK(letters(loadVolume(sourceOf(folder.write("b.mha", meta + moreZlib)))) == "abcdef");
    CHECK_THAT(errorOf(sourceOf(folder.write("c.nrrd", nrrd(without(more, 8))))), Contains("checksum"));
    CHECK_THAT(errorOf(sourceOf(folder.write("c.mha", meta + without(moreZlib, 4)))), Contains("checksum"));
    CHECK_THAT(errorOf(sourceOf(folder.write("d.nrrd", nrrd(more.substr(0, more.size() - 1))))),
               Contains("is cut off after 8 bytes, before its checksum"));
    // Each of three steps is read alone, first and last.
    for (const int step : {0, 1, 2}) {
        const std::string name = std::to_string(step) + ".nrrd";
        CHECK_THAT(errorOf(sourceOf(folder.write("w" + name, nrrd(without(packed, 8), true)), step)),
                   Contains("checksum"));
        CHECK_THAT(errorOf(sourceOf(folder.write("c" + name, nrrd(packed.substr(0, packed.size() - 1), true)), step)),
                   Contains("before its checksum"));
        CHECK(letters(loadVolume(sourceOf(folder.write("g" + name, nrrd(packed, true)), step))) ==
              std::string("abcdef").substr(2 * static_cast<std::size_t>(step), 2));
    }
}

TEST_CASE("gzip in several members is read, and needs no more of them than are wanted", "[damaged-data]") {
    const TempFolder folder;
    for (const std::size_t each : {1u, 2u, 4u, 6u}) {
        CAPTURE(each);
        const std::string packed = inMembers("abcdef", each) + gzipped(""); // an empty member is one, too
        const std::string name = std::to_string(each) + ".nrrd";
        CHECK(letters(loadVolume(sourceOf(folder.write("a" + name, nrrd(packed))))) == "abcdef");
        for (const int step : {2, 0, 1})
            CHECK(letters(loadVolume(sourceOf(folder.write("s" + name, nrrd(packed, true)), step))) ==
                  std::string("abcdef").substr(2 * static_cast<std::size_t>(step), 2));
    }
    // Members of two steps and one: of the first all is known to be sound, whatever has become of the second.
    const std::string first = gzipped("abcd"), second = gzipped("ef");
    for (const std::string& end : {second.substr(0, second.size() - 3), std::string(), std::string("\x1f")}) {
        const std::string path = folder.write("m" + std::to_string(end.size()) + ".nrrd", nrrd(first + end, true));
        CHECK(letters(loadVolume(sourceOf(path, 0))) == "ab");
        CHECK_THAT(errorOf(sourceOf(path, 2)), Contains("compressed data"));
        CHECK(letters(loadVolume(sourceOf(path, 1))) == "cd"); // after an error, too
    }
}

TEST_CASE("what stands behind compressed data is left alone, unless it says where they end", "[damaged-data]") {
    const TempFolder folder;
    const std::string packed = gzipped("abcdef");
    int n = 0;
    for (const std::string& behind : {std::string("garbage"), std::string(700, '\0'), std::string("\x1f\x8b"),
                                      std::string("\x1f garbage"), std::string(3, '\0') + "x"}) {
        CAPTURE(behind);
        const std::string name = std::to_string(n++);
        CHECK(letters(loadVolume(sourceOf(folder.write(name + ".nrrd", nrrd(packed + behind))))) == "abcdef");
        CHECK(letters(loadVolume(sourceOf(folder.write("s" + name + ".nrrd", nrrd(packed + behind, true)), 2))) ==
              "ef");
        CHECK(letters(loadVolume(sourceOf(
                  folder.write(name + ".mha", "NDims = 1\nDimSize = 6\nElementType = MET_UCHAR\nCompressedData = "
                                              "True\nElementDataFile = LOCAL\n" +
                                                  zlibbed("abcdef") + behind)))) == "abcdef");
        // The last six of what the file unpacks to: zeros are padding, other bytes may have been a member.
        const std::string last = nrrd(gzipped("..") + packed + behind, false, "byte skip: -1\n");
        const std::string path = folder.write("l" + name + ".nrrd", last);
        if (behind.size() == 700)
            CHECK(letters(loadVolume(sourceOf(path))) == "abcdef");
        else
            CHECK_THAT(errorOf(sourceOf(path)), Contains("compressed data"));
    }
    CHECK_THAT(errorOf(sourceOf(folder.write("f.nrrd", nrrd(packed + "x", false, "byte skip: -1\n")))),
               Contains("followed by something else"));
}

TEST_CASE("a block of VTK data with a wrong checksum is refused", "[damaged-data][vtk]") {
    // The last four bytes of a block are its Adler-32; 6 letters in one block of 6 or two of 4 and 2.
    const TempFolder folder;
    for (const std::size_t block : {6u, 4u})
        for (const std::size_t broken : {0u, 1u}) {
            if (block == 6 && broken == 1) continue;
            CAPTURE(block, broken);
            const Style style{Style::Place::Raw, true, false, false, block};
            std::string file = vti(style, {{"type=\"UInt8\" Name=\"a\"", "", "abcdef"}});
            CHECK(letters(loadVolume(sourceOf(folder.write("a.vti", file)))) == "abcdef");
            const std::string packed = zlibbed(broken == 0 ? std::string("abcdef").substr(0, block) : "ef");
            char& sum = file[file.find(packed) + packed.size() - 1];
            sum = static_cast<char>(sum ^ 1);
            CHECK_THAT(errorOf(sourceOf(folder.write("a.vti", file))), Contains("damaged"));
        }
}
