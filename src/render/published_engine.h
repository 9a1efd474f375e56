// Visibility as the published profile defines it (docs/method.md, "The published profile").
#pragma once

#include "render/visibility.h"

namespace pellucid {

/// The engine "published": straight through the voxel planes along one axis of the grid, front to back, every opacity
/// rounded to 8 bits. Features are closed intervals: a voxel at the upper end of one, and in no other, is its own.
///
/// sums() and field() are exact, in whole numbers, and the same on any number of threads. jacobian() returns the same
/// sums; a rounded function has no derivative, so that the derivatives are those of the compositing without rounding,
/// scaled by what rounding made of the sums over all voxels: the shares' derivatives follow from them.
///
/// All of them throw UsageError unless the camera is orthographic and looks along an axis of the grid.
std::unique_ptr<VisibilityEngine> makePublishedEngine(std::shared_ptr<const Volume> volume);

} // namespace pellucid
