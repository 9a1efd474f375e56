// A panel: a dock that brings all of itself along.
#pragma once

#include <functional>
#include <vector>

#include <QKeySequence>
#include <QString>
#include <QWidget>

namespace pellucid::gui {

struct Controllers;
class Services;

/// What panels are for; the menu Panels is in this order.
enum class PanelGroup { Look, Shares, Time, Files };

/// What the frame needs to know of a panel. `make` is called once; the widget gets the services (the store, results,
/// actions), adds its own actions there, and the controllers that it calls.
struct PanelInfo {
    const char* id; ///< the dock's object name is "<id>Dock", its toggle's "<id>Action"
    QString title;
    PanelGroup group = PanelGroup::Look;
    Qt::DockWidgetArea area = Qt::RightDockWidgetArea;
    bool visible = true;          ///< at the first start
    const char* tabOf = nullptr;  ///< id of a panel before it that it is a tab beside; null: a place of its own
    const char* beside = nullptr; ///< id of a panel before it that it stands right of; null: wherever there is room
    int size = 0;                 ///< width (or height, at the bottom) at the first start, pixels; 0: as it likes
    QKeySequence keys;            ///< show or hide it
    QString tip;
    std::function<QWidget*(Services&, Controllers&, QWidget* parent)> make;
};

/// All panels, in the order in which they are docked. To add one: its own files, and its line in panel_registry.cpp.
std::vector<PanelInfo> panelRegistry();

} // namespace pellucid::gui
