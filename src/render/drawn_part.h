// What a transfer function draws of a volume, and cameras that fit it into the picture.
#pragma once

#include <vector>

#include "base/job.h"
#include "render/camera.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// How far what is drawn reaches: points of the world whose convex hull holds it. Empty: nothing is drawn.
using DrawnPart = std::vector<Vec3>;

/// Where `tf` is opaque enough to be seen (drawnCells()). What is cut away does not count, nor do lone specks beside
/// something larger. It is found on a grid of at most 2¹⁸ voxels, which is laid again, closer, over what is small. The
/// same for any number of threads. Throws Cancelled.
DrawnPart drawnPart(const Volume& volume, const TransferFunction& tf, const Clipping& clipping,
                    const JobControl& job = {});

/// How much of the shorter side of the picture fittedTo() fills.
inline constexpr double kFilledByFit = 0.88;

/// From the same direction, with `part` in the middle of the picture, which it fills up to kFilledByFit of the shorter
/// side of pictures that are at least as wide as high. The eye stays outside the sphere around the box: where it would
/// enter, the image narrows instead. Where nothing is drawn, the whole box is fitted.
Camera fittedTo(const DrawnPart& part, const Camera& camera, const Geometry& geometry);

} // namespace pellucid
