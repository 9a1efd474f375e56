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
        const QRectF frame(2.5, 3.5, 15, 13);
        painter.drawRect(frame);
        painter.setBrush(QColor(0x84, 0x88, 0x8e, 150)); // where the volume is
        const QPointF middle = frame.center();
        switch (layout) {
        case Layout::Volume:
            painter.drawRect(frame);
            break;
        case Layout::Four:
            painter.drawLine(QPointF(frame.left(), middle.y()), QPointF(frame.right(), middle.y()));
            painter.drawRect(QRectF(QPointF(middle.x(), frame.top()), QPointF(frame.right(), middle.y())));
            painter.drawLine(QPointF(middle.x(), frame.top()), QPointF(middle.x(), frame.bottom()));
            break;
        case Layout::VolumeLarge: {
            const double x = frame.left() + 0.65 * frame.width();
            painter.drawRect(QRectF(frame.topLeft(), QPointF(x, frame.bottom())));
            for (const double share : {1 / 3.0, 2 / 3.0}) {
                const double y = frame.top() + share * frame.height();
                painter.drawLine(QPointF(x, y), QPointF(frame.right(), y));
            }
            break;
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
    const QString menu = QObject::tr("&View") + "/" + QObject::tr("La&yout");
    const auto editable = [&services] { return services.isEditable(); };
    struct Texts {
        Layout layout;
        QString id, text, tip;
    };
    const Texts layouts[] = {
        {Layout::Volume, "layoutVolumeAction", QObject::tr("&Volume"), QObject::tr("The volume alone")},
        {Layout::Four, "layoutFourAction", QObject::tr("&Four views"),
         QObject::tr("The volume and three slices through it, of a size")},
        {Layout::VolumeLarge, "layoutVolumeLargeAction", QObject::tr("Volume and &slices"),
         QObject::tr("The volume large, three slices small beside it")}};
    int key = 1;
    for (const Texts& t : layouts)
        actions
            .add(menu, t.id, t.text, QStringLiteral("Ctrl+Shift+%1").arg(key++), t.tip,
                 [&store, layout = t.layout] { setLayout(store, layout); }, editable,
                 {.checked = [&store, layout = t.layout] { return store.session().slices->layout == layout; },
                  .inToolBar = true})
            ->setIcon(iconOf(t.layout));
    actions.add(
        menu, "centreCrosshairAction", QObject::tr("&Crosshair to the middle"), {},
        QObject::tr("The slices through the middle of the volume"),
        [&store] { moveCrosshair(store, Vec3(store.scene().volume->dims() / 2)); },
        [&store] { return store.hasVolume(); }, {.separatorBefore = true});
    actions.add(
        menu, "resetGreyWindowAction", QObject::tr("&Reset the window of grey"), {},
        QObject::tr("Black and white of the slices at the ends of the range of values, as the transfer "
                    "function has it"),
        [&store] { resetGreyWindow(store); },
        [&store, editable] { return editable() && store.session().slices->window.has_value(); });
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
