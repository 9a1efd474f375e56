// Anything that draws the volume: a pixel's alpha is 1 − exp(−∫τ), its colour the matching emission-absorption
// integral (docs/method.md, "The picture").
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/image.h"
#include "base/job.h"
#include "render/render_settings.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// Made for one volume, used by one thread at a time.
class ImageRenderer {
public:
    virtual ~ImageRenderer() = default;
    virtual std::string name() const = 0; ///< "cpu" or "gl"
    virtual Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                         const JobControl& job = {}) = 0;
};

/// Pixels [x0, x1) × [y0, y1) of a picture.
struct ImagePart {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// A part of a picture into the same place of a window's pixels (screenPixel()), which are as many.
void toScreen(const Image& from, const ImagePart& part, std::uint32_t* pixels);

/// A renderer whose pictures come in pieces: for windows that cannot wait for the whole.
class TileRenderer : public ImageRenderer {
public:
    /// The picture with `scale` rays per pixel along each axis, (0, 1]: an image of ⌈width·scale⌉ × ⌈height·scale⌉
    /// whose pixels are 1/scale pixels of the picture wide, so that its right and lower edge may reach beyond that.
    virtual Image preview(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                          double scale, const JobControl& job = {}) = 0;
    struct PreviewSize {
        int width = 0, height = 0;
    };
    static PreviewSize previewSize(const RenderSettings& settings, double scale);
    /// The same for a window, in its bytes (screenPixel()): `pixels` has room for previewSize(), row after row. The
    /// settings have a background.
    virtual void previewOnScreen(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                                 double scale, std::uint32_t* pixels, const JobControl& job = {}) = 0;
    /// Whether preview() draws it in storage order, from slice to slice: quickly, and nearly as render() does
    /// (docs/method.md, "The quick picture"). Else it is render() with fewer rays.
    virtual bool previewsInStorageOrder(const Camera& camera, const RenderSettings& settings) const = 0;
    /// Draws the picture into `image`, which has its size, outward from the pixel (x, y); the pixels are those of
    /// render(). `done` is called after each part, from any thread, by one at a time. Where it is stopped (Cancelled),
    /// the parts that were done stay.
    virtual void refine(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings, Image& image,
                        int x, int y, const std::function<void(const ImagePart&)>& done,
                        const JobControl& job = {}) = 0;
};

/// Rays on threads; needs no GL.
std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume);

} // namespace pellucid
