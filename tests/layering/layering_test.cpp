// Keeps the arrows of docs/ARCHITECTURE.md: reads every #include and fails on one that points up.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

/// What each layer may include besides itself.
const std::map<std::string, std::set<std::string>> kAllowed{
    {"src/base", {}},
    {"src/volume", {"base"}},
    {"src/tf", {"base", "volume"}},
    {"src/saliency", {"base", "volume", "tf"}},
    {"src/render", {"base", "volume", "tf", "saliency"}},
    {"src/render/gl", {"base", "volume", "tf", "saliency", "render"}},
    {"src/image_io", {"base", "volume", "tf", "saliency", "render"}},
    {"src/optimize", {"base", "volume", "tf", "saliency", "render"}},
    {"src/engines", {"base", "volume", "tf", "saliency", "render"}},
    {"src/bench", {"base", "volume", "tf", "saliency", "render", "optimize", "engines"}},
    {"src/session", {"base", "volume", "tf", "saliency", "render", "optimize", "engines"}},
    {"src/report", {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session"}},
    {"app/cli",
     {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "bench", "session", "report",
      "cli"}},
    {"app/gui",
     {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session", "report", "gui"}},
    {"app/gpu_check", {"base", "volume", "tf", "saliency", "render", "optimize", "engines", "bench", "gpu_check"}},
};
const std::set<std::string> kOurFolders{"base",    "volume", "tf",      "saliency", "render", "image_io", "optimize",
                                        "engines", "bench",  "session", "report",   "cli",    "gui",      "gpu_check"};

struct Include {
    std::string file; ///< relative to the sources' top
    int line;
    std::string name; ///< between the quotes or brackets
};

std::vector<Include> includesBelow(const fs::path& top) {
    static const std::regex directive(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::vector<Include> all;
    for (const char* folder : {"src", "app"})
        for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
            const std::string suffix = entry.path().extension().string();
            if (suffix != ".h" && suffix != ".cpp" && suffix != ".inl") continue;
            std::ifstream in(entry.path());
            std::string text;
            for (int line = 1; std::getline(in, text); ++line) {
                std::smatch match;
                if (std::regex_search(text, match, directive))
                    all.push_back({fs::relative(entry.path(), top).generic_string(), line, match[1]});
            }
        }
    return all;
}

/// The layer of a file: the longest of kAllowed's folders that it lies in.
std::string layerOf(const std::string& file) {
    std::string layer;
    for (const auto& [folder, allowed] : kAllowed)
        if (file.rfind(folder + "/", 0) == 0 && folder.size() > layer.size()) layer = folder;
    return layer;
}

bool startsWith(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

/// Why the include breaks the architecture; empty where it does not.
std::string fault(const Include& include) {
    const std::string layer = layerOf(include.file);
    if (layer.empty()) return "lies in no layer";
    const bool gl = include.name == "epoxy/gl.h" || include.name == "epoxy/egl.h" || startsWith(include.name, "GL/") ||
                    startsWith(include.name, "EGL/") || startsWith(include.name, "GLES");
    if (gl && layer != "src/render/gl") return "GL outside src/render/gl";
    static const std::regex qt("^(Q[A-Z]|Qt[A-Z]).*");
    if (std::regex_match(include.name, qt) && layer != "app/gui") return "Qt outside app/gui";
    const std::string folder = include.name.substr(0, include.name.find('/'));
    if (include.name.find('/') == std::string::npos || !kOurFolders.count(folder)) return "";
    const std::string own = layer.substr(layer.find('/') + 1);
    if (startsWith(include.name, "render/gl/") && layer != "src/render/gl" && layer != "src/engines" &&
        layer != "app/gui" && layer != "app/gpu_check")
        return "only engines, the window and the GPU's check may include render/gl";
    if (startsWith(include.file, "src/optimize/solve/") && folder == own &&
        !startsWith(include.name, "optimize/solve/"))
        return "solvers know nothing of the searches that use them";
    if (folder == own || kAllowed.at(layer).count(folder)) return "";
    return "an arrow that points up or sideways";
}

} // namespace

TEST_CASE("every include points down the layers", "[layering]") {
    const auto includes = includesBelow(PELLUCID_SOURCE_DIR);
    REQUIRE(includes.size() > 100); // the sources were found
    for (const Include& include : includes) {
        INFO(include.file << ":" << include.line << " includes " << include.name);
        CHECK(fault(include) == "");
    }
}

TEST_CASE("the rule itself catches what it should", "[layering]") {
    CHECK(fault({"src/tf/a.cpp", 1, "render/camera.h"}) != "");
    CHECK(fault({"src/volume/a.cpp", 1, "tf/color.h"}) != "");
    CHECK(fault({"src/base/a.cpp", 1, "volume/grid.h"}) != "");
    CHECK(fault({"src/render/a.cpp", 1, "epoxy/gl.h"}) != "");
    CHECK(fault({"src/render/a.cpp", 1, "render/gl/gl_engines.h"}) != "");
    CHECK(fault({"src/session/a.cpp", 1, "render/gl/gl_engines.h"}) != "");
    CHECK(fault({"app/cli/a.cpp", 1, "render/gl/gl_engines.h"}) != "");
    CHECK(fault({"src/optimize/a.cpp", 1, "session/scene.h"}) != "");
    CHECK(fault({"src/optimize/a.h", 1, "QWidget"}) != "");
    CHECK(fault({"src/optimize/solve/a.h", 1, "optimize/optimizer.h"}) != "");
    CHECK(fault({"src/optimize/solve/a.h", 1, "optimize/solve/matrix.h"}) == "");
    CHECK(fault({"app/cli/a.cpp", 1, "QtWidgets/QWidget"}) != "");
    CHECK(fault({"app/cli/a.cpp", 1, "gui/main_window.h"}) != "");
    CHECK(fault({"src/session/a.cpp", 1, "report/plot.h"}) != "");
    CHECK(fault({"src/render/gl/a.cpp", 1, "epoxy/gl.h"}) == "");
    CHECK(fault({"src/optimize/a.cpp", 1, "render/camera.h"}) == "");
    CHECK(fault({"app/gui/a.cpp", 1, "QWidget"}) == "");
}
