// What a picture is made of, pixel by pixel: what each feature adds to it, how far away it is, and which way it faces
// (docs/method.md, "Layers").
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "base/image.h"
#include "base/plane.h"
#include "render/image_renderer.h"

namespace pellucid {

/// All of one size. The sum of `features` and `rest` is `picture`, premultiplied.
struct PictureLayers {
    Image picture; ///< transparent, straight
    /// By feature of the transfer function: its part of the colour, premultiplied, and its share of the pixel's opacity
    /// in the place of alpha.
    std::vector<Image> features;
    Image rest;  ///< likewise: what lies in no feature
    Plane depth; ///< world units along the ray to where half of the light is absorbed; infinity: less is
    /// Width × height × 3, there: the unit vector along the gradient that faces the viewer, in the camera's right, up
    /// and toward the viewer. 0, 0, 0 where there is no depth, or the intensity is the same all around.
    std::vector<float> normals;

    PictureLayers() = default;
    PictureLayers(int width, int height, std::size_t count)
        : picture(width, height), features(count, Image(width, height)), rest(width, height), depth(width, height),
          normals(3 * depth.values.size(), 0.0f) {
        depth.values.assign(depth.values.size(), std::numeric_limits<float>::infinity());
    }
};

/// Throws UsageError where pictures have no layers: in other modes than Composite, with a ground or an overlay, or
/// where `tf` has too many features.
void checkLayers(const TransferFunction& tf, const RenderSettings& settings);
/// Bytes that layers of so many features take.
double bytesOfLayers(int width, int height, std::size_t features);

/// Draws the picture as the cpu renderer does, without a background, and its layers. Depths count from the eye or, for
/// parallel rays, from the plane through it. Throws as checkLayers() and ImageRenderer::render() do.
PictureLayers pictureLayers(std::shared_ptr<const Volume> volume, const Camera& camera, const TransferFunction& tf,
                            const RenderSettings& settings, const JobControl& job = {});

} // namespace pellucid
