// `bench`: which rows there are, and that their figures agree with each other and with the other commands. How long
// anything takes is not asserted.
#include <array>
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

constexpr double kVoxels = 24 * 24 * 24;
const std::vector<std::string> kBench{"bench", "sample:shells", "--size", "24", "--engine", "cpu", "--repeat", "1"};

json bench(const Workshop& w, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = kBench;
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.emplace_back("--json");
    const Outcome outcome = w.run(arguments); // a note tells where threads share processors
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return json::parse(outcome.out);
}

std::vector<json> rowsNamed(const json& answer, const std::string& name) {
    std::vector<json> rows;
    for (const json& row : answer["rows"])
        if (row["name"] == name) rows.push_back(row);
    return rows;
}

} // namespace

TEST_CASE("bench prints every row, with one thread and with two", "[cli][bench]") {
    const Workshop w;
    const json j = bench(w, {});
    CHECK(j["command"] == "bench");
    REQUIRE(j["memcpy"].size() == 2);
    CHECK(j["memcpy"][0]["threads"] == 1);
    CHECK(j["memcpy"][1]["threads"] == 2);
    CHECK(j["memcpy_gb_per_s"] == j["memcpy"][1]["gb_per_s"]);

    std::set<std::string> names;
    for (const json& row : j["rows"]) {
        INFO(row.dump());
        names.insert(row["name"]);
        CHECK(row["engine"] == "cpu");
        CHECK(row["volume"] == "sample:shells");
        CHECK(row["dims"] == json({24, 24, 24}));
        CHECK(row["runs"] == 1);
        const int threads = row["threads"];
        REQUIRE((threads == 1 || threads == 2 || row["name"] == "threads"));
        const double seconds = row["seconds"], bytes = row["bytes_per_voxel"], rate = row["gb_per_s"];
        CHECK(seconds > 0);
        CHECK(row["cpu_seconds"].get<double>() > 0);
        CHECK(row["ns_per_voxel"].get<double>() == Approx(1e9 * seconds / kVoxels));
        CHECK(rate == Approx(bytes * kVoxels / seconds / 1e9));
        CHECK(row.contains("memcpy_share") == (threads <= 2));
        if (threads > 2) continue;
        const double memcpyRate = j["memcpy"][static_cast<std::size_t>(threads - 1)]["gb_per_s"];
        CHECK(row["memcpy_share"].get<double>() == Approx(rate / memcpyRate));
    }
    CHECK(names == std::set<std::string>{"open", "setup", "saliency", "saliency-direct", "sweep", "jacobian",
                                         "optimize", "optimize-newton", "threads", "optimize-whole", "refine",
                                         "refine-500", "refine-1000", "refine-direct", "render", "preview"});

    std::set<std::string> files;
    for (const json& row : rowsNamed(j, "open")) files.insert(row["file"]);
    CHECK(files == std::set<std::string>{"raw.mhd", "gzip.nrrd", "vtk.vti", "stack.tif", "image.zarr", "dicom"});

    for (const json& row : rowsNamed(j, "preview")) CHECK(row["ssim"].get<double>() > 0.95);

    // One and eight candidates, three densities, one and two threads; codes of 2 bytes and two weights of 2 each.
    const auto sweeps = rowsNamed(j, "sweep");
    CHECK(sweeps.size() == 2 * 3 * 2);
    std::set<std::string> tfs;
    for (const json& row : sweeps) {
        tfs.insert(row["tf"]);
        CHECK((row["candidates"] == 1 || row["candidates"] == 8));
        CHECK(row["features"] == 3);
        CHECK(row["bytes_per_voxel"] == 6.0);
    }
    CHECK(tfs == std::set<std::string>{"default", "dense", "sparse"});
    std::multiset<int> features;
    for (const json& row : rowsNamed(j, "jacobian")) features.insert(row["features"].get<int>());
    CHECK(features == std::multiset<int>{3, 3, 3, 3, 3, 3, 9, 9});
    // The samples are of one byte; saliency writes four, the engine codes of two.
    CHECK(rowsNamed(j, "saliency")[0]["bytes_per_voxel"] == 5.0);
    CHECK(rowsNamed(j, "setup")[0]["bytes_per_voxel"] == 3.0);

    const Outcome text = w.run(kBench);
    CHECK(text.status == 0);
    for (const char* part : {"memcpy", "sweep, 8 TFs", "jacobian, 9 features", "sweep8_over_8_singles"}) {
        INFO(part);
        CHECK(text.out.find(part) != std::string::npos);
    }
}

