// What a picture should look like.
#pragma once

#include <array>
#include <optional>

#include "render/camera.h"
#include "tf/color.h"
#include "tf/transfer_function.h"

namespace pellucid {

struct RenderSettings {
    int width = 512, height = 512;                ///< pixels, each in [1, 16384]
    std::optional<Rgb> background = Rgb{0, 0, 0}; ///< empty: transparent
    double stepInD0 = 0.5;                        ///< largest distance of samples along a ray, in d0, (0, 16]
    bool shading = false;                         ///< diffuse and specular light from the eye, by the gradient
    /// The part of the box that is drawn, in fractions [0,1] of it along each axis, lo < hi.
    Vec3 clipLo{0, 0, 0}, clipHi{1, 1, 1};
    int onlyFeature = -1; ///< index: draw the voxels of this feature alone; −1: all

    void validate() const; ///< throws UsageError
    bool operator==(const RenderSettings&) const = default;
    /// The feature of `tf` that is drawn alone; null: all are drawn. Throws UsageError where it has none of this index.
    const Feature* featureAlone(const TransferFunction& tf) const;
};

} // namespace pellucid
