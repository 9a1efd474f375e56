// What comes of a study: small tables whose figures can be worked out by hand.
#include <catch2/catch.hpp>

#include <cmath>

#include "base/error.h"
#include "study/analysis.h"

using namespace pellucid;

namespace {

using Figures = std::vector<std::optional<double>>;

/// A stimulus for training, then one per VWS: a1, a2, …
Study studyWith(const Figures& vws) {
    Study study;
    study.stimuli.emplace_back();
    study.stimuli.back().id = "t1";
    study.stimuli.back().training = true;
    for (std::size_t i = 0; i < vws.size(); ++i) {
        Stimulus s;
        s.id = "a" + std::to_string(i + 1);
        s.feature = "f1";
        s.data = "tooth";
        s.vws = vws[i];
        study.stimuli.push_back(s);
    }
    return study;
}

using Scores = std::vector<std::optional<int>>;

/// Who gives a1, a2, … these scores, and `second` to their repetitions.
Participant someone(const std::string& id, const Scores& scores, const Scores& second = {},
                    ColorVision vision = ColorVision::Normal) {
    Participant who{.id = id, .colorVision = vision, .answers = {}};
    who.answers.push_back({.trial = 1, .training = true, .stimulus = "t1", .feature = {}, .score = 1, .time = {}});
    for (const bool repeat : {false, true}) {
        const Scores& given = repeat ? second : scores;
        for (std::size_t i = 0; i < given.size(); ++i)
            who.answers.push_back({.trial = static_cast<int>(who.answers.size()) + 1,
                                   .stimulus = "a" + std::to_string(i + 1),
                                   .feature = {},
                                   .repeat = repeat,
                                   .score = given[i],
                                   .time = {}});
    }
    return who;
}

/// Who scores three pictures 1, and 1 + difference the second time.
Participant wavering(const std::string& id, const std::vector<int>& differences) {
    Scores second;
    for (const int d : differences) second.emplace_back(1 + d);
    return someone(id, Scores(differences.size(), 1), second);
}

const StudyParticipant& named(const StudyAnalysis& analysis, const std::string& id) {
    return *std::ranges::find(analysis.participants, id, &StudyParticipant::id);
}

bool isMentioned(const StudyAnalysis& analysis, const std::string& words) {
    return std::ranges::any_of(analysis.remarks,
                               [&](const std::string& remark) { return remark.find(words) != std::string::npos; });
}

constexpr std::optional<int> kSkipped = std::nullopt;

} // namespace

TEST_CASE("a mean opinion has its interval, and a second showing is a point of its own", "[study]") {
    const Study study = studyWith({0.1, 0.2, 0.3});
    const StudyAnalysis analysis =
        analyzeStudy(study, {someone("p1", {2, 4, kSkipped}, {3}), someone("p2", {3, 4, kSkipped}, {kSkipped}),
                             someone("p3", {4, 4, kSkipped}, {5})});
    // a1, its repetition and a2; nobody has scored a3, and training does not count.
    REQUIRE(analysis.points.size() == 3);
    const OpinionPoint& first = analysis.points[0];
    CHECK((first.stimulus == 0 && !first.repeat));
    CHECK(first.opinion.count == 3);
    CHECK(first.opinion.value == 3);
    // 2, 3, 4: standard deviation 1; t of 0.975 with 2 degrees of freedom is 4.302653: 3 ± 4.302653/√3.
    CHECK(first.opinion.interval.low == Approx(3 - 4.302652729911275 / std::sqrt(3)));
    CHECK(first.opinion.interval.high == Approx(3 + 4.302652729911275 / std::sqrt(3)));
    const OpinionPoint& second = analysis.points[1];
    CHECK((second.stimulus == 0 && second.repeat));
    CHECK(second.opinion.count == 2);
    CHECK(second.opinion.value == 4);
    CHECK(analysis.points[2].opinion.value == 4);
    CHECK(analysis.points[2].opinion.interval.high == 4); // all agree
    const StudyParticipant& p1 = analysis.participants[0];
    CHECK((p1.scores == 3 && p1.skipped == 1 && p1.pairs == 1 && p1.sumDifference == 1));
    CHECK(analysis.participants[1].pairs == 0); // the second time was skipped
    CHECK(std::isnan(analysis.participants[1].meanDifference()));
}

