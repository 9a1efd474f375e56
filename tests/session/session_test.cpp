// The session as a value: who a feature is, what belongs to it, and what copies share.
#include <catch2/catch.hpp>

#include <numeric>

#include "session/session.h"
#include "support/random_sessions.h"

using namespace pellucid;

namespace {

Feature feature(const std::string& name, double a, double b, FeatureId id = 0) {
    Feature f{name, a, b, {1, 0, 0}, {}};
    f.id = id;
    return f;
}

TransferFunction tfOf(std::vector<Feature> features) {
    TransferFunction tf;
    tf.features = std::move(features);
    return tf;
}

Session opened() {
    Session s;
    s.variables = std::vector<Variable>(1);
    return s;
}

std::vector<FeatureId> idsOf(const Session& s) {
    std::vector<FeatureId> ids;
    for (const Feature& f : s.tf()->features) ids.push_back(f.id);
    return ids;
}

std::vector<double> targetsIn(const Session& s) { return targetsOf(*s.tf(), *s.goals); }

void setTargets(Session& s, const std::vector<double>& targets) { s.goals = withTargets(*s.goals, *s.tf(), targets); }

using Ids = std::vector<FeatureId>;

} // namespace

TEST_CASE("an empty session has no transfer function", "[session]") { CHECK(Session{}.tf() == nullptr); }

TEST_CASE("features get identities that are never used again", "[session]") {
    Session s = opened();
    s.setTf(tfOf({feature("a", 0, 0.1), feature("b", 0.2, 0.3)}));
    CHECK(idsOf(s) == Ids{1, 2});
    s.setTf(tfOf({feature("a", 0, 0.1)}));
    s.setTf(tfOf({feature("a", 0, 0.1), feature("c", 0.4, 0.5)})); // 2 has gone, and is not c
    CHECK(idsOf(s) == Ids{1, 3});
    // Nor after its goal is lost, as long as another key frame knows it.
    s.frame = 5;
    s.variables.edit([](std::vector<Variable>& all) {
        all[0].track.keys[5] = Part<TransferFunction>(tfOf({feature("z", 0, 1, 40)}));
    });
    s.setTf(tfOf({feature("new", 0.6, 0.7)}));
    CHECK(idsOf(s) == Ids{41});
}

TEST_CASE("a feature without identity is the one of its name and interval, then name, then interval", "[session]") {
    Session s = opened();
    s.setTf(tfOf({feature("a", 0, 0.1, 11), feature("a", 0.2, 0.3, 12), feature("b", 0.4, 0.5, 13)}));
    SECTION("name and interval before name alone") {
        s.setTf(tfOf({feature("a", 0.2, 0.3), feature("a", 0.6, 0.7)}));
        CHECK(idsOf(s) == Ids{12, 11});
    }
    SECTION("name before interval") {
        s.setTf(tfOf({feature("c", 0.4, 0.5), feature("b", 0.6, 0.7)}));
        CHECK(idsOf(s) == Ids{14, 13}); // 13 went by its name, so that its place is free
    }
    SECTION("interval") {
        s.setTf(tfOf({feature("renamed", 0.4, 0.5)}));
        CHECK(idsOf(s) == Ids{13});
    }
    SECTION("an identity that is given stays") {
        s.setTf(tfOf({feature("b", 0.4, 0.5, 12), feature("a", 0.2, 0.3)}));
        CHECK(idsOf(s) == Ids{12, 11});
    }
    SECTION("a copy is another feature") {
        s.setTf(tfOf({feature("a", 0, 0.1, 11), feature("copy", 0.1, 0.2, 11)}));
        CHECK(idsOf(s)[0] == 11);
        CHECK(idsOf(s)[1] > 13);
    }
    SECTION("nobody has two") {
        s.setTf(tfOf({feature("b", 0.6, 0.7), feature("b", 0.8, 0.9)}));
        CHECK(idsOf(s)[0] == 13);
        CHECK(idsOf(s)[1] > 13);
    }
}

TEST_CASE("equal features that are other ones replace those that were there", "[session]") {
    Session s = opened();
    s.setTf(tfOf({feature("a", 0, 0.1, 1), feature("b", 0.2, 0.3, 2)}));
    s.setTf(tfOf({feature("a", 0, 0.1, 5), feature("b", 0.2, 0.3, 6)}));
    CHECK(idsOf(s) == Ids{5, 6});
}

