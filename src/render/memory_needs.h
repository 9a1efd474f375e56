// What measuring and drawing take of memory beside the volume itself, bytes per voxel.
#pragma once

namespace pellucid {

/// 2 for intensity codes, 2 for the same in the order of sweeps along x, 4 for the two weights of saliency. Measuring
/// and optimizing store nothing else.
inline constexpr double kMeasureBytesPerVoxel = 8;
/// 4 more for the visibility that is written.
inline constexpr double kFieldsBytesPerVoxel = 12;
/// The reference engine keeps intensities as doubles, and which are valid, in the place of codes: so much more.
inline constexpr double kMoreByReferenceBytesPerVoxel = 5;
/// To look at a volume takes its codes, and which are valid.
inline constexpr double kViewBytesPerVoxel = 3;

} // namespace pellucid
