#include "controllers/controllers.h"

#include "controllers/menu_actions.h"
#include "controllers/tf_exchange_controller.h"
#include "services/services.h"

namespace pellucid::gui {
namespace {

void addEditActions(Services& services) {
    const SessionStore& store = services.store();
    ActionMenu menu(services.actions(), QObject::tr("&Edit"));
    menu.add(
        "undoAction", QObject::tr("&Undo"), "Ctrl+Z", {}, [&services] { services.undo(); },
        {.enabled = [&services, &store] { return !services.isReadOnly() && store.canUndo(); },
         .say =
             [&store] { return store.canUndo() ? QObject::tr("Undo: %1").arg(store.undoText()) : QObject::tr("Undo"); },
         .inToolBar = true});
    menu.add(
        "redoAction", QObject::tr("&Redo"), "Ctrl+Shift+Z; Ctrl+Y", {}, [&services] { services.redo(); },
        {.enabled = [&services, &store] { return !services.isReadOnly() && store.canRedo(); },
         .say =
             [&store] { return store.canRedo() ? QObject::tr("Redo: %1").arg(store.redoText()) : QObject::tr("Redo"); },
         .inToolBar = true});
}

} // namespace

Controllers::Controllers(Services& all) : services(all) {
    // The menus stand in the order in which their first actions come.
    opening.addActions();
    overlays.addActions();
    saving.addActions();
    addTfExchangeActions(services, opening);
    figures.addActions();
    films.addActions();
    sharing.addActions();
    studies.addActions();
    addEditActions(services);
    orientation.addActions();
    starting.addActions();
    features.addActions();
    refining.addActions();
    targets.addActions();
    optimizing.addActions();
    live.addActions();
    addViewActions(services);
    addAnnotationActions(services);
    fields.addActions();
    pictureSaliency.addActions();
    comparing.addActions();
    addSliceActions(services);
    player.addActions();
    adapting.addActions();
    keyframes.addActions();
    addThemeActions(services);
    addVisionActions(services);
    clipHandles = &addClipHandlesAction(services);
    probe.addActions();
    rulers.addActions();

    SessionStore& store = services.store();
    Actions& actions = services.actions();
    QObject::connect(&store, &SessionStore::historyChanged, &actions, &Actions::refresh);
    QObject::connect(&store, &SessionStore::changed, &actions, &Actions::refresh);
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
    watch(figures, &FigureController::busyChanged);
    watch(films, &FilmController::busyChanged);
    watch(sharing, &ShareController::busyChanged);
    watch(fields, &FieldController::busyChanged);
    watch(pictureSaliency, &PictureSaliencyController::busyChanged);
    watch(rulers, &RulerController::busyChanged);
    // Clicks are for one of the two.
    QObject::connect(&rulers, &RulerController::placingChanged, &probe, &ProbeController::clear);
    watch(comparing, &ComparisonController::busyChanged);
    QObject::connect(&refining, &RefineController::pairWanted, &comparing,
                     &ComparisonController::compareWithRefinement);
    watch(player, &PlayerController::changed);
    watch(studies, &StudyController::busyChanged);
    watch(adapting, &AdaptController::changed);
}

Controllers::~Controllers() { // what ends now must not be heard by what has ended already
    services.store().disconnect();
    services.results().disconnect();
}

} // namespace pellucid::gui
