// Texts in PNG files: written by our own code, read by it, and damaged.
#include <random>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>
#include <zlib.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image_io/image_file.h"
#include "image_io/png_text.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

std::string pngWith(const std::vector<PngText>& texts) {
    const std::vector<unsigned char> bytes = pngBytes(Image(3, 2), texts);
    return {bytes.begin(), bytes.end()};
}

std::vector<PngText> textsIn(const std::string& file) {
    std::istringstream in(file);
    return readPngTexts(in, "x.png");
}

std::string number(std::size_t value) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

std::string chunk(const std::string& name, const std::string& data) {
    const std::string body = name + data;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return number(data.size()) + body + number(crc);
}

std::string packed(const std::string& text) {
    uLongf size = compressBound(static_cast<uLong>(text.size()));
    std::string bytes(size, '\0');
    compress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
             static_cast<uLong>(text.size()));
    bytes.resize(size);
    return bytes;
}

const std::string kBegin("\x89PNG\r\n\x1a\n", 8), kNul(1, '\0');
const std::string kEnd = chunk("IEND", "");

} // namespace

TEST_CASE("texts come back from a PNG file as they were", "[image][png]") {
    const std::vector<PngText> texts{{"Software", "Pellucid"},
                                     {"Description", "Von rechts: Zahn, Käse & 歯"},
                                     {"pellucid:session", std::string(300000, '{') + "ü"},
                                     {"Empty", ""}};
    const std::string file = pngWith(texts);
    CHECK(textsIn(file) == texts);
    CHECK(file.size() < 3000); // 300 000 equal characters pack to some hundreds of bytes
    CHECK(pngWith(texts) == file);
    // tEXt, which all readers know, where ASCII does.
    CHECK(file.find("tEXtSoftware" + kNul + "Pellucid") != std::string::npos);
    CHECK(file.find("iTXtDescription" + kNul) != std::string::npos);
}

TEST_CASE("pixels are the same with texts and without", "[image][png]") {
    const TempFolder folder;
    Image image(9, 4);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = static_cast<float>(i % 256) / 255;
    writeImage(image, folder.path("plain.png"));
    writeImage(image, folder.path("texts.png"), {"Pellucid", "größer", "pellucid-cli render", std::string(5000, 'x')});
    CHECK(readImage(folder.path("plain.png")).rgba == readImage(folder.path("texts.png")).rgba);
    CHECK(readPngTexts(folder.path("plain.png")).empty());
    CHECK(readPngTexts(folder.path("texts.png")).size() == 4);
    CHECK(isPngFile(folder.path("plain.png")));
    CHECK_FALSE(isPngFile(folder.path("none.png")));
}

TEST_CASE("texts of other programs are read in all three forms", "[image][png]") {
    // zTXt is Latin-1, packed: 0xe4 is ä. iTXt may name a language.
    const std::string file = kBegin + chunk("IHDR", std::string(13, '\0')) +
                             chunk("zTXt", "Comment" + kNul + kNul + packed("\xe4")) + chunk("IDAT", "anything") +
                             chunk("iTXt", "Title" + kNul + "\1" + kNul + "de" + kNul + "Titel" + kNul + packed("ö")) +
                             chunk("tEXt", "Author" + kNul + "\xfc") + kEnd;
    CHECK(textsIn(file) == std::vector<PngText>{{"Comment", "ä"}, {"Title", "ö"}, {"Author", "ü"}});
}

TEST_CASE("a damaged PNG file is refused, wherever it is cut or changed", "[image][png]") {
    const std::string file = pngWith({{"Software", "Pellucid"}, {"Long", std::string(2000, 'a') + "é"}});
    for (std::size_t size = 0; size < file.size() - 4; ++size) { // the last four are a checksum of nothing
        INFO(size);
        REQUIRE_THROWS_AS(textsIn(file.substr(0, size)), FileError);
    }
    // No change of a byte of a text goes unnoticed, and none anywhere ends otherwise than in an answer or an error.
    const std::size_t begin = file.find("tEXt"), end = file.find("IDAT") - 4;
    for (std::size_t at = 0; at < file.size(); ++at)
        for (const int bit : {0, 3, 7}) {
            std::string other = file;
            other[at] = static_cast<char>(other[at] ^ 1 << bit);
            INFO(at);
            if (at >= begin + 4 && at < end) {
                if (at < file.find("iTXt") - 8 || at >= file.find("iTXt") + 4)
                    REQUIRE_THROWS_AS(textsIn(other), FileError);
                continue;
            }
            try {
                textsIn(other);
            } catch (const FileError&) {
            }
        }
}

TEST_CASE("texts in a PNG file that do not follow the format are refused", "[image][png]") {
    const auto refused = [](const std::string& chunks) { CHECK_THROWS_AS(textsIn(kBegin + chunks + kEnd), FileError); };
    refused(chunk("tEXt", "no end of the keyword"));
    refused(chunk("tEXt", kNul + "no keyword"));
    refused(chunk("tEXt", std::string(80, 'k') + kNul + "a keyword has 79 letters at most"));
    refused(chunk("zTXt", "k" + kNul));
    refused(chunk("zTXt", "k" + kNul + "\1" + packed("another way to pack")));
    refused(chunk("zTXt", "k" + kNul + kNul + "not packed"));
    refused(chunk("zTXt", "k" + kNul + kNul + packed("cut short").substr(0, 6)));
    refused(chunk("iTXt", "k" + kNul));
    refused(chunk("iTXt", "k" + kNul + kNul + kNul + "language without end"));
    refused(chunk("iTXt", "k" + kNul + kNul + kNul + kNul + "likewise the keyword"));
    // A chunk that claims 2 GB: nothing of that size is reserved, and nothing read beyond the end.
    refused(number(0x7ffffff0) + "tEXtk");
    refused(number(0xfffffff0) + "IDAT");
    CHECK_THROWS_AS(textsIn("not a PNG file at all"), FileError);
}

TEST_CASE("a text that unpacks to more than anybody wrote is refused", "[image][png]") {
    // 80 MB of zeros pack to 80 KB; 64 MiB is what texts may have.
    CHECK_THROWS_AS(textsIn(kBegin + chunk("zTXt", "k" + kNul + kNul + packed(std::string(80'000'000, '0'))) + kEnd),
                    FileError);
    // Together, too.
    const std::string half = chunk("zTXt", "k" + kNul + kNul + packed(std::string(40'000'000, '0')));
    CHECK(textsIn(kBegin + half + kEnd).size() == 1);
    CHECK_THROWS_AS(textsIn(kBegin + half + half + kEnd), FileError);
}
