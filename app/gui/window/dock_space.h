// The room that panels take and give back.
#pragma once

#include <map>
#include <set>

#include <QMainWindow>
#include <QObject>
#include <QSize>

class QDockWidget;

namespace pellucid::gui {

/// Whether a dock can be seen: it is open, and no other tab lies before it.
bool isInFront(const QDockWidget& dock);

/// Remembers how large the docks of a window were while the same ones were open: where one is closed, the others get
/// the sizes back that they had without it.
class DockSpace : public QObject {
    Q_OBJECT
public:
    explicit DockSpace(QMainWindow& window);
    void watch(QDockWidget& dock);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    using Docks = std::set<QDockWidget*>;
    void settle();
    Docks open() const;
    void giveBack(const std::map<QDockWidget*, QSize>& sizes);

    QMainWindow& m_window;
    Docks m_watched, m_open; ///< the latter when it was last looked at
    std::map<Docks, std::map<QDockWidget*, QSize>> m_sizes;
    bool m_waiting = false;
};

} // namespace pellucid::gui
