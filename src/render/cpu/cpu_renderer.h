// The renderer on the CPU, with what tests vary.
#pragma once

#include "render/cpu/shear_view.h"
#include "render/image_renderer.h"

namespace pellucid {

/// Ways to the same picture.
struct CpuRenderOptions {
    int kernel = 0;   ///< index into packetKernels()
    bool leap = true; ///< over what is transparent
    /// Whether previews are drawn in storage order where they can be.
    bool sheared = true;
    ShearDensity density{}; ///< of their rays
};

std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume, const CpuRenderOptions& options);

} // namespace pellucid
