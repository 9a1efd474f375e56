// The real pellucid-mpi under mpirun, against pellucid-cli.
#include <catch2/catch.hpp>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "cli_runner.h"
#include "support/text_parts.h"

using namespace pellucid::test;
using nlohmann::json;

namespace {

/// More ranks than cores, as root, without binding to cores: what a test machine is.
const Words kMpirun{"OMPI_ALLOW_RUN_AS_ROOT=1",
                    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                    "OMPI_MCA_rmaps_base_oversubscribe=1",
                    "OMPI_MCA_hwloc_base_binding_policy=none",
                    "OMPI_MCA_orte_abort_print_stack=0",
                    PELLUCID_MPIRUN};

Words onRanks(int count, const Words& words) {
    return kMpirun + Words{"-n", std::to_string(count), PELLUCID_MANY} + words + Words{"--threads", "1"};
}
json ofMany(const Workshop& shop, int count, const Words& words) { return shop.json(onRanks(count, words)); }
json ofOne(const Workshop& shop, const Words& words) { return shop.json(Words{PELLUCID_ONE} + words); }

/// The largest difference of a number of all features.
double difference(const json& a, const json& b, const char* key) {
    REQUIRE(a["features"].size() == b["features"].size());
    double most = 0;
    for (std::size_t i = 0; i < a["features"].size(); ++i)
        most = std::max(most, std::abs(a["features"][i][key].get<double>() - b["features"][i][key].get<double>()));
    return most;
}

/// A raw file of 8-bit values, 150 × 140 × 132: shells around a place off its middle, and something all over.
Words rawVolume(const Workshop& shop) {
    std::string bytes;
    for (int k = 0; k < 132; ++k)
        for (int j = 0; j < 140; ++j)
            for (int i = 0; i < 150; ++i) {
                const double r = std::sqrt((i - 60.0) * (i - 60) + (j - 80.0) * (j - 80) + (k - 60.0) * (k - 60));
                const int hash = (i * 7919 + j * 104729 + k * 1299709) % 17;
                bytes += static_cast<char>(r < 25 ? 200 + hash : r < 50 ? 110 + hash : r < 70 ? 60 + hash : hash);
            }
    shop.write("volume.raw", bytes);
    return {"volume.raw", "--raw", "150,140,132,u8", "--spacing", "1,1.2,0.9"};
}

} // namespace

TEST_CASE("ranks measure what one process measures", "[mpi]") {
    const Workshop shop;
    const Words volume = rawVolume(shop), tf{"--tf", "tents:4:0.3"};
    for (const Words& view : {Words{"--view", "30,20"}, Words{"--view", "200,-65"}, Words{"--view", "45,35,2.6"},
                              Words{"--view", "90,0", "--orthographic"}}) {
        const Words words = Words{"measure"} + volume + tf + view + Words{"--jacobian"};
        const json one = ofOne(shop, words);
        for (const int count : {1, 2, 3, 8}) {
            INFO(view[1] << ", " << count << " ranks");
            const json many = ofMany(shop, count, words);
            CHECK(difference(one, many, "vws") < 1e-4);
            CHECK(difference(one, many, "visibility") < 1e-4);
            CHECK(difference(one, many, "cover") < 1e-4);
            CHECK(std::abs(one["coverage"].get<double>() - many["coverage"].get<double>()) < 1e-4);
            CHECK(one["volume"] == many["volume"]);
            double largest = 0, most = 0;
            for (std::size_t i = 0; i < one["jacobian"].size(); ++i)
                for (std::size_t j = 0; j < one["jacobian"].size(); ++j) {
                    const double d = one["jacobian"][i][j].get<double>();
                    largest = std::max(largest, std::abs(d));
                    most = std::max(most, std::abs(many["jacobian"][i][j].get<double>() - d));
                }
            CHECK(most < 1e-3 * largest);
        }
    }
}

TEST_CASE("a volume of few voxels gives the same figures on ranks, bit by bit", "[mpi]") {
    const Workshop shop;
    const Words words{"measure", "sample:shells", "--size", "40", "--tf", "tents:3", "--view", "30,20"};
    const json one = ofOne(shop, words), many = ofMany(shop, 3, words);
    CHECK(one["features"] == many["features"]);
    CHECK(one["visibility_histogram"] == many["visibility_histogram"]);
}

