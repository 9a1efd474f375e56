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

TEST_CASE("bzip2 data in one stream or several, in steps, after skipped bytes", "[damaged-data]") {
    const TempFolder folder;
    const auto file = [&](const std::string& packed, bool steps = false, const std::string& fields = "") {
        std::string text = nrrd(packed, steps, fields);
        return folder.write("a.nrrd", text.replace(text.find("gzip"), 4, "bzip2"));
    };
    const std::string whole = bzipped("abcdef", 1), two = bzipped("abc") + bzipped("def"), four = two + bzipped("");
    for (const std::string& packed : {whole, two, four, two + std::string(5, '\0'), two + "behind"}) {
        CHECK(letters(loadVolume(sourceOf(file(packed)))) == "abcdef");
        for (const int step : {2, 0, 1})
            CHECK(letters(loadVolume(sourceOf(file(packed, true), step))) ==
                  std::string("abcdef").substr(2 * static_cast<std::size_t>(step), 2));
    }
    CHECK(letters(loadVolume(sourceOf(file(bzipped("xyz") + two, false, "byte skip: 3\n")))) == "abcdef");
    CHECK(letters(loadVolume(sourceOf(file(bzipped("xyz") + two, false, "byte skip: -1\n")))) == "abcdef");
    CHECK_THAT(errorOf(sourceOf(file(two + "behind", false, "byte skip: -1\n"))), Contains("followed by"));
    for (std::size_t kept = 0; kept < whole.size(); ++kept) {
        CAPTURE(kept);
        CHECK_THAT(errorOf(sourceOf(file(whole.substr(0, kept)))),
                   Contains("compressed data is cut off") || Contains("compressed data ends"));
    }
    CHECK_THAT(errorOf(sourceOf(file(bzipped("abcde")))), Contains("ends after 5 of 6 bytes"));
    CHECK_THAT(errorOf(sourceOf(file(gzipped("abcdef")))), Contains("is damaged after 0"));
    // Each bit of a short stream: but for the size of blocks and the last bits, which are none of the data's.
    int refused = 0;
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::string bytes = whole;
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
        CAPTURE(bit);
        const std::string path = file(bytes);
        if (errorOf(sourceOf(path)) != "no error")
            ++refused;
        else
            REQUIRE(letters(loadVolume(sourceOf(path))) == "abcdef");
    }
    CHECK(refused > static_cast<int>(8 * whole.size()) - 16);
    std::string claims = nrrd(whole);
    claims.replace(claims.find("gzip"), 4, "bzip2");
    claims.replace(claims.find("sizes: 6"), 8, "sizes: 2000000000");
    CHECK_THAT(errorOf(sourceOf(folder.write("a.nrrd", claims))), Contains("cannot hold"));
}

TEST_CASE("a headerless file may be gzip, if what it unpacks to has the size of its layout", "[damaged-data]") {
    const TempFolder folder;
    const std::string bytes = bytesOf(std::vector<std::uint16_t>{258, 3, 4, 5, 6, 65535});
    const auto source = [&](const std::string& content, const std::string& layout, std::uint64_t skip = 0) {
        VolumeSource raw = sourceOf(folder.write("a.raw.gz", content));
        raw.raw = parseRawLayout(layout);
        raw.raw->skipBytes = skip;
        return raw;
    };
    for (const std::string& packed : {gzipped("head" + bytes), gzipped("he") + gzipped("ad" + bytes)}) {
        const Volume volume = loadVolume(source(packed, "3,2,1,u16", 4));
        CHECK(volume.format == "raw");
        CHECK(volume.value(0) == 258);
        CHECK(volume.value(5) == 65535);
        CHECK(loadVolume(source(packed, "3,2,1,u16,big", 4)).value(0) == 513); // 1·256 + 2 the other way round
        CHECK(loadVolume(source(packed, "16,1,1,u8")).value(0) == 'h');
    }
    // Steps, which have to be asked for.
    VolumeSource steps = source(gzipped("head" + bytes), "2,1,1,u16", 4);
    CHECK_THAT(errorOf(steps), Contains("that unpack to 16, but"));
    steps.frames = FrameRange{};
    CHECK(listSeries(steps).frames.size() == 3);
    CHECK(loadVolume(listSeries(steps).frames[2].source).value(1) ==
          65535); // though (36 − 4) / 4 packed steps fit, too
    // Its own size comes first: then it is no gzip, whatever it begins with.
    const std::string packed = gzipped(bytes);
    const std::string own = std::to_string(packed.size()) + ",1,1,u8";
    CHECK(loadVolume(source(packed, own)).value(0) == 0x1f);
    const std::string almost = std::string("\x1f\x8b") + std::string(10, 'x');
    CHECK(loadVolume(source(almost, "12,1,1,u8")).value(1) == 0x8b);
    CHECK_THAT(errorOf(source(almost, "13,1,1,u8")), Contains("the file has 12 bytes, but"));
    CHECK_THAT(errorOf(source(packed.substr(0, packed.size() - 3), "3,2,1,u16")), Contains("cut off after 12"));
    CHECK_THAT(errorOf(source(packed + "x", "3,2,1,u16")), Contains("followed by something else"));
    CHECK_THAT(errorOf(source(packed, "4,2,1,u16")), Contains("that unpack to 12, but"));
    CHECK_THAT(errorOf(source(packed, "2000000000,2000000000,1,u16")), Contains("that unpack to 12, but"));
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
