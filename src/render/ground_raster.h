// The ground as renderers take it: any part of a picture, compact (docs/method.md, "The ground").
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "render/ground.h"
#include "render/render_settings.h"

namespace pellucid {

/// Which part of a picture is drawn, in pixels of the part. The whole picture need not be whole pixels wide: a preview
/// is drawn in larger ones.
struct GroundWindow {
    double pictureWidth = 1, pictureHeight = 1;
    double left = 0, top = 0;  ///< of the part, in the picture
    int width = 1, height = 1; ///< of the part
    double pixelAspect = 1;    ///< width of a pixel over its height
    bool operator==(const GroundWindow&) const = default;
};

/// How colours fade with depth: towards `color`, by `strength` · clamp((depth − from) · perDepth, 0, 1).
struct DepthFade {
    double strength = 0; ///< 0: not at all
    Rgb color;
    double from = 0, perDepth = 0; ///< world units along the view, and their inverse
    bool operator==(const DepthFade&) const = default;
};

/// Rows from the top.
struct GroundPicture {
    static constexpr float kNone = std::numeric_limits<float>::infinity();
    int width = 0, height = 0;
    std::vector<std::uint32_t> rgba; ///< sRGB as VoxelColors::pack(); 0 where there is no ground
    std::vector<float> depth;        ///< world units along the view (not the ray); kNone where there is no ground
};

/// Depths count from the plane that lies `depthOfZero` in front of the eye. Throws UsageError (an unknown colour map),
/// Cancelled.
GroundPicture rasterizeGround(const Ground& ground, const Camera& camera, double depthOfZero,
                              const GroundWindow& window, const DepthFade& fade = {}, const JobControl& job = {});

/// Whether the picture shows the ground of its settings: modes that show intensities as grey do not.
bool showsGround(const RenderSettings& settings);

/// The ground of the settings as the renderers of a volume count depths: from the plane through the middle of its box.
/// It fades as the volume does.
GroundPicture groundOf(const RenderSettings& settings, const Camera& camera, const Geometry& geometry,
                       const GroundWindow& window, const JobControl& job = {});

} // namespace pellucid
