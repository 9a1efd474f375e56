#include "controllers/view_actions.h"

#include "render/camera_motion.h"
#include "workbench.h"

namespace pellucid::gui {

void fitView(SessionStore& store) {
    if (store.hasVolume()) store.setCamera(fitted(store.scene().camera, store.scene().volume->geometry()));
}

void resetView(SessionStore& store) {
    if (store.hasVolume())
        store.setCamera(homeCamera(store.scene().volume->geometry(), store.scene().camera.projection));
}

void setStandardView(SessionStore& store, StandardView view) {
    if (!store.hasVolume()) return;
    double azimuth = 0, elevation = 0;
    switch (view) {
    case StandardView::Front:
        break;
    case StandardView::Back:
        azimuth = 180;
        break;
    case StandardView::Left:
        azimuth = -90;
        break;
    case StandardView::Right:
        azimuth = 90;
        break;
    case StandardView::Top:
        elevation = 90;
        break;
    case StandardView::Bottom:
        elevation = -90;
        break;
    }
    store.setCamera(
        standardCamera(store.scene().volume->geometry(), azimuth, elevation, store.scene().camera.projection));
}

void setProjection(SessionStore& store, Projection projection) {
    if (!store.hasVolume()) return;
    store.setCamera(withProjection(store.scene().camera, store.scene().volume->geometry(), projection));
}

void zoomView(SessionStore& store, double factor, int gesture) {
    if (store.hasVolume())
        store.setCamera(zoomed(store.scene().camera, store.scene().volume->geometry(), factor), gesture);
}

void addViewActions(Workbench& bench) {
    SessionStore& store = bench.store();
    Actions& actions = bench.actions();
    const QString menu = QObject::tr("&View");
    const auto open = [&store] { return store.hasVolume(); };
    const auto add = [&](const QString& id, const QString& text, const QList<QKeySequence>& keys, const QString& tip,
                         std::function<void()> trigger, bool separator = false) {
        actions.add({.id = id,
                     .menu = menu,
                     .text = text,
                     .keys = keys,
                     .tip = tip,
                     .trigger = std::move(trigger),
                     .enabled = open,
                     .separatorBefore = separator,
                     .inToolBar = true});
    };
    add("fitAction", QObject::tr("&Fit"), {QKeySequence("R"), QKeySequence("F")},
        QObject::tr("The whole volume from the same direction; double-click does the same"),
        [&store] { fitView(store); });
    add("resetViewAction", QObject::tr("&Reset"), {QKeySequence("Home")},
        QObject::tr("The view that the volume opened with"), [&store] { resetView(store); });
    const std::pair<QString, StandardView> views[] = {
        {QObject::tr("Front"), StandardView::Front}, {QObject::tr("Back"), StandardView::Back},
        {QObject::tr("Left"), StandardView::Left},   {QObject::tr("Right"), StandardView::Right},
        {QObject::tr("Top"), StandardView::Top},     {QObject::tr("Bottom"), StandardView::Bottom}};
    int key = 1;
    for (const auto& [text, view] : views) {
        const QString number = QString::number(key);
        add(
            "view" + number, text, {QKeySequence(number)}, QObject::tr("Look from this side"),
            [&store, side = view] { setStandardView(store, side); }, key == 1);
        ++key;
    }
    actions.add({.id = "perspectiveAction",
                 .menu = menu,
                 .text = QObject::tr("&Perspective"),
                 .keys = {QKeySequence("P")},
                 .tip = QObject::tr("Perspective or parallel projection"),
                 .trigger =
                     [&store] {
                         const bool perspective = store.scene().camera.projection == Projection::Perspective;
                         setProjection(store, perspective ? Projection::Orthographic : Projection::Perspective);
                     },
                 .enabled = open,
                 .checked = [&store] { return store.scene().camera.projection == Projection::Perspective; },
                 .separatorBefore = true,
                 .inToolBar = true});
    actions.add({.id = "undoViewAction",
                 .menu = menu,
                 .text = QObject::tr("&Previous view"),
                 .keys = {QKeySequence("Alt+Left")},
                 .tip = QObject::tr("Where the eye was before it moved last"),
                 .trigger = [&store] { store.undoCamera(); },
                 .enabled = [&store] { return store.canUndoCamera(); },
                 .separatorBefore = true});
    actions.add({.id = "redoViewAction",
                 .menu = menu,
                 .text = QObject::tr("&Next view"),
                 .keys = {QKeySequence("Alt+Right")},
                 .trigger = [&store] { store.redoCamera(); },
                 .enabled = [&store] { return store.canRedoCamera(); }});
}

} // namespace pellucid::gui
