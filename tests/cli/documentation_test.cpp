// --help, the manual and the shell completion know the same options.
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>

#include "base/atomic_file.h"
#include "base/text.h"
#include "cli_runner.h"
#include "figure/figure_settings.h"
#include "film/film.h"
#include "options/setting_options.h"
#include "session/session.h"
#include "share/share.h"
#include "volume/loader.h"

using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

const std::vector<std::string> kCommands{"info",         "samples", "presets",  "generate", "convert", "render",
                                         "measure",      "fields",  "propose",  "refine",   "density", "optimize",
                                         "probe",        "rulers",  "views",    "space",    "bench",   "sequence",
                                         "saliency-map", "compare", "describe", "plot",     "film",    "reproduce",
                                         "share",        "study",   "colors",   "figure"};
/// Of commands that have commands of their own.
const std::vector<std::string> kStudyCommands{"prepare", "run", "analyze"};
/// What file managers and shells call.
const std::vector<std::string> kDesktopCommands{"thumbnail", "completions"};

std::vector<std::string> allCommands() {
    std::vector<std::string> all = kCommands;
    all.insert(all.end(), kDesktopCommands.begin(), kDesktopCommands.end());
    return all;
}

/// The words of each command that does something.
std::vector<std::vector<std::string>> workingCommands() {
    std::vector<std::vector<std::string>> all;
    for (const std::string& command : allCommands())
        if (command != "study") all.push_back({command});
    for (const std::string& command : kStudyCommands) all.push_back({"study", command});
    return all;
}

std::vector<std::string> withHelp(std::vector<std::string> words) {
    words.emplace_back("--help");
    return words;
}

std::string sourceFile(const std::string& path) {
    std::ifstream in(std::string(PELLUCID_SOURCE_DIR) + "/" + path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::set<std::string> optionsIn(const std::string& text) {
    static const std::regex kOption("--[a-z0-9][a-z0-9-]*");
    std::set<std::string> options;
    for (std::sregex_iterator i(text.begin(), text.end(), kOption), end; i != end; ++i) options.insert(i->str());
    return options;
}

std::string unescaped(std::string text) {
    for (std::size_t at = 0; (at = text.find("\\-", at)) != std::string::npos; ++at) text.erase(at, 1);
    return text;
}

std::string escaped(const std::string& text) {
    std::string roff;
    for (const char c : text) roff += c == '-' ? std::string("\\-") : std::string(1, c);
    return roff;
}

/// Lines of at most 120 bytes.
std::string wrapped(const std::string& text) {
    std::string lines;
    std::size_t length = 0;
    std::istringstream words(text);
    for (std::string word; words >> word; length += word.size()) {
        const bool breaks = length > 0 && length + 1 + word.size() > 120;
        lines += length == 0 ? "" : breaks ? "\n" : " ";
        length = breaks ? 0 : length + (length == 0 ? 0 : 1);
        lines += word;
    }
    return lines;
}

/// Entries of the manual for the settings of these keys; without keys, for all that have an option.
template <class T>
std::string manualOf(std::initializer_list<const char*> keys = {}) {
    pellucid::cli::SettingOptions<T> options;
    CLI::App app;
    app.set_help_flag();
    options.add(app, "Options", keys);
    std::string text;
    for (const CLI::Option* option : app.get_options())
        text += ".TP\n" +
                (option->get_type_size() == 0
                     ? ".B " + escaped(option->get_name())
                     : ".BI " + escaped(option->get_name()) + " \" " + escaped(option->get_type_name()) + "\"") +
                "\n" +
                wrapped(escaped(static_cast<char>(std::toupper(option->get_description()[0])) +
                                option->get_description().substr(1) + ".")) +
                "\n";
    return text;
}

std::string manualOf(const std::string& group) {
    using namespace pellucid;
    if (group == "engine") return manualOf<MeasureSettings>();
    if (group == "saliency") return manualOf<SaliencyOptions>() + manualOf<VwsOptions>();
    if (group == "display") return manualOf<DisplaySettings>();
    if (group == "light") return manualOf<Light>({"silhouettes", "occlusion", "depth_cue", "gradient_opacity"});
    if (group == "field") return manualOf<FieldView>();
    if (group == "ground") return manualOf<GroundView>();
    if (group == "overlay") return manualOf<OverlayView>();
    if (group == "figure") return manualOf<FigureSettings>();
    if (group == "film") return manualOf<FilmSettings>();
    if (group == "share") return manualOf<ShareSettings>();
    if (group == "coordinates") return manualOf<CoordinateSettings>();
    if (group == "slice") return manualOf<SliceViews>();
    if (group == "refine") return manualOf<RefineSteps>();
    if (group == "optimize") return manualOf<OptimizeOptions>();
    if (group == "adapt") return manualOf<AdaptSettings>();
    if (group == "search") return manualOf<OptimizeOptions>({"tolerance", "exact_shares"});
    FAIL("the manual asks for settings called " << group);
    return {};
}

/// What bash offers after `line`, the completion script being loaded.
std::set<std::string> completions(const std::string& line) {
    const std::string script = "source <('" PELLUCID_CLI "' completions bash); COMP_LINE='" + line +
                               "'; COMP_POINT=${#COMP_LINE}; COMP_WORDS=(pellucid-cli); _pellucid_cli; "
                               "printf '%s\\n' \"${COMPREPLY[@]}\"";
    FILE* pipe = popen(("bash -c " +
                        [&] {
                            std::string quoted = "'";
                            for (const char c : script) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
                            return quoted + "'";
                        }())
                           .c_str(),
                       "r");
    REQUIRE(pipe != nullptr);
    std::string text;
    std::array<char, 256> buffer{};
    while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) text += buffer.data();
    pclose(pipe);
    std::set<std::string> words;
    std::istringstream lines(text);
    for (std::string word; std::getline(lines, word);)
        if (!word.empty()) words.insert(word);
    return words;
}

} // namespace

