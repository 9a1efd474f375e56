// `sequence`: the frames of a series, each under its transfer function.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"
#include "tf/formats/tf_json.h"

using nlohmann::json;
using pellucid::readImage;
using pellucid::readTf;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

constexpr int kSize = 14, kFrames = 5;

/// Three layers whose borders move from frame to frame.
std::string layers(int frame) {
    std::string bytes;
    for (int k = 0; k < kSize; ++k)
        for (int j = 0; j < kSize; ++j)
            for (int i = 0; i < kSize; ++i) {
                const bool inside = std::min({i, j, k}) > 0 && std::max({i, j, k}) < kSize - 1;
                const int value = !inside ? 0 : i < 4 + frame ? 42 : i < 9 ? 128 : 212;
                bytes += static_cast<char>(i == 0 && j == 0 && k == 0 ? 255 : value);
            }
    return bytes;
}

std::string frameName(int frame) { return "f0" + std::to_string(frame) + ".raw"; }

/// A folder with the frames f00.raw … f04.raw.
struct Series : Workshop {
    Series() {
        for (int f = 0; f < kFrames; ++f) write(frameName(f), layers(f));
    }
};

const Words kSeries{"sequence", "f%02d.raw",   "--raw",  "14,14,14,u8", "--range",  "0,255",
                    "--tf",     "tents:3:0.2", "--size", "32x24",       "--engine", "cpu"};
const Words kOptimize = kSeries + Words{"--mode", "optimize", "--target", "1,1,1"};

/// What is told, whatever is noted beside it.
json answerOf(const Workshop& w, const Words& words) {
    const Outcome r = w.run(words + Words{"--json"});
    REQUIRE(r.status == 0);
    return json::parse(r.out);
}

/// The environment's PATH, changed for as long as this lives.
struct PathOf {
    explicit PathOf(const std::string& path) : before(std::getenv("PATH")) { setenv("PATH", path.c_str(), 1); }
    ~PathOf() { setenv("PATH", before.c_str(), 1); }
    std::string before;
};

} // namespace

TEST_CASE("sequence optimizes every frame and compares with the static transfer function", "[cli][sequence]") {
    const Series w;
    const json j = w.json(kOptimize + Words{"--coherence", "0", "--compare", "--out", "o"});
    CHECK(j["command"] == "sequence");
    CHECK(j["mode"] == "optimize");
    CHECK(j["coherence"] == 0);
    REQUIRE(j["frames"].size() == kFrames);
    double most = 0;
    for (int f = 0; f < kFrames; ++f) {
        const json& one = j["frames"][static_cast<std::size_t>(f)];
        CHECK(one["frame"] == f);
        CHECK(one["objective"] <= 1e-3); // what tracking goes below; the first one is optimized
        CHECK(one.contains("moves"));    // the first one's, too, which starts where it was optimized to
        CHECK(one.contains("flicker") == (f > 0));
        most = std::max(most, one["static"]["objective"].get<double>());
        const std::string stem = "o/frame_000" + std::to_string(f);
        const pellucid::Image image = readImage(w.path(stem + ".png").string());
        CHECK(image.width == 32);
        CHECK(image.height == 24);
        CHECK(w.has(stem + "_static.png"));
        // The file of the transfer function is the one that was told.
        CHECK(pellucid::featureOpacities(readTf(w.path(stem + ".tf.json").string())) ==
              one["opacity"].get<std::vector<double>>());
    }
    CHECK(most > 0.05); // the first layer grows to twice its size
    CHECK(j["static"]["rms"] > 10 * j["mean"]["rms"].get<double>());
    const std::string csv = w.read("o/curves.csv");
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 2 * kFrames);
    CHECK(w.read("o/curves.svg").find("static") != std::string::npos);
    CHECK(readImage(w.path("o/curves.png").string()).width > 0);
}

