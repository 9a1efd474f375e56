#include "controllers/controllers.h"

#include "controllers/menu_actions.h"
#include "services/services.h"

namespace pellucid::gui {
namespace {

void addEditActions(Services& services) {
    const SessionStore& store = services.store();
    const auto undoTip = [&store] {
        return store.canUndo() ? QObject::tr("Undo: %1").arg(store.undoText()) : QObject::tr("Undo");
    };
    const auto redoTip = [&store] {
        return store.canRedo() ? QObject::tr("Redo: %1").arg(store.redoText()) : QObject::tr("Redo");
    };
    services.actions().add(
        QObject::tr("&Edit"), "undoAction", QObject::tr("&Undo"), "Ctrl+Z", {}, [&services] { services.undo(); },
        [&services, &store] { return !services.isReadOnly() && store.canUndo(); }, {.say = undoTip, .inToolBar = true});
    services.actions().add(
        QObject::tr("&Edit"), "redoAction", QObject::tr("&Redo"), "Ctrl+Shift+Z; Ctrl+Y", {},
        [&services] { services.redo(); }, [&services, &store] { return !services.isReadOnly() && store.canRedo(); },
        {.say = redoTip, .inToolBar = true});
}

} // namespace

Controllers::Controllers(Services& all) : services(all) {
    // The menus stand in the order in which their first actions come.
    opening.addActions();
    saving.addActions();
    addEditActions(services);
    starting.addActions();
    addTfActions(services);
    features.addActions();
    refining.addActions();
    targets.addActions();
    optimizing.addActions();
    live.addActions();
    addViewActions(services);
    addAnnotationActions(services);
    fields.addActions();
    addSliceActions(services);
    player.addActions();
    adapting.addActions();
    addThemeActions(services);
    clipHandles = &addClipHandlesAction(services);
    probe.addActions();

    SessionStore& store = services.store();
    Actions& actions = services.actions();
    QObject::connect(&store, &SessionStore::historyChanged, &actions, &Actions::refresh);
    QObject::connect(&store, &SessionStore::changed, &actions, [&actions](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || before.tf.features.empty() != after.tf.features.empty() ||
            before.camera.projection != after.camera.projection ||
            before.session.reference != after.session.reference ||
            !before.session.slices.isSame(after.session.slices) || !before.session.field.isSame(after.session.field))
            actions.refresh();
    });
    services.setReadOnlyWhile([this] { return optimizing.isRunning(); });
    QObject::connect(&optimizing, &OptimizeController::runningChanged, &services, [this] {
        services.actions().refresh();
        Q_EMIT services.readOnlyChanged();
        Q_EMIT services.idleChanged();
    });
    const auto watch = [this](auto& controller, auto changed) {
        services.addWork([&controller] { return controller.isBusy(); });
        QObject::connect(&controller, changed, &services, &Services::idleChanged);
    };
    watch(optimizing, &OptimizeController::messageChanged);
    watch(opening, &OpenController::busyChanged);
    watch(refining, &RefineController::busyChanged);
    watch(live, &LiveController::busyChanged);
    watch(starting, &StartController::busyChanged);
    watch(saving, &SaveController::busyChanged);
    watch(fields, &FieldController::busyChanged);
    watch(player, &PlayerController::changed);
    watch(adapting, &AdaptController::changed);
}

Controllers::~Controllers() { // what ends now must not be heard by what has ended already
    services.store().disconnect();
    services.results().disconnect();
}

} // namespace pellucid::gui
