// `reproduce`: items of the thesis, run again only where something has changed, and the page and index made of them.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "printed_lines.h"

using nlohmann::json;
using namespace pellucid::test;

namespace {

/// An item in the answer.
json itemOf(const json& answer, const std::string& id) {
    for (const json& item : answer.at("items"))
        if (item.at("id") == id) return item;
    FAIL("there is no item " << id);
    return {};
}

std::set<std::string> figures(const std::string& chapter, int from, int to) {
    std::set<std::string> names;
    for (int i = from; i <= to; ++i) names.insert(chapter + "." + std::to_string(i));
    return names;
}

const Words kTiny{"--sample-size", "16"};

} // namespace

TEST_CASE("every figure that software can redo belongs to one item", "[cli][reproduce]") {
    std::set<std::string> wanted{"table-3.2", "4.18", "4.19", "table-5.1"};
    for (const auto& more :
         {figures("3", 4, 14), figures("4", 1, 12), figures("5", 1, 17), figures("6", 1, 7), figures("A", 1, 5)})
        wanted.insert(more.begin(), more.end());
    const Workshop w;
    const json listed = w.json({"reproduce", "--list"});
    std::set<std::string> shown;
    for (const json& item : listed["items"]) {
        INFO(item);
        CHECK(item["id"] == item["shows"][0]);
        CHECK_FALSE(item["title"].get<std::string>().empty());
        CHECK(item["thesis"].get<std::string>().ends_with("."));
        CHECK_FALSE(item["data"].get<std::string>().empty());
        for (const json& name : item["shows"]) CHECK(shown.insert(name).second); // of no other item
        for (const json& equation : item["equations"])
            CHECK(std::filesystem::is_regular_file(std::filesystem::path(PELLUCID_SOURCE_DIR) /
                                                   equation["file"].get<std::string>()));
    }
    CHECK(std::includes(shown.begin(), shown.end(), wanted.begin(), wanted.end()));
    CHECK(w.list().empty()); // listing makes no files
}

TEST_CASE("what is there is not done again until something changes", "[cli][reproduce]") {
    const Workshop w;
    const Words command = Words{"reproduce", "4.2", "--out", "thesis"} + kTiny;
    const json first = itemOf(w.json(command), "4.2");
    CHECK(first["reused"] == false);
    CHECK(first["error"] == "");
    REQUIRE(first["pictures"].size() == 2);
    for (const json& picture : first["pictures"]) CHECK(w.has("thesis/" + picture["file"].get<std::string>()));
    const std::string page = w.read("thesis/index.html");
    CHECK(page.find("src=\"4.2/brightness.png\"") != std::string::npos);
    // The commands are those that ran: they do the same again in the folder of the page.
    const std::string line = first["commands"][0]["line"];
    CHECK(line.starts_with("pellucid-cli render sample:disks --sample-size 16 --tf 4.2/disks.tf.json "));
    CHECK(line.ends_with(" --out 4.2/brightness.png"));

    json again = itemOf(w.json(command), "4.2");
    CHECK(again["reused"] == true);
    again["reused"] = false;
    CHECK(again == first);

    std::filesystem::remove(w.path("thesis/4.2/brightness.png"));
    CHECK(itemOf(w.json(command), "4.2")["reused"] == false);
    CHECK(w.has("thesis/4.2/brightness.png"));
    w.write("thesis/4.2/item.json", "{\"format\": \"damaged\"");
    CHECK(itemOf(w.json(command), "4.2")["reused"] == false);
    CHECK(itemOf(w.json({"reproduce", "4.2", "--out", "thesis", "--sample-size", "20"}), "4.2")["reused"] == false);
    CHECK(itemOf(w.json({"reproduce", "4.2", "--out", "thesis", "--sample-size", "20"}), "4.2")["reused"] == true);
}