TEST_CASE("ranks optimize as one process does", "[mpi]") {
    const Workshop shop;
    const Words volume = rawVolume(shop),
                words = Words{"optimize"} + volume +
                        Words{"--tf", "tents:4:0.3", "--view", "30,20", "--target", "3,2,2,1", "--out-tf"};
    const json one = ofOne(shop, words + Words{"one.tf.json"});
    const json many = ofMany(shop, 4, words + Words{"many.tf.json"});
    CHECK(many["converged"] == one["converged"]);
    CHECK(many["stopped"] == one["stopped"]);
    CHECK(std::abs(many["iterations"].get<int>() - one["iterations"].get<int>()) <= 1);
    const auto best = [](const json& run, const char* key) { return run[key][run["best"].get<std::size_t>()]; };
    CHECK(std::abs(best(many, "objective").get<double>() - best(one, "objective").get<double>()) < 1e-3);
    // What it has come to is what one process measures of it.
    const json measured = ofOne(shop, Words{"measure"} + volume + Words{"--tf", "many.tf.json", "--view", "30,20"});
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(std::abs(measured["features"][i]["vws"].get<double>() - best(many, "vws")[i].get<double>()) < 1e-4);
}

TEST_CASE("ranks propose what one process proposes", "[mpi]") {
    const Workshop shop;
    const Words words = Words{"measure"} + rawVolume(shop);
    const json one = ofOne(shop, words), many = ofMany(shop, 3, words);
    REQUIRE(one["features"].size() == many["features"].size());
    for (std::size_t i = 0; i < one["features"].size(); ++i) {
        CHECK(one["features"][i]["name"] == many["features"][i]["name"]);
        CHECK(one["features"][i]["range"] == many["features"][i]["range"]);
    }
    CHECK(difference(one, many, "opacity") < 1e-9);
    CHECK(difference(one, many, "vws") < 1e-4);
    CHECK(one["camera"] == many["camera"]);
}

TEST_CASE("ranks refine and propose as one process does", "[mpi]") {
    const Workshop shop;
    const Words volume = rawVolume(shop);
    for (const Words& words : {Words{"propose"} + volume, Words{"refine"} + volume + Words{"--tf", "tents:5"},
                               Words{"refine"} + volume + Words{"--tf", "tents:5", "--intensity", "0.5"}}) {
        json one = ofOne(shop, words), many = ofMany(shop, 3, words);
        CHECK(many["ranks"]["count"] == 3);
        for (const char* own : {"seconds", "ranks"}) { // all else is the same
            one.erase(own);
            many.erase(own);
        }
        CHECK(one == many);
    }
}

TEST_CASE("ranks draw what one process draws", "[mpi]") {
    const Workshop shop;
    const Words volume = rawVolume(shop);
    for (const Words& how :
         {Words{"--view", "30,20"}, Words{"--view", "200,-65,2.4", "--shading"},
          Words{"--view", "90,10", "--orthographic", "--clip", "x:0.3:1", "--background", "transparent"}}) {
        const Words words = Words{"render"} + volume + Words{"--tf", "tents:4:0.3", "--size", "200x150", "--out"} + how;
        const auto with = [&](const std::string& out) {
            Words all = words;
            all.insert(std::find(all.begin(), all.end(), "--out") + 1, out);
            return all;
        };
        ofOne(shop, with("one.exr"));
        for (const int count : {2, 5}) {
            INFO(how[1] << ", " << count << " ranks");
            ofMany(shop, count, with("many.exr"));
            CHECK(ofOne(shop, {"compare", "one.exr", "many.exr"})["ssim"].get<double>() > 0.999);
        }
    }
    const Outcome refused = shop.run(onRanks(2, Words{"render"} + volume + Words{"--mode", "mip", "--out", "mip.png"}));
    CHECK(refused.status == 2);
    CHECK(refused.err.find("--mode") != std::string::npos);
    CHECK(!shop.has("mip.png"));
}