TEST_CASE("sequence tells the 2D feature saliency of each frame's picture", "[cli][sequence]") {
    const Series w;
    const json j = w.json(kOptimize + Words{"--coherence", "0", "--compare", "--2dfs", "--out", "o"});
    for (int f = 0; f < kFrames; ++f) {
        const std::string number = std::to_string(f);
        const auto fs = j["frames"][static_cast<std::size_t>(f)]["fs"].get<std::vector<double>>();
        REQUIRE(fs.size() == 3);
        CHECK(fs[0] + fs[1] + fs[2] == Approx(1));
        // What measure tells of the frame under its transfer function.
        const json alone =
            w.json({"measure", "f%02d.raw", "--raw", "14,14,14,u8", "--range", "0,255", "--frame", number, "--tf",
                    "o/frame_000" + number + ".tf.json", "--size", "32x24", "--engine", "cpu", "--2dfs"});
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(alone["features"][i]["fs"].get<double>() == Approx(fs[i]).margin(1e-6));
    }
    CHECK(j["frames"][4]["static"]["fs"] != j["frames"][4]["fs"]);
    CHECK(w.read("o/curves.csv").find("2DFS f1") != std::string::npos);
    CHECK(w.read("o/curves.svg").find("2D feature saliency, static") != std::string::npos);
    // Without pictures too, and pictures are those that are drawn without it.
    const json bare = w.json(kSeries + Words{"--2dfs", "--no-pictures", "--out", "bare"});
    CHECK(bare["frames"][0]["fs"].size() == 3);
    CHECK_FALSE(w.has("bare/frame_0000.png"));
    w.json(kOptimize + Words{"--coherence", "0", "--compare", "--out", "plain"});
    CHECK(w.read("plain/frame_0003.png") == w.read("o/frame_0003.png"));
    CHECK(w.read("plain/curves.csv").find("2DFS") == std::string::npos);
}

TEST_CASE("with coherence frames flicker less, as near to the targets as it says", "[cli][sequence]") {
    const Series w;
    const json free = w.json(kOptimize + Words{"--coherence", "0", "--no-pictures", "--out", "free"});
    const json held = answerOf(w, kOptimize + Words{"--coherence", "2", "--compare", "--no-pictures", "--out", "held"});
    CHECK(held["mean"]["rms"] <= 0.02);                                            // 2/100
    CHECK(held["mean"]["flicker"] < 0.95 * free["mean"]["flicker"].get<double>()); // the border drifts one way
    // The first frame gives way to what comes; as static counts what it was optimized to.
    CHECK(free["frames"][0]["objective"] < 1e-3);
    CHECK(held["frames"][0]["objective"] > 2e-3);
    CHECK(held["frames"][0]["static"]["objective"] < 1e-3);
    CHECK(held["frames"][1]["moves"] >= 1);
}

TEST_CASE("infinite coherence draws what a static transfer function draws", "[cli][sequence]") {
    const Series w;
    const json held = answerOf(w, kOptimize + Words{"--coherence", "inf", "--out", "held"});
    const json fixed = answerOf(w, kSeries + Words{"--mode", "static", "--target", "1,1,1", "--out", "fixed"});
    CHECK(held["coherence"] == "infinite");
    for (std::size_t f = 0; f < kFrames; ++f) {
        CHECK(held["frames"][f]["opacity"] == fixed["frames"][0]["opacity"]);
        const std::string picture = "/frame_000" + std::to_string(f) + ".png";
        CHECK(w.read("held" + picture) == w.read("fixed" + picture));
    }
    CHECK(held["mean"]["flicker"] == 0);
    CHECK(fixed["frames"][1]["flicker"] == 0);
}

TEST_CASE("sequence begins with the frame that is asked for", "[cli][sequence]") {
    const Series w;
    const json j = w.json(kSeries + Words{"--mode", "refine", "--from", "3", "--no-pictures", "--out", "o"});
    REQUIRE(j["frames"].size() == 2);
    CHECK(j["from"] == 3);
    CHECK(j["frames"][0]["frame"] == 3);
    CHECK(j["frames"][1]["moves"] > 0); // iterations of the refinement
    CHECK_FALSE(w.has("o/frame_0003.png"));
    CHECK(w.has("o/frame_0003.tf.json"));
    const Outcome beyond = w.run(kSeries + Words{"--from", "9", "--out", "o"});
    CHECK(beyond.status == 2);
    CHECK(beyond.err.find("there is no frame 9") != std::string::npos);
}

