// What a picture is made of: how much of its opacity each feature has, and an overlay.
#pragma once

#include <vector>

#include "render/image_renderer.h"

namespace pellucid {

/// Means over all pixels, [0,1]. Together they are `alpha`.
struct PictureShares {
    std::vector<double> features; ///< by feature of the transfer function
    double overlay = 0;
    double rest = 0;  ///< of what lies in no feature
    double alpha = 0; ///< opacity of the picture
};

/// Each thing adds to a pixel what it absorbs times what lies in front of it lets through, of either volume
/// (docs/method.md, "The overlay"). Drawn by `renderer` without light, which the shares do not depend on, but for
/// gradient opacity; the mode is that of emission and absorption. Throws as ImageRenderer::render() does.
PictureShares pictureShares(ImageRenderer& renderer, const Camera& camera, const TransferFunction& tf,
                            const RenderSettings& settings, const JobControl& job = {});

} // namespace pellucid
