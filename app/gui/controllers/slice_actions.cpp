#include "controllers/menu_actions.h"

#include "services/services.h"
#include "store/view_edits.h"

namespace pellucid::gui {
namespace {

using Layout = SliceViews::Layout;

} // namespace

void addSliceActions(Services& services) {
    SessionStore& store = services.store();
    Actions& actions = services.actions();
    ActionMenu menu(actions, QObject::tr("&View") + "/" + QObject::tr("La&yout"),
                    [&services] { return services.isEditable(); });
    int key = 1;
    const auto addLayout = [&](Layout layout, const char* id, const QString& text, const QString& tip) {
        menu.addCheck(
            id, text, QStringLiteral("Ctrl+Shift+%1").arg(key++), tip,
            [&store, layout] { return store.session().slices->layout == layout; },
            [&store, layout] { setLayout(store, layout); }, true);
    };
    addLayout(Layout::Volume, "layoutVolumeAction", QObject::tr("&Volume"), QObject::tr("The volume alone"));
    addLayout(Layout::Four, "layoutFourAction", QObject::tr("&Four views"),
              QObject::tr("The volume and three slices through it, all of one size"));
    addLayout(Layout::VolumeLarge, "layoutVolumeLargeAction", QObject::tr("Volume and &slices"),
              QObject::tr("The volume large, three slices small beside it"));
    menu.separate();
    menu.add("centreCrosshairAction", QObject::tr("&Crosshair to the middle"), {},
             QObject::tr("The slices through the middle of the volume"),
             [&store] { moveCrosshair(store, Vec3(store.scene().volume->dims() / 2)); },
             {.enabled = [&store] { return store.hasVolume(); }});
    menu.add("resetGreyWindowAction", QObject::tr("&Reset the window of grey"), {},
             QObject::tr("Black and white of the slices at the ends of the range of values that the transfer function "
                         "covers"),
             [&store] { resetGreyWindow(store); }, {.enabled = [&services] {
                 return services.isEditable() && services.scene().session.slices->window.has_value();
             }});
    const QString slices = QObject::tr("Slices");
    actions.addGestures(
        {{slices, QObject::tr("Left drag"), QObject::tr("move the crosshair")},
         {slices, QObject::tr("Wheel, Page Up and Down, arrow keys; with Shift"),
          QObject::tr("next slice; ten further")},
         {slices, QObject::tr("Right drag across, up and down"), QObject::tr("window and level of grey")},
         {slices, QObject::tr("Right double-click"), QObject::tr("reset the window of grey")},
         {slices, QObject::tr("Ctrl + wheel, + and −"), QObject::tr("zoom")},
         {slices, QObject::tr("Middle drag, Shift + left drag"), QObject::tr("pan")},
         {slices, QObject::tr("Double-click; on the title"), QObject::tr("fit; one view alone, and back")}});
}

} // namespace pellucid::gui
