// Anything that draws the volume: a pixel's alpha is 1 − exp(−∫τ), its colour the matching emission-absorption
// integral (docs/method.md, "The picture").
#pragma once

#include <memory>
#include <string>

#include "base/job.h"
#include "render/image.h"
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

/// A ray per pixel on threads; needs no GL.
std::unique_ptr<ImageRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume);

} // namespace pellucid
