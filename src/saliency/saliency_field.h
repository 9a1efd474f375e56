// Centre against surround, per voxel (MEASURES §5, eq. 4.6–4.8).
#pragma once

#include <array>

#include "tf/transfer_function.h"
#include "volume/grid.h"
#include "volume/job.h"
#include "volume/volume.h"

namespace pellucid {

enum class SaliencyKernel {
    Thesis, ///< (4.7): weights exp(−d²/(2σ)²)
    Narrow  ///< standard deviation √2/8 · radius, the author's published programs
};

struct SaliencyOptions {
    double sigma = 2.0; ///< in d0, (0, 8]
    SaliencyKernel kernel = SaliencyKernel::Thesis;
    double w1 = 1.0, w2 = 1.0;
    Rgb background; ///< colour of voxels in no feature, and of invalid ones
    bool operator==(const SaliencyOptions&) const = default;
};

/// Per voxel weights L(O_b), L(O_s): shape of the volume, ≥ 0, no unit. What visibility is weighted by.
struct WeightFields {
    Grid<float> brightness;
    Grid<float> saturation;
};

/// Depends on the colours and features of `tf`, never on its opacities. Throws Error for options out of range.
WeightFields saliencyFields(const Volume& volume, const TransferFunction& tf, const SaliencyOptions& options = {},
                            const JobControl& job = {});

/// The same by the book: double precision, a direct sum over each ball. The oracle; slow.
WeightFields saliencyFieldsReference(const Volume& volume, const TransferFunction& tf,
                                     const SaliencyOptions& options = {}, const JobControl& job = {});

} // namespace pellucid
