#include "options/light_options.h"

#include <glm/geometric.hpp>

#include "parse.h"
#include "render/light_presets.h"

namespace pellucid::cli {

namespace {

std::string presetNames(const char* separator) {
    std::string names;
    for (const LightPreset& preset : lightPresets())
        names += (names.empty() ? "" : separator) + std::string(preset.name);
    return names;
}

Vec3 parseDirection(const std::string& text, const std::string& option) {
    const std::vector<double> v = parseReals(text, option, 3, "X,Y,Z: right, up and toward the viewer");
    const Vec3 direction{v[0], v[1], v[2]};
    if (!(glm::length(direction) > 0)) throw UsageError("0,0,0 is no direction", option, "0,0,1 comes from the eye");
    return direction;
}

} // namespace

/// "ambient=0.3,diffuse=0.7,specular=0.2,shininess=24", any of them.
void LightOptions::takeParts(const std::string& text, const std::string& option) {
    for (const std::string& part : split(text, ',')) {
        const std::vector<std::string> pair = split(part, '=');
        const std::string form = "give ambient=A,diffuse=D,specular=S,shininess=N, or some of them";
        if (pair.size() != 2) throw UsageError("'" + part + "' is no part of a light", option, form);
        if (pair[0] == "ambient")
            ambient = parseReal(pair[1], option, 0, 2);
        else if (pair[0] == "diffuse")
            diffuse = parseReal(pair[1], option, 0, 2);
        else if (pair[0] == "specular")
            specular = parseReal(pair[1], option, 0, 2);
        else if (pair[0] == "shininess")
            shininess = parseReal(pair[1], option, 1, 1000);
        else
            throw UsageError("a light has no '" + pair[0] + "'", option, form);
    }
}

void LightOptions::add(CLI::App& app) {
    const char* const group = "Light";
    app.add_flag("--shading", shading, "light, by the gradient (default: what the session says, else none)")
        ->group(group);
    app.add_flag("--no-shading", noShading, "none, whatever the session says")->group(group);
    addValue(
        app, "--light-preset", presetNames("|"),
        [this](const std::string& text, const std::string& option) {
            preset = atOption(option, [&] { return std::string(lightPreset(text).name); });
        },
        "light with all its numbers; like the next two it turns the light on", group);
    addValue(
        app, "--light", "KEY=VALUE,...",
        [this](const std::string& text, const std::string& option) { takeParts(text, option); },
        "any of ambient, diffuse, specular (0 to 2; default 0.35, 0.65, 0.25) and shininess (1 to 1000; default 24)",
        group);
    addValue(
        app, "--light-direction", "X,Y,Z",
        [this](const std::string& text, const std::string& option) { direction = parseDirection(text, option); },
        "where it comes from: right, up and toward the viewer (default 0,0,1, from the eye)", group);
    const auto addStrength = [&](const char* name, std::optional<double>& value, const char* help) {
        addValue(
            app, name, "S",
            [&value](const std::string& text, const std::string& option) { value = parseReal(text, option, 0, 1); },
            help, group);
    };
    addStrength("--gradient-opacity", gradientOpacity,
                "0 to 1: how far what is homogeneous fades; figures do not depend on it");
    addStrength("--occlusion", occlusion, "0 to 1: how dark hollows get");
    addStrength("--depth-cue", depthCue, "0 to 1: how far what is far fades into the background");
    addStrength("--silhouettes", silhouettes, "0 to 1: how dark surfaces get that are seen edge-on");
}

void LightOptions::applyTo(Light& light) const {
    if (noShading && (shading || saysHowBright()))
        throw UsageError("a light is given and no light", "--no-shading", "leave it or the light's options out");
    if (preset) light = withPreset(light, lightPreset(*preset));
    if (noShading) light.on = false;
    if (shading || saysHowBright()) light.on = true;
    light.ambient = ambient.value_or(light.ambient);
    light.diffuse = diffuse.value_or(light.diffuse);
    light.specular = specular.value_or(light.specular);
    light.shininess = shininess.value_or(light.shininess);
    light.direction = direction.value_or(light.direction);
    light.gradientOpacity = gradientOpacity.value_or(light.gradientOpacity);
    light.occlusion = occlusion.value_or(light.occlusion);
    light.depthCue = depthCue.value_or(light.depthCue);
    light.silhouettes = silhouettes.value_or(light.silhouettes);
}

} // namespace pellucid::cli