TEST_CASE("a broken frame is reported and left out", "[cli][sequence]") {
    const Series w;
    w.write(frameName(2), "too short");
    const Outcome r = w.run(kOptimize + Words{"--json", "--out", "o"});
    REQUIRE(r.status == 0);
    const json j = json::parse(r.out);
    REQUIRE(j["frames"].size() == kFrames - 1);
    CHECK(j["frames"][2]["frame"] == 3);
    REQUIRE(j["broken"].size() == 1);
    CHECK(j["broken"][0]["frame"] == 2);
    CHECK(r.err.find("is passed over") != std::string::npos);
    CHECK_FALSE(w.has("o/frame_0002.png"));
    CHECK(w.read("o/curves.csv").find("\noptimize,2,f02.raw,2,,") != std::string::npos);
}

TEST_CASE("the first frame is refined, too, and coherence lowers flicker", "[cli][sequence]") {
    const Series w;
    const Words refine{"--mode", "refine", "--compare", "--no-pictures"};
    // Of five tents the first holds 42 and the third 128: what is of one value alone can be told more or less of.
    Words five = kSeries + refine;
    std::replace(five.begin(), five.end(), std::string("tents:3:0.2"), std::string("tents:5:0.2"));
    const Outcome made = w.run(five + Words{"--json", "--out", "five"}); // two of the five have no voxel, which is told
    REQUIRE(made.status == 0);
    const json first = json::parse(made.out)["frames"][0];
    CHECK(first["moves"] > 0);
    CHECK(first["opacity"] != json({0.2, 0.2, 0.2, 0.2, 0.2}));
    CHECK(first["vws"] != first["static"]["vws"]);
    double flicker = 0;
    for (const char* coherence : {"0", "1", "4", "16"}) {
        const json j = w.json(kSeries + refine + Words{"--coherence", coherence, "--out", coherence});
        INFO("coherence " << coherence << ": " << j["mean"].dump());
        const double now = j["mean"]["flicker"];
        CHECK(now > 0);
        CHECK((flicker == 0 || now < flicker));
        flicker = now;
    }
}

TEST_CASE("the worst frame is told with its number, and frames above the tolerance always", "[cli][sequence]") {
    const Series w;
    // Static: optimized in the first frame, so that the last one, whose border has moved farthest, is the worst.
    const Outcome r = w.run(kSeries + Words{"--target", "1,1,1", "--json", "--no-pictures", "--out", "o"});
    REQUIRE(r.status == 0);
    const json j = json::parse(r.out);
    CHECK(j["worst"]["frame"] == kFrames - 1);
    CHECK(j["worst"]["objective"] == j["frames"][kFrames - 1]["objective"]);
    int above = 0;
    for (const json& f : j["frames"]) above += f["objective"] >= 0.03 ? 1 : 0;
    REQUIRE(above > 0);
    REQUIRE(above < kFrames);
    CHECK(j["above_tolerance"] == above);
    CHECK(r.err.find(std::to_string(above) + " of 5 frames are not within 3.0 % of the targets") != std::string::npos);
    CHECK(r.err.find("the farthest, frame 4, is off target by ") != std::string::npos);
    const Outcome text = w.run(kSeries + Words{"--target", "1,1,1", "--no-pictures", "--out", "o"});
    CHECK(text.out.find(", frame 4), flicker") != std::string::npos);
    // Just above is above.
    const double worst = j["worst"]["objective"];
    const auto with = [&](double tolerance) {
        return w.run(kSeries + Words{"--target", "1,1,1", "--tolerance", std::to_string(tolerance), "--no-pictures",
                                     "--out", "o"});
    };
    CHECK(with(worst * 0.99).err.find("1 of 5 frames is not within ") != std::string::npos);
    CHECK(with(worst * 1.01).err.find("not within") == std::string::npos);
}

