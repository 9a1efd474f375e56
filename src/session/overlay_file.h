// The overlay of a session, from its file.
#pragma once

#include <string>
#include <vector>

#include "render/overlay.h"
#include "session/session.h"
#include "tf/overlay_look.h"

namespace pellucid {

/// An overlay with what was found in its data.
struct SceneOverlay : Overlay {
    OverlayLook usual;                ///< what the values propose
    OverlayLook look;                 ///< what is drawn, unless a curve of its own says it
    bool byCentres = false;           ///< as OverlayPlace
    std::vector<std::string> notices; ///< what people should know of it
};

/// Reads the second volume and lays it over `first`. Throws FileError where the two do not meet in the world or all of
/// its values are the same, UsageError for an unknown colour map, and as loadVolume() does.
SceneOverlay readOverlay(const OverlayView& view, const Geometry& first, const JobControl& job = {});

/// Gives the overlay the transfer function that `view` says. Throws UsageError for an unknown colour map.
void dressOverlay(SceneOverlay& overlay, const OverlayView& view);

} // namespace pellucid
