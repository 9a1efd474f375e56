#include "render/light_presets.h"

#include <algorithm>
#include <array>

#include "base/error.h"

namespace pellucid {

namespace {

/// Members that are not named are 0: a preset says all of the light.
struct Numbers {
    double ambient, diffuse, specular, shininess;
    double gradientOpacity = 0, occlusion = 0, depthCue = 0, silhouettes = 0;
};

Light lightOf(const Numbers& n) {
    Light light;
    light.on = true;
    light.ambient = n.ambient;
    light.diffuse = n.diffuse;
    light.specular = n.specular;
    light.shininess = n.shininess;
    light.gradientOpacity = n.gradientOpacity;
    light.occlusion = n.occlusion;
    light.depthCue = n.depthCue;
    light.silhouettes = n.silhouettes;
    return light;
}

Light lit(Light light) {
    light.on = true;
    return light;
}

const std::array kPresets{
    LightPreset{"default", "a little gloss, clear but mild shadows", lit({})},
    LightPreset{"soft", "bright, with darkness in hollows and no gloss",
                lightOf({.ambient = 0.55, .diffuse = 0.5, .specular = 0.03, .shininess = 8, .occlusion = 0.6})},
    LightPreset{"matte", "like chalk: no gloss",
                lightOf({.ambient = 0.3, .diffuse = 0.75, .specular = 0, .shininess = 24})},
    LightPreset{"metal", "dark, with strong highlights",
                lightOf({.ambient = 0.2, .diffuse = 0.55, .specular = 0.75, .shininess = 48})},
    LightPreset{"contrast", "deep shadows and dark edges: shapes before colours",
                lightOf({.ambient = 0.12, .diffuse = 0.9, .specular = 0.2, .shininess = 32, .silhouettes = 0.6})}};

} // namespace

std::span<const LightPreset> lightPresets() { return kPresets; }

const LightPreset& lightPreset(const std::string& name) {
    const auto found = std::find_if(kPresets.begin(), kPresets.end(), [&](const auto& p) { return name == p.name; });
    if (found != kPresets.end()) return *found;
    std::string known;
    for (const LightPreset& p : kPresets) known += (known.empty() ? "" : ", ") + std::string(p.name);
    throw UsageError("no light is named '" + name + "'", "light", "known: " + known);
}

Light withPreset(const Light& light, const LightPreset& preset) {
    Light result = preset.light;
    result.direction = light.direction;
    return result;
}

const LightPreset* presetOf(const Light& light) {
    const Light wanted = lit(light);
    const auto found = std::find_if(kPresets.begin(), kPresets.end(),
                                    [&](const LightPreset& p) { return withPreset(light, p) == wanted; });
    return found == kPresets.end() ? nullptr : &*found;
}

} // namespace pellucid
