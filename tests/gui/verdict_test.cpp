// What the window says of targets that are out of reach.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QLabel>

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
