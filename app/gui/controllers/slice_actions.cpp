#include "controllers/menu_actions.h"

#include <QIcon>
#include <QPainter>
#include <QPixmap>

#include "services/services.h"
#include "store/view_edits.h"

namespace pellucid::gui {
namespace {

using Layout = SliceViews::Layout;

/// The places of the views in a small window.
QIcon iconOf(Layout layout) {
    QIcon icon;
    for (const int scale : {1, 2}) {
        QPixmap pixmap(20 * scale, 20 * scale);
        pixmap.setDevicePixelRatio(scale);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        painter.setPen(QPen(QColor(0x84, 0x88, 0x8e), 1.2)); // is seen on dark and on light
        const QRectF all(2.5, 3.5, 15, 13);
        painter.drawRect(all);
        painter.setBrush(QColor(0x84, 0x88, 0x8e, 150)); // where the volume is
        const QPointF middle = all.center();
        if (layout == Layout::Volume) {
            painter.drawRect(all);
        } else if (layout == Layout::Four) {
            painter.drawLine(QPointF(all.left(), middle.y()), QPointF(all.right(), middle.y()));
            painter.drawRect(QRectF(QPointF(middle.x(), all.top()), QPointF(all.right(), middle.y())));
            painter.drawLine(QPointF(middle.x(), all.top()), QPointF(middle.x(), all.bottom()));
        } else {
            const double x = all.left() + 0.65 * all.width();
            painter.drawRect(QRectF(all.topLeft(), QPointF(x, all.bottom())));
            for (const double share : {1 / 3.0, 2 / 3.0}) {
                const double y = all.top() + share * all.height();
                painter.drawLine(QPointF(x, y), QPointF(all.right(), y));
            }
        }
        painter.end();
        icon.addPixmap(pixmap);
    }
    return icon;
}

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
                [&store, layout] { setLayout(store, layout); }, true)
            ->setIcon(iconOf(layout));
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
