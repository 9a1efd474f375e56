#include "render/light_presets.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

namespace {

const std::array kPresets{
    LightPreset{"default", "a little gloss, clear but mild shadows", {.on = true}},
    LightPreset{"soft",
                "bright, with darkness in hollows and no gloss",
                {.on = true, .ambient = 0.55, .diffuse = 0.5, .specular = 0.03, .shininess = 8, .occlusion = 0.6}},
    LightPreset{
        "matte", "like chalk: no gloss", {.on = true, .ambient = 0.3, .diffuse = 0.75, .specular = 0, .shininess = 24}},
    LightPreset{"metal",
                "dark, with strong highlights",
                {.on = true, .ambient = 0.2, .diffuse = 0.55, .specular = 0.75, .shininess = 48}},
    LightPreset{"contrast",
                "deep shadows and dark edges: shapes before colours",
                {.on = true, .ambient = 0.12, .diffuse = 0.9, .specular = 0.2, .shininess = 32, .silhouettes = 0.6}}};

} // namespace

std::span<const LightPreset> lightPresets() { return kPresets; }

const LightPreset& lightPreset(const std::string& name) {
    const auto found = std::ranges::find(kPresets, name, &LightPreset::name);
    if (found != kPresets.end()) return *found;
    throw UsageError("no light is named '" + name + "'", "light",
                     "known: " + joined(kPresets, ", ", &LightPreset::name));
}

Light withPreset(const Light& light, const LightPreset& preset) {
    Light result = preset.light;
    result.direction = light.direction;
    return result;
}

const LightPreset* presetOf(const Light& light) {
    Light wanted = light;
    wanted.on = true;
    const auto found =
        std::ranges::find_if(kPresets, [&](const LightPreset& p) { return withPreset(light, p) == wanted; });
    return found == kPresets.end() ? nullptr : &*found;
}

} // namespace pellucid
