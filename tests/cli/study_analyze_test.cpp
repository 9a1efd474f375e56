// `study analyze` and `study run --simulate`: from a prepared study to figures, page and table.
#include <catch2/catch.hpp>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// Nine pictures of three disks under tents of three heights; three of them are shown twice.
void prepare(const Workshop& w) {
    REQUIRE(w.run({"generate", "disks", "--size", "20", "--out", "disks.nrrd"}).status == 0);
    json study{{"format", "pellucid-study"}, {"version", 1}, {"title", "Disks"}, {"size", {40, 32}}, {"repeats", 3}};
    for (const char* peak : {"0.02", "0.2", "0.8"})
        for (const char* feature : {"f1", "f2", "f3"})
            study["stimuli"].push_back({{"id", std::string(feature) + "-" + (peak + 2)},
                                        {"volume", "disks.nrrd"},
                                        {"tf", std::string("tents:3:") + peak},
                                        {"view", "20,30"},
                                        {"feature", feature}});
    w.write("disks.study.json", study.dump());
    REQUIRE(w.run({"study", "prepare", "disks.study.json", "--out", "d", "--engine", "cpu"}).status == 0);
}

} // namespace

TEST_CASE("simulated answers are analysed", "[cli][study]") {
    const Workshop w;
    prepare(w);
    const json simulated =
        w.json({"study", "run", "d", "--simulate", "6", "--rho", "1", "--noise", "0.2", "--seed", "4"});
    CHECK(simulated["command"] == "study run");
    CHECK(simulated["simulated"].size() == 6);
    CHECK(w.has("d/participants/simulated-006.csv"));

    const Outcome run = w.run({"study", "analyze", "d", "--json", "--out", "report.html", "--csv", "points.csv"});
    REQUIRE(run.status == 0);
    CHECK(run.err.find("6 of the participants who count are simulated") != std::string::npos);
    const json j = json::parse(run.out);
    CHECK(j["command"] == "study analyze");
    CHECK((j["counted"] == 6 && j["simulated"] == 6));
    REQUIRE(j["points"].size() == 12);
    CHECK(j["points"][0]["scores"] == 6);
    CHECK(j["points"][0]["volume"] == "disks.nrrd");
    CHECK(j["participants"][0]["pairs"] == 3);
    REQUIRE(j["correlations"].size() == 3);
    const json& vws = j["correlations"][0];
    CHECK((vws["measure"] == "vws" && vws["points"] == 12));
    CHECK(vws["spearman"]["value"] > 0.85);
    CHECK(vws["spearman"]["p"] < 0.001);
    CHECK(vws["spearman"]["low"] <= vws["spearman"]["value"]);
    CHECK(j["differences"].size() == 3);
    CHECK(j["agreement"]["raters"] == 6);
    CHECK(j["agreement"]["icc_mean"] > 0.9);
    CHECK(j["files"] == json{"report.html", "points.csv"});
    CHECK(w.read("report.html").find("study analyze d --json --out report.html") != std::string::npos);
    CHECK(w.read("points.csv").starts_with("stimulus,volume,feature"));

    // Who is left out by hand is not counted, and intervals depend on the seed alone.
    const json without = json::parse(
        w.run({"study", "analyze", "d", "--json", "--exclude", "simulated-002", "--exclude", "simulated-004"}).out);
    CHECK(without["counted"] == 4);
    CHECK(without["participants"][1]["excluded"] == "by hand");
    CHECK_FALSE(without.contains("files"));
    const json other = json::parse(w.run({"study", "analyze", "d", "--json", "--seed", "9"}).out);
    CHECK(other["correlations"][0]["spearman"]["value"] == vws["spearman"]["value"]);
    CHECK(other["correlations"][0] != vws);

    const Outcome text = w.run({"study", "analyze", "d"});
    CHECK(text.out.find("simulated-001") != std::string::npos);
    CHECK(text.out.find("Spearman's rank correlation with the mean opinion score") != std::string::npos);
}

TEST_CASE("answers that were cut off, and what cannot be analysed", "[cli][study]") {
    const Workshop w;
    prepare(w);
    const Outcome nobody = w.run({"study", "analyze", "d"});
    CHECK(nobody.status == 1);
    CHECK(nobody.err.find("nobody has taken part yet") != std::string::npos);
    REQUIRE(w.run({"study", "run", "d", "--simulate", "2"}).status == 0);
    // The program ended while it wrote the last of twelve answers.
    const std::string file = "d/participants/simulated-001.csv", whole = w.read(file);
    w.write(file, whole.substr(0, whole.size() - 7));
    const json j = json::parse(w.run({"study", "analyze", "d", "--json"}).out);
    CHECK(j["participants"][0]["scores"] == 11);
    CHECK(j["participants"][1]["scores"] == 12);
    w.write(file, whole + "simulated-001,13,trial,f1-02,f1,0,nine,1,1,1,normal,now\n");
    const Outcome wrong = w.run({"study", "analyze", "d"});
    CHECK(wrong.status == 1);
    CHECK(wrong.err.find("simulated-001.csv:14") != std::string::npos);
    w.write(file, whole);

    const auto refused = [&](const Words& words, const std::string& why) {
        const Outcome outcome = w.run(words);
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find(why) != std::string::npos);
        CHECK(outcome.out.empty());
    };
    refused({"study", "analyze", "d", "--exclude", "simulated-007"},
            "there is no participant 'simulated-007', participants to leave out");
    refused({"study", "analyze", "d", "--out", "report.pdf"}, "--out");
    refused({"study", "analyze", "d", "--csv", file}, file);
    CHECK(w.read(file) == whole);
    refused({"study", "run", "d", "--rho", "0.5"}, "give --simulate N too");
    refused({"study", "run", "d", "--simulate", "2", "--rho", "1.5"}, "--rho");
    refused({"study", "run", "d", "--simulate", "2", "--participant", "p1"}, "--participant");
    CHECK(w.run({"study", "analyze", "nowhere"}).status == 1);
}
