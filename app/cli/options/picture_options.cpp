#include "options/picture_options.h"

namespace pellucid::cli {

void PictureOptions::add(CLI::App& app, Mode modeIs) {
    addValue(app, "--size", "WxH", size, parseImageSize, "pixels (default 512x512)");
    addLook(app, modeIs);
}

void PictureOptions::addLook(CLI::App& app, Mode modeIs) {
    addValue(
        app, "--background", "COLOR|TOP/BOTTOM|transparent",
        [this](const std::string& text, const std::string& option) {
            transparent = text == "transparent";
            if (!transparent) background = parseBackground(text, option);
        },
        "components R,G,B from 0 to 1 or #rrggbb, two of them for a gradient, or transparent (default 0,0,0)");
    addValue(app, "--step", "D", step, realAbove(0, 16),
             "distance of samples in reference lengths, the smallest voxel spacing (default 0.5, and less where "
             "--finest-step says so)");
    given.add(app, "Options", {"finest_step"});
    if (modeIs == Mode::Option) given.add(app, "Options", {"mode"});
    app.add_flag("--jitter", jitter, "shift the samples of each pixel, against bands of colour");
    addValue(app, "--feature", "NAME", feature, anyText,
             "draw the voxels of this feature alone; of a field, its values in these voxels");
    light.add(app);
}

void PictureOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.display.edit([this](DisplaySettings& d) {
        if (background) {
            d.background = background->bottom;
            d.backgroundTop = background->top;
        }
        given.applyTo(d);
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
        picture.settings.finestInD0.reset();
        if (given.has("finest_step")) picture.settings.finestInD0 = given.values().finestStep;
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
