// Series on the command line: what info says of frames, and how one or some are chosen.
#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Workshop;

namespace {

/// 4³ voxels of 0 … 63 + `first`.
std::string volume(int first) {
    std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n";
    for (int i = 0; i < 64; ++i) bytes += static_cast<char>(first + i);
    return bytes;
}

/// d_010 … d_060 in steps of 10; the fourth is cut off, the fifth is not there.
void writeSeries(const Workshop& w) {
    for (const int n : {10, 20, 30, 40, 60}) {
        std::string bytes = volume(n);
        if (n == 40) bytes.resize(bytes.size() - 7);
        w.write("d_0" + std::to_string(n) + ".nrrd", bytes);
    }
}

} // namespace

TEST_CASE("info tells the frames of a series, and which cannot be read", "[cli][series]") {
    const Workshop w;
    writeSeries(w);
    for (const char* what : {"d_%03d.nrrd", "d_*.nrrd", "."}) {
        CAPTURE(what);
        const json j = w.json({"info", what});
        const json& frames = j["frames"];
        CHECK(frames["count"] == 6);
        CHECK(frames["frame"] == 0);
        CHECK(frames["first"] == "d_010");
        CHECK(frames["last"] == "d_060");
        CHECK(frames["range"] == json({10, 123})); // 60 + 63
        CHECK(frames["broken"] == json({3, 4}));
        CHECK(frames["list"][0] == json({{"name", "d_010"}, {"valid", 64}, {"range", {10, 73}}}));
        CHECK(frames["list"][3]["problem"].get<std::string>().find("57 of 64 bytes") != std::string::npos);
        CHECK(frames["list"][4]["problem"] == "no such file");
        CHECK(frames["notices"].size() == 1);
        CHECK(j["range"] == json({10, 123})); // the window is that of all frames
        CHECK(j["data_range"] == json({10, 73}));
    }
    const Outcome text = w.run({"info", "d_%03d.nrrd"});
    for (const char* part : {"6, d_010 .. d_060", "3, d_040: the data has 57 of 64 bytes", "4, d_050: no such file"})
        CHECK(text.out.find(part) != std::string::npos);
    CHECK_FALSE(w.json({"info", "d_010.nrrd"}).contains("frames"));
}

TEST_CASE("frames are chosen by number", "[cli][series]") {
    const Workshop w;
    writeSeries(w);
    const auto range = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"info", "d_%03d.nrrd"});
        return w.json(options)["data_range"];
    };
    CHECK(range({"--frame", "2"}) == json({30, 93}));
    CHECK(range({"--frames", "1:"}) == json({20, 83}));
    CHECK(range({"--frames", "3:5"}) == json({60, 123})); // the first that can be read
    CHECK(range({"--frames", ":2:2", "--frame", "1"}) == json({30, 93}));
    const json some = w.json({"info", "d_%03d.nrrd", "--frames", "0:2:2", "--cache", "0.001"});
    CHECK(some["frames"]["count"] == 2);
    CHECK(some["frames"]["range"] == json({10, 93}));
    const auto refused = [&](std::vector<std::string> options, int status, const char* part) {
        options.insert(options.begin(), {"info", "d_%03d.nrrd"});
        const Outcome outcome = w.run(options);
        CAPTURE(outcome.err);
        CHECK(outcome.status == status);
        CHECK(outcome.out.empty());
        CHECK(outcome.err.find(part) != std::string::npos);
    };
    refused({"--frame", "4"}, 1, "no such file");
    refused({"--frame", "6"}, 2, "give 0 to 5");
    refused({"--frame", "-1"}, 2, "--frame");
    refused({"--frames", "2:9"}, 2, "give frames from 0 to 5");
    refused({"--frames", "3:1"}, 2, "end before they begin");
    refused({"--frames", "1:2:0"}, 2, "--frames");
    refused({"--frames", "7"}, 2, "not a range of frames");
    refused({"--array", "x"}, 2, "no array");
    refused({"--cache", "0"}, 2, "--cache");
    const Outcome none = w.run({"info", "e_*.nrrd"});
    CHECK(none.status == 1);
    CHECK(none.err.find("no file with a name of this pattern") != std::string::npos);
}

TEST_CASE("a headerless file holds as many steps as are asked for", "[cli][series]") {
    const Workshop w;
    w.write("s.bin", std::string("\1\2\3\4\5\6", 6));
    CHECK(w.run({"info", "s.bin", "--raw", "2,1,1,u8"}).status == 1);
    const json j = w.json({"info", "s.bin", "--raw", "2,1,1,u8", "--frames", ":", "--frame", "2"});
    CHECK(j["frames"]["count"] == 3);
    CHECK(j["frames"]["range"] == json({1, 6}));
    CHECK(j["data_range"] == json({5, 6}));
}

TEST_CASE("other commands work on one frame, and say which are passed over", "[cli][series]") {
    const Workshop w;
    writeSeries(w);
    const Outcome outcome = w.run({"measure", "d_%03d.nrrd", "--frame", "1", "--tf", "tents:2", "--engine", "cpu"});
    CHECK(outcome.status == 0);
    CHECK(outcome.err.find("d_050.nrrd") != std::string::npos);
    CHECK(outcome.err.find("frame 3 (d_040) is passed over") != std::string::npos);
    // The window of the series: 10 … 123.
    const Outcome measured =
        w.run({"measure", "d_%03d.nrrd", "--frame", "1", "--tf", "tents:2", "--engine", "cpu", "--json"});
    CHECK(json::parse(measured.out)["volume"]["range"] == json({10, 123}));
    // No output may take the place of any frame.
    CHECK(w.run({"render", "d_%03d.nrrd", "--out", "d_020.nrrd"}).status != 0);
    CHECK(w.read("d_020.nrrd") == volume(20));
}