TEST_CASE("help and version are answers", "[cli][documentation]") {
    const Workshop w;
    const Outcome version = w.run({"--version"});
    CHECK(version.status == 0);
    CHECK(std::regex_match(version.out, std::regex("pellucid-cli [0-9]+\\.[0-9]+\\.[0-9]+\n")));
    const Outcome help = w.run({"--help"});
    CHECK(help.status == 0);
    CHECK(help.err.empty());
    for (const std::string& command : allCommands()) {
        INFO(command);
        CHECK(help.out.find("  " + command + " ") != std::string::npos);
    }
    for (const auto& words : workingCommands()) {
        const std::string command = pellucid::joined(words, " ");
        INFO(command);
        const Outcome own = w.run(withHelp(words));
        CHECK(own.status == 0);
        CHECK(own.err.empty());
        CHECK(own.out.find("Usage: pellucid-cli " + command) != std::string::npos);
        CHECK(optionsIn(own.out).count("--json") == 1);
    }
    const Outcome study = w.run({"study", "--help"});
    CHECK(study.status == 0);
    for (const std::string& command : kStudyCommands) CHECK(study.out.find("  " + command + " ") != std::string::npos);
}

TEST_CASE("the manual has every command and option, and no others", "[cli][documentation]") {
    const Workshop w;
    const std::string manual = unescaped(sourceFile("docs/man/pellucid-cli.1"));
    REQUIRE_FALSE(manual.empty());
    std::set<std::string> known{"--version"};
    for (const auto& words : workingCommands()) {
        const std::string command = pellucid::joined(words, R"(\\ )"); // blanks that keep the words together
        INFO(command);
        CHECK(std::regex_search(manual, std::regex("\n\\.BI? " + command + "\\b")));
        known.merge(optionsIn(w.run(withHelp(words)).out));
    }
    CHECK(optionsIn(manual) == known);
}

TEST_CASE("the manual says of settings what their descriptions say", "[cli][documentation][documents]") {
    const std::string path = "docs/man/pellucid-cli.1", begin = ".\\\" settings: ", end = ".\\\" end\n";
    const std::string manual = sourceFile(path);
    std::string fresh;
    std::size_t at = 0;
    for (std::size_t from; (from = manual.find(begin, at)) != std::string::npos;) {
        const std::size_t line = manual.find('\n', from) + 1, to = manual.find(end, line);
        REQUIRE(to != std::string::npos);
        fresh +=
            manual.substr(at, line - at) + manualOf(manual.substr(from + begin.size(), line - 1 - from - begin.size()));
        at = to;
    }
    fresh += manual.substr(at);
    if (std::getenv("PELLUCID_REFRESH_DOCS") != nullptr)
        pellucid::writeTextAtomically(std::string(PELLUCID_SOURCE_DIR) + "/" + path, fresh);
    else
        CHECK(manual == fresh); // else scripts/refresh-docs.sh writes it
}

/// The part of a script that is of one command, from its beginning in that shell's tables to the next one's.
std::string partOf(const std::string& script, const std::string& begin, const std::string& end) {
    std::string part;
    for (std::size_t at = 0; (at = script.find(begin, at)) != std::string::npos;) {
        const std::size_t to = script.find(end, at);
        part += script.substr(at, to - at) + "\n";
        at = to;
    }
    return part;
}

