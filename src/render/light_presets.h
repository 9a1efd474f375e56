// Ready-made light, for the window and the command line.
#pragma once

#include <span>
#include <string>

#include "render/render_settings.h"

namespace pellucid {

struct LightPreset {
    const char* name;        ///< one lower-case word
    const char* description; ///< what it looks like, a phrase
    Light light;             ///< on; its direction is not part of the preset
};

/// The first is what Light has by itself.
std::span<const LightPreset> lightPresets();
/// Throws UsageError where none has the name.
const LightPreset& lightPreset(const std::string& name);

/// The light of the preset from where `light` comes.
Light withPreset(const Light& light, const LightPreset& preset);
/// The preset that `light` looks like, whether it is on or not and wherever it comes from; null: its own.
const LightPreset* presetOf(const Light& light);

} // namespace pellucid
