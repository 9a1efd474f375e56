#include "render/feature_pictures.h"

#include <algorithm>

#include "render/background.h"

namespace pellucid {

namespace {

/// Sets alpha to 1 where the picture is not `behind`, else to 0.
void markChanges(Image& picture, const Image& behind) {
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        picture.rgba[i + 3] = std::equal(&picture.rgba[i], &picture.rgba[i] + 3, &behind.rgba[i]) ? 0.0f : 1.0f;
}

/// Puts the background behind the picture, whose alpha stays.
void paintBehind(Image& picture, const RenderSettings& settings) {
    Image shown = picture;
    paintBackground(shown, settings);
    for (std::size_t i = 3; i < shown.rgba.size(); i += 4) shown.rgba[i] = picture.rgba[i];
    picture = std::move(shown);
}

} // namespace

FeaturePictures featurePictures(ImageRenderer& renderer, const Camera& camera, const TransferFunction& tf,
                                const RenderSettings& settings, const JobControl& job) {
    const std::size_t features = tf.features.size();
    const std::vector<double> peaks = featureOpacities(tf);
    std::size_t drawn = 0;
    const auto draw = [&](const TransferFunction& what, const RenderSettings& how) {
        const JobControl part = job.part(std::min(drawn++, features), features + 1);
        return renderer.render(camera, what, how, part);
    };
    RenderSettings seen = settings; // over black where nothing else is behind
    seen.overlay.reset();
    if (!seen.background) seen.background = Rgb{};
    FeaturePictures pictures;
    pictures.whole = draw(tf, seen);
    Image behind;
    if (settings.ground) {
        TransferFunction clear = tf;
        for (ControlPoint& point : clear.points) point.opacity = 0;
        behind = draw(clear, seen);
    }
    for (std::size_t f = 0; f < features; ++f) {
        RenderSettings one = seen;
        one.onlyFeature = static_cast<int>(f);
        Image alone(settings.width, settings.height);
        if (peaks[f] > 0 && (settings.onlyFeature < 0 || settings.onlyFeature == one.onlyFeature)) {
            if (!settings.ground) {
                one.background.reset();
                one.backgroundTop.reset();
            }
            alone = draw(tf, one);
            if (settings.ground)
                markChanges(alone, behind); // the ground is opaque: alpha says nothing of the feature
            else
                paintBehind(alone, seen);
        }
        pictures.alone.push_back(std::move(alone));
    }
    return pictures;
}

} // namespace pellucid