TEST_CASE("who contradicts himself far more than the others is left out", "[study]") {
    const Study study = studyWith({0.1, 0.2, 0.3});
    // Mean differences 0, 1/3, 1/3, 2/3, 8/3: median 1/3, deviations 1/3, 0, 0, 1/3, 7/3 with median 1/3: at most
    // 1/3 + 3·1.4826/3 = 1.8159 is tolerated.
    std::vector<Participant> all{wavering("p1", {0, 0, 0}), wavering("p2", {1, 0, 0}), wavering("p3", {0, 1, 0}),
                                 wavering("p4", {0, 1, 1}), wavering("p5", {4, 4, 0})};
    const StudyAnalysis analysis = analyzeStudy(study, all);
    CHECK(analysis.mostDifference == Approx((1 + 3 * 1.4826) / 3));
    CHECK(named(analysis, "p5").sumDifference == 8);
    CHECK(named(analysis, "p5").meanDifference() == Approx(8.0 / 3));
    CHECK(named(analysis, "p5").exclusion == Exclusion::Inconsistent);
    CHECK(analysis.counted() == 4);
    CHECK(analysis.points[0].opinion.count == 4);

    CHECK(analyzeStudy(study, all, {.exclude = {}, .keepAll = true, .bootstrap = {}}).counted() == 5);
    // 5/3 would be tolerated.
    all[4] = wavering("p5", {4, 1, 0});
    CHECK(analyzeStudy(study, all).counted() == 5);
}

TEST_CASE("differences of one on average are tolerated, and two pairs tell nothing", "[study]") {
    const Study study = studyWith({0.1, 0.2, 0.3});
    // Median and deviation of the others are 0.
    const std::vector<Participant> all{wavering("p1", {0, 0, 0}), wavering("p2", {0, 0, 0}), wavering("p3", {0, 0, 0}),
                                       wavering("p4", {1, 1, 1}), wavering("p5", {2, 1, 1}), wavering("p6", {4, 4})};
    const StudyAnalysis analysis = analyzeStudy(study, all);
    CHECK(analysis.mostDifference == 1);
    CHECK(named(analysis, "p4").counts());
    CHECK(named(analysis, "p5").exclusion == Exclusion::Inconsistent);
    CHECK(named(analysis, "p6").counts());
}

TEST_CASE("colour vision, by hand, and without a score", "[study]") {
    const Study study = studyWith({0.1, 0.2, 0.3});
    const std::vector<Participant> all{someone("p1", {1, 2, 3}), someone("p2", {5, 5, 5}, {}, ColorVision::Deficient),
                                       someone("p3", {1, 2, 3}, {}, ColorVision::Unsure),
                                       someone("p4", {kSkipped, kSkipped, kSkipped}),
                                       someone("simulated-001", {4, 4, 4})};
    const StudyAnalysis analysis = analyzeStudy(study, all, {.exclude = {"simulated-001"}, .bootstrap = {}});
    CHECK(named(analysis, "p1").counts());
    CHECK(named(analysis, "p2").exclusion == Exclusion::ColorVision);
    CHECK(named(analysis, "p3").counts());
    CHECK(named(analysis, "p4").exclusion == Exclusion::NoScores);
    CHECK(named(analysis, "simulated-001").exclusion == Exclusion::ByHand);
    CHECK(analysis.points[0].opinion.value == 1);
    CHECK(analysis.simulated() == 0);
    const StudyAnalysis kept = analyzeStudy(study, all, {.exclude = {}, .keepAll = true, .bootstrap = {}});
    CHECK(kept.counted() == 4);
    CHECK(kept.simulated() == 1);
    CHECK(kept.points[0].opinion.value == Approx((1 + 5 + 1 + 4) / 4.0));

    CHECK_THROWS_AS(analyzeStudy(study, all, {.exclude = {"p9"}, .bootstrap = {}}), UsageError);
    CHECK_THROWS_AS(analyzeStudy(study, {}), Error);
    CHECK_THROWS_AS(analyzeStudy(study, {all[3]}), Error);
    CHECK_THROWS_AS(analyzeStudy(study, {all[1]}), Error);
}

