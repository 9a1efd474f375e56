// Visibility as the published profile defines it (docs/method.md, "The published profile").
#pragma once

#include "render/profile.h"
#include "render/visibility.h"

namespace pellucid {

/// In parallel onto that face of the grid, the whole box in the picture: front looks from the highest j down, back from
/// the lowest up; top from the highest k, bottom from the lowest; right from the highest i, left from the lowest.
Camera cameraAlong(const Geometry& geometry, Along along);

/// The engine "published": straight through the voxel planes along one axis of the grid, front to back, every opacity
/// rounded to 8 bits. Features are closed intervals: a voxel at the upper end of one, and in no other, is its own.
///
/// sums() and field() are exact, in whole numbers, and the same on any number of threads. jacobian() returns the same
/// sums; a rounded function has no derivative, so that the derivatives are those of the compositing without rounding,
/// scaled by what rounding made of the sums over all voxels: the shares' derivatives follow from them.
///
/// All of them throw UsageError unless the camera looks along an axis of the grid in parallel, as cameraAlong() does.
std::unique_ptr<VisibilityEngine> makePublishedEngine(std::shared_ptr<const Volume> volume);

} // namespace pellucid
