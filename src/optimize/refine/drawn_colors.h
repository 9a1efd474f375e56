// The colours that control points have in a picture whose colours do not come from the transfer function.
#pragma once

#include "optimize/refine/refine.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"
#include "volume/voxel_colors.h"

namespace pellucid {

/// `tf` with the drawn colours in place of its own: each control point has the mean colour of the voxels around it,
/// which count by how near their intensity is, as in linear interpolation between neighbouring points. A point without
/// voxels keeps its own. As it is where `colors` is null. What regions and hues of a picture are compared with
/// (docs/method.md, "Entropy refinement").
TransferFunction withDrawnColors(const TransferFunction& tf, const Volume& volume, const VoxelColors* colors);

/// refine() of `tf`, whose points are compared with a prioritised region by their drawn colours; the answer has the
/// colours of `tf`. Throws as refine() does.
RefineResult refineAsDrawn(const Histogram& histogram, const TransferFunction& tf, const Volume& volume,
                           const VoxelColors* colors, const RefineOptions& options, const JobControl& job = {});

} // namespace pellucid