TEST_CASE("ranks write their parts of fields into one file", "[mpi]") {
    const Workshop shop;
    const Words words =
        Words{"fields"} + rawVolume(shop) + Words{"--tf", "tents:4:0.3", "--view", "30,20", "--feature", "f3", "--out"};
    ofOne(shop, words + Words{"one"});
    const json many = ofMany(shop, 3, words + Words{"many"});
    CHECK(many["files"].size() == 8);
    for (const json& file : many["files"]) {
        INFO(file);
        const std::string name = std::filesystem::path(file.get<std::string>()).filename().string();
        const auto values = [&](const std::string& folder) {
            // All of it, and boxes within and across blocks; millimetres of the world: spacing 1, 1.2, 0.9.
            return ofOne(shop, {"rulers", folder + "/" + name, "--box", "0,0,0:149,166.8,117.9", "--box",
                                "40,60,30:70,120,80", "--box", "60,60,55:62,62,57"})["rulers"];
        };
        const json a = values("one"), b = values("many");
        // The last 0.1 % of the light is given up at other slices.
        const double close = 1e-3 * a[0]["range"][1].get<double>();
        for (std::size_t i = 0; i < a.size(); ++i) {
            CHECK(b[i]["voxels"] == a[i]["voxels"]);
            CHECK(std::abs(b[i]["mean"].get<double>() - a[i]["mean"].get<double>()) < 0.1 * close);
            CHECK(std::abs(b[i]["range"][1].get<double>() - a[i]["range"][1].get<double>()) < close);
        }
    }
}

TEST_CASE("a rank that cannot write its part of a field is heard, and no file is left", "[mpi]") {
    const Workshop shop;
    const Words words =
        Words{PELLUCID_MANY, "fields"} + rawVolume(shop) + Words{"--tf", "tents:4:0.3", "--out", "many"};
    // Files of that rank may have 1000 blocks of 512 bytes or of 1024; a field has 11 million bytes.
    const Outcome outcome = shop.run(kMpirun + Words{"-n", "1"} + words +
                                     Words{":", "-n", "1", "sh", "-c", "ulimit -f 1000; exec \"$@\"", "sh"} + words);
    CHECK(outcome.status == 1);
    CHECK(outcome.err.find("rank 1: cannot write the file (File too large)") != std::string::npos);
    CHECK(shop.list() == std::vector<std::string>{"volume.raw"});
}

TEST_CASE("ranks find the view that one process finds", "[mpi]") {
    const Workshop shop;
    const Words words =
        Words{"views"} + rawVolume(shop) + Words{"--tf", "tents:4:0.3", "--feature", "f3", "--count", "16"};
    const json one = ofOne(shop, words), many = ofMany(shop, 2, words);
    CHECK(std::abs(many["best"]["value"].get<double>() - one["best"]["value"].get<double>()) < 1e-4);
    for (std::size_t a = 0; a < 3; ++a)
        CHECK(std::abs(many["best"]["camera"]["eye"][a].get<double>() - one["best"]["camera"]["eye"][a].get<double>()) <
              1e-3);
    REQUIRE(many["views"].size() == one["views"].size());
    for (std::size_t i = 0; i < one["views"].size(); ++i)
        CHECK(std::abs(many["views"][i]["value"].get<double>() - one["views"][i]["value"].get<double>()) < 1e-4);
}

TEST_CASE("ranks follow the curve of equal shares that one process follows", "[mpi]") {
    const Workshop shop;
    const Words words = Words{"density"} + rawVolume(shop) + Words{"--tf", "tents:3:0.3", "--coverage", "0.4"};
    const json one = ofOne(shop, words), many = ofMany(shop, 2, words);
    REQUIRE(many["points"].size() == one["points"].size());
    const auto near = [](const json& a, const json& b) { // opacities between two points that rays along blocks moved
        for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i].get<double>() - b[i].get<double>()) < 2e-3);
    };
    for (std::size_t i = 0; i < one["points"].size(); ++i)
        near(many["points"][i]["opacity"], one["points"][i]["opacity"]);
    near(many["chosen"]["opacity"], one["chosen"]["opacity"]);
    near(many["chosen"]["vws"], one["chosen"]["vws"]);
}

TEST_CASE("ranks follow a series as one process does", "[mpi]") {
    const Workshop shop;
    rawVolume(shop);
    std::string bytes = shop.read("volume.raw");
    for (int frame = 0; frame < 3; ++frame) {
        shop.write("f" + std::to_string(frame) + ".raw", bytes);
        for (char& c : bytes) c = static_cast<char>(static_cast<unsigned char>(c) * 15 / 16);
    }
    const Words words{"sequence", "f%d.raw", "--raw",  "150,140,132,u8", "--tf",     "tents:3",
                      "--range",  "0,220",   "--mode", "optimize",       "--target", "3,2,1",
                      "--view",   "30,20",   "--size", "64x64",          "--out"};
    const json one = ofOne(shop, words + Words{"one"}), many = ofMany(shop, 2, words + Words{"many"});
    REQUIRE(one["frames"].size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(many["frames"][i]["objective"].get<double>() - one["frames"][i]["objective"].get<double>()) <
              1e-3);
        const std::string name = "/frame_000" + std::to_string(i) + ".png";
        CHECK(ofOne(shop, {"compare", "one" + name, "many" + name})["ssim"].get<double>() > 0.99);
    }
}