TEST_CASE("goals follow a feature through names, intervals and presets", "[session]") {
    Session s = opened();
    s.setTf(tfOf({feature("skin", 0, 0.1), feature("muscle", 0.2, 0.3), feature("bone", 0.4, 0.5)}));
    setTargets(s, {0.2, 0.3, 0.5});
    s.goals.edit([](FeatureGoals& all) { all.at(3).locked = true; });

    TransferFunction tf = *s.tf();
    tf.features[2].name = "Knochen";
    s.setTf(tf);
    CHECK(targetsIn(s) == std::vector{0.2, 0.3, 0.5});
    tf.features[2].a = 0.45;
    tf.features[0].color = {0, 0, 1};
    s.setTf(tf);
    CHECK(targetsIn(s) == std::vector{0.2, 0.3, 0.5});
    std::swap(tf.features[0], tf.features[2]);
    s.setTf(tf);
    CHECK(targetsIn(s) == std::vector{0.5, 0.3, 0.2});

    // A preset, and back: as a file that says nothing of identities.
    const Ids before = idsOf(s);
    TransferFunction file = tf;
    for (Feature& f : file.features) f.id = 0;
    s.setTf(tents(4));
    CHECK(targetsIn(s) == std::vector<double>(4, 0.25));
    setTargets(s, {0.1, 0.1, 0.1, 0.7});
    s.setTf(file);
    CHECK(idsOf(s) == before);
    CHECK(targetsIn(s) == std::vector{0.5, 0.3, 0.2});
    CHECK(s.goals->at(before[0]).locked);
    s.setTf(tents(4));
    CHECK(targetsIn(s) == std::vector{0.1, 0.1, 0.1, 0.7});
    // Fewer tents, and more again: the fourth comes back.
    s.setTf(tents(3));
    s.setTf(tents(4));
    CHECK(targetsIn(s)[3] == 0.7);
}

TEST_CASE("a new feature is wanted as much as the others on average", "[session]") {
    Session s = opened();
    s.setTf(tfOf({feature("a", 0, 0.1), feature("b", 0.2, 0.3)}));
    CHECK(targetsIn(s) == std::vector{0.5, 0.5});
    setTargets(s, {30, 10}); // only proportions count
    s.setTf(tfOf({feature("a", 0, 0.1), feature("b", 0.2, 0.3), feature("c", 0.4, 0.5)}));
    CHECK(targetsIn(s)[0] == Approx(0.5));
    CHECK(targetsIn(s)[1] == Approx(1 / 6.0));
    CHECK(targetsIn(s)[2] == Approx(1 / 3.0)); // 20 of 60
}

TEST_CASE("targets are shares", "[session]") {
    const TransferFunction tf = tfOf({feature("a", 0, 0.1, 1), feature("b", 0.2, 0.3, 2), feature("c", 0.4, 0.5, 3)});
    const auto goals = [](std::vector<std::pair<FeatureId, double>> targets) {
        FeatureGoals all;
        for (const auto& [id, t] : targets) all[id].target = t;
        return all;
    };
    CHECK(targetsOf(tf, goals({{1, 0.5}, {2, 0.25}, {3, 0.25}})) == std::vector{0.5, 0.25, 0.25});
    CHECK(targetsOf(tf, goals({{1, 2}, {2, 1}, {3, 1}, {4, 100}})) == std::vector{0.5, 0.25, 0.25});
    CHECK(targetsOf(tf, goals({{1, 2}, {2, 4}})) == std::vector{2 / 9.0, 4 / 9.0, 3 / 9.0}); // the mean of 2 and 4
    const std::vector<double> equal(3, 1 / 3.0);
    CHECK(targetsOf(tf, {}) == equal);
    CHECK(targetsOf(tf, goals({{1, 0}, {2, 0}, {3, 0}})) == equal);
    CHECK(targetsOf(tfOf({}), goals({{1, 1}})).empty());
    // Bits stay: what withTargets() has stored comes back.
    const std::vector<double> odd{0.1 + 0.2, 0.1, 0.6};
    CHECK(targetsOf(tf, withTargets({}, tf, odd)) == odd);
    // The smallest and largest that files may hold
    for (const double t : {5e-324, kLargestTarget}) {
        const auto shares = targetsOf(tf, goals({{1, t}, {2, t}, {3, t}}));
        CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == Approx(1));
    }
}

