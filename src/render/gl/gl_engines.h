// The ways into OpenGL for everybody else: engine, renderer, and what a driver is.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/image_renderer.h"
#include "render/visibility.h"

namespace pellucid {

/// The OpenGL engine on a headless context of its own (EGL surfaceless, else OSMesa), which is made current inside each
/// call, so that any thread may call. Throws Error where there is no GL 4.3.
std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality = Quality::Normal);
/// The thesis's own method, on a context likewise: the slices of a picture, and what accumulates in front of each of
/// them (docs/method.md, "The slices engine"). The whole volume must fit into the device's memory.
std::unique_ptr<VisibilityEngine> makeSlicesEngine(std::shared_ptr<const Volume> volume,
                                                   Quality quality = Quality::Normal);
std::unique_ptr<ImageRenderer> makeGlRenderer(std::shared_ptr<const Volume> volume);

/// Whether GL_RENDERER names a software rasterizer: llvmpipe, softpipe, SwiftShader or the like.
bool isSoftwareRenderer(const std::string& renderer);

/// What a headless context finds here; empty where none can be made.
struct GlInfo {
    std::string vendor, renderer, version;
    std::string platform;                             ///< "EGL surfaceless", "OSMesa", …
    bool software = false;                            ///< isSoftwareRenderer(renderer)
    std::vector<std::pair<std::string, long>> limits; ///< by OpenGL's names: "max_3d_texture_size", …
};
std::optional<GlInfo> probeGl();

} // namespace pellucid