TEST_CASE("other values behind the same header are other data", "[cli][reproduce]") {
    const Workshop w;
    std::filesystem::create_directories(w.path("real/tooth"));
    std::string values(16 * 16 * 16, '\0');
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<char>(i / 16);
    w.write("real/tooth/tooth.mhd", "NDims = 3\nDimSize = 16 16 16\nElementType = MET_UCHAR\n"
                                    "ElementSpacing = 1 1 1\nElementDataFile = tooth.raw\n");
    w.write("real/tooth/tooth.raw", values);
    const Words command = Words{"reproduce", "4.18", "--data", "real", "--out", "thesis"} + kTiny;
    CHECK(itemOf(w.json(command), "4.18")["reused"] == false);
    CHECK(itemOf(w.json(command), "4.18")["reused"] == true);
    std::ranges::reverse(values);
    w.write("real/tooth/tooth.raw", values);
    CHECK(itemOf(w.json(command), "4.18")["reused"] == false);
}

TEST_CASE("threads and memory are those of the commands, too", "[cli][reproduce]") {
    const Workshop w;
    const Words command = Words{"reproduce", "4.2", "--threads", "1", "--memory", "2", "--out", "thesis"} + kTiny;
    for (const json& ran : itemOf(w.json(command), "4.2")["commands"])
        CHECK(ran["line"].get<std::string>().ends_with(" --threads 1 --memory 2"));
}

TEST_CASE("an item that fails is told, and the others go on", "[cli][reproduce]") {
    const Workshop w;
    std::filesystem::create_directories(w.path("real/tooth"));
    w.write("real/tooth/tooth.mhd", "NDims = 3\nDimSize = no numbers\n");
    const Words command = Words{"reproduce", "4.2", "4.18", "--data", "real", "--out", "thesis"} + kTiny;
    const Outcome failed = w.run(command);
    CHECK(failed.status == 1);
    CHECK(failed.err.find("1 item failed: 4.18") != std::string::npos);
    CHECK(failed.err.find("data/tooth/tooth.mhd") != std::string::npos);
    CHECK(w.has("thesis/4.2/item.json"));
    CHECK_FALSE(w.has("thesis/4.18/item.json"));
    const std::string page = w.read("thesis/index.html");
    CHECK(page.find("It failed: ") != std::string::npos);
    CHECK(page.find("src=\"4.2/brightness.png\"") != std::string::npos);

    // Without the data the sample takes its place; a page has what an earlier call has left, too.
    const json mended = w.json(Words{"reproduce", "4.19", "--out", "thesis"} + kTiny);
    CHECK(mended["items"].size() == 1);
    CHECK(itemOf(mended, "4.18")["data"][0].get<std::string>().find("in place of tooth") != std::string::npos);
    CHECK(w.read("thesis/index.html").find("src=\"4.2/brightness.png\"") != std::string::npos);
}

TEST_CASE("items of chapters 5 and 6 find what the thesis says", "[cli][reproduce]") {
    const Workshop w;
    const json searches = itemOf(w.json(Words{"reproduce", "5.6", "--out", "thesis"} + kTiny), "5.6");
    REQUIRE(searches["statements"].size() == 4);
    for (const json& statement : searches["statements"]) {
        INFO(statement);
        CHECK(statement["holds"] == true);
    }
    // Both searches choose the same steps (§5.3.5); the files behind the curves say so, too.
    for (const std::string name : {"nucleon", "vortex"}) {
        const json line = json::parse(w.read("thesis/5.6/" + name + "_line.json"));
        const json parallel = json::parse(w.read("thesis/5.6/" + name + "_parallel.json"));
        CHECK(line["objective"].back().get<double>() ==
              Approx(parallel["objective"].back().get<double>()).margin(1e-9));
        CHECK(line["method"] != parallel["method"]);
    }
    const json swapped = itemOf(w.json(Words{"reproduce", "6.5", "--out", "thesis"} + kTiny), "6.5");
    REQUIRE(swapped["statements"].size() == 2);
    for (const json& statement : swapped["statements"]) {
        INFO(statement);
        CHECK(statement["holds"] == true);
    }
    CHECK(swapped["pictures"].size() == 3);
}

TEST_CASE("reproduce is refused in words", "[cli][reproduce]") {
    const Workshop w;
    const Outcome unknown = w.run({"reproduce", "9.9", "--out", "thesis"});
    CHECK(unknown.status == 2);
    CHECK(unknown.err.find("'9.9'") != std::string::npos);
    CHECK(unknown.err.find("table-3.2") != std::string::npos);
    CHECK(w.run({"reproduce", "4.2"}).status == 2); // where to?
    CHECK(w.run({"reproduce", "4.2", "--out", "thesis", "--data", "nowhere"}).status == 1);
    CHECK(w.list().empty());
}

