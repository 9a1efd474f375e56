// The ground of a session, from its file.
#pragma once

#include "render/ground.h"
#include "session/session.h"

namespace pellucid {

/// Reads the height field and lays it under the volume: over the whole box, from side to side, along i and j, height 0
/// at its lower face along k. The file has one layer, along z or else y or else x; its other axes lie along i and j.
/// Without GroundView::scale heights are world units where the largest of them lies in the box and reaches a hundredth
/// of it; else that one rises to a tenth of the box. With a negative scale they are depths. Colours go from the lowest
/// to the highest; those of kTerrainMap begin at 0 where some lie below. Throws FileError where the file has more than
/// one layer along every axis, UsageError for an unknown colour map, and as loadVolume() does.
Ground readGround(const GroundView& view, const Geometry& box, const JobControl& job = {});

/// What its heights are read from, which may be a sample.
VolumeSource sourceOf(const GroundView& view);

/// Gives the heights the colours and relief of `view`. Throws UsageError for an unknown colour map.
void dressGround(Ground& ground, const GroundView& view);

} // namespace pellucid
