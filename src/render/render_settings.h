// What a picture should look like.
#pragma once

#include <memory>
#include <optional>

#include "base/color.h"
#include "base/setting.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/voxel_colors.h"

namespace pellucid {

struct Ground;
struct Overlay;

inline constexpr double kFinestStep = 1.0 / 256; ///< that pictures are drawn with, d0

/// What becomes of the intensities along a ray (docs/method.md, "The picture").
enum class RenderMode {
    Composite, ///< emission and absorption by the transfer function
    Mip,       ///< the largest intensity, as grey
    MinIp,     ///< the smallest
    Average,   ///< the mean along the path
    Surface    ///< the first surface of each feature
};
template <>
inline constexpr auto kNamesOf<RenderMode> = enumNames("way to draw", "composite", "mip", "minip", "average",
                                                       "surface");

/// Colours are those of the transfer function; in the other modes they are grey.
constexpr bool isColored(RenderMode mode) { return mode == RenderMode::Composite || mode == RenderMode::Surface; }

/// Light and what helps to see depth (docs/method.md, "Light"). It changes colours; measures, and the alpha of pixels
/// but for `gradientOpacity`, are those of the unlit transfer function. Ranges are those of settingsOf<Light>().
struct Light {
    bool on = false;
    double ambient = 0.35, diffuse = 0.65, specular = 0.25;
    double shininess = 24;      ///< exponent of the highlight
    Vec3 direction{0, 0, 1};    ///< toward the light, in the camera's right, up and toward the viewer; any length but 0
    double gradientOpacity = 0; ///< how far homogeneous regions fade
    double occlusion = 0;       ///< strength of ambient occlusion
    double depthCue = 0;        ///< how far the farthest fades into the background
    double silhouettes = 0;     ///< how dark surfaces get that are seen edge-on
    bool operator==(const Light&) const = default;
    /// Whether anything that is drawn depends on it.
    bool changesColors() const { return on || gradientOpacity > 0 || occlusion > 0 || depthCue > 0 || silhouettes > 0; }
};
/// All but the direction.
template <>
std::span<const Setting> settingsOf<Light>();

inline constexpr int kMostPixels = 16384; ///< along a side of a picture

struct RenderSettings {
    int width = 512, height = 512;                ///< pixels, each in [1, kMostPixels]
    std::optional<Rgb> background = Rgb{0, 0, 0}; ///< empty: transparent
    std::optional<Rgb> backgroundTop; ///< at the top of the picture, `background` at its bottom; empty: plain
    double stepInD0 = 0.5;            ///< largest distance of samples along a ray, in d0, (0, 16]
    /// How small that may become where the picture would change else, in d0; empty: the same everywhere.
    std::optional<double> finestInD0;
    RenderMode mode = RenderMode::Composite;
    Light light;
    Clipping clipping;
    bool jitter = false;  ///< shifts the samples of each pixel by a part of a step, against banding
    int onlyFeature = -1; ///< index: draw the voxels of this feature alone; −1: all
    /// In place of the colours of the transfer function, on the volume's grid; null: none.
    std::shared_ptr<const VoxelColors> colors;
    std::shared_ptr<const Ground> ground;   ///< what lies under the volume, opaque; null: nothing
    std::shared_ptr<const Overlay> overlay; ///< a second volume over this one; null: none

    void validate() const; ///< throws UsageError
    /// How often a step may be halved until the next time would make it smaller than finestInD0.
    int halvings() const;
    double smallestStep() const; ///< that any samples have, in d0
    /// Whether the faint rest is drawn: in mode Composite alone.
    bool drawsFaint() const {
        return mode == RenderMode::Composite && !clipping.rest.isNone() && clipping.rest.density > 0;
    }
    bool operator==(const RenderSettings&) const = default;
    /// The feature of `tf` that is drawn alone; null: all are drawn. Throws UsageError where it has none of this index.
    const Feature* featureAlone(const TransferFunction& tf) const;
};

} // namespace pellucid
