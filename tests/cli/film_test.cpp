// `film`: pictures and films of a turning volume, of a series, and of a way from view to view.
#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kSmall{"film", "sample:shells", "--sample-size", "12", "--tf", "tents:3", "--size", "32x24"};

} // namespace

TEST_CASE("film writes the pictures of a turntable and of a way between views", "[cli][film]") {
    const Workshop w;
    const json turn = w.json(kSmall + Words{"--seconds", "1", "--fps", "4", "--out", "turn"});
    CHECK(turn["command"] == "film");
    CHECK(turn["kind"] == "turntable");
    CHECK(turn["pictures"] == 4);
    CHECK(turn["seconds"] == 1.0);
    for (const char* name : {"turn/picture_00000.png", "turn/picture_00003.png"}) CHECK(w.has(name));
    CHECK_FALSE(w.has("turn/picture_00004.png"));
    const json way = w.json(kSmall + Words{"--kind", "views", "--views", "front; right; present", "--seconds", "0.5",
                                           "--fps", "6", "--out", "way"});
    CHECK(way["pictures"] == 3);
    CHECK(w.read("way/picture_00000.png") != w.read("way/picture_00001.png"));
}

TEST_CASE("film goes through the frames of a series", "[cli][film]") {
    const Workshop w;
    const json film = w.json({"film", "sample:vortex", "--sample-size", "12", "--frames", "0:3", "--tf", "tents:3",
                              "--size", "32x24", "--kind", "series", "--out", "time"});
    CHECK(film["pictures"].get<int>() >= 3);
    CHECK(w.read("time/picture_00000.png") != w.read("time/picture_00002.png"));
}

TEST_CASE("films that cannot be made are refused in words", "[cli][film]") {
    const Workshop w;
    const auto refused = [&](const Words& options, const std::string& word) {
        const Outcome outcome = w.run(kSmall + options);
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find(word) != std::string::npos);
    };
    refused({}, "--out");
    refused({"--out", "f", "--kind", "views"}, "--views");
    refused({"--out", "f", "--views", "front; left"}, "--kind views");
    refused({"--out", "f", "--kind", "views", "--views", "front"}, "two views");
    refused({"--out", "f", "--kind", "series"}, "no series");
    refused({"--out", "f", "--kind", "views", "--views", "front; left", "--degrees", "90"}, "--degrees");
    refused({"--out", "f", "--seconds", "0"}, "--seconds");
    refused({"--out", "f", "--seconds", "3600", "--fps", "100"}, "100000 pictures");
    // They would become folders of these names.
    for (const char* suffix : {"avi", "mov", "MKV", "wmv", "m4v", "ogv", "flv", "mpg", "mpeg"})
        refused({"--out", std::string("f.") + suffix}, ".mp4, .webm, .gif or .apng");
    CHECK(w.list().empty());
}
