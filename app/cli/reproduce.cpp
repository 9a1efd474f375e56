// `reproduce`: figures and tables of the thesis, done again, as a page.
#include <algorithm>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "command_line.h"
#include "commands.h"
#include "interrupt.h"
#include "options/volume_options.h"
#include "output_files.h"
#include "parse.h"
#include "report/reproduction_page.h"
#include "reproduce/runner.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPageFile = "index.html";
constexpr int kMostSideBySide = 64;

struct ReproduceArguments {
    std::vector<std::string> names;
    std::optional<std::string> out, data, index;
    int sampleSize = DeskSettings{}.sampleSize;
    int sideBySide = 0; ///< 0: as many as there are threads, four at most
    bool list = false;
};

/// What an item needs, where `settings` look for it.
std::string dataText(const Item& item, const DeskSettings& settings) {
    return joined(item.data, "; ", [&](const DataNeed& need) { return sourceOf(need, settings).said; });
}

Answer listed(const std::vector<Item>& chosen, const DeskSettings& settings) {
    Json list = Json::array();
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Item& item : chosen) {
        lines.emplace_back(joined(item.shows, " "), item.title + " (" + dataText(item, settings) + ")");
        list.push_back({{"id", item.id()}, {"shows", item.shows}, {"title", item.title}, {"thesis", item.thesis}});
        for (const ReproducedEquation& e : item.equations)
            list.back()["equations"].push_back({{"number", e.number}, {"file", e.file}});
        list.back()["data"] = dataText(item, settings);
    }
    return {listing(lines), {{"command", "reproduce"}, {"items", std::move(list)}}};
}

/// The place of this program.
fs::path ownPath() {
    std::error_code ec;
    const fs::path path = fs::read_symlink("/proc/self/exe", ec);
    if (ec) throw Error("the program does not find itself (" + ec.message() + ")", "/proc/self/exe", "mount /proc");
    return path;
}

DeskSettings settingsOf(const ReproduceArguments& o) {
    DeskSettings settings;
    settings.program = ownPath();
    settings.folder = fs::absolute(o.out.value_or("."));
    settings.sampleSize = o.sampleSize;
    if (o.data) {
        settings.data = fs::weakly_canonical(*o.data);
        if (!fs::is_directory(*settings.data))
            throw FileError("there is no such folder", *o.data, "give --data the folder with the real volumes");
    }
    return settings;
}

std::string textOf(const std::vector<ItemOutcome>& outcomes, const std::string& page, double seconds) {
    Table table({"item", "statements", "pictures", "time", ""});
    for (const ItemOutcome& o : outcomes) {
        const Reproduction& r = o.result;
        table.add({headingOf(r), std::to_string(r.holding()) + " of " + std::to_string(r.statements.size()) + " hold",
                   std::to_string(r.pictures.size()), secondsText(r.seconds),
                   !r.error.empty() ? "failed"
                   : o.isReused     ? "as before"
                                    : ""});
    }
    return table.text() + "wrote " + page + ", " + secondsText(seconds) + "\n";
}

Json jsonOf(const std::vector<ItemOutcome>& outcomes) {
    Json list = Json::array();
    for (const ItemOutcome& o : outcomes) {
        list.push_back(jsonFromReproduction(o.result));
        list.back()["reused"] = o.isReused;
    }
    return list;
}

/// What to say where items failed.
std::optional<Error> failureOf(const std::vector<ItemOutcome>& outcomes) {
    std::vector<std::string> failed;
    std::string first;
    for (const ItemOutcome& o : outcomes) {
        if (o.result.error.empty()) continue;
        if (failed.empty()) first = o.result.error;
        failed.push_back(o.result.id);
    }
    if (failed.empty()) return {};
    return Error(std::to_string(failed.size()) + (failed.size() == 1 ? " item" : " items") +
                     " failed: " + joined(failed),
                 first, "run the same command again once that is mended");
}

/// What was given for this program as a whole, and holds for those that it starts.
void takeCommonOptions(const CLI::App& app, DeskSettings& settings) {
    for (const char* name : {"--threads", "--memory"})
        for (const std::string& value : app.get_option(name)->results()) settings.common.emplace_back(name, value);
}

Answer run(const ReproduceArguments& o, const CLI::App& app, Progress& progress) {
    const Stopwatch total;
    const std::vector<Item> chosen = itemsShowing(o.names);
    DeskSettings settings = settingsOf(o);
    takeCommonOptions(app, settings);
    if (o.list) return listed(chosen, settings);
    if (!o.out) throw isRequired("--out", "reproduce");
    addOutputFile(*o.out, kPageFile, "--out");
    std::error_code ec;
    fs::create_directories(settings.folder, ec);
    if (ec) throw FileError("cannot create the folder (" + ec.message() + ")", *o.out, "check permissions and space");
    linkData(settings);

    const int jobs = o.sideBySide > 0 ? o.sideBySide : std::min(4, threadCount());
    const JobControl job = progress.phase("reproducing");
    const std::vector<ItemOutcome> outcomes = runItems(chosen, settings, jobs, interruptToken(), [&](std::size_t done) {
        job.report(static_cast<double>(done) / static_cast<double>(chosen.size()));
    });
    const std::vector<Reproduction> results = resultsAt(settings, outcomes);
    const std::string page = (fs::path(*o.out) / kPageFile).string();
    writeTextAtomically(page, htmlOf({results, "Pellucid " PELLUCID_VERSION, commandLine(), total.seconds()}));
    if (o.index) writeTextAtomically(*o.index, indexOf(results));
    std::string text = textOf(outcomes, page, total.seconds());
    if (o.index) text += "wrote " + *o.index + "\n";
    Answer answer{
        std::move(text),
        {{"command", "reproduce"}, {"page", page}, {"items", jsonOf(outcomes)}, {"seconds", total.seconds()}}};
    answer.failure = failureOf(outcomes);
    return answer;
}

} // namespace

Command addReproduce(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "reproduce", "Does figures and tables of the thesis again, as a page with its numbers beside");
    const auto o = std::make_shared<ReproduceArguments>();
    app->add_option("ITEM", o->names, "figures and tables, such as 3.4 or table-3.2 (default: all; --list names them)")
        ->type_name("");
    addOutputFolder(*app, "--out", o->out,
                    "folder for the page, index.html, and a folder for each item; made where missing. What is there "
                    "already, of the same program, data and options, is not done again");
    addValue(*app, "--data", "DIR", o->data, anyText,
             "folder with the real volumes, as tooth/tooth.mhd (default: samples take their place)");
    addValue(*app, "--sample-size", "N", o->sampleSize, parseSampleSize,
             "voxels along the longest axis of samples (default " + std::to_string(o->sampleSize) + ")");
    addValue(*app, "--jobs", "N", o->sideBySide, wholeFrom(1, kMostSideBySide),
             "items that run side by side (default: as many as there are threads, 4 at most)");
    addOutputFile(*app, "--index", o->index,
                  "also write what was found as Markdown: equations, files, commands, results");
    app->add_flag("--list", o->list, "only list the items");
    return {app, [o, app](Progress& progress) { return run(*o, *app, progress); }};
}

} // namespace pellucid::cli
