// What the menu of targets does: presets of all targets, locks of one.
#pragma once

#include <QList>

class QAction;

namespace pellucid::gui {

class Services;

class TargetActions {
public:
    explicit TargetActions(Services& services) : m_services(services) {}
    void addActions();

    /// The entries of the menu of targets.
    const QList<QAction*>& entries() const { return m_entries; }
    /// Those of a feature's opacity in an optimization: lock and limits.
    const QList<QAction*>& limits() const { return m_limits; }

private:
    Services& m_services;
    QList<QAction*> m_entries, m_limits;
};

} // namespace pellucid::gui
