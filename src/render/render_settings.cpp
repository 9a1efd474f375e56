#include "render/render_settings.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "base/error.h"

namespace pellucid {

template <>
std::span<const Setting> settingsOf<Light>() {
    constexpr auto isOn = [](const void* light) { return static_cast<const Light*>(light)->on; };
    static const Setting kSettings[] = {
        {.key = "on",
         .at = member<&Light::on>,
         .words = "&Light",
         .help = "Light the volume by the gradient of its values; figures do not depend on it.",
         .option = "shading"},
        {.key = "ambient",
         .at = member<&Light::ambient>,
         .words = "Ambient",
         .help = "How much light comes from everywhere, as a share of the colour's own brightness.",
         .range = {0, 2},
         .option = "",
         .used = isOn},
        {.key = "diffuse",
         .at = member<&Light::diffuse>,
         .words = "Diffuse",
         .help = "How much light falls on what faces it, as a share of the colour's own brightness.",
         .range = {0, 2},
         .option = "",
         .used = isOn},
        {.key = "specular",
         .at = member<&Light::specular>,
         .words = "Specular",
         .help = "How bright highlights are.",
         .range = {0, 2},
         .option = "",
         .used = isOn},
        {.key = "shininess",
         .at = member<&Light::shininess>,
         .words = "Shininess",
         .help = "The exponent of highlights: the higher it is, the smaller they are.",
         .range = {1, 1000},
         .option = "",
         .used = isOn},
        {.key = "silhouettes",
         .at = member<&Light::silhouettes>,
         .words = "Silhouettes",
         .help = "How much surfaces seen edge-on darken."},
        {.key = "occlusion", .at = member<&Light::occlusion>, .words = "Occlusion", .help = "How dark hollows become."},
        {.key = "depth_cue",
         .at = member<&Light::depthCue>,
         .words = "Depth cue",
         .help = "How much the farthest parts fade into the background."},
        {.key = "gradient_opacity",
         .at = member<&Light::gradientOpacity>,
         .words = "Surfaces",
         .help = "How much homogeneous regions fade, so that surfaces stay; figures do not depend on it."},
    };
    return kSettings;
}

void RenderSettings::validate() const {
    if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels)
        throw UsageError("an image must have 1 to " + std::to_string(kMostPixels) + " pixels along each side",
                         "image size", "give such a size");
    if (!(stepInD0 > 0 && stepInD0 <= 16))
        throw UsageError("the step must lie in (0, 16] reference lengths", "step", "give such a step");
    if (finestInD0 && !(*finestInD0 >= kFinestStep && *finestInD0 <= 16))
        throw UsageError("the finest step must lie in [1/256, 16] reference lengths", "finest step",
                         "give such a step");
    clipping.validate();
    checkSettings(light, "light");
    const double length = glm::length(light.direction);
    if (!(length > 0) || !std::isfinite(length))
        throw UsageError("the light needs a direction", "light", "give one that is finite and not 0");
}

int RenderSettings::halvings() const {
    if (mode != RenderMode::Composite || !finestInD0 || *finestInD0 >= stepInD0) return 0;
    return static_cast<int>(std::log2(stepInD0 / *finestInD0) + 1e-9);
}

double RenderSettings::smallestStep() const { return std::ldexp(stepInD0, -halvings()); }

const Feature* RenderSettings::featureAlone(const TransferFunction& tf) const {
    if (onlyFeature == -1) return nullptr;
    if (onlyFeature >= 0 && static_cast<std::size_t>(onlyFeature) < tf.features.size())
        return &tf.features[static_cast<std::size_t>(onlyFeature)];
    throw UsageError("there is no feature number " + std::to_string(onlyFeature), "transfer function",
                     "it has " + std::to_string(tf.features.size()) + ", counted from 0");
}

} // namespace pellucid