TEST_CASE("a plot of the transfer function has the histogram of the volume", "[cli][plot]") {
    const Workshop w;
    const json j = w.json({"plot", "sample:disks", "--sample-size", "16", "--tf", "tents:3", "--out", "tf.svg"});
    CHECK(j["file"] == "tf.svg");
    REQUIRE(j["histogram"].size() == 256);
    std::size_t voxels = 0;
    for (const json& count : j["histogram"]) voxels += count.get<std::size_t>();
    CHECK(voxels == 16 * 16 * 16);
    CHECK(w.read("tf.svg").find("voxels (logarithmic)") != std::string::npos);
    CHECK(w.run({"plot", "sample:disks", "--sample-size", "16", "--out", "tf.png", "--highest", "1"}).status == 0);
    CHECK(w.run({"plot", "sample:disks", "--out", "tf.txt"}).status == 2);
    CHECK(w.run({"plot", "sample:disks", "--out", "tf.svg", "--highest", "2"}).status == 2);
}

TEST_CASE("maps are written as pictures, as strong as one says", "[cli][2dfs]") {
    const Workshop w;
    const Words command{"measure", "sample:disks", "--sample-size", "16", "--2dfs", "--size", "64x48"};
    w.json(command + Words{"--maps", "maps", "--map-strength", "8"});
    CHECK(w.has("maps/saliency.exr"));
    CHECK(w.has("maps/saliency.png"));
    CHECK(w.has("maps/feature1_total.png"));
    CHECK(w.run(command + Words{"--map-strength", "8"}).status == 2);
}

TEST_CASE("docs/reproduce.md is what the items give", "[cli][reproduce][documents]") {
    const Lines document = linesOf(textOf(std::filesystem::path(PELLUCID_SOURCE_DIR) / "docs/reproduce.md"));
    const auto headings = [](const Lines& lines) {
        Lines found;
        for (const std::string& line : lines)
            if (line.starts_with("## ")) found.push_back(line);
        return found;
    };
    const auto section = [](const Lines& lines, const std::string& heading) {
        auto begin = std::find(lines.begin(), lines.end(), heading);
        REQUIRE(begin != lines.end());
        const auto end = std::find_if(begin + 1, lines.end(), [](const auto& line) { return line.starts_with("## "); });
        Lines part(begin, end);
        while (part.back().empty()) part.pop_back();
        return part;
    };
    const Workshop w;
    // Every item has its section, in the order of the list.
    const json listed = w.json({"reproduce", "--list"});
    CHECK(headings(document).size() == listed["items"].size() + 1); // and one for the equations
    // Of those that need little time and no data from outside the figures are the same; scripts/refresh-docs.sh writes
    // what they are now.
    // Software draws no faster than the cpu, so that it is the engine everywhere.
    setenv("PELLUCID_GL_PLATFORM", "osmesa", 1);
    w.json({"reproduce", "4.2", "4.5", "--out", "thesis", "--index", "index.md"});
    unsetenv("PELLUCID_GL_PLATFORM");
    const Lines fresh = linesOf(w.read("index.md"));
    REQUIRE(headings(fresh).size() == 3);
    for (const std::string& heading : headings(fresh)) {
        if (heading == "## Equations") continue;
        const Lines shown = section(document, heading), printed = section(fresh, heading);
        INFO(heading);
        REQUIRE(shown.size() == printed.size());
        for (std::size_t i = 0; i < shown.size(); ++i) {
            INFO(shown[i] << "\n" << printed[i]);
            CHECK(sameLine(shown[i], printed[i]));
        }
    }
    for (const json& item : listed["items"])
        for (const json& equation : item["equations"]) {
            const std::string row =
                "| (" + equation["number"].get<std::string>() + ") | `" + equation["file"].get<std::string>() + "` |";
            INFO(row);
            CHECK(std::any_of(document.begin(), document.end(),
                              [&](const std::string& line) { return line.starts_with(row); }));
        }
}