TEST_CASE("a gap in the series is no neighbour for flicker, unless asked for", "[cli][sequence]") {
    const Series w;
    std::filesystem::remove(w.path(frameName(2)));
    const Words refine = kSeries + Words{"--mode", "refine", "--no-pictures", "--out", "o"};
    const Outcome r = w.run(refine + Words{"--json"});
    REQUIRE(r.status == 0);
    const json j = json::parse(r.out);
    REQUIRE(j["frames"].size() == kFrames - 1); // 0, 1, 3, 4
    CHECK(j["frames"][1].contains("flicker"));
    CHECK_FALSE(j["frames"][2].contains("flicker"));
    CHECK(j["frames"][3].contains("flicker"));
    CHECK(r.err.find("frame 3 follows a gap") != std::string::npos);
    const json over = answerOf(w, refine + Words{"--flicker-over-gaps"});
    CHECK(over["frames"][2].contains("flicker"));
    CHECK(over["frames"][3]["flicker"] == j["frames"][3]["flicker"]);
    // The table says which file is which.
    const std::string csv = w.read("o/curves.csv");
    CHECK(csv.find("run,frame,file,time,F,flicker") == 0);
    CHECK(csv.find("\nrefine,3,f03.raw,3,") != std::string::npos);
    CHECK(csv.find("\nrefine,2,f02.raw,2,,") != std::string::npos); // it is missing
    CHECK(j["frames"][2]["file"] == "f03.raw");
}

TEST_CASE("where more files are missing than there are, gaps are gaps all the same", "[cli][sequence]") {
    const Workshop w;
    for (const int number : {1, 2, 3, 40, 41}) {
        const std::string name = std::to_string(number);
        w.write("f" + std::string(name.size() < 2 ? "0" : "") + name + ".raw", layers(number % 5));
    }
    const json j = answerOf(w, kSeries + Words{"--mode", "refine", "--no-pictures", "--out", "o"});
    REQUIRE(j["frames"].size() == 5);
    for (std::size_t f = 0; f < 5; ++f) CHECK(j["frames"][f].contains("flicker") == (f != 0 && f != 3));
    CHECK(j["frames"][3]["file"] == "f40.raw");
}

TEST_CASE("a broken frame of another variable is reported with its number and left out", "[cli][sequence]") {
    const Series w;
    for (int f = 0; f < kFrames; ++f) w.write("y0" + std::to_string(f) + ".raw", layers(kFrames - f));
    w.write("y02.raw", "short");
    const Words variable{"--variable", "y=y%02d.raw", "--no-pictures", "--out", "o"};
    // Whatever follows the frames: none, one frame from the other, and all of them smoothed together.
    for (const Words& mode : {Words{"--mode", "static"}, Words{"--mode", "refine"},
                              Words{"--mode", "optimize", "--target", "1,1,1", "--coherence", "0"},
                              Words{"--mode", "optimize", "--target", "1,1,1", "--coherence", "2"}})
        // A volatility over two frames makes do with the one that is sound, but not where its own is broken.
        for (const char* channels : {"brightness=y", "saturation=volatility:y:2"}) {
            const Outcome r = w.run(kSeries + variable + mode + Words{"--hsb", channels, "--json"});
            INFO(mode[1] << " " << channels << ": " << r.err);
            REQUIRE(r.status == 0);
            const json j = json::parse(r.out);
            REQUIRE(j["frames"].size() == kFrames - 1);
            CHECK(j["frames"][2]["frame"] == 3);
            REQUIRE(j["broken"].size() == 1);
            CHECK(j["broken"][0]["frame"] == 2);
            CHECK(j["broken"][0]["problem"].get<std::string>().find("y02.raw") != std::string::npos);
            CHECK(r.err.find("frame 2 (f02) is passed over: ") != std::string::npos);
        }
}