TEST_CASE("ranks divide the frames of a series that each of them can hold", "[mpi]") {
    // Five frames of 2.8 million voxels, which lie in blocks otherwise; one is cut off. What each rank does with its
    // own is what one process does: the same figures, bit by bit, and the same pictures.
    const Workshop shop;
    rawVolume(shop);
    std::string bytes = shop.read("volume.raw");
    for (int frame = 0; frame < 5; ++frame) {
        shop.write("f" + std::to_string(frame) + ".raw", frame == 2 ? bytes.substr(0, 1000) : bytes);
        for (char& c : bytes) c = static_cast<char>(static_cast<unsigned char>(c) * 15 / 16);
    }
    const Words words{"sequence", "f%d.raw", "--raw", "150,140,132,u8", "--tf",  "tents:3", "--range",
                      "0,220",    "--view",  "30,20", "--size",         "64x64", "--2dfs",  "--compare"};
    for (const Words& mode :
         {Words{"--mode", "static"}, Words{"--mode", "optimize", "--target", "3,2,1"},
          Words{"--mode", "optimize", "--target", "3,2,1", "--coherence", "0"}, Words{"--mode", "refine"}}) {
        const std::string how = mode[1] + std::to_string(mode.size());
        INFO(how);
        const Outcome alone = shop.run(Words{PELLUCID_ONE} + words + mode + Words{"--out", "one" + how, "--json"});
        const Outcome shared = shop.run(onRanks(3, words + mode + Words{"--out", "many" + how, "--json"}));
        INFO(alone.err << shared.err);
        REQUIRE(alone.status == 0);
        REQUIRE(shared.status == 0);
        json one = json::parse(alone.out), many = json::parse(shared.out);
        const auto saysOfBroken = [](const Outcome& o) { return o.err.find("frame 2 (f2) is passed over"); };
        CHECK(saysOfBroken(alone) != std::string::npos);
        CHECK(saysOfBroken(shared) == saysOfBroken(alone));
        REQUIRE(one["frames"].size() == 4);
        for (json* all : {&one, &many})
            for (json& frame : (*all)["frames"]) frame.erase("seconds");
        CHECK(many["frames"] == one["frames"]);
        CHECK(many["broken"].size() == 1);
        CHECK(many["broken"][0]["frame"] == 2);
        CHECK(shop.read("many" + how + "/curves.csv").size() > 100);
        for (const char* frame : {"0", "1", "3", "4"})
            for (const char* file : {".png", "_static.png", ".tf.json"}) {
                const std::string name = std::string("/frame_000") + frame + file;
                CHECK(shop.read("many" + how + name) == shop.read("one" + how + name));
            }
        CHECK_FALSE(std::filesystem::exists(shop.path("many" + how + "/frame_0002.png")));
    }
}

TEST_CASE("frames that would lie in folders of several machines are not begun", "[mpi]") {
    // Two ranks in different folders, for whom `out` is not the same.
    const Workshop shop;
    for (const char* name : {"f0.raw", "f1.raw"}) shop.write(name, std::string(12 * 12 * 12, 'x'));
    shop.write("f1.raw", std::string(12 * 12 * 6, 'x') + std::string(12 * 12 * 6, 'y'));
    std::filesystem::create_directory(shop.path("elsewhere"));
    const Words words{PELLUCID_MANY,
                      "sequence",
                      shop.path("f%d.raw").string(),
                      "--raw",
                      "12,12,12,u8",
                      "--tf",
                      "tents:2",
                      "--size",
                      "16x16",
                      "--out",
                      "out",
                      "--threads",
                      "1"};
    const Outcome outcome = shop.run(kMpirun + Words{"-n", "1"} + words +
                                     Words{":", "-n", "1", "sh", "-c", "cd elsewhere && exec \"$@\"", "sh"} + words);
    CHECK(outcome.status == 1);
    CHECK(outcome.err.find("not all processes see this folder") != std::string::npos);
    CHECK(std::filesystem::is_empty(shop.path("out")));
}