TEST_CASE("bench optimizes and refines as the commands of that name do", "[cli][bench]") {
    const Workshop w;
    const json j = bench(w, {"--only", "optimize,refine", "--tf", "tents:3:0.2", "--threads", "2"});
    REQUIRE(j["rows"].size() == 2);
    const json found = w.json({"optimize", "sample:shells", "--size", "24", "--engine", "cpu", "--tf", "tents:3:0.2",
                               "--target", "0.1,0.3,0.6", "--method", "parallel", "--view", "30,20", "--exact-shares"});
    const json& optimized = j["rows"][0];
    CHECK(optimized["name"] == "optimize");
    CHECK(optimized["converged"] == true);
    CHECK(optimized["objective"].get<double>() < 0.03);
    CHECK(optimized["objective"] == found["objective"].back());
    CHECK(optimized["iterations"] == found["iterations"]);
    CHECK(optimized["evaluations"] == found["evaluations"]);
    // The start alone, then eight candidates at a time.
    CHECK(8 * optimized["sweeps"].get<int>() - 7 == optimized["evaluations"].get<int>());
    const json refined = w.json({"refine", "sample:shells", "--size", "24", "--tf", "tents:3:0.2"});
    CHECK(j["rows"][1]["name"] == "refine");
    CHECK(j["rows"][1]["iterations"] == refined["iterations"]);
}

TEST_CASE("bench searches with more and more threads, and finds the same", "[cli][bench]") {
    const Workshop w;
    const json j = bench(w, {"--only", "optimize,threads", "--tf", "tents:3:0.2", "--plot", "t.svg"});
    CHECK(j["plot"] == "t.svg");
    const auto rows = rowsNamed(j, "threads");
    REQUIRE(rows.size() == 4);
    const std::array<int, 4> numbers{1, 2, 4, 8};
    const double alone = rows[0]["seconds"];
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const json& row = rows[i];
        INFO(row.dump());
        CHECK(row["threads"] == numbers[i]);
        CHECK(row["speedup"].get<double>() == Approx(alone / row["seconds"].get<double>()));
        CHECK(row["processors"].get<int>() >= 1);
        // The very search of the row optimize, whatever the number of threads.
        for (const char* key : {"iterations", "evaluations", "sweeps", "objective", "converged", "bytes_per_voxel"})
            CHECK(row[key] == rowsNamed(j, "optimize")[0][key]);
    }
    // A curve with a dot per number of threads, in the colour of first curves.
    const std::string svg = w.read("t.svg");
    CHECK(svg.find("sample:shells, tents:3:0.2") != std::string::npos);
    std::size_t dots = 0;
    for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++dots;
    CHECK(dots == 4);

    // As far as the user goes.
    const auto three = rowsNamed(bench(w, {"--only", "threads", "--threads", "3"}), "threads");
    REQUIRE(three.size() == 3);
    CHECK(three[2]["threads"] == 3);

    const Outcome useless = w.run({"bench", "sample:shells", "--only", "sweep", "--plot", "t.png"});
    CHECK(useless.status == 2);
    CHECK(useless.err.find("add threads to --only") != std::string::npos);
    CHECK(w.run({"bench", "sample:shells", "--plot", "t.txt"}).status == 2);
}