TEST_CASE("measures are compared with the opinions", "[study]") {
    Study study = studyWith({0.1, 0.2, 0.3, 0.4});
    for (std::size_t i = 1; i < study.stimuli.size(); ++i) {
        study.stimuli[i].fs = 1 - *study.stimuli[i].vws; // the reverse
        if (i > 1) study.stimuli[i].visibility = study.stimuli[i].vws;
    }
    const StudyAnalysis analysis = analyzeStudy(study, {someone("p1", {1, 2, 3, 5}), someone("p2", {1, 3, 3, 5})});
    const MeasurePrediction& vws = analysis.predictions[0];
    CHECK(vws.points == 4);
    CHECK(vws.of(CorrelationKind::Spearman).value == Approx(1));
    CHECK(vws.of(CorrelationKind::Spearman).p == Approx(2.0 / 24)); // two orders of 4! are as extreme
    CHECK(vws.of(CorrelationKind::Kendall).value == Approx(1));
    // MOS 1, 2.5, 3, 5 over 1, 2, 3, 4: 6.25/√(8.1875·5).
    CHECK(vws.of(CorrelationKind::Pearson).value == Approx(6.25 / std::sqrt(8.1875 * 5)));
    CHECK(analysis.predictions[1].points == 3); // FV of a1 is not known
    CHECK(isMentioned(analysis, "1 point has no value of FV and is left out"));
    CHECK(analysis.predictions[2].of(CorrelationKind::Spearman).value == Approx(-1));
    REQUIRE(analysis.differences.size() == 3);
    CHECK(analysis.differences[0].value == Approx(0).margin(1e-12)); // VWS and FV, over three points
    CHECK(analysis.differences[0].points == 3);
    CHECK(analysis.differences[1].value == Approx(2)); // VWS and 2DFS
    CHECK(analysis.differences[1].interval.low == Approx(2));
}

TEST_CASE("an interval is of the pictures: showing each twice does not narrow it", "[study]") {
    // Where both showings have the same opinions, the ranks are the same twice, and so is every resample.
    const Study study = studyWith({0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
    const Scores scores{1, 3, 2, 5, 4, 4};
    const Correlation
        once = analyzeStudy(study, {someone("p1", scores)}).predictions[0].of(CorrelationKind::Spearman),
        twice = analyzeStudy(study, {someone("p1", scores, scores)}).predictions[0].of(CorrelationKind::Spearman);
    CHECK(twice.value == Approx(once.value).margin(1e-12));
    CHECK(twice.interval.low == Approx(once.interval.low).margin(1e-12));
    CHECK(twice.interval.high == Approx(once.interval.high).margin(1e-12));
    CHECK(once.interval.low < once.value);
}

TEST_CASE("what cannot be told is said", "[study]") {
    const Participant two = someone("p1", {1, 4}, {2, 5}), three = someone("p1", {1, 4, 5});
    const StudyAnalysis few = analyzeStudy(studyWith({0.1, 0.2}), {two});
    CHECK(few.points.size() == 4);
    CHECK(std::isnan(few.predictions[0].of(CorrelationKind::Spearman).value));
    CHECK(isMentioned(few, "Only 2 scored pictures have a value of VWS"));
    CHECK(isMentioned(few, "Only 0 scored pictures have a value of FV"));
    CHECK(std::isnan(few.differences[0].value));
    CHECK(std::isnan(few.mostDifference)); // two pairs tell nothing
    CHECK(std::isnan(few.alpha));
    const StudyAnalysis equal = analyzeStudy(studyWith({0.2, 0.2, 0.2}), {three});
    CHECK(std::isnan(equal.predictions[0].of(CorrelationKind::Spearman).value));
    CHECK(isMentioned(equal, "are equal"));
    // The study once had a third picture.
    CHECK(isMentioned(analyzeStudy(studyWith({0.1, 0.2}), {three}), "1 answer is about a picture that the study"));
}

TEST_CASE("features of a volume have their points in the order of VWS", "[study]") {
    Study study = studyWith({0.4, 0.1, 0.3, 0.2, std::nullopt});
    study.stimuli[3].feature = "f2"; // a3
    study.stimuli[4].data.clear();   // a4
    study.stimuli[4].session = "folder/foot.pellucid.json";
    study.stimuli[4].label = "RED";
    const StudyAnalysis analysis = analyzeStudy(study, {someone("p1", {5, 1, 4, 2, 3}, {4})});
    REQUIRE(analysis.features.size() == 3);
    CHECK(analysis.features[0].volume == "tooth");
    CHECK(analysis.features[0].feature == "f1");
    // Points: a1, a1 again, a2, a3, a4, a5. Without a5, whose VWS is not known: a2, a1, a1 again.
    CHECK(analysis.features[0].points == std::vector<std::size_t>{2, 0, 1});
    CHECK(analysis.features[1].points == std::vector<std::size_t>{3});
    CHECK(analysis.features[2].volume == "foot.pellucid.json");
    CHECK(analysis.features[2].word == "RED");
}
