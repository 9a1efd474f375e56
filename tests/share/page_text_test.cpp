#include "share/page_text.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "share/page_files.h"

using namespace pellucid;

namespace {

/// What the page's script does: pairs of digits of base 91 are 13 bits each.
std::vector<unsigned char> bytesOf(const std::string& text, std::size_t count) {
    std::string digits;
    for (char c = '!'; c <= '~'; ++c)
        if (std::string("&<\\").find(c) == std::string::npos) digits += c;
    std::vector<unsigned char> bytes;
    unsigned held = 0, bits = 0;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        held = held << 13 | static_cast<unsigned>(digits.find(text[i]) * 91 + digits.find(text[i + 1]));
        for (bits += 13; bits >= 8; bits -= 8) bytes.push_back(static_cast<unsigned char>(held >> (bits - 8)));
        held &= (1u << bits) - 1;
    }
    bytes.resize(count);
    return bytes;
}

} // namespace

TEST_CASE("texts from outside stay texts in HTML", "[share]") {
    CHECK(htmlText("Skull 7") == "Skull 7");
    CHECK(htmlText("</h1><script>") == "&#60;/h1&#62;&#60;script&#62;");
    CHECK(htmlText("a & b \"c\" 'd'") == "a &#38; b &#34;c&#34; &#39;d&#39;");
    CHECK(htmlText("{{voxels}}") == "&#123;&#123;voxels&#125;&#125;");
    // One, two, three and four bytes of UTF-8: U+00E9, U+2603, U+1F9B7.
    CHECK(htmlText("e\xc3\xa9\xe2\x98\x83\xf0\x9f\xa6\xb7") == "e&#233;&#9731;&#129463;");
    CHECK(htmlText("\xff").find("65533") != std::string::npos);
    CHECK(htmlText("a\nb") == "a b");
}

TEST_CASE("JSON in a script cannot end it", "[share]") {
    const std::string hostile = "</script><!--<script>&\xe2\x80\xa8";
    const std::string text = scriptJson(nlohmann::json{{"title", hostile}});
    CHECK(text.find_first_of("<>&") == std::string::npos);
    for (const char c : text) CHECK((c >= 32 && c < 127));
    CHECK(nlohmann::json::parse(text)["title"] == hostile);
}

TEST_CASE("bytes become printable digits and come back", "[share]") {
    for (const std::size_t count : {0u, 1u, 2u, 12u, 13u, 14u, 1000u}) {
        std::vector<unsigned char> bytes(count);
        for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<unsigned char>(i * 97 + (i >> 3) * 31 + 255);
        const std::string text = digitsOf(bytes);
        CHECK(text.size() == digitCount(count));
        CHECK(text.find_first_of("<&\\ \n") == std::string::npos);
        CHECK(bytesOf(text, count) == bytes);
    }
    CHECK(digitCount(13) == 16); // 8 pairs of 13 bits
}

TEST_CASE("what is put into a page is not filled in again", "[share]") {
    const auto value = [](const std::string& name) { return name == "a" ? std::string("{{b}}") : "B"; };
    CHECK(filled("<{{a}}|{{b}}>", value) == "<{{b}}|B>");
    CHECK(filled("none", value) == "none");
}

TEST_CASE("shaders of the renderer lose what WebGL does not know", "[share]") {
    CHECK(webShader("layout(location = 3) uniform mat3 u_a; // b\nlayout(binding = 0) uniform sampler3D u_b;\n") ==
          "uniform mat3 u_a; // b\nuniform sampler3D u_b;\n");
    CHECK(rayShaders().size() > 6);
    for (const PageFile& file : pageFiles())
        for (const char c : file.text) {
            INFO(file.name);
            REQUIRE((c == '\n' || (c >= 32 && c < 127)));
        }
}
