#include "controllers/menu_actions.h"
#include "services/services.h"
#include "store/view_edits.h"

namespace pellucid::gui {
namespace {

Frame frameOf(const SessionStore& store) {
    return store.hasVolume() ? store.scene().volume->geometry().frame : Frame::File;
}

QString captionOf(StandardView view, Frame frame) {
    const bool patient = frame == Frame::Patient;
    switch (view) {
    case StandardView::Front:
        return patient ? QObject::tr("Anterior") : QObject::tr("Front");
    case StandardView::Back:
        return patient ? QObject::tr("Posterior") : QObject::tr("Back");
    case StandardView::Left:
        return QObject::tr("Left");
    case StandardView::Right:
        return QObject::tr("Right");
    case StandardView::Top:
        return patient ? QObject::tr("Superior") : QObject::tr("Top");
    case StandardView::Bottom:
        return patient ? QObject::tr("Inferior") : QObject::tr("Bottom");
    }
    return {};
}

QString tipOf(StandardView view, Frame frame) {
    if (frame != Frame::Patient) return QObject::tr("Look from this side of the file's axes");
    switch (view) {
    case StandardView::Front:
        return QObject::tr("From the front of the patient, whose left is at the right");
    case StandardView::Back:
        return QObject::tr("From behind the patient, whose left is at the left");
    case StandardView::Left:
        return QObject::tr("From the patient's left, with the front at the left");
    case StandardView::Right:
        return QObject::tr("From the patient's right, with the front at the right");
    case StandardView::Top:
        return QObject::tr("From above the head, with the front up and the patient's left at the left");
    case StandardView::Bottom:
        return QObject::tr(
            "From the feet, with the front up and the patient's left at the right, as radiologists look");
    }
    return {};
}

} // namespace

void addViewActions(Services& services) {
    SessionStore& store = services.store();
    Actions& actions = services.actions();
    const QString menu = QObject::tr("&View");
    const auto open = [&store] { return store.hasVolume(); };
    const auto add = [&](const QString& id, const QString& text, const QString& keys, const QString& tip,
                         std::function<void()> trigger, bool separator = false) {
        actions.add(menu, id, text, keys, tip, std::move(trigger), open,
                    {.separatorBefore = separator, .inToolBar = true});
    };
    add("fitAction", QObject::tr("&Fit"), "R; F",
        QObject::tr("The whole volume from the same direction; double-click does the same"),
        [&store] { fitView(store); });
    add("resetViewAction", QObject::tr("&Reset"), "Home", QObject::tr("The view that the volume opened with"),
        [&store] { resetView(store); });
    int key = 1;
    for (const StandardView view : kStandardViews) {
        const QString number = QString::number(key);
        actions.add(menu, "view" + number, captionOf(view, Frame::File), number, {},
                    [&store, view] { setStandardView(store, view); }, open,
                    {.say = [&store, view] { return tipOf(view, frameOf(store)); },
                     .caption = [&store, view] { return captionOf(view, frameOf(store)); },
                     .separatorBefore = key == 1,
                     .inToolBar = true});
        ++key;
    }
    actions.add(menu, "perspectiveAction", QObject::tr("&Perspective"), "P",
                QObject::tr("Perspective or parallel projection"),
                [&store] {
                    const bool perspective = store.scene().camera.projection == Projection::Perspective;
                    setProjection(store, perspective ? Projection::Orthographic : Projection::Perspective);
                },
                open,
                {.checked = [&store] { return store.scene().camera.projection == Projection::Perspective; },
                 .separatorBefore = true,
                 .inToolBar = true});
    actions.add(
        menu, "undoViewAction", QObject::tr("&Previous view"), "Alt+Left",
        QObject::tr("Where the eye was before it moved last"), [&store] { store.undoCamera(); },
        [&store] { return store.canUndoCamera(); }, {.separatorBefore = true});
    actions.add(
        menu, "redoViewAction", QObject::tr("&Next view"), "Alt+Right", {}, [&store] { store.redoCamera(); },
        [&store] { return store.canRedoCamera(); });
}

QAction& addClipHandlesAction(Services& services) {
    const auto shown = std::make_shared<bool>(false);
    return *services.actions().add(
        QObject::tr("&View"), "clipHandlesAction", QObject::tr("Clip &handles"), "C",
        QObject::tr("Drag the faces of the box, or a plane, to cut the volume open; with "
                    "Shift the opposite face goes along; Esc gives up"),
        [shown] { *shown = !*shown; }, [&services] { return services.store().hasVolume(); },
        {.checked = [shown] { return *shown; }, .separatorBefore = true, .inToolBar = true});
}

} // namespace pellucid::gui
