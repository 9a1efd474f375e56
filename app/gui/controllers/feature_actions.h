// The submenus Presets, Feature and Colours of the menu Transfer function.
#pragma once

#include <QList>

class QAction;
class QMenu;

namespace pellucid::gui {

class Services;
class TargetActions;

/// Add a shape, and duplicate, split, merge, remove, hide what is selected; colour maps. Each is an undo step.
class FeatureActions {
public:
    FeatureActions(Services& services, TargetActions& targets) : m_services(services), m_targets(targets) {}
    void addActions();

    /// The entries that concern one feature, as its context menu has them.
    void fillMenu(QMenu& menu) const;
    void fillColorMenu(QMenu& menu) const;
    const QList<QAction*>& shapes() const { return m_shapes; } ///< "Add …"
    /// Split, merge, duplicate, remove.
    const QList<QAction*>& shaping() const { return m_shaping; }

    /// Draws this feature alone, or all again where it is already; one undo step.
    void toggleOnly(int feature);

private:
    void addPresets();
    void addColorActions();

    Services& m_services;
    TargetActions& m_targets;
    QList<QAction*> m_shapes, m_shaping, m_kinds, m_showing, m_maps, m_colors;
};

} // namespace pellucid::gui
