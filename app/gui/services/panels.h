// The docks of a window by their panels' names: for those who open one that is not their own.
#pragma once

#include <map>

#include <QDockWidget>

namespace pellucid::gui {

class Panels : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    void add(const QString& id, QDockWidget& dock) {
        m_docks[id] = &dock;
        connect(&dock, &QDockWidget::visibilityChanged, this,
                [this, id](bool visible) { Q_EMIT visibilityChanged(id, visible); });
    }
    QDockWidget* dock(const QString& id) const { return m_docks.contains(id) ? m_docks.at(id) : nullptr; }
    /// Opens it, in front of those that it is a tab beside.
    void show(const QString& id) {
        if (QDockWidget* const found = dock(id)) {
            found->show();
            found->raise();
        }
    }

Q_SIGNALS:
    void visibilityChanged(const QString& id, bool visible); ///< `visible`: it can be seen, it lies behind no tab

private:
    std::map<QString, QDockWidget*> m_docks;
};

} // namespace pellucid::gui
