// Targets that are set with one word.
#include <catch2/catch.hpp>

#include <numeric>

#include "base/error.h"
#include "session/scene.h"
#include "session/target_presets.h"
#include "tf/shapes.h"

using namespace pellucid;

namespace {

/// Peaks at 1/8, 3/8, 5/8, 7/8; identities 1 to 4.
TransferFunction fourTents() {
    TransferFunction tf = tents(4, 0.5);
    for (std::size_t i = 0; i < 4; ++i) tf.features[i].id = static_cast<FeatureId>(i + 1);
    return tf;
}

FeatureGoals goalsOf(const std::vector<double>& targets) { return withTargets({}, fourTents(), targets); }

void checkShares(const std::vector<double>& is, const std::vector<double>& wanted) {
    REQUIRE(is.size() == wanted.size());
    for (std::size_t i = 0; i < is.size(); ++i) CHECK(is[i] == Approx(wanted[i]).margin(1e-12));
}

} // namespace

TEST_CASE("targets are equal, rise with the peaks, or are turned round", "[session][presets]") {
    const TransferFunction tf = fourTents();
    const FeatureGoals goals = goalsOf({0.1, 0.2, 0.3, 0.4});
    checkShares(presetTargets(TargetPreset::Equal, tf, goals), {0.25, 0.25, 0.25, 0.25});
    // 1 : 3 : 5 : 7, which sum to 16.
    checkShares(presetTargets(TargetPreset::Diagonal, tf, goals), {1 / 16.0, 3 / 16.0, 5 / 16.0, 7 / 16.0});
    checkShares(presetTargets(TargetPreset::InsideOut, tf, goals), {0.4, 0.3, 0.2, 0.1});
    // Equal shares in reverse order would be the same again.
    checkShares(presetTargets(TargetPreset::InsideOut, tf, {}), {7 / 16.0, 5 / 16.0, 3 / 16.0, 1 / 16.0});
    checkShares(targetsForOne(tf, goals, 2), {0, 0, 1, 0});
    checkShares(targetsByWeights(tf, goals, {0, 0, 0, 0}), {0.25, 0.25, 0.25, 0.25});
    CHECK(fromName<TargetPreset>("inside-out") == TargetPreset::InsideOut);
    CHECK_THROWS_AS(fromName<TargetPreset>("most"), UsageError);
}

TEST_CASE("locked targets stay under presets, hidden features get nothing", "[session][presets]") {
    TransferFunction tf = fourTents();
    FeatureGoals goals = withTargetLocked(goalsOf({0.1, 0.2, 0.3, 0.4}), tf, 1, true);
    // 0.8 is left for the first, third and fourth.
    checkShares(presetTargets(TargetPreset::Equal, tf, goals), {0.8 / 3, 0.2, 0.8 / 3, 0.8 / 3});
    // 1 : 5 : 7, which sum to 13.
    checkShares(presetTargets(TargetPreset::Diagonal, tf, goals), {0.8 / 13, 0.2, 4 / 13.0, 5.6 / 13});
    checkShares(presetTargets(TargetPreset::InsideOut, tf, goals), {0.4, 0.2, 0.3, 0.1});
    checkShares(targetsForOne(tf, goals, 3), {0, 0.2, 0, 0.8});
    tf.features[3].hidden = true;
    checkShares(presetTargets(TargetPreset::Equal, tf, goals), {0.4, 0.2, 0.4, 0});
}

