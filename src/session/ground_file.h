// The ground of a session, from its file.
#pragma once

#include "render/ground.h"
#include "session/session.h"

namespace pellucid {

/// Reads the height field and lays it under the volume: over the whole box along i and j, height 0 at its lower face
/// along k. Without GroundView::scale heights are world units where the box is as high as they are at least in part;
/// else the highest rises to a tenth of the box. Throws FileError where the file has more than one layer along every
/// axis, and as loadVolume() does.
Ground readGround(const GroundView& view, const Geometry& box, const JobControl& job = {});

} // namespace pellucid
