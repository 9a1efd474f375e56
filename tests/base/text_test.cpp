#include <catch2/catch.hpp>

#include "base/error.h"
#include "base/text.h"

using namespace pellucid;

TEST_CASE("a text from a file cannot steer a terminal, or read as another", "[text]") {
    CHECK(printable("knee, 3 µm, 膝 🦴") == "knee, 3 µm, 膝 🦴");
    CHECK(printable("a\x1b[31mb\x07") == "a [31mb "); // escape, bell
    CHECK(printable("a\xc2\x9b"
                    "31mb") == "a 31mb"); // U+009B, which some terminals take for an escape
    CHECK(printable("a\nb\tc\xe2\x80\xa8"
                    "d") == "a b c d"); // U+2028 ends a line
    CHECK(printable("a\xe2\x80\xae"
                    "gpj.exe") == "a\uFFFDgpj.exe"); // U+202E turns round what follows
    CHECK(printable("\xe2\x81\xa6x\xe2\x80\x8f\xd8\x9c") == "\uFFFDx\uFFFD\uFFFD");
    CHECK(printableLines("a\n\tb\r\x1b") == "a\n\tb  ");
}

TEST_CASE("bytes that are no UTF-8 are shown as such, one by one", "[text]") {
    CHECK(printable("caf\xe9") == "caf\uFFFD");                         // Latin-1, at the end
    CHECK(printable("\xe9t\xe9") == "\uFFFDt\uFFFD");                   // and before a letter
    CHECK(printable("\xc0\xaf") == "\uFFFD\uFFFD");                     // a longer form of "/"
    CHECK(printable("\xed\xa0\x80") == "\uFFFD\uFFFD\uFFFD");           // half of a surrogate pair
    CHECK(printable("\xf4\x90\x80\x80") == "\uFFFD\uFFFD\uFFFD\uFFFD"); // beyond U+10FFFF
    CHECK(printable("\xe8\x86") == "\uFFFD\uFFFD");                     // cut off
}

TEST_CASE("JSON says what it said, in characters that can be shown", "[text]") {
    CHECK(printableJson("{\"a\":\n \"b\xe2\x80\xae\x7f\xc2\x9b\"}") == "{\"a\":\n \"b\\u202e\\u007f\\u009b\"}");
}

TEST_CASE("an error is a line that can be shown", "[text]") {
    const FileError e("bad \x1b[2J",
                      "/tmp/\xe2\x80\xae"
                      "x",
                      "copy\nit");
    CHECK(std::string(e.what()) == "bad  [2J, /tmp/\uFFFDx, copy it");
    CHECK(e.where() == "/tmp/\uFFFDx");
}

TEST_CASE("a text is split at each separator", "[text]") {
    using Parts = std::vector<std::string>;
    CHECK(splitAt(',', "a,b") == Parts{"a", "b"});
    CHECK(splitAt(',', ",a,,") == Parts{"", "a", "", ""});
    CHECK(splitAt(',', "a") == Parts{"a"});
    CHECK(splitAt(',', "").empty());
}
