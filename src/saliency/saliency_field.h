// Centre against surround, per voxel (docs/method.md, "Saliency"; eq. 4.6–4.8).
#pragma once

#include <optional>

#include "base/job.h"
#include "base/setting.h"
#include "saliency/weight_fields.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"
#include "volume/voxel_colors.h"

namespace pellucid {

enum class SaliencyKernel {
    Thesis, ///< (4.7): weights exp(−d²/(2σ)²)
    Narrow  ///< standard deviation √2/8 · radius, the author's published programs
};
template <>
inline constexpr auto kNamesOf<SaliencyKernel> = enumNames("kernel", "thesis", "narrow");

/// Ranges are those of settingsOf<SaliencyOptions>().
struct SaliencyOptions {
    double sigma = 2.0; ///< in d0
    SaliencyKernel kernel = SaliencyKernel::Thesis;
    double w1 = 1.0, w2 = 1.0; ///< of centre and surround (4.8), no unit
    Rgb background;            ///< colour of voxels in no feature, and of invalid ones
    bool operator==(const SaliencyOptions&) const = default;
};
template <>
std::span<const Setting> settingsOf<SaliencyOptions>();

/// All 0, with room for the largest weights possible: L ≤ max(w1, w2)·O (4.8), and no sRGB colour has O_b above 1 or
/// O_s above 1.34. These bounds do not depend on the colours at hand, so that greys, whose chroma is 0 but for
/// rounding, get weights of exactly 0. `form`: empty: weightFormOf(dims).
WeightFields emptyWeightFields(const Int3& dims, const SaliencyOptions& options, std::optional<WeightForm> form = {});
WeightForm weightFormOf(const Int3& dims); ///< of a volume: compact from kLeanVoxels on
/// Makes `fields` such as emptyWeightFields() returns, but keeps memory and values that fit: true where it does.
bool keepWeightFields(WeightFields& fields, const Int3& dims, const SaliencyOptions& options,
                      std::optional<WeightForm> form = {});
/// How many voxels around a voxel its saliency depends on, along each axis.
Int3 saliencyReach(const Geometry& geometry, const SaliencyOptions& options);

/// The part of `tf` that saliency depends on: two with equal parts have the same fields. Opacities and names are gone,
/// and points between which no colour bends, such as those that scaling a feature inserts.
TransferFunction colorsOf(const TransferFunction& tf);

/// Of a volume on several ranks: of the voxels that are here, right of those that this rank answers for. Throws Error
/// where too few voxels around these are here.
/// Depends on the colours and features of `tf`, never on its opacities. With `colors`, voxels in features have those in
/// place of the transfer function's. Throws Error for options out of range.
WeightFields saliencyFields(const Volume& volume, const TransferFunction& tf, const SaliencyOptions& options = {},
                            const JobControl& job = {}, const VoxelColors* colors = nullptr);

/// The same into `fields`, whose memory is used again where it fits: the system takes longer to hand out new pages than
/// the sums take. What was there is gone, also where this throws.
void updateSaliencyFields(WeightFields& fields, const Volume& volume, const TransferFunction& tf,
                          const SaliencyOptions& options = {}, const JobControl& job = {},
                          const VoxelColors* colors = nullptr);

/// The same by the book: double precision, a direct sum over each ball. The oracle; slow.
WeightFields saliencyFieldsReference(const Volume& volume, const TransferFunction& tf,
                                     const SaliencyOptions& options = {}, const JobControl& job = {},
                                     const VoxelColors* colors = nullptr);

} // namespace pellucid