TEST_CASE("bench refines after a click 500 times, fast and by integrating every edge anew", "[cli][bench]") {
    const Workshop w;
    const json j =
        bench(w, {"--only", "refine-500,refine-1000,refine-direct,render", "--tf", "tents:3", "--threads", "2"});
    REQUIRE(j["rows"].size() == 4);
    const json &fast = j["rows"][0], &longer = j["rows"][1], &direct = j["rows"][2], &render = j["rows"][3];
    CHECK(fast["name"] == "refine-500");
    CHECK(direct["name"] == "refine-direct");
    CHECK(fast["iterations"] == 500);
    CHECK(longer["iterations"] == 1000);
    CHECK(direct["iterations"] == 500);
    CHECK(fast["energy"] == direct["energy"]); // the same answer
    const double seconds = fast["seconds"];
    CHECK(j["ratios"]["refine_direct_over_refine500"].get<double>() ==
          Approx(direct["seconds"].get<double>() / seconds));
    CHECK(j["ratios"]["refine500_over_render"].get<double>() == Approx(seconds / render["seconds"].get<double>()));
}

TEST_CASE("bench measures only the rows and threads that are asked for", "[cli][bench]") {
    const Workshop w;
    const json saliency = bench(w, {"--only", "saliency"});
    REQUIRE(saliency["rows"].size() == 2);
    for (const json& row : saliency["rows"]) CHECK(row["name"] == "saliency");
    CHECK(saliency["ratios"].contains("threads_speedup_saliency"));
    CHECK_FALSE(saliency["ratios"].contains("sweep8_over_8_singles"));

    const json sweep = bench(w, {"--only", "sweep", "--tf", "tents:2", "--threads", "3"});
    REQUIRE(sweep["rows"].size() == 2);
    for (const json& row : sweep["rows"]) {
        CHECK(row["threads"] == 3);
        CHECK(row["tf"] == "tents:2");
        CHECK(row["features"] == 2);
    }
    const double single = sweep["rows"][0]["seconds"], eight = sweep["rows"][1]["seconds"];
    CHECK(sweep["rows"][0]["candidates"] == 1);
    CHECK(sweep["ratios"].size() == 1);
    CHECK(sweep["ratios"]["sweep8_over_8_singles"].get<double>() == Approx(eight / (8 * single)));
}

TEST_CASE("bench without a volume measures the knee and a series of cubes", "[cli][bench]") {
    const Workshop w;
    const json j = w.json({"bench", "--only", "saliency", "--repeat", "1", "--threads", "2"});
    REQUIRE(j["rows"].size() == 3);
    const std::vector<std::pair<std::string, json>> expected{
        {"sample:knee", {379, 229, 305}}, {"cube:128", {128, 128, 128}}, {"cube:256", {256, 256, 256}}};
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(j["rows"][i]["volume"] == expected[i].first);
        CHECK(j["rows"][i]["dims"] == expected[i].second);
    }
}

TEST_CASE("bench takes volumes with nothing to see", "[cli][bench]") {
    const Workshop w;
    w.write("flat.dat", std::string(512, '\7'));
    const std::vector<std::string> bench{"bench",    "flat.dat", "--raw",     "8,8,8,u8", "--engine", "cpu",
                                         "--repeat", "1",        "--threads", "1",        "--json"};
    const auto rowsOf = [&](std::vector<std::string> options) {
        options.insert(options.begin(), bench.begin(), bench.end());
        const Outcome o = w.run(options);
        CHECK(o.status == 0);
        CHECK(o.err == "pellucid-cli: note: all voxels have the value 7\n");
        return json::parse(o.out)["rows"];
    };
    CHECK(rowsOf({"--only", "sweep,saliency,optimize"}).size() == 3 * 2 + 1 + 3);
    // A transfer function may have no features.
    w.write("empty.tf.json", R"({"format":"pellucid-tf","version":1,"features":[],
        "points":[{"x":0.2,"opacity":0.5,"color":"#ff8800"}]})");
    CHECK(rowsOf({"--only", "sweep", "--tf", "empty.tf.json"}).size() == 2);
}
