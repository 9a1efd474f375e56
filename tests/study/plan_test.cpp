#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "study/plan.h"
#include "support/study_cases.h"

using namespace pellucid;
using pellucid::test::studyOf;

namespace {

std::set<std::size_t> repeatedIn(const std::vector<PlannedTrial>& plan) {
    std::set<std::size_t> repeated;
    for (const PlannedTrial& t : plan)
        if (t.repeat) repeated.insert(t.stimulus);
    return repeated;
}

} // namespace

TEST_CASE("a plan shows training first, each stimulus once and as many twice as asked for", "[study]") {
    for (const int count : {2, 3, 5, 27})
        for (const int repeats : {0, 1, 2, count})
            for (int person = 0; person < 50; ++person) {
                if (repeats > count) continue;
                const Study study = studyOf(2, count, repeats);
                const auto plan = planOf(study, "p" + std::to_string(person));
                INFO(count << " stimuli, " << repeats << " repeats, person " << person);
                REQUIRE(plan.size() == static_cast<std::size_t>(2 + count + repeats));
                std::map<std::size_t, int> shown;
                for (std::size_t i = 0; i < plan.size(); ++i) {
                    CHECK(plan[i].trial == static_cast<int>(i) + 1);
                    CHECK(plan[i].training == (i < 2));
                    CHECK(plan[i].training == study.stimuli[plan[i].stimulus].training);
                    CHECK(plan[i].repeat == (shown[plan[i].stimulus] == 1)); // the second of two
                    ++shown[plan[i].stimulus];
                    if (i > 0) CHECK(plan[i].stimulus != plan[i - 1].stimulus);
                }
                CHECK(shown.size() == study.stimuli.size());
                CHECK(repeatedIn(plan).size() == static_cast<std::size_t>(repeats));
                for (const auto& [stimulus, times] : shown) CHECK(times <= 2);
                CHECK(plan[0].stimulus == 0); // training in the order of the study
                CHECK(plan[1].stimulus == 1);
            }
}

TEST_CASE("an order follows from seed and participant, what is repeated from the seed alone", "[study]") {
    Study study = studyOf(0, 12, 4);
    const auto plan = planOf(study, "anna");
    CHECK(planOf(study, "anna") == plan);
    CHECK(planOf(study, "ben") != plan);
    CHECK(repeatedIn(planOf(study, "ben")) == repeatedIn(plan));
    study.seed = 2;
    CHECK(planOf(study, "anna") != plan);
    CHECK(repeatedIn(planOf(study, "anna")) != repeatedIn(plan));
}

TEST_CASE("an order is the same on every machine", "[study]") {
    // Written down once: whoever resumes elsewhere must find the same trials.
    std::string order;
    for (const PlannedTrial& t : planOf(studyOf(1, 5, 2), "p1"))
        order += std::to_string(t.stimulus) + (t.repeat ? "' " : " ");
    CHECK(order == "0 4 3 2 4' 3' 1 5 ");
}

TEST_CASE("every order is as likely", "[study]") {
    // Each of 4 stimuli is the first in 250 of 1000 orders, with a standard deviation of √(1000·¼·¾) ≈ 13.7; 5 of
    // those.
    std::map<std::size_t, int> first;
    const Study study = studyOf(0, 4);
    for (int person = 0; person < 1000; ++person) ++first[planOf(study, std::to_string(person)).front().stimulus];
    for (const auto& [stimulus, times] : first) CHECK(std::abs(times - 250) < 69);
}

TEST_CASE("pauses come after the training and after so many trials", "[study]") {
    Study study = studyOf(2, 6);
    study.pauseEvery = 3;
    const auto plan = planOf(study, "p");
    std::string pauses;
    for (std::size_t i = 0; i <= plan.size(); ++i) pauses += isPauseBefore(study, plan, i) ? '|' : '-';
    CHECK(pauses == "--|--|---"); // 2 of training, 3, 3, the end
    study.pauseEvery = 0;
    CHECK(isPauseBefore(study, plan, 2));
    CHECK_FALSE(isPauseBefore(study, plan, 5));
    CHECK_FALSE(isPauseBefore(studyOf(0, 3), planOf(studyOf(0, 3), "p"), 0));
}