TEST_CASE("sequence writes the same on one thread and on two", "[cli][sequence]") {
    const Series w;
    for (const char* threads : {"1", "2"}) {
        const Outcome r = w.run(kOptimize + Words{"--threads", threads, "--out", threads});
        REQUIRE(r.status == 0);
    }
    for (int f = 0; f < kFrames; ++f)
        for (const char* suffix : {".png", ".tf.json"}) {
            const std::string name = "/frame_000" + std::to_string(f) + suffix;
            CHECK(w.read("1" + name) == w.read("2" + name));
        }
}

TEST_CASE("sequence says what it cannot do", "[cli][sequence]") {
    const Series w;
    const auto fails = [&](const Words& words, int status, const std::string& what) {
        const Outcome r = w.run(words);
        CHECK(r.status == status);
        CHECK(r.out.empty());
        CHECK(r.err.find(what) != std::string::npos);
    };
    fails(kSeries + Words{"--mode", "optimize", "--out", "o"}, 2, "--target is required");
    fails(kSeries + Words{"--mode", "slow", "--out", "o"}, 2, "static, refine or optimize");
    fails(kSeries + Words{"--background", "transparent", "--out", "o"}, 2, "give a colour");
    fails(kSeries + Words{"--fps", "5", "--out", "o"}, 2, "--mp4");
    fails(kSeries + Words{"--mp4", "film.avi", "--out", "o"}, 2, ".mp4");
    fails(kSeries + Words{"--mp4", "film.mp4", "--no-pictures", "--out", "o"}, 2, "pictures");
    CHECK_FALSE(w.has("o"));
    // The answer is written, but does not reach what was demanded.
    const Outcome missed = w.run(
        kSeries + Words{"--mode", "static", "--target", "1,1,1", "--require-converged", "--no-pictures", "--out", "o"});
    CHECK(missed.status == 1);
    CHECK(missed.err.find("the targets were not reached") != std::string::npos);
    CHECK(w.has("o/curves.csv"));
}

TEST_CASE("a film is made where ffmpeg is installed", "[cli][sequence]") {
    const Series w;
    const Words film = kSeries + Words{"--mp4", "film.mp4", "--fps", "5", "--out", "o"};
    {
        const PathOf none(w.path("nowhere").string());
        const Outcome r = w.run(film);
        CHECK(r.status == 1);
        CHECK(r.err.find("ffmpeg is not installed") != std::string::npos);
        CHECK_FALSE(w.has("o")); // told before any work
    }
    // In its place a program that notes the pictures that it was given, and their rate; the film is an empty box of
    // MP4.
    std::filesystem::create_directory(w.path("bin"));
    w.write("bin/ffmpeg", "#!/bin/sh\nwhile [ $# -gt 1 ]; do [ \"$1\" = -framerate ] && rate=$2; shift; done\n"
                          "{ for f in *.png; do readlink $f; done; echo rate $rate; } > \"$(dirname \"$0\")/list\"\n"
                          "printf '\\000\\000\\000\\010free' > \"$1\"\n");
    std::filesystem::permissions(w.path("bin/ffmpeg"), std::filesystem::perms::owner_all);
    const PathOf with(w.path("bin").string() + ":/usr/bin:/bin");
    REQUIRE(w.run(film).status == 0);
    const std::string made = w.read("film.mp4");
    CHECK(made.size() == 8);
    const std::string list = w.read("bin/list");
    CHECK(list.find("frame_0000.png") < list.find("frame_0004.png"));
    CHECK(list.find("rate 5") != std::string::npos);
    CHECK_FALSE(w.has("film.mp4.list"));
    w.write("bin/ffmpeg", "#!/bin/sh\necho no such codec >&2\nexit 3\n");
    const Outcome failed = w.run(film);
    CHECK(failed.status == 1);
    CHECK(failed.err.find("no such codec") != std::string::npos);
    CHECK(w.read("film.mp4") == made); // whole or as it was
}