TEST_CASE("each shell is told of every command and option", "[cli][documentation]") {
    const Workshop w;
    const std::string bash = w.run({"completions", "bash"}).out, zsh = w.run({"completions", "zsh"}).out,
                      fish = w.run({"completions", "fish"}).out;
    const std::string ofProgram = partOf(bash, "        '') words=", ";;");
    for (const std::string& command : allCommands()) {
        INFO(command);
        CHECK(std::regex_search(ofProgram, std::regex("[ ']" + command + "[ ']")));
        CHECK(zsh.find("\n            '" + command + ":") != std::string::npos);
        CHECK(fish.find("'__pellucid_cli_at ' -a " + command + " -d '") != std::string::npos);
    }
    for (const auto& words : workingCommands()) {
        const std::string command = pellucid::joined(words, " ");
        INFO(command);
        const std::string ofBash = partOf(bash, "        '" + command + "') words=", ";;"),
                          ofZsh = partOf(zsh, "        '" + command + "') _arguments", ";;"),
                          ofFish = partOf(fish, "'__pellucid_cli_at " + command + "'", "\n");
        std::set<std::string> inBash = optionsIn(ofBash), inZsh, inFish;
        static const std::regex kSpec("'\\*(--[a-z0-9-]+)\\[");
        for (std::sregex_iterator i(ofZsh.begin(), ofZsh.end(), kSpec), end; i != end; ++i) inZsh.insert(i->str(1));
        static const std::regex kLong(" -l ([a-z0-9-]+)");
        for (std::sregex_iterator i(ofFish.begin(), ofFish.end(), kLong), end; i != end; ++i)
            inFish.insert("--" + i->str(1));
        // What is defined, not what descriptions mention: "  --name …" at the beginning of a line of the help.
        const std::string help = w.run(withHelp(words)).out;
        std::set<std::string> defined;
        static const std::regex kDefined("\n  (-[a-z],)?((--[a-z0-9-]+,?)+)");
        for (std::sregex_iterator i(help.begin(), help.end(), kDefined), end; i != end; ++i)
            defined.merge(optionsIn(i->str(2)));
        CHECK(defined.size() >= 2);
        CHECK(inBash == defined);
        CHECK(inZsh == defined);
        CHECK(inFish == defined);
    }
    const Outcome other = w.run({"completions", "csh"});
    CHECK(other.status == 2);
    CHECK(other.err.find("bash fish zsh") != std::string::npos);
    const Outcome written = w.run({"completions", "fish", "--out", "script"});
    CHECK(written.status == 0);
    CHECK(w.read("script") == fish);
}

TEST_CASE("desktops know the names of all volume files", "[cli][documentation]") {
    const std::string types = sourceFile("packaging/desktop/pellucid.xml");
    // Those that every desktop knows: shared-mime-info has them for DICOM, HDF5, NetCDF and TIFF.
    const std::set<std::string> known{"*.dcm", "*.hdf", "*.cdf", "*.tif", "*.tiff"};
    // Of many programs; what MATLAB 7.3 writes is known by its first bytes, and the header of an .img stands beside it.
    const std::set<std::string> unclaimed{"*.mat", "*.img", "*.img.gz"};
    REQUIRE(pellucid::volumeFilePatterns().size() > 20);
    for (const std::string& pattern : pellucid::volumeFilePatterns()) {
        INFO(pattern);
        CHECK((known.count(pattern) + unclaimed.count(pattern) == 1 ||
               types.find("<glob pattern=\"" + pattern + "\"") != std::string::npos));
    }
    CHECK(types.find("<glob pattern=\"*.pellucid.json\"") != std::string::npos);
}

TEST_CASE("bash completes commands, options, values and samples", "[cli][documentation]") {
    const auto commands = completions("pellucid-cli ");
    for (const std::string& command : allCommands()) CHECK(commands.count(command) == 1);
    CHECK(completions("pellucid-cli me") == std::set<std::string>{"measure"});
    CHECK(completions("pellucid-cli optimize sample:shells --req") == std::set<std::string>{"--require-converged"});
    CHECK(completions("pellucid-cli measure x.nrrd --engine ") ==
          std::set<std::string>{"auto", "cpu", "gl", "reference", "slices"});
    CHECK(completions("pellucid-cli render x.nrrd --field sal") ==
          std::set<std::string>{"saliency", "saliency-brightness", "saliency-saturation"});
    CHECK(completions("pellucid-cli render x.nrrd --mode mi") == std::set<std::string>{"minip", "mip"});
    CHECK(completions("pellucid-cli render x.nrrd --light-preset m") == std::set<std::string>{"matte", "metal"});
    CHECK(completions("pellucid-cli generate sh") == std::set<std::string>{"shells"});
    CHECK(completions("pellucid-cli reproduce table-3") == std::set<std::string>{"table-3.2"});
    // Bash takes the word after the colon for the one to complete.
    CHECK(completions("pellucid-cli info sample:sh") == std::set<std::string>{"shells"});
    CHECK(completions("pellucid-cli refine sample:shells --engine").empty());
    CHECK(completions("pellucid-cli render sample:shells --view a") == std::set<std::string>{"anterior"});
    CHECK(completions("pellucid-cli optimize sample:shells --view be") == std::set<std::string>{"best"});
    CHECK(completions("pellucid-cli render sample:shells --view be").empty());
    CHECK(completions("pellucid-cli render sample:shells --annotate le") == std::set<std::string>{"legend", "letters"});
    CHECK(completions("pellucid-cli study pr") == std::set<std::string>{"prepare"});
    CHECK(completions("pellucid-cli study run x --part") == std::set<std::string>{"--participant"});
    CHECK(completions("pellucid-cli study run x --measure v") == std::set<std::string>{"visibility", "vws"});
    CHECK(completions("pellucid-cli study prepare x --engine c") == std::set<std::string>{"cpu"});
    CHECK(completions("pellucid-cli bench --only s") ==
          std::set<std::string>{"saliency", "saliency-direct", "setup", "slices", "sweep"});
}
