// A picture and those of its features alone, as 2D feature saliency needs them.
#pragma once

#include "render/image_renderer.h"
#include "saliency/image_saliency.h"

namespace pellucid {

/// Draws the picture, and each feature of `tf` with the others left out. A feature that is hidden, of no opacity or cut
/// away is nowhere in its picture; where `settings` draw one feature alone, the others are not. Over a ground
/// alpha is 1 where a feature changes the picture of the ground alone, else 0. Throws as ImageRenderer::render() does.
FeaturePictures featurePictures(ImageRenderer& renderer, const Camera& camera, const TransferFunction& tf,
                                const RenderSettings& settings, const JobControl& job = {});

} // namespace pellucid