TEST_CASE("sequence brings out an intensity, a hue or a region in every frame", "[cli][sequence]") {
    const Series w;
    const Words refine{"--mode", "refine", "--no-pictures", "--frames", "0:2"};
    // What refine makes of a frame, from the transfer function of the frame before.
    const auto alone = [&](int frame, const std::string& tf, const Words& priority) {
        return w.json(Words{"refine", "f%02d.raw", "--raw", "14,14,14,u8", "--range", "0,255", "--frame",
                            std::to_string(frame), "--tf", tf} +
                      priority);
    };
    const auto checkFrames = [&](const json& told, const Words& priority) {
        std::string before = "tents:3:0.2";
        for (int f = 0; f < 3; ++f) {
            const json& one = told["frames"][static_cast<std::size_t>(f)];
            const json expected = alone(f, before, priority);
            CHECK(one["tf"]["points"] == expected["tf"]["points"]);
            for (const char* energy :
                 {"energy_before", "energy_after", "energy_movable_before", "energy_movable_after"})
                CHECK(one[energy] == expected[energy]);
            CHECK(one["moves"] == expected["iterations"]);
            if (f == 0) CHECK(told["priority"] == expected["priority"]);
            before = "o/frame_000" + std::to_string(f) + ".tf.json";
        }
    };
    const json plain = w.json(kSeries + refine + Words{"--out", "o"});
    CHECK(plain["priority"] == json({{"kind", "none"}}));
    const Words steps{"--step-down", "0.01", "--step-up", "auto", "--max-iterations", "7"};
    const Words intensity = Words{"--intensity", "0.5"} + steps;
    checkFrames(w.json(kSeries + refine + intensity + Words{"--out", "o"}), intensity);
    const json byHue = w.json(kSeries + refine + Words{"--hue", "300", "--out", "o"});
    checkFrames(byHue, {"--hue", "300"});
    // Tent 3 of 3: hue 360 degrees times its centre 5/6.
    CHECK(byHue["frames"][2]["priority"]["intensity"].get<double>() == Approx(5.0 / 6));
    CHECK(byHue["frames"][2]["tf"] != plain["frames"][2]["tf"]);
    const json byRegion = w.json(kSeries + refine + Words{"--region", "10,8,20,16", "--out", "o"});
    CHECK(byRegion["priority"]["kind"] == "region");
    CHECK(byRegion["priority"]["size"] == json({32, 24}));
    CHECK(byRegion["priority"]["pixels"] == 10 * 8);
    const json first = alone(0, "tents:3:0.2", {"--region", "10,8,20,16", "--size", "32x24"});
    CHECK(byRegion["priority"] == first["priority"]);
    CHECK(byRegion["frames"][0]["tf"]["points"] == first["tf"]["points"]);
    CHECK(w.read("o/curves.csv").find("seconds,energy,") != std::string::npos);
    const Outcome text = w.run(kSeries + refine + Words{"--hue", "300", "--out", "o"});
    CHECK_THAT(text.out, Catch::Contains("energy") && Catch::Contains("priority intensity 0.833333, hue 300"));
    // Voxels of the data are chosen by three intervals.
    CHECK(answerOf(w, kSeries + refine + Words{"--region", "2:12,0:14,0:14", "--out", "p"})["volume"]["dims"][0] == 10);
}

TEST_CASE("sequence refuses priorities that say nothing", "[cli][sequence]") {
    const Series w;
    const auto refused = [&](const Words& words, int status, const std::string& message) {
        const Outcome o = w.run(kSeries + words + Words{"--no-pictures", "--out", "o"});
        CHECK(o.status == status);
        CHECK_THAT(o.err, Catch::Contains(message));
    };
    refused({"--mode", "refine", "--hue", "3", "--intensity", "0.5"}, 2, "more than one priority");
    refused({"--mode", "refine", "--region", "0,0,40,8"}, 2, "outside the picture of 32 x 24 pixels");
    refused({"--mode", "refine", "--region", "4,4,4,8"}, 2, "holds no pixel");
    refused({"--hue", "3"}, 2, "only in the mode refine");
    refused({"--mode", "static", "--step-down", "0.1"}, 2, "--step-down");
    refused({"--mode", "refine", "--region", "0,0,1,1"}, 1, "the region shows nothing");
}
