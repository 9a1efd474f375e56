// What a sweep on ranks sends, found from where blocks and rays lie alone (docs/scale.md).
#pragma once

#include "ranks/communicator.h"
#include "ranks/decomposition.h"
#include "render/camera.h"

namespace pellucid {

/// Of depths, for one sweep of so many lanes: the most of any rank. Messages are not counted. Rounds: calls of
/// Communicator::exchange().
Traffic expectedTraffic(const Geometry& whole, const Decomposition& blocks, const Camera& camera, int lanes);

} // namespace pellucid
