#include "window/dock_space.h"

#include <algorithm>

#include <QDockWidget>
#include <QEvent>
#include <QTabBar>
#include <QTimer>

namespace pellucid::gui {
namespace {

/// On tabs, with arrows where there is no room for all: Qt would leave two letters of each.
void showWholeNames(QMainWindow& window) {
    for (QTabBar* bar : window.findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly)) {
        bar->setElideMode(Qt::ElideNone);
        bar->setUsesScrollButtons(true);
    }
}

} // namespace

bool isInFront(const QDockWidget& dock) {
    if (dock.isHidden()) return false;
    // Qt keeps tabs that lie behind outside the window.
    return dock.isFloating() || dock.parentWidget()->rect().intersects(dock.geometry());
}

DockSpace::DockSpace(QMainWindow& window) : QObject(&window), m_window(window) {}

void DockSpace::watch(QDockWidget& dock) {
    m_watched.insert(&dock);
    dock.installEventFilter(this);
}

bool DockSpace::eventFilter(QObject* watched, QEvent* event) {
    switch (event->type()) {
    case QEvent::Resize:
    case QEvent::ShowToParent:
    case QEvent::HideToParent:
        // When the window has laid out everything.
        if (!std::exchange(m_waiting, true)) QTimer::singleShot(0, this, &DockSpace::settle);
        break;
    default:
        break;
    }
    return QObject::eventFilter(watched, event);
}

DockSpace::Docks DockSpace::open() const {
    Docks docks;
    for (QDockWidget* dock : m_watched)
        if (!dock->isHidden() && !dock->isFloating()) docks.insert(dock);
    return docks;
}

void DockSpace::settle() {
    m_waiting = false;
    if (!m_window.isVisible()) return;
    showWholeNames(m_window);
    Docks now = open();
    const bool closed =
        now.size() < m_open.size() && std::includes(m_open.begin(), m_open.end(), now.begin(), now.end());
    m_open = std::move(now);
    if (const auto known = m_sizes.find(m_open); closed && known != m_sizes.end()) return giveBack(known->second);
    auto& sizes = m_sizes[m_open];
    sizes.clear();
    for (QDockWidget* dock : m_open)
        if (isInFront(*dock)) sizes[dock] = dock->size();
}

void DockSpace::giveBack(const std::map<QDockWidget*, QSize>& sizes) {
    QList<QDockWidget*> docks;
    QList<int> widths, heights;
    for (const auto& [dock, size] : sizes) {
        docks << dock;
        widths << size.width();
        heights << size.height();
    }
    m_window.resizeDocks(docks, widths, Qt::Horizontal);
    m_window.resizeDocks(docks, heights, Qt::Vertical);
}

} // namespace pellucid::gui