TEST_CASE("one target is set, the others share the rest as before", "[session]") {
    CHECK(withTarget({0.2, 0.3, 0.5}, 2, 0.0)[0] == Approx(0.4));
    CHECK(withTarget({0.2, 0.3, 0.5}, 2, 0.0)[1] == Approx(0.6));
    CHECK(withTarget({0.2, 0.3, 0.5}, 0, 1.5) == std::vector{1.0, 0.0, 0.0});
    CHECK(withTarget({1.0, 0.0, 0.0}, 0, 0.5) == std::vector{0.5, 0.25, 0.25}); // nothing to go by
    CHECK(withTarget({1.0}, 0, 0.5) == std::vector{1.0});
    CHECK(withTarget({0.5, 0.5}, 7, 0.5) == std::vector{0.5, 0.5});
    test::Random random(3);
    for (int n = 0; n < 200; ++n) {
        std::vector<double> t(static_cast<std::size_t>(1 + random.below(6)), 0.0);
        for (double& each : t) each = random.unit();
        for (double& each : t) each /= std::accumulate(t.begin(), t.end(), 0.0);
        const auto changed = withTarget(t, static_cast<std::size_t>(random.below(6)), random.unit());
        for (const double each : changed) CHECK((each >= 0 && each <= 1));
    }
}

TEST_CASE("a part that an edit leaves as it was stays the same part", "[session]") {
    Session a = opened();
    a.setTf(tents(3));
    Session b = a;
    CHECK(b == a);
    CHECK(b.variables.isSame(a.variables));
    b.display.edit([](DisplaySettings& d) { d.light.on = false; });
    CHECK(b.display.isSame(a.display));
    b.measure.set(MeasureSettings{});
    CHECK(b.measure.isSame(a.measure));
    b.setTf(*a.tf());
    CHECK(b.variables.isSame(a.variables));
    CHECK(b.goals.isSame(a.goals));

    b.display.edit([](DisplaySettings& d) { d.light.on = true; });
    CHECK_FALSE(b.display.isSame(a.display));
    CHECK_FALSE(b == a);
    CHECK_FALSE(a.display->light.on); // the copy has its own
    b.display.edit([](DisplaySettings& d) { d.light.on = false; });
    CHECK(b == a); // equal again, though not the same
    CHECK_FALSE(b.display.isSame(a.display));
    CHECK(Part<Clipping>().isSame(Part<Clipping>()));
}

TEST_CASE("a transfer function holds from its key frame to the next", "[session]") {
    TfTrack track;
    CHECK(track.at(0) == nullptr);
    const auto named = [](const char* name) { return Part<TransferFunction>(tfOf({feature(name, 0, 1)})); };
    track.keys = {{2, named("two")}, {5, named("five")}};
    const auto nameAt = [&](int frame) { return track.at(frame)->features[0].name; };
    CHECK(nameAt(-1) == "two"); // the first, before there is any
    CHECK(nameAt(0) == "two");
    CHECK(nameAt(2) == "two");
    CHECK(nameAt(4) == "two");
    CHECK(nameAt(5) == "five");
    CHECK(nameAt(1000) == "five");
}

TEST_CASE("one key is that of all frames, among several the present frame becomes one", "[session]") {
    Session s = opened();
    s.frame = 7;
    s.setTf(tents(1)); // the first key holds from the beginning
    CHECK(s.variable().track.keys.count(0) == 1);
    s.variables.edit([](std::vector<Variable>& all) { all[0].track.keys[5] = Part<TransferFunction>(tents(2)); });
    s.setTf(tents(4));
    CHECK(s.variable().track.keys.size() == 3);
    CHECK(s.tf()->features.size() == 4);
    s.frame = 6; // of the key at 5: what has other features is not gone to evenly
    CHECK(s.tf()->features.size() == 2);
    s.frame = 4;
    CHECK(s.tf()->features.size() == 1);
}

TEST_CASE("features of a session without identities get them, the same in all key frames", "[session]") {
    Session s = opened();
    s.variables.edit([](std::vector<Variable>& all) {
        all[0].track.keys[0] = Part<TransferFunction>(tfOf({feature("a", 0, 0.1), feature("b", 0.2, 0.3, 9)}));
        all[0].track.keys[5] = Part<TransferFunction>(tfOf({feature("b", 0.3, 0.4), feature("a", 0, 0.2)}));
    });
    s.identifyFeatures();
    const Ids first = idsOf(s);
    CHECK(first == Ids{10, 9});
    s.frame = 5;
    CHECK(idsOf(s) == Ids{9, 10});
    const Session before = s;
    s.identifyFeatures();
    CHECK(s.variables.isSame(before.variables));
}

TEST_CASE("the latest runs are kept", "[session]") {
    Session s;
    for (int i = 0; i < static_cast<int>(kMostRuns) + 5; ++i) {
        Run run;
        run.iterations = i;
        s.addRun(run);
    }
    CHECK(s.runs->size() == kMostRuns);
    CHECK(s.runs->front().iterations == 5);
    CHECK(s.runs->back().iterations == static_cast<int>(kMostRuns) + 4);
}
