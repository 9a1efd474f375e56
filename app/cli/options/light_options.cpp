#include "options/light_options.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "parse.h"
#include "render/light_presets.h"

namespace pellucid::cli {

namespace {

/// What --light takes: the settings that count where there is light.
constexpr std::array kParts{"ambient", "diffuse", "specular", "shininess"};

/// "ambient (from 0 to 2; default 0.35)".
std::string rangeOfPart(const std::string& key) {
    const Light usual;
    const Setting& setting = settingOf(settingsOf<Light>(), key);
    return key + " (" + setting.range.text() + "; default " + textOf(setting, &usual) + ")";
}

Vec3 parseDirection(const std::string& text, const std::string& option) {
    const std::vector<double> v = parseReals(text, option, 3, "X,Y,Z: right, up and toward the viewer");
    const Vec3 direction{v[0], v[1], v[2]};
    if (!(glm::length(direction) > 0)) throw UsageError("0,0,0 is not a direction", option, "0,0,1 comes from the eye");
    return direction;
}

} // namespace

/// "ambient=0.3,diffuse=0.7,specular=0.2,shininess=24", any of them.
void LightOptions::takeParts(const std::string& text, const std::string& option) {
    for (const std::string& part : split(text, ',')) {
        const std::vector<std::string> pair = split(part, '=');
        const std::string form = "give ambient=A,diffuse=D,specular=S,shininess=N, or some of them";
        if (pair.size() != 2) throw UsageError("'" + part + "' is not a part of the light", option, form);
        if (std::find(kParts.begin(), kParts.end(), pair[0]) == kParts.end())
            throw UsageError("the light has no part called '" + pair[0] + "'", option, form);
        atOption(option, [&] { given.take(settingOf(settingsOf<Light>(), pair[0]), pair[1]); });
    }
}

void LightOptions::add(CLI::App& app) {
    const char* const group = "Light";
    app.add_flag("--shading", shading, "light, by the gradient (default: what the session says, else none)")
        ->group(group);
    app.add_flag("--no-shading", noShading, "none, whatever the session says")->group(group);
    addValue(
        app, "--light-preset", joined(lightPresets(), "|", &LightPreset::name),
        [this](const std::string& text, const std::string& option) {
            preset = atOption(option, [&] { return std::string(lightPreset(text).name); });
        },
        "light with all its numbers; like the next two it turns the light on", group);
    addValue(
        app, "--light", "KEY=VALUE,...",
        [this](const std::string& text, const std::string& option) { takeParts(text, option); },
        "any of " + joined(kParts, ", ", rangeOfPart), group);
    addValue(app, "--light-direction", "X,Y,Z", direction, parseDirection,
             "where the light comes from: right, up and toward the viewer (default 0,0,1, from the eye)", group);
    // Of `measure` --occlusion is something else: ambient occlusion is the session's or the preset's there.
    if (app.get_option_no_throw("--occlusion") == nullptr) given.add(app, group, {"occlusion"});
    given.add(app, group, {"gradient_opacity", "depth_cue", "silhouettes"});
}

bool LightOptions::saysHowBright() const {
    return preset || direction ||
           std::any_of(kParts.begin(), kParts.end(), [&](const char* key) { return given.has(key); });
}

void LightOptions::applyTo(Light& light) const {
    if (noShading && (shading || saysHowBright()))
        throw UsageError("--no-shading does not go with other options of the light", "--no-shading",
                         "leave out --no-shading or the others");
    if (preset) light = withPreset(light, lightPreset(*preset));
    if (noShading) light.on = false;
    if (shading || saysHowBright()) light.on = true;
    given.applyTo(light);
    light.direction = direction.value_or(light.direction);
}

} // namespace pellucid::cli
