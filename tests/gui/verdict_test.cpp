// What the window says of targets that are out of reach.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QLabel>
#include <QToolButton>

#include "controllers/optimize_controller.h"

using namespace pellucid;
using namespace pellucid::gui;

TEST_CASE("a target that a locked feature keeps out of reach is explained", "[verdict]") {
    OpenWindow w;
    w.child<QCheckBox>("exactSharesCheck").click();
    // f1 is the outermost shell. Solid and locked, it hides the others.
    w.document().setTf(withFeatureOpacities(w.document().tf(), {0.95, 0.5, 0.5}), "solid");
    const FeatureId outermost = w.document().tf().features[0].id;
    w.document().store().edit("lock", {}, [&](Session& session) {
        session.goals.edit([&](FeatureGoals& goals) { goals[outermost].locked = true; });
    });
    w.document().setTargets({0.1, 0.3, 0.6});
    w.settle();
    auto& message = w.child<QLabel>("panelMessage");
    w.child<QAction>("optimizeAction").trigger();
    w.settle();
    CHECK(message.isVisible());
    CHECK(message.text().startsWith("Out of reach: the nearest is off target by "));
    CHECK(message.text().contains("f1 is locked at opacity 0.95; unlocked, the targets are reached"));
    CHECK(message.text().contains("f1 hides"));
    CHECK(featureOpacities(w.document().tf())[0] == Approx(0.95).margin(1e-6));
    const QImage before = w.picture();
    // What helps is a button away: the shares in reach as targets, or the lock opened and the search made anew.
    auto& use = w.child<QToolButton>("messageChoice0");
    const std::vector<double> reached = [&] {
        std::vector<double> shares;
        for (const FeatureMeasures& m : w.document().measures()->features) shares.push_back(m.vws);
        return shares;
    }();
    CHECK(use.text() == QString("Use %1/%2/%3 %")
                            .arg(std::lround(100 * reached[0]))
                            .arg(std::lround(100 * reached[1]))
                            .arg(std::lround(100 * reached[2])));
    CHECK(w.child<QToolButton>("messageChoice1").text() == "Unlock f1");
    use.click();
    w.settle();
    for (std::size_t f = 0; f < 3; ++f) CHECK(w.document().targets()[f] == Approx(reached[f]).margin(0.005));
    CHECK_FALSE(message.isVisible());
    w.document().undo();
    CHECK(w.document().targets()[2] == Approx(0.6));
    w.child<QAction>("optimizeAction").trigger();
    w.settle();
    w.child<QToolButton>("messageChoice1").click();
    w.settle();
    CHECK(message.text().startsWith("On target"));
    w.document().undo(); // the search
    w.document().undo(); // the lock
    CHECK(w.services().store().session().goals->at(outermost).locked);

    // It is true of this state; whatever changes, it goes.
    w.document().store().edit("unlock", {}, [&](Session& session) {
        session.goals.edit([&](FeatureGoals& goals) { goals[outermost].locked = false; });
    });
    w.child<QAction>("optimizeAction").trigger();
    w.settle();
    CHECK(message.text().startsWith("On target"));
    CHECK(*w.services().results().objective() < 0.03);
    CHECK(w.picture() != before);
    w.document().setTarget(0, 0.5);
    w.settle();
    CHECK_FALSE(message.isVisible());
}

TEST_CASE("a feature without voxels can be removed by the button that says so", "[verdict]") {
    OpenWindow w;
    TransferFunction tf = w.document().tf();
    const std::size_t count = tf.features.size();
    // The shells have whole values of 8 bits only: between two of them there is nothing.
    Feature nothing;
    nothing.name = "nothing";
    nothing.a = 0.0005;
    nothing.b = 0.001;
    tf.features[0].a = 0.002;
    tf.features.insert(tf.features.begin(), nothing);
    w.document().setTf(tf, "empty");
    w.settle();
    auto& button = w.child<QToolButton>("removeEmptyButton");
    REQUIRE(w.services().scene().isEmpty(0));
    CHECK(button.isVisible());
    CHECK(w.child<QLabel>("emptyFeatureLabel").text().startsWith("nothing is empty"));
    button.click();
    CHECK(w.document().tf().features.size() == count);
    CHECK_FALSE(button.isVisible());
    w.document().undo();
    CHECK(w.document().tf().features.size() == count + 1);
    CHECK(button.isVisible());
}
