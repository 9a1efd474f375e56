// The renderer on the CPU, with what tests vary.
#pragma once

#include <optional>

#include "render/cpu/shear_view.h"
#include "render/image_renderer.h"

namespace pellucid {

inline constexpr int kTileRows = 32; ///< pictures are drawn by squares of so many pixels

/// Of the rows of squares of a picture, every `count`-th from `first` on; the others stay transparent.
struct PictureBands {
    int first = 0, count = 1;
};

/// Ways to the same picture, or to parts of it.
struct CpuRenderOptions {
    int kernel = 0;   ///< index into packetKernels()
    bool leap = true; ///< over what is transparent
    /// Whether previews are drawn in storage order where they can be.
    bool sheared = true;
    ShearDensity density{}; ///< of their rays
    PictureBands bands{};   ///< what render() draws
    /// The volume is a part of this one: depths count from the middle of its box, and no background is drawn, since
    /// other parts may lie behind.
    std::optional<Geometry> blockOf = {};
    BoxPart part{}; ///< what is drawn of the volume at all: nothing lies beyond it
};

std::unique_ptr<TileRenderer> makeCpuRenderer(std::shared_ptr<const Volume> volume, const CpuRenderOptions& options);

} // namespace pellucid
