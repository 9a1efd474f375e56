#include "options/picture_options.h"

namespace pellucid::cli {

void PictureOptions::add(CLI::App& app, Mode modeIs) {
    addValue(
        app, "--size", "WxH",
        [this](const std::string& text, const std::string& option) { size = parseImageSize(text, option); },
        "pixels (default 512x512)");
    addValue(
        app, "--background", "COLOR|TOP/BOTTOM|transparent",
        [this](const std::string& text, const std::string& option) {
            transparent = text == "transparent";
            if (!transparent) background = parseBackground(text, option);
        },
        "components R,G,B from 0 to 1 or #rrggbb, two of them for a gradient, or transparent (default 0,0,0)");
    addValue(
        app, "--step", "D",
        [this](const std::string& text, const std::string& option) { step = parseRealAbove(text, option, 0, 16); },
        "distance of samples in reference lengths, the smallest voxel spacing (default 0.5, and less where "
        "--finest-step says so)");
    addValue(
        app, "--finest-step", "D",
        [this](const std::string& text, const std::string& option) {
            finest = parseReal(text, option, kFinestStep, 16);
        },
        "how small that may become where it would change the picture by 1/255 (default: what the session says, else "
        "1/16; with --step: no smaller than that)");
    if (modeIs == Mode::Option)
        addValue(
            app, "--mode", "composite|mip|minip|average|surface",
            [this](const std::string& text, const std::string& option) {
                mode = renderModeFromName(text);
                if (!mode)
                    throw UsageError("'" + text + "' is no way to draw", option,
                                     "use composite, mip, minip, average or surface");
            },
            "what becomes of the intensities along a ray: emission and absorption by the transfer function (default); "
            "the "
            "largest, smallest or mean one, as grey; the first surface of each feature");
    app.add_flag("--jitter", jitter, "shift the samples of each pixel, against bands of colour");
    addValue(
        app, "--feature", "NAME", [this](const std::string& text, const std::string&) { feature = text; },
        "draw the voxels of this feature alone, or of a field what it is in them");
    light.add(app);
}

void PictureOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.display.edit([this](DisplaySettings& d) {
        if (background) {
            d.background = background->bottom;
            d.backgroundTop = background->top;
        }
        d.mode = mode.value_or(d.mode);
        d.finestStep = finest.value_or(d.finestStep);
        light.applyTo(d.light);
    });
}

void PictureOptions::applyTo(Scene& scene) const {
    if (!feature) return;
    const FeatureId id = scene.tf.features[parseFeature(*feature, "--feature", scene.tf)].id;
    scene.session.display.edit([&](DisplaySettings& d) { d.onlyFeature = id; });
    scene.session.field.edit([&](FieldView& view) { view.feature = id; });
}

void PictureOptions::applyTo(PictureInput& picture) const {
    if (step) {
        picture.settings.stepInD0 = *step;
        picture.settings.finestInD0 = finest;
    }
    picture.settings.jitter = jitter;
    picture.settings.validate();
}

PictureInput PictureOptions::pictureOf(const Scene& scene) const {
    PictureInput picture = pictureInput(scene, size.width, size.height, transparent);
    applyTo(picture);
    return picture;
}

} // namespace pellucid::cli
