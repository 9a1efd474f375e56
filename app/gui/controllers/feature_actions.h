// What is done to features as objects: the menu Transfer function → Feature, and that of the colours.
#pragma once

#include <QIcon>

#include "tf/color_maps.h"

class QMenu;

namespace pellucid::gui {

class Services;

/// Add a shape, and duplicate, split, merge, remove, hide what is selected; colour maps. Each is an undo step.
void addFeatureActions(Services& services);

/// The entries that concern one feature, as its context menu has them.
void fillFeatureMenu(QMenu& menu, Services& services);
void fillShapeMenu(QMenu& menu, Services& services); ///< "Add …"
void fillColorMenu(QMenu& menu, Services& services);

/// Index of the selected feature in the scene's transfer function; −1: none.
int selectedFeature(Services& services);
/// Draws this feature alone, or all again where it is already; one undo step.
void toggleOnlyFeature(Services& services, int feature);

/// The colours of a map from left to right.
QPixmap colorStrip(const ColorMap& map, const QSize& size);

} // namespace pellucid::gui
