#include <catch2/catch.hpp>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "base/error.h"
#include "render/gl/shader_source.h"

using namespace pellucid;
using namespace pellucid::gl;

namespace {

ShaderLookup filesOf(std::map<std::string, std::string> files) {
    return [files = std::move(files)](const std::string& name) -> std::optional<std::string> {
        const auto found = files.find(name);
        if (found == files.end()) return {};
        return found->second;
    };
}

std::string readFile(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

} // namespace

TEST_CASE("includes are expanded once, and every line knows where it came from", "[shader_source]") {
    const auto lookup =
        filesOf({{"a.frag", "one\n#include \"b.glsl\"\n  #include \"b.glsl\" // again\nfour\n"}, {"b.glsl", "b1\nb2"}});
    const ShaderSource source = expandShader("a.frag", {"FAST", "N 4"}, lookup);
    CHECK(source.text == "#version 430 core\n#define FAST\n#define N 4\none\nb1\nb2\nfour\n");
    REQUIRE(source.lines.size() == 7);
    CHECK(source.lines[0].line == 0);
    CHECK(source.lines[3].file == "a.frag");
    CHECK(source.lines[3].line == 1);
    CHECK(source.lines[5].file == "b.glsl");
    CHECK(source.lines[5].line == 2);
    CHECK(source.lines[6].file == "a.frag");
    CHECK(source.lines[6].line == 4);
}

TEST_CASE("two files that include each other end", "[shader_source]") {
    const auto lookup = filesOf({{"a.glsl", "a\n#include \"b.glsl\"\n"}, {"b.glsl", "b\n#include \"a.glsl\"\n"}});
    CHECK(expandShader("a.glsl", {}, lookup).text == "#version 430 core\na\nb\n");
}

TEST_CASE("a missing or malformed include names its file and line", "[shader_source]") {
    const auto lookup = filesOf({{"a.frag", "x\n\n#include \"gone.glsl\"\n"}, {"b.frag", "#include <c.glsl>\n"}});
    try {
        expandShader("a.frag", {}, lookup);
        FAIL("expected an error");
    } catch (const Error& error) {
        CHECK(error.where() == "a.frag:3");
        CHECK(error.problem().find("gone.glsl") != std::string::npos);
    }
    try {
        expandShader("b.frag", {}, lookup);
        FAIL("expected an error");
    } catch (const Error& error) {
        CHECK(error.where() == "b.frag:1");
    }
    CHECK_THROWS_AS(expandShader("absent.frag", {}, lookup), Error);
}

TEST_CASE("compilers' messages lead back to the original file and line", "[shader_source]") {
    const auto lookup = filesOf({{"a.frag", "one\n#include \"b.glsl\"\nlast\n"}, {"b.glsl", "b1\nb2\n"}});
    const ShaderSource source = expandShader("a.frag", {}, lookup);
    // Line 1 is #version, 2 "one", 3 and 4 those of b.glsl, 5 "last".
    CHECK(mapShaderLog("0:4(7): error: no", source) == "b.glsl:2: error: no");
    CHECK(mapShaderLog("0(5) : error C1: no", source) == "a.frag:3: error C1: no");
    CHECK(mapShaderLog("ERROR: 0:2: 'x' : no\nsummary", source) == "ERROR: a.frag:1: 'x' : no\nsummary");
    CHECK(mapShaderLog("0:99(1): error: beyond", source) == "0:99(1): error: beyond");
}

TEST_CASE("every shader file is embedded as it is, and every include is found", "[shader_source]") {
    const std::filesystem::path folder = std::filesystem::path(PELLUCID_SOURCE_DIR) / "shaders";
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const std::string name = std::filesystem::relative(entry.path(), folder).generic_string();
        CAPTURE(name);
        const auto source = embeddedShaderSource(name);
        REQUIRE(source);
        CHECK(*source == readFile(entry.path()));
        CHECK_NOTHROW(expandShader(name, {}));
    }
    CHECK(files == embeddedShaders().size());
    CHECK(files > 0);
}

TEST_CASE("the lists of GL and EGL functions are those of the sources", "[shader_source]") {
    const std::filesystem::path root = PELLUCID_SOURCE_DIR, list = root / "src/render/gl/gl_functions.h";
    // Every word after `before` that starts with `prefix` and a capital letter and is followed by `after`.
    const auto names = [](const std::string& text, const std::string& before, const std::string& prefix, char after) {
        std::set<std::string> found;
        for (std::size_t at = text.find(before + prefix); at != std::string::npos;
             at = text.find(before + prefix, at + 1)) {
            const std::size_t first = at + before.size();
            std::size_t end = first;
            while (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_') ++end;
            const char previous = first == 0 ? ' ' : text[first - 1];
            const bool wordStart = std::isalnum(static_cast<unsigned char>(previous)) == 0 && previous != '_';
            if (wordStart && std::isupper(static_cast<unsigned char>(text[first + prefix.size()])) != 0 &&
                text[end] == after)
                found.insert(text.substr(first, end - first));
        }
        return found;
    };
    for (const std::string prefix : {"gl", "egl"}) {
        std::set<std::string> used;
        for (const char* folder : {"src/render/gl", "tests/gl"})
            for (const auto& entry : std::filesystem::directory_iterator(root / folder))
                if (entry.path() != list) used.merge(names(readFile(entry.path()), "", prefix, '('));
        used.erase("glInteger"); // functions of ours
        used.erase("eglCandidates");
        CHECK(used == names(readFile(list), "X(", prefix, ')'));
    }
}
