// Simulated participants, and whether the analysis gives back what was planted.
#include <catch2/catch.hpp>

#include "base/error.h"
#include "study/simulation.h"
#include "support/study_cases.h"

using namespace pellucid;
using pellucid::test::studyOf;
using pellucid::test::TempFolder;
using pellucid::test::writePrepared;

namespace {

std::vector<double> figures(std::size_t count) {
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(static_cast<double>((7 * i) % count) * 0.01);
    return all;
}

double spearman(const std::vector<double>& x, const std::vector<double>& y) {
    return coefficient(CorrelationKind::Spearman, x, y);
}

} // namespace

TEST_CASE("opinions have the rank correlation that was planted", "[study]") {
    for (const double wanted : {-1.0, -0.4, 0.0, 0.3, 0.675, 0.9, 1.0})
        for (const std::uint32_t seed : {1u, 2u}) {
            const std::vector<double> opinions = plantedOpinions(figures(45), wanted, seed);
            CAPTURE(wanted, seed);
            CHECK(spearman(figures(45), opinions) == Approx(wanted).margin(0.02));
            CHECK(*std::ranges::min_element(opinions) == Approx(1.5 + 3 * 0.5 / 45));
            CHECK(*std::ranges::max_element(opinions) == Approx(4.5 - 3 * 0.5 / 45));
        }
    CHECK(plantedOpinions(figures(45), 0.5, 1) == plantedOpinions(figures(45), 0.5, 1));
    CHECK(plantedOpinions(figures(45), 0.5, 1) != plantedOpinions(figures(45), 0.5, 2));
    CHECK_THROWS_AS(plantedOpinions({0.1, 0.2}, 0.5, 1), Error);
    CHECK_THROWS_AS(plantedOpinions({0.1, 0.1, 0.1}, 0.5, 1), Error);
}

TEST_CASE("the analysis gives back what simulated participants were given", "[study]") {
    const TempFolder folder;
    Study study = studyOf(1, 24, 6);
    writePrepared(study, folder);
    study = readPreparedStudy(folder.path(""));
    for (std::size_t i = 0; i < study.stimuli.size(); ++i) // in another order than VWS
        study.stimuli[i].fs = 0.03 * static_cast<double>((11 * i) % study.stimuli.size());
    writeStudy(study, preparedStudyFile(folder.path("")));

    const SimulationOptions options{.participants = 8, .measure = StudyMeasure::Fs, .correlation = 0.7, .seed = 3};
    const std::vector<std::string> ids = simulateParticipants(folder.path(""), options);
    CHECK(ids.size() == 8);
    CHECK(ids.front() == "simulated-001");
    const std::vector<Participant> participants = readParticipants(folder.path(""));
    REQUIRE(participants.size() == 8);
    for (const Participant& p : participants) CHECK(p.answers.size() == 31); // 1 training, 24, 6 again
    const StudyAnalysis analysis = analyzeStudy(study, participants);
    CHECK(analysis.simulated() == 8);
    CHECK(analysis.points.size() == 30);
    const Correlation& planted = analysis.predictions[2].of(CorrelationKind::Spearman);
    CHECK(planted.interval.contains(0.7));
    CHECK(planted.value == Approx(0.7).margin(0.15));
    CHECK(planted.p < 0.001);
    CHECK(analysis.predictions[0].of(CorrelationKind::Spearman).p > 0.01); // VWS has nothing to do with it
    CHECK(analysis.differences[1].value < 0);
    CHECK_FALSE(analysis.differences[1].interval.contains(0));
    CHECK(analysis.intraclass.mean > analysis.intraclass.single);
    CHECK(analysis.alpha > 0.2);

    // The same again elsewhere; further ones are others.
    const TempFolder second;
    writePrepared(study, second);
    writeStudy(study, preparedStudyFile(second.path("")));
    simulateParticipants(second.path(""), options);
    const std::vector<Participant> again = readParticipants(second.path(""));
    for (std::size_t i = 0; i < again.size(); ++i)
        for (std::size_t a = 0; a < again[i].answers.size(); ++a)
            CHECK(again[i].answers[a].score == participants[i].answers[a].score);
    CHECK(simulateParticipants(second.path(""), {.participants = 1}).front() == "simulated-009");
}

TEST_CASE("without noise all answer alike, and without figures nobody can", "[study]") {
    const TempFolder folder;
    Study study = writePrepared(studyOf(0, 9), folder);
    simulateParticipants(folder.path(""), {.participants = 2, .correlation = 1, .noise = 0});
    const StudyAnalysis analysis = analyzeStudy(study, readParticipants(folder.path("")));
    CHECK(analysis.intraclass.single == Approx(1));
    // Nine opinions from 1.67 to 4.33, in steps of 1/3, as whole scores: 2 2 2 3 3 3 4 4 4.
    for (std::size_t i = 0; i < 9; ++i) CHECK(analysis.points[i].opinion.value == 2 + static_cast<double>(i / 3));

    study.stimuli[4].visibility.reset();
    writeStudy(study, preparedStudyFile(folder.path("")));
    CHECK_THROWS_AS(simulateParticipants(folder.path(""), {.participants = 1, .measure = StudyMeasure::Visibility}),
                    Error);
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(simulateParticipants(folder.path(""), {.participants = 1}, {stop.get_token(), {}}), Cancelled);
    CHECK(readParticipants(folder.path("")).size() == 2);
}
