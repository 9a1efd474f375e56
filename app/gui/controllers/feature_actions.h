// What is done to features as objects: the menu Transfer function → Feature, and that of the colours.
#pragma once

#include <QIcon>

#include "tf/color_maps.h"

class QMenu;

namespace pellucid::gui {

class Workbench;

/// Add a shape, and duplicate, split, merge, remove, hide what is selected; colour maps. Each is an undo step.
void addFeatureActions(Workbench& bench);

/// The entries that concern one feature, as its context menu has them.
void fillFeatureMenu(QMenu& menu, Workbench& bench);
void fillShapeMenu(QMenu& menu, Workbench& bench); ///< "Add …"
void fillColorMenu(QMenu& menu, Workbench& bench);

/// Index of the selected feature in the scene's transfer function; −1: none.
int selectedFeature(Workbench& bench);
/// Draws this feature alone, or all again where it is already; one undo step.
void toggleOnlyFeature(Workbench& bench, int feature);

/// The colours of a map from left to right.
QPixmap colorStrip(const ColorMap& map, const QSize& size);

} // namespace pellucid::gui
