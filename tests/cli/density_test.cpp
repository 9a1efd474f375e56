// `density`: pictures from faint to strong that keep the shares of features.
#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kShells{"sample:shells", "--sample-size", "32", "--tf", "tents:3:0.3", "--view", "30,20"};

double largestDifference(const json& a, const json& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i].get<double>() - b[i].get<double>()));
    return most;
}

} // namespace

TEST_CASE("density tells pictures of equal shares, the fainter ones first", "[cli][density]") {
    const Workshop w;
    const json answer = w.json(Words{"density"} + kShells);
    CHECK(answer["command"] == "density");
    const json measured = w.json(Words{"measure"} + kShells);
    for (std::size_t f = 0; f < 3; ++f)
        CHECK(answer["shares"][f].get<double>() == Approx(measured["features"][f]["vws"].get<double>()).margin(1e-6));
    REQUIRE(answer["points"].size() > 2);
    double before = 0;
    for (const json& point : answer["points"]) {
        CHECK(point["coverage"].get<double>() > before);
        before = point["coverage"];
        CHECK(point["objective"].get<double>() < 0.01); // what the curve is held to
        // F is the root of the mean square of three differences.
        CHECK(largestDifference(point["vws"], answer["shares"]) <=
              std::sqrt(3) * point["objective"].get<double>() + 1e-9);
    }
    // It ends at a tenth of the largest coverage.
    CHECK(answer["points"].front()["coverage"].get<double>() < 0.15 * before);
}

TEST_CASE("density chooses the picture of a coverage, and writes its transfer function", "[cli][density]") {
    const Workshop w;
    const json answer = w.json(Words{"density"} + kShells + Words{"--coverage", "0.3", "--out-tf", "a.tf.json"});
    const json& chosen = answer["chosen"];
    CHECK(chosen["coverage"].get<double>() == Approx(0.3).margin(0.03)); // between points of the curve
    CHECK(chosen["objective"].get<double>() < 0.01);
    const json measured =
        w.json({"measure", "sample:shells", "--sample-size", "32", "--tf", "a.tf.json", "--view", "30,20"});
    for (std::size_t f = 0; f < 3; ++f) {
        CHECK(measured["features"][f]["opacity"].get<double>() == Approx(chosen["opacity"][f].get<double>()));
        CHECK(measured["features"][f]["vws"].get<double>() == Approx(chosen["vws"][f].get<double>()).margin(1e-6));
    }
}

TEST_CASE("density takes the end of the curve where no picture is as strong as asked for", "[cli][density]") {
    const Workshop w;
    const Outcome out = w.run(Words{"density"} + kShells + Words{"--coverage", "1", "--json"});
    REQUIRE(out.status == 0);
    CHECK(out.err.find("the nearest one was taken") != std::string::npos);
    const json answer = json::parse(out.out);
    CHECK(largestDifference(answer["chosen"]["opacity"], answer["points"].back()["opacity"]) < 1e-9);
}

TEST_CASE("density keeps what is locked", "[cli][density]") {
    const Workshop w;
    const json one = w.json(Words{"density"} + kShells + Words{"--lock", "f1"});
    for (const json& point : one["points"]) CHECK(point["opacity"][0].get<double>() == Approx(0.3));
    const json none = w.json(Words{"density"} + kShells + Words{"--lock", "f1", "--lock", "f2", "--lock", "f3"});
    CHECK(none["points"].size() == 1);
    CHECK(largestDifference(none["points"][0]["opacity"], json({0.3, 0.3, 0.3})) < 1e-9);
}

TEST_CASE("density refuses what it cannot do", "[cli][density]") {
    const Workshop w;
    const auto refused = [&](const Words& words, const std::string& what) {
        const Outcome out = w.run(Words{"density"} + kShells + words);
        CHECK(out.status == 2);
        CHECK(out.out.empty());
        INFO(out.err);
        CHECK(out.err.find(what) != std::string::npos);
    };
    refused({"--out-tf", "a.tf.json"}, "--coverage");
    refused({"--coverage", "0"}, "--coverage");
    refused({"--coverage", "1.5"}, "--coverage");
    refused({"--lock", "f9"}, "f9");
}
