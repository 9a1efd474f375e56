// `rulers`, and coordinates as people have chosen them.
#include <cmath>

#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// 8³ voxels of 2 mm from the origin, in LPS, whose value is i + 8·j: a patient's where `space` says so.
void writeNumbered(const Workshop& w, const std::string& name, const std::string& space) {
    std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\n" + space +
                        "\nsizes: 8 8 8\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (0,0,0)\n"
                        "encoding: raw\n\n";
    for (int n = 0; n < 512; ++n) bytes += static_cast<char>(n % 64);
    w.write(name, bytes);
}

Workshop& workshop() {
    static Workshop s_workshop;
    if (!s_workshop.has("head.nrrd")) {
        writeNumbered(s_workshop, "head.nrrd", "space: left-posterior-superior");
        writeNumbered(s_workshop, "block.nrrd", "space dimension: 3");
    }
    return s_workshop;
}

} // namespace

TEST_CASE("rulers tell distances, angles and values, as text, JSON and a table", "[rulers]") {
    const Workshop& w = workshop();
    const Words what{"rulers",   "head.nrrd", "--distance", "0,0,0:6,8,0", "--angle", "2,0,0:0,0,0:0,5,0",
                     "--sphere", "4,4,4,2",   "--box",      "6,2,0:2,2,0"};
    const json answer = w.json(what);
    CHECK(answer["unit"] == "mm");
    CHECK(answer["coordinates"] == "lps");
    const json& rulers = answer["rulers"];
    REQUIRE(rulers.size() == 4);
    CHECK(rulers[0]["name"] == "Distance 1");
    CHECK(rulers[0]["length"] == Approx(10));
    CHECK(rulers[1]["angle"] == Approx(90));
    // Around voxel (2, 2, 2) of value 18: itself and its six neighbours, ±1, ±8, ±0.
    CHECK(rulers[2]["voxels"] == 7);
    CHECK(rulers[2]["mean"] == Approx(18));
    CHECK(rulers[2]["sigma"] == Approx(std::sqrt(2 * (1 + 64) / 7.0)));
    CHECK(rulers[2]["range"] == json({10.0, 26.0}));
    CHECK(rulers[2]["outside"] == 0.0);
    // Corners in any order: voxels 1 to 3 of row 1, 9 to 11.
    CHECK(rulers[3]["voxels"] == 3);
    CHECK(rulers[3]["mean"] == Approx(10));
    CHECK(rulers[3]["points"] == json({{2.0, 2.0, 0.0}, {6.0, 2.0, 0.0}}));

    const Outcome text = w.run(what + Words{"--csv", "all.csv"});
    REQUIRE(text.status == 0);
    CHECK(text.out.find("Distance 1  10 mm") != std::string::npos);
    CHECK(text.out.find("90.0°") != std::string::npos);
    CHECK(text.out.find("7 voxels") != std::string::npos);
    const std::string table = w.read("all.csv");
    CHECK(table.starts_with("name,kind,length,angle,radius,mean,sigma,min,max,voxels,invalid,outside,unit,x1,"));
    CHECK(table.find("Distance 1,distance,10,,,,,,,,,,mm,0,0,0,6,8,0,,,,LPS") != std::string::npos);
    CHECK(table.find("Box 1,box,,,,10,") != std::string::npos);
}

TEST_CASE("rulers take and tell places in RAS where that is asked for", "[rulers][coordinates]") {
    const Workshop& w = workshop();
    const json ras =
        w.json({"rulers", "head.nrrd", "--coordinates", "ras", "--sphere", "-4,-4,4,2", "--box", "-6,-2,0:-2,-2,0"});
    CHECK(ras["coordinates"] == "ras");
    CHECK(ras["rulers"][0]["mean"] == Approx(18)); // as above, in LPS 4,4,4
    CHECK(ras["rulers"][0]["points"][0] == json({-4.0, -4.0, 4.0}));
    CHECK(ras["rulers"][1]["mean"] == Approx(10));
    CHECK(ras["rulers"][1]["points"] == json({{-6.0, -2.0, 0.0}, {-2.0, -2.0, 0.0}}));
    // Without a patient there is one kind of coordinates.
    const json block = w.json({"rulers", "block.nrrd", "--coordinates", "ras", "--sphere", "4,4,4,2"});
    CHECK_FALSE(block.contains("coordinates"));
    CHECK(block["unit"] == "units");
    CHECK(block["rulers"][0]["mean"] == Approx(18));
}

