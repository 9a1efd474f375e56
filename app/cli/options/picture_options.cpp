#include "options/picture_options.h"

#include <algorithm>

namespace pellucid::cli {

void PictureOptions::add(CLI::App& app) {
    addValue(
        app, "--size", "WxH",
        [this](const std::string& text, const std::string& option) { size = parseImageSize(text, option); },
        "pixels (default 512x512)");
    addValue(
        app, "--background", "R,G,B|transparent",
        [this](const std::string& text, const std::string& option) {
            transparent = text == "transparent";
            if (!transparent) background = parseColor(text, option);
        },
        "components from 0 to 1, #rrggbb or transparent (default 0,0,0)");
    addValue(
        app, "--step", "D",
        [this](const std::string& text, const std::string& option) { step = parseRealAbove(text, option, 0, 16); },
        "largest distance of samples in reference lengths, the smallest voxel spacing (default 0.5)");
    app.add_flag("--shading", shading, "light from the eye, by the gradient");
    addRepeated(
        app, "--clip", "x:A:B",
        [this](const std::string& text, const std::string& option) { clips.push_back(parseClip(text, option)); },
        "draw only this part of the box along x, y or z, in fractions from 0 to 1");
    addValue(
        app, "--feature", "NAME", [this](const std::string& text, const std::string&) { feature = text; },
        "draw the voxels of this feature alone");
}

void PictureOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.display.edit([this](DisplaySettings& d) {
        d.background = background.value_or(d.background);
        d.light.on = d.light.on || shading;
    });
    if (clips.empty()) return;
    Clipping left;
    for (const Clip& clip : clips) {
        left.lo[clip.axis] = std::max(left.lo[clip.axis], clip.lo);
        left.hi[clip.axis] = std::min(left.hi[clip.axis], clip.hi);
        if (!(left.lo[clip.axis] < left.hi[clip.axis]))
            throw UsageError("nothing is left between the clips of one axis", "--clip", "let them overlap");
    }
    inputs.session.clipping.set(left);
}

void PictureOptions::applyTo(Scene& scene) const {
    if (!feature) return;
    std::string known;
    for (const Feature& f : scene.tf.features) {
        if (f.name == *feature) {
            scene.session.display.edit([&](DisplaySettings& d) { d.onlyFeature = f.id; });
            return;
        }
        known += (known.empty() ? "'" : ", '") + f.name + "'";
    }
    throw UsageError("no feature is named '" + *feature + "'", "--feature",
                     known.empty() ? "leave it out: this transfer function has none" : "known: " + known);
}

PictureInput PictureOptions::pictureOf(const Scene& scene) const {
    PictureInput picture = pictureInput(scene, size.width, size.height, transparent);
    if (step) picture.settings.stepInD0 = *step;
    picture.settings.validate();
    return picture;
}

} // namespace pellucid::cli