TEST_CASE("a locked target keeps its share whatever becomes of the others", "[session][presets]") {
    const TransferFunction tf = fourTents();
    // Stored as proportions; the lock turns them into the shares that they are, 0.1 to 0.4.
    const FeatureGoals goals = withTargetLocked(goalsOf({1, 2, 3, 4}), tf, 3, true);
    checkShares(targetsOf(tf, goals), {0.1, 0.2, 0.3, 0.4});
    const std::vector<bool> held = heldTargets(tf, goals);
    CHECK(held == std::vector<bool>{false, false, false, true});
    // The second and third divide 1 − 0.4 − 0.35 as 2 : 3.
    checkShares(withTarget(targetsOf(tf, goals), 0, 0.35, held), {0.35, 0.1, 0.15, 0.4});
    checkShares(withTarget(targetsOf(tf, goals), 0, 0.9, held), {0.6, 0, 0, 0.4}); // as far as there is room
    // Its own target can be set; nobody but the locked ones could give way: nothing happens.
    checkShares(withTarget(targetsOf(tf, goals), 3, 0.7, held), {0.05, 0.1, 0.15, 0.7});
    checkShares(withTarget({0.5, 0.5}, 0, 0.2, {false, true}), {0.5, 0.5});
    // A feature more, wanted as much as the others on average: they give way, the locked one does not.
    FeatureGoals more = goals;
    more[5].target = 0.25;
    TransferFunction five = tents(5, 0.5);
    for (std::size_t i = 0; i < 5; ++i) five.features[i].id = static_cast<FeatureId>(i + 1);
    const auto shares = targetsOf(five, more);
    CHECK(shares[3] == Approx(0.4));
    CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == Approx(1));
    CHECK(shares[4] == Approx(0.6 * 0.25 / 0.85));
}

TEST_CASE("a feature's peak is where it is most opaque", "[session][presets]") {
    const TransferFunction tf = fourTents();
    CHECK(peakIntensity(tf, 1) == Approx(0.375));
    Shape plateau;
    plateau.kind = ShapeKind::Step;
    plateau.a = 0.2;
    plateau.b = 0.6;
    const AddedFeature added = withShapeAdded({}, plateau);
    CHECK(peakIntensity(added.tf, 0) == Approx(0.4)); // its middle
}

TEST_CASE("features without a voxel have no target, it comes back with their voxels", "[session][presets]") {
    // Frame 0 has the intensities 1/8 and 7/8 alone: tents 1 and 2 are empty there. Frame 1 has all four.
    SeriesListing listing;
    listing.declaredRange = ValueRange{0, 1};
    for (int f = 0; f < 2; ++f) {
        SeriesFrame frame;
        frame.source.path = "steps.raw";
        frame.source.step = f;
        listing.frames.push_back(frame);
    }
    Scene basis;
    basis.series = std::make_shared<TimeSeries>(listing, [](int frame, const JobControl&) {
        std::vector<float> values;
        for (int i = 0; i < 64; ++i)
            values.push_back(frame == 1 ? (2 * static_cast<float>(i % 4) + 1) / 8 : i % 2 == 0 ? 0.125f : 0.875f);
        return Volume(Geometry{{4, 4, 4}}, Samples(std::move(values)));
    });
    basis.session = sessionOf(listing.frames[0].source);
    basis.data = basis.series->load(0);
    basis.volume = std::make_shared<const Volume>(basis.data->withRange({0, 1}));
    Session session = basis.session;
    session.setTf(fourTents());
    session.goals.set(withTargets(*session.goals, *session.tf(), {0.1, 0.2, 0.3, 0.4}));
    const Scene scene = resolve(session, basis);
    for (std::size_t f = 0; f < 4; ++f) CHECK(scene.isEmpty(f) == (f == 1 || f == 2));
    checkShares(scene.targets(), {0.2, 0, 0, 0.8}); // 1 : 4
    const TransferFunction wanted = scene.wantedTf();
    checkShares(presetTargets(TargetPreset::Equal, wanted, *session.goals), {0.5, 0, 0, 0.5});
    checkShares(presetTargets(TargetPreset::Diagonal, wanted, *session.goals), {1 / 8.0, 0, 0, 7 / 8.0});
    checkShares(presetTargets(TargetPreset::InsideOut, wanted, *session.goals), {0.8, 0, 0, 0.2});
    checkShares(targetsForOne(wanted, *session.goals, 3), {0, 0, 0, 1});
    // What is stored for them stays: at another frame they are wanted again.
    session.goals.set(withTargets(*session.goals, wanted, {0.5, 0, 0, 0.5}));
    session.frame = 1;
    checkShares(resolve(session, scene).targets(), {0.5 / 1.5, 0.2 / 1.5, 0.3 / 1.5, 0.5 / 1.5});
}