TEST_CASE("probe tells its place in RAS where that is asked for", "[probe][coordinates]") {
    const Workshop& w = workshop();
    const Words at{"probe", "head.nrrd", "32,32", "--size", "64x64", "--tf", "tents:3"};
    const json lps = w.json(at), ras = w.json(at + Words{"--coordinates", "ras"});
    for (const char* place : {"entry", "exit", "position"}) {
        INFO(place);
        CHECK(ras[place][0].get<double>() == Approx(-lps[place][0].get<double>()));
        CHECK(ras[place][1].get<double>() == Approx(-lps[place][1].get<double>()));
        CHECK(ras[place][2] == lps[place][2]);
    }
    CHECK(ras["voxel"] == lps["voxel"]);
    CHECK(w.run(at).out.find("(LPS)") != std::string::npos);
    CHECK(w.run(at + Words{"--coordinates", "ras"}).out.find("(RAS)") != std::string::npos);
}

TEST_CASE("measures of a session are told, and drawn into its pictures", "[rulers]") {
    const Workshop& w = workshop();
    w.write("s.pellucid.json", R"({"format": "pellucid-session", "version": 1,
        "variables": [{"name": "x", "source": {"path": "head.nrrd"}, "transfer_functions": []}],
        "coordinates": {"axes": "ras"},
        "rulers": [{"kind": "distance", "name": "from ear to ear", "number": 1,
                    "points": [[0, 7, 7], [14, 7, 7]]},
                   {"kind": "sphere", "name": "middle", "number": 2, "points": [[4, 4, 4]], "radius": 2}]})");
    const json answer = w.json({"rulers", "--session", "s.pellucid.json", "--distance", "0,0,0:0,0,3"});
    REQUIRE(answer["rulers"].size() == 3);
    CHECK(answer["rulers"][0]["name"] == "from ear to ear");
    CHECK(answer["rulers"][0]["length"] == Approx(14));
    CHECK(answer["rulers"][0]["points"][1] == json({-14.0, -7.0, 7.0})); // files keep LPS
    CHECK(answer["rulers"][1]["mean"] == Approx(18));
    CHECK(answer["rulers"][2]["length"] == Approx(3));

    const auto picture = [&](const std::string& name, const Words& more) {
        const Outcome outcome = w.run(Words{"render", "--session", "s.pellucid.json", "--size", "160x120", "--tf",
                                            "tents:3", "--engine", "cpu", "--out", name} +
                                      more);
        INFO(outcome.err);
        REQUIRE(outcome.status == 0);
        return w.read(name);
    };
    CHECK(picture("a.png", {}) != picture("b.png", {"--annotate", "measures"}));
    CHECK(picture("c.png", {"--slice", "z:0.47"}) != picture("d.png", {"--slice", "z:0.47", "--annotate", "measures"}));
    const Outcome letters = w.run(
        {"render", "--session", "s.pellucid.json", "--slice", "z:0.5", "--annotate", "letters", "--out", "e.png"});
    CHECK(letters.status == 2);
    CHECK(letters.err.find("measures") != std::string::npos);
}

TEST_CASE("rulers that cannot be measured are refused in words", "[rulers][errors]") {
    const Workshop& w = workshop();
    const auto refused = [&](const Words& options, const std::string& word) {
        const Outcome outcome = w.run(Words{"rulers", "head.nrrd"} + options);
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.out.empty());
        CHECK(outcome.err.find(word) != std::string::npos);
    };
    refused({}, "--distance");
    refused({"--distance", "0,0,0"}, "1 of 2 points");
    refused({"--distance", "0,0:1,1,1"}, "X,Y,Z");
    refused({"--distance", "0,0,0:1,1,nan"}, "--distance");
    refused({"--angle", "0,0,0:0,0,0:1,1,1"}, "leg");
    refused({"--sphere", "0,0,0,0"}, "radius");
    refused({"--sphere", "0,0,0"}, "X,Y,Z,R");
    refused({"--coordinates", "xyz"}, "lps");
    // A sphere beyond the volume is no error: it says so.
    const Outcome away = w.run({"rulers", "head.nrrd", "--sphere", "99,99,99,2"});
    CHECK(away.status == 0);
    CHECK(away.out.find("no voxels") != std::string::npos);
    CHECK(away.out.find("100.0 % outside the volume") != std::string::npos);
}
