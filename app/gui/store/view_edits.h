// How camera, crosshair and slices are set: what menus and the hands on the pictures share.
#pragma once

#include "render/standard_view.h"
#include "store/session_store.h"

namespace pellucid::gui {

void fitView(SessionStore& store);   ///< the same direction; what is drawn fills the picture
void resetView(SessionStore& store); ///< the home view, fitted to what is drawn now
void setStandardView(SessionStore& store, StandardView view);
void setProjection(SessionStore& store, Projection projection);
void zoomView(SessionStore& store, double factor, int gesture = 0);

/// Where the slices meet, voxel coordinates within the grid; the scene has a volume.
Vec3 crosshairOf(const Scene& scene);
/// Data units of black and white.
ValueRange greyWindowOf(const Scene& scene);

/// To the nearest voxel; no step of the history.
void moveCrosshair(SessionStore& store, const Vec3& voxel);
void moveCrosshairToWorld(SessionStore& store, const Vec3& world);
void setLayout(SessionStore& store, SliceViews::Layout layout);
void resetGreyWindow(SessionStore& store); ///< to the range of values that the transfer function covers

} // namespace pellucid::gui
