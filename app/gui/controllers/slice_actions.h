// What can be done with the slices beside the picture: layouts, the crosshair where they meet, the window of their
// grey.
#pragma once

#include "store/session_store.h"

namespace pellucid::gui {

class Services;

/// Where the slices meet, voxel coordinates within the grid; the scene has a volume.
Vec3 crosshairOf(const Scene& scene);
/// Data units of black and white.
ValueRange greyWindowOf(const Scene& scene);

/// To the nearest voxel; no step of the history.
void moveCrosshair(SessionStore& store, const Vec3& voxel);
void moveCrosshairToWorld(SessionStore& store, const Vec3& world);
void setLayout(SessionStore& store, SliceViews::Layout layout);
void resetGreyWindow(SessionStore& store); ///< to the range of values that the transfer function covers

void addSliceActions(Services& services);

} // namespace pellucid::gui