TEST_CASE("ranks with different programs find out", "[mpi]") {
    const Workshop shop;
    std::filesystem::copy_file(PELLUCID_MANY, shop.path("other"));
    { std::ofstream(shop.path("other"), std::ios::app | std::ios::binary) << "changed"; }
    const Outcome outcome = shop.run(onRanks(1, {"info", "sample:shells"}) +
                                     Words{":", "-n", "1", shop.path("other").string(), "info", "sample:shells"});
    CHECK(outcome.status != 0);
    CHECK(outcome.err.find("the ranks run different programs") != std::string::npos);
}

TEST_CASE("processes of srun that MPI has not brought together do not begin", "[mpi]") {
    const Workshop shop;
    const Words alone{PELLUCID_MANY, "info", "sample:shells", "--size", "20"};
    const Outcome outcome = shop.run(Words{"SLURM_STEP_NUM_TASKS=8"} + alone);
    CHECK(outcome.status == 1);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, "srun has started 8 processes"));
    CHECK(shop.run(Words{"SLURM_STEP_NUM_TASKS=1"} + alone).status == 0);
    // mpirun on the nodes of a step is another matter.
    CHECK(shop.run(Words{"SLURM_STEP_NUM_TASKS=8"} + onRanks(1, {"info", "sample:shells", "--size", "20"})).status ==
          0);
}

TEST_CASE("a full disk is said by the rank that writes", "[mpi]") {
    const Workshop shop;
    const Outcome outcome =
        shop.run(onRanks(2, Words{"optimize"} + rawVolume(shop) +
                                Words{"--tf", "tents:4:0.3", "--target", "3,2,2,1", "--out-tf", "/dev/full"}));
    CHECK(outcome.status == 1);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find("pellucid-mpi: error: rank 0: cannot write the file (No space left on device)") !=
          std::string::npos);
}

TEST_CASE("what goes wrong on ranks is said once", "[mpi]") {
    const Workshop shop;
    const Outcome usage = shop.run(onRanks(3, {"measure", "sample:shells", "--view", "nonsense"}));
    CHECK(usage.status == 2);
    CHECK(timesIn(usage.err, "pellucid-mpi: error:") == 1);
    const Outcome nothing = shop.run(onRanks(2, {"measure"}));
    CHECK(nothing.status == 2);
    CHECK(contains(nothing.err, "VOLUME is required, pellucid-mpi measure, see pellucid-mpi measure --help"));
    // Options that ranks do not have are refused first: there is no such volume.
    const Outcome engine = shop.run(onRanks(2, {"measure", "nothing.nrrd", "--engine", "reference"}));
    CHECK(engine.status == 2);
    CHECK(contains(engine.err, "ranks work with the cpu engine, --engine"));
    const Outcome missing =
        shop.run(onRanks(3, {"measure", "nothing.raw", "--raw", "200,200,200,u8", "--tf", "tents:3"}));
    CHECK(missing.status == 1);
    CHECK(timesIn(missing.err, "pellucid-mpi: error:") == 1);
    CHECK(missing.out.empty());
    shop.write("short.raw", std::string(150 * 140 * 100, 'x'));
    const Outcome cut = shop.run(onRanks(2, {"measure", "short.raw", "--raw", "150,140,132,u8", "--tf", "tents:3"}));
    CHECK(cut.status == 1);
    CHECK(timesIn(cut.err, "pellucid-mpi: error: the file has 2100000 bytes") == 1);
}

TEST_CASE("a rank that is killed takes the others with it, and no file is left", "[mpi]") {
    const Workshop shop;
    const Words words = Words{"optimize"} + rawVolume(shop) +
                        Words{"--tf", "tents:4:0.3", "--target", "1,1,2,3", "--progress", "--out-tf", "out.tf.json"};
    for (const char* phase : {"loading", "saliency", "optimizing"}) {
        INFO(phase);
        Running running(shop, onRanks(3, words));
        REQUIRE(running.waitForError(phase));
        // The last of the ranks that run here, not those of another test: pgrep lists them in the order of their start.
        shop.run({"sh", "-c",
                  "for p in $(pgrep -f '^" PELLUCID_MANY "'); do "
                  "[ \"$(readlink /proc/$p/cwd)\" = \"$(pwd -P)\" ] && last=$p; done; kill -9 $last"});
        const auto start = std::chrono::steady_clock::now();
        const Outcome outcome = running.finish();
        CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60)); // 10 at rest
        CHECK(outcome.status != 0);
        CHECK(outcome.out.empty());
        CHECK(!outcome.err.empty());
        CHECK(shop.list() == std::vector<std::string>{"volume.raw"});
    }
}
