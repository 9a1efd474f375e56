// Keeps the arrows of docs/ARCHITECTURE.md: reads every #include and fails on one that points up, or round.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
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
    {"src/foreign", {"base", "volume"}},
    {"app/reader", {"base", "volume", "foreign", "reader"}},
    {"src/tf", {"base", "volume"}},
    {"src/saliency", {"base", "volume", "tf"}},
    {"src/render", {"base", "volume", "tf", "saliency"}},
    {"src/render/gl", {"base", "volume", "tf", "saliency", "render"}},
    {"src/image_io", {"base", "volume", "tf", "saliency", "render"}},
    {"src/optimize", {"base", "volume", "tf", "saliency", "render"}},
    {"src/ranks", {"base", "volume", "tf", "saliency", "render"}},
    {"src/ranks/mpi", {"base", "ranks"}},
    {"src/engines", {"base", "volume", "tf", "saliency", "render", "ranks"}},
    {"src/bench", {"base", "volume", "tf", "saliency", "render", "optimize", "engines"}},
    {"src/session", {"base", "volume", "tf", "saliency", "render", "optimize", "engines"}},
    {"src/figure", {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session"}},
    {"src/film", {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session"}},
    {"src/share", {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session"}},
    {"src/study", {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session"}},
    {"src/report",
     {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session", "study"}},
    {"app/cli",
     {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "ranks", "engines", "bench", "session",
      "study", "report", "figure", "film", "share", "cli"}},
    {"app/mpi", {"base", "volume", "tf", "saliency", "render", "ranks", "cli"}},
    {"app/paraview", {"base", "volume", "tf", "saliency", "render", "optimize", "ranks", "session"}},
    {"app/gui",
     {"base", "volume", "tf", "saliency", "render", "image_io", "optimize", "engines", "session", "study", "report",
      "figure", "film", "share", "gui"}},
    {"app/gpu_check", {"base", "volume", "tf", "saliency", "render", "optimize", "engines", "bench", "gpu_check"}},
};
const std::set<std::string> kOurFolders{"base",    "volume", "tf",      "saliency",  "render",  "image_io", "optimize",
                                        "engines", "bench",  "session", "study",     "report",  "film",     "share",
                                        "ranks",   "cli",    "gui",     "gpu_check", "foreign", "reader",   "figure"};

/// The folders of app/gui: each may include those before its row, and itself. What lies beside them, main.cpp, all.
const std::vector<std::set<std::string>> kGuiRows{{"jobs"},   {"store"},    {"widgets"},     {"dialogs"},
                                                  {"runner"}, {"services"}, {"controllers"}, {"view", "tf"},
                                                  {"panels"}, {"window"}};

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
            if (suffix != ".h" && suffix != ".cpp" && suffix != ".inl" && suffix != ".cxx") continue;
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

const fs::path kGui = fs::path(PELLUCID_SOURCE_DIR) / "app/gui";

std::string firstOf(const std::string& path) { return path.substr(0, path.find('/')); }
std::string folderOf(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }

/// The row of a path within app/gui; that of main.cpp is the last.
std::size_t guiRow(const std::string& path) {
    const auto row = std::find_if(kGuiRows.begin(), kGuiRows.end(),
                                  [&](const auto& folders) { return folders.count(firstOf(path)) > 0; });
    return static_cast<std::size_t>(row - kGuiRows.begin());
}

/// Between the folders of app/gui. "tf" is a folder of src, too: which is meant, the file tells.
std::string guiFault(const Include& include) {
    if (!fs::exists(kGui / include.name) &&
        (startsWith(include.name, "tf/") || guiRow(include.name) == kGuiRows.size()))
        return "";
    const std::string own = include.file.substr(std::string("app/gui/").size());
    if (firstOf(own) == firstOf(include.name) || guiRow(own) > guiRow(include.name)) return "";
    return "a folder of the window may include those before it in docs/ARCHITECTURE.md";
}

/// Between the folders of src/optimize: solve stands alone, what lies in no folder uses it, all others use both.
std::string optimizeFault(const Include& include) {
    const std::string own = folderOf(include.file.substr(std::string("src/").size())), to = folderOf(include.name);
    if (!startsWith(to, "optimize/") || to == own || (to == "optimize/solve/" && own != to)) return "";
    if (to == "optimize/" && own != "optimize/solve/") return "";
    return "folders of src/optimize do not know each other, but for solve, which all may use";
}

/// "OpenController" of "controllers/open_controller.h"
std::string classOf(const std::string& header) {
    std::string name;
    bool up = true;
    for (const char c : fs::path(header).stem().string()) {
        if (c != '_') name += up ? static_cast<char>(std::toupper(c)) : c;
        up = c == '_';
    }
    return name;
}

/// Between controllers: only what the constructor takes. `ownHeader` is the text of the header beside the file; a file
/// without one is of menu_actions.h. Controllers makes them all.
std::string controllerFault(const Include& include, const std::string& ownHeader) {
    const std::string own = fs::path(include.file).stem().string(), other = fs::path(include.name).stem().string();
    if (folderOf(include.file) != "app/gui/controllers/" || folderOf(include.name) != "controllers/" || own == other ||
        own == "controllers" || (ownHeader.empty() && other == "menu_actions"))
        return "";
    std::smatch constructor;
    const std::regex declared("\\b" + classOf(own) + R"(\(([^)]*)\))");
    if (std::regex_search(ownHeader, constructor, declared) &&
        std::regex_search(constructor.str(1), std::regex("\\b" + classOf(other) + "&")))
        return "";
    return "a controller knows those that its constructor takes";
}

/// Files with the same name are one unit: who includes whom.
using Units = std::map<std::string, std::set<std::string>>;

/// Units that include each other, in a row; empty where the graph has no circle.
std::vector<std::string> circleIn(const Units& units) {
    std::set<std::string> done;
    std::vector<std::string> way;
    const std::function<bool(const std::string&)> follow = [&](const std::string& unit) {
        if (const auto seen = std::find(way.begin(), way.end(), unit); seen != way.end()) {
            way.erase(way.begin(), seen);
            return true;
        }
        if (!done.insert(unit).second) return false;
        way.push_back(unit);
        if (const auto found = units.find(unit); found != units.end())
            for (const std::string& next : found->second)
                if (follow(next)) return true;
        way.pop_back();
        return false;
    };
    for (const auto& [unit, others] : units)
        if (follow(unit)) return way;
    return {};
}

std::string textOf(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Why the include breaks the architecture; empty where it does not.
std::string fault(const Include& include) {
    const std::string layer = layerOf(include.file);
    if (layer.empty()) return "lies in no layer";
    const bool gl = include.name == "epoxy/gl.h" || include.name == "epoxy/egl.h" || startsWith(include.name, "GL/") ||
                    startsWith(include.name, "EGL/") || startsWith(include.name, "GLES");
    if (gl && layer != "src/render/gl") return "GL outside src/render/gl";
    if (include.name == "mpi.h" && layer != "src/ranks/mpi") return "MPI outside src/ranks/mpi";
    if (startsWith(include.name, "ranks/mpi/") && layer != "src/ranks/mpi" && layer != "app/mpi" &&
        layer != "app/paraview")
        return "only pellucid-mpi and the plugin may include ranks/mpi";
    if (startsWith(include.name, "vtk") && layer != "app/paraview") return "VTK outside app/paraview";
    if (startsWith(include.name, "gdcm") && layer != "src/foreign") return "GDCM outside src/foreign";
    if (startsWith(include.name, "hdf5") && layer != "src/foreign") return "HDF5 outside src/foreign";
    static const std::regex qt("^(Q[A-Z]|Qt[A-Z]).*");
    if (std::regex_match(include.name, qt) && layer != "app/gui") return "Qt outside app/gui";
    if (layer == "app/gui")
        if (const std::string why = guiFault(include); !why.empty()) return why;
    if (layer == "src/optimize")
        if (const std::string why = optimizeFault(include); !why.empty()) return why;
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
        const fs::path header = fs::path(PELLUCID_SOURCE_DIR) / fs::path(include.file).replace_extension(".h");
        CHECK(controllerFault(include, textOf(header)) == "");
    }
}

TEST_CASE("no units of the window include each other in a circle", "[layering]") {
    Units units;
    for (const Include& include : includesBelow(PELLUCID_SOURCE_DIR)) {
        const fs::path from = fs::path(include.file).lexically_relative("app/gui").replace_extension(),
                       to = fs::path(include.name).replace_extension();
        if (startsWith(include.file, "app/gui/") && fs::exists(kGui / include.name) && from != to)
            units[from.generic_string()].insert(to.generic_string());
    }
    REQUIRE(units.size() > 50);
    CHECK(circleIn(units) == std::vector<std::string>{});
}

TEST_CASE("nothing of the window is looked for by its name", "[layering]") {
    for (const auto& entry : fs::recursive_directory_iterator(kGui)) {
        INFO(entry.path());
        if (entry.is_regular_file()) CHECK(textOf(entry.path()).find("window()->findChild") == std::string::npos);
    }
}

TEST_CASE("the rule itself catches what it should", "[layering]") {
    CHECK(fault({"src/tf/a.cpp", 1, "render/camera.h"}) != "");
    CHECK(fault({"src/volume/a.cpp", 1, "tf/palette.h"}) != "");
    CHECK(fault({"src/base/a.cpp", 1, "volume/grid.h"}) != "");
    CHECK(fault({"src/render/a.cpp", 1, "epoxy/gl.h"}) != "");
    CHECK(fault({"src/volume/a.cpp", 1, "vtkImageData.h"}) != "");
    CHECK(fault({"src/volume/a.cpp", 1, "gdcmReader.h"}) != "");
    CHECK(fault({"src/volume/a.cpp", 1, "hdf5.h"}) != "");
    CHECK(fault({"src/session/a.cpp", 1, "foreign/dicom_series.h"}) != "");
    CHECK(fault({"app/paraview/plugin/filters/a.cxx", 1, "vtkImageData.h"}) == "");
    CHECK(fault({"app/paraview/plugin/filters/a.cxx", 1, "image_io/image_file.h"}) != "");
    CHECK(fault({"src/render/a.cpp", 1, "render/gl/gl_engines.h"}) != "");
    CHECK(fault({"src/session/a.cpp", 1, "render/gl/gl_engines.h"}) != "");
    CHECK(fault({"src/ranks/a.cpp", 1, "mpi.h"}) != "");
    CHECK(fault({"src/engines/a.cpp", 1, "ranks/mpi/mpi_communicator.h"}) != "");
    CHECK(fault({"src/ranks/a.cpp", 1, "optimize/measure.h"}) != "");
    CHECK(fault({"src/ranks/mpi/a.cpp", 1, "mpi.h"}) == "");
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

TEST_CASE("the rules inside a layer catch what they should", "[layering]") {
    CHECK(fault({"app/gui/services/a.h", 1, "controllers/open_controller.h"}) != "");
    CHECK(fault({"app/gui/widgets/a.cpp", 1, "services/services.h"}) != "");
    CHECK(fault({"app/gui/controllers/a.cpp", 1, "view/volume_view.h"}) != "");
    CHECK(fault({"app/gui/controllers/a.cpp", 1, "tf/tf_canvas.h"}) != "");
    CHECK(fault({"app/gui/view/a.cpp", 1, "tf/tf_canvas.h"}) != "");
    CHECK(fault({"app/gui/tf/a.cpp", 1, "panels/channels_box.h"}) != "");
    CHECK(fault({"app/gui/panels/a.cpp", 1, "window/main_window.h"}) != "");
    CHECK(fault({"app/gui/jobs/a.h", 1, "store/session_store.h"}) != "");
    CHECK(fault({"app/gui/controllers/a.cpp", 1, "tf/transfer_function.h"}) == ""); // of src
    CHECK(fault({"app/gui/panels/a.cpp", 1, "panels/panel.h"}) == "");
    CHECK(fault({"app/gui/main.cpp", 1, "window/main_window.h"}) == "");

    CHECK(fault({"src/optimize/solve/a.h", 1, "optimize/optimizer.h"}) != "");
    CHECK(fault({"src/optimize/solve/a.h", 1, "optimize/refine/refine.h"}) != "");
    CHECK(fault({"src/optimize/a.cpp", 1, "optimize/refine/refine.h"}) != "");
    CHECK(fault({"src/optimize/refine/a.cpp", 1, "optimize/answer/verdict.h"}) != "");
    CHECK(fault({"src/optimize/time/a.cpp", 1, "optimize/solve/log_depths.h"}) == "");
    CHECK(fault({"src/optimize/time/a.cpp", 1, "optimize/optimizer.h"}) == "");
    CHECK(fault({"src/optimize/a.cpp", 1, "optimize/solve/boxed_step.h"}) == "");

    const Include save{"app/gui/controllers/open_controller.cpp", 1, "controllers/save_controller.h"};
    CHECK(controllerFault(save, "explicit OpenController(Services& services);") != "");
    CHECK(controllerFault(save, "OpenController(Services& services,\n SaveController& saving);") == "");
    CHECK(controllerFault(save, "OpenController(Services& services, AutoSaveController& saving);") != "");
    CHECK(controllerFault({"app/gui/controllers/view_actions.cpp", 1, "controllers/menu_actions.h"}, "") == "");
    CHECK(controllerFault({"app/gui/controllers/view_actions.cpp", 1, "controllers/save_controller.h"}, "") != "");

    CHECK(circleIn({{"a", {"b", "c"}}, {"b", {"c"}}}).empty());
    CHECK(circleIn({{"a", {"b"}}, {"b", {"a"}}}) == std::vector<std::string>{"a", "b"}); // a mutual pair
    CHECK(circleIn({{"a", {"b"}}, {"b", {"c"}}, {"c", {"d"}}, {"d", {"b"}}}).size() == 3);
}

TEST_CASE("files that the documents name exist", "[layering]") {
    const fs::path top(PELLUCID_SOURCE_DIR);
    std::vector<std::string> files;
    for (const char* folder : {"src", "app", "shaders", "tests", "scripts", "benchmarks", "cmake"})
        for (const auto& entry : fs::recursive_directory_iterator(top / folder))
            if (entry.is_regular_file()) files.push_back("/" + fs::relative(entry.path(), top).generic_string());
    const std::regex named("`([a-z_/]+\\.(cpp|h|inl|comp|frag|vert|glsl|py|sh))`");
    int seen = 0;
    for (const auto& entry : fs::recursive_directory_iterator(top / "docs")) {
        if (entry.path().extension() != ".md") continue;
        const std::string text = textOf(entry.path());
        for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at, ++seen) {
            const std::string name = "/" + at->str(1);
            INFO(entry.path().filename() << ": " << at->str(1));
            CHECK(std::any_of(files.begin(), files.end(), [&](const std::string& f) { return f.ends_with(name); }));
        }
    }
    CHECK(seen > 100);
}

TEST_CASE("a folder with many files says what each is", "[layering]") {
    std::map<fs::path, std::set<std::string>> folders; // headers by folder
    std::map<fs::path, int> files;
    for (const char* top : {"src", "app"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(PELLUCID_SOURCE_DIR) / top)) {
            const std::string suffix = entry.path().extension().string();
            if (suffix != ".h" && suffix != ".cpp" && suffix != ".inl") continue;
            ++files[entry.path().parent_path()];
            if (suffix == ".h") folders[entry.path().parent_path()].insert(entry.path().stem().string());
        }
    for (const auto& [folder, headers] : folders) {
        if (files[folder] <= 10) continue;
        std::ifstream in(folder / "README.md");
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        for (const std::string& header : headers) {
            INFO(folder << ": " << header);
            CHECK(text.find(header) != std::string::npos);
        }
    }
}

TEST_CASE("no name of a test has a semicolon, at which ctest would cut it and run nothing", "[layering]") {
    const std::regex cut(R"(^TEST_CASE\("[^"]*;)");
    const auto hasOne = [&](const std::string& line) { return std::regex_search(line, cut); };
    CHECK(hasOne("TEST_CASE(\"this" + std::string(";") + " that\", \"[x]\")"));
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PELLUCID_SOURCE_DIR) / "tests")) {
        if (entry.path().extension() != ".cpp") continue;
        ++files;
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) {
            INFO(entry.path() << ": " << line);
            CHECK_FALSE(hasOne(line));
        }
    }
    CHECK(files > 100);
}
