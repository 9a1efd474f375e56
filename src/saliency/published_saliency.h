// Saliency as the published profile defines it (docs/method.md, "The published profile").
#pragma once

#include <vector>

#include "base/job.h"
#include "saliency/appearance.h"
#include "saliency/weight_fields.h"

namespace pellucid {

/// O_b = L*/100 and O_s = C*ab/100 with the white point D50 (sRGB taken there by Bradford's matrix) of the colour
/// rounded to 8 bits a component.
Appearance publishedAppearanceOf(const Rgb& srgb);

/// Weights of the offsets 0 … radius of the discrete Gaussian e^(−t)·I_k(t), t = (radius·√2/8)², I_k the modified
/// Bessel function; scaled so that they sum to 1 over −radius … radius.
std::vector<double> discreteGaussian(int radius);

/// |G_2 − G_4| of both attributes, G_r the separable discrete Gaussian of radius r in voxels along each axis of the
/// grid, whatever the spacing; the edge's voxels are repeated outward. Colours are those of the transfer function
/// wherever it has any, in features or not; invalid voxels are black. Never compact. Intensities are taken from 16-bit
/// codes, which are exact for samples of 8 and 16 bits.
WeightFields publishedSaliencyFields(const Volume& volume, const TransferFunction& tf, const JobControl& job = {});

} // namespace pellucid
