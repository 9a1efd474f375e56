#include "reproduce/runner.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

#include "base/atomic_file.h"
#include "base/json_value.h"
#include "base/stopwatch.h"
#include "volume/loader.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char *kFormat = "pellucid-reproduction", *kResultFile = "item.json";
constexpr int kVersion = 1;

/// What tells a file from the one that it was.
Json stateOf(const fs::path& file) {
    std::error_code ec;
    const auto bytes = fs::file_size(file, ec);
    const auto written = fs::last_write_time(file, ec).time_since_epoch();
    return {{"file", file.string()},
            {"bytes", ec ? 0 : bytes},
            {"written", std::chrono::duration_cast<std::chrono::nanoseconds>(written).count()}};
}

/// Everything that the result of an item depends on.
Json inputsOf(const Item& item, const DeskSettings& settings) {
    std::set<fs::path> files;
    for (const DataNeed& need : item.data) {
        const auto file = realFileOf(need, settings);
        if (!file) continue;
        VolumeSource source;
        source.path = file->string();
        for (const std::string& read : filesOf(source)) files.insert(read);
    }
    if (std::error_code ec; !files.empty())
        for (const auto& entry : fs::directory_iterator(settings.folder / kThesisLink, ec)) files.insert(entry.path());
    Json data = Json::array();
    for (const fs::path& file : files) data.push_back(stateOf(file));
    return {{"version", PELLUCID_VERSION},
            {"program", stateOf(settings.program)},
            {"sample_size", settings.sampleSize},
            {"data", std::move(data)}};
}

fs::path resultFile(const Item& item, const DeskSettings& settings) {
    return settings.folder / item.id() / kResultFile;
}

void keep(const Item& item, const DeskSettings& settings, const Reproduction& result) {
    const Json document{{"format", kFormat},
                        {"version", kVersion},
                        {"inputs", inputsOf(item, settings)},
                        {"item", jsonFromReproduction(result)}};
    writeTextAtomically(resultFile(item, settings).string(),
                        document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// Runs one item. What goes wrong in it is its own affair; being stopped is not.
Reproduction done(const Item& item, const DeskSettings& settings, const std::stop_token& stop) {
    const Stopwatch watch;
    std::error_code ec;
    fs::remove(resultFile(item, settings), ec); // from now on the folder's pictures are not those of the old result
    Reproduction result = item.unmade();
    try {
        Desk desk(item, settings, stop);
        try {
            item.run(desk);
        } catch (...) {
            result = desk.result(watch.seconds());
            throw;
        }
        result = desk.result(watch.seconds());
        keep(item, settings, result);
    } catch (const Error& e) {
        result.error = e.what();
    } catch (const std::exception& e) {
        result.error = std::string("unexpected failure (") + e.what() + ")";
    }
    return result;
}

/// Does `count` pieces of work on up to `threads` threads; the first exception is thrown again.
void sideBySide(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr thrown;
    {
        std::vector<std::jthread> workers;
        for (std::size_t t = 0; t < std::min(count, static_cast<std::size_t>(threads)); ++t)
            workers.emplace_back([&] {
                for (std::size_t i = 0; (i = next++) < count;) {
                    try {
                        work(i);
                    } catch (...) {
                        const std::lock_guard lock(mutex);
                        if (!thrown) thrown = std::current_exception();
                        next = count;
                    }
                }
            });
    }
    if (thrown) std::rethrow_exception(thrown);
}

void link(const fs::path& link, const fs::path& to) {
    std::error_code ec;
    if (fs::is_symlink(fs::symlink_status(link, ec))) {
        if (fs::read_symlink(link, ec) == to) return;
        fs::remove(link, ec);
    }
    fs::create_directory_symlink(to, link, ec);
    if (ec)
        throw FileError("cannot link to the data (" + ec.message() + ")", link.string(),
                        "give another folder with --out");
}

} // namespace

std::optional<Reproduction> keptResult(const Item& item, const DeskSettings& settings) {
    const fs::path file = resultFile(item, settings);
    std::error_code ec;
    if (!fs::exists(file, ec)) return {};
    try {
        std::ifstream in(file); // no input of the command, which writes the file anew
        const nlohmann::json document = nlohmann::json::parse(in);
        const JsonValue value(document, file.string());
        requireFormat(value, kFormat, kVersion, "leave it to reproduce");
        if (document.at("inputs") != nlohmann::json(inputsOf(item, settings))) return {};
        Reproduction result = reproductionFromJson(document.at("item"), file.string());
        const bool whole = result.shows == item.shows && std::ranges::all_of(result.pictures, [&](const auto& picture) {
                               return fs::exists(settings.folder / picture.file, ec);
                           });
        if (whole) return result;
    } catch (const std::exception&) {
        // Damaged, or of another kind: it is made anew.
    }
    return {};
}

std::vector<ItemOutcome> runItems(std::span<const Item> items, const DeskSettings& settings, int sideBySideAtMost,
                                  const std::stop_token& stop, const ItemsDone& tell) {
    std::vector<ItemOutcome> outcomes(items.size());
    std::mutex mutex;
    std::size_t ended = 0;
    const auto work = [&](std::size_t i) {
        if (stop.stop_requested()) throw Cancelled{};
        if (auto kept = keptResult(items[i], settings))
            outcomes[i] = {std::move(*kept), true};
        else
            outcomes[i].result = done(items[i], settings, stop);
        const std::lock_guard lock(mutex);
        ++ended;
        if (tell) tell(ended);
    };
    std::vector<std::size_t> together, alone;
    for (std::size_t i = 0; i < items.size(); ++i) (items[i].timed ? alone : together).push_back(i);
    sideBySide(together.size(), sideBySideAtMost, [&](std::size_t i) { work(together[i]); });
    for (const std::size_t i : alone) work(i);
    return outcomes;
}

std::vector<Reproduction> resultsAt(const DeskSettings& settings, std::span<const ItemOutcome> outcomes) {
    std::vector<Reproduction> results;
    for (const Item& item : items()) {
        const auto own = std::ranges::find_if(outcomes, [&](const ItemOutcome& o) { return o.result.id == item.id(); });
        if (own != outcomes.end())
            results.push_back(own->result);
        else if (auto kept = keptResult(item, settings))
            results.push_back(std::move(*kept));
    }
    return results;
}

void linkData(const DeskSettings& settings) {
    if (!settings.data) return;
    link(settings.folder / kDataLink, *settings.data);
    const fs::path thesis = settings.data->parent_path() / kThesisLink;
    std::error_code ec;
    if (fs::is_directory(thesis, ec) && !fs::equivalent(thesis, settings.folder, ec))
        link(settings.folder / kThesisLink, thesis);
}

} // namespace pellucid::cli
