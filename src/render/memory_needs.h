// What measuring and drawing take of memory beside the volume itself.
#pragma once

#include "volume/memory_use.h"

namespace pellucid {

// Bytes per voxel; "lean" those of large volumes of 8-bit samples, see isLean().

/// 2 for intensity codes, 2 for the same in the order of sweeps along x, 4 for the two weights of saliency. Measuring
/// and optimizing store nothing else. Lean: codes take at most 1, in one order, weights 1.
inline constexpr double kMeasureBytesPerVoxel = 8, kLeanMeasureBytesPerVoxel = 2;
/// 4 more for the visibility that is written. Lean: likewise, and for each weight in its turn.
inline constexpr double kFieldsBytesPerVoxel = 12, kLeanFieldsBytesPerVoxel = 10;
/// A field that is drawn: its values as floats while they become a volume of floats, later that and its codes.
inline constexpr double kFieldBytesPerVoxel = 8;
/// The reference engine keeps intensities as doubles, and which are valid, in the place of codes: so much more.
inline constexpr double kMoreByReferenceBytesPerVoxel = 5, kLeanMoreByReferenceBytesPerVoxel = 8;
/// The published profile's weights are never compact.
inline constexpr double kMoreByPublishedLeanBytesPerVoxel = 3;
/// To look at a volume takes its codes, and which are valid. Quick pictures take both again in another order. Lean:
/// codes alone.
inline constexpr double kViewBytesPerVoxel = 3, kPreviewBytesPerVoxel = 6, kLeanViewBytesPerVoxel = 1;

inline MemoryUse toMeasure(std::string doing) {
    return {std::move(doing), kMeasureBytesPerVoxel, kLeanMeasureBytesPerVoxel};
}
inline MemoryUse toWriteFields() { return {"measuring", kFieldsBytesPerVoxel, kLeanFieldsBytesPerVoxel}; }
/// Beside what measuring takes, `weightsToo` where that has not been taken yet.
inline MemoryUse toDrawField(bool weightsToo) {
    return {"a field of", kFieldBytesPerVoxel + (weightsToo ? 4 : 0), kFieldBytesPerVoxel + (weightsToo ? 1 : 0)};
}
inline MemoryUse toMeasureAndDrawField() {
    return {"a field of", kMeasureBytesPerVoxel + kFieldBytesPerVoxel, kLeanMeasureBytesPerVoxel + kFieldBytesPerVoxel};
}
inline MemoryUse toView(std::string doing) { return {std::move(doing), kViewBytesPerVoxel, kLeanViewBytesPerVoxel}; }
/// The same with quick pictures.
inline MemoryUse toPreview(std::string doing) {
    return {std::move(doing), kPreviewBytesPerVoxel, kLeanViewBytesPerVoxel};
}
/// The same by the reference engine.
inline MemoryUse byReference(MemoryUse use) {
    use.bytesPerVoxel += kMoreByReferenceBytesPerVoxel;
    use.leanBytesPerVoxel += kLeanMoreByReferenceBytesPerVoxel;
    return use;
}
/// The same by the published profile.
inline MemoryUse byPublished(MemoryUse use) {
    use.leanBytesPerVoxel += kMoreByPublishedLeanBytesPerVoxel;
    return use;
}

} // namespace pellucid
