#include "session/refine_priority.h"

#include <algorithm>

#include "base/error.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/refine/region_colors.h"
#include "render/image_renderer.h"

namespace pellucid {

namespace {

constexpr int kUsualSize = 512; ///< pixels of a side, where nobody knows

} // namespace

RefineOptions refineOptions(const Session& session) {
    RefineOptions options = session.refine->options();
    options.profile = session.measure->profile;
    if (options.profile == Profile::Published) options.stepDown = kPublishedStep;
    if (options.profile == Profile::Published) options.stepUp = kPublishedStep;
    return options;
}

std::array<int, 2> regionPictureSize(const RefineSettings& settings) {
    return settings.regionSize[0] > 0 ? settings.regionSize : std::array{kUsualSize, kUsualSize};
}

std::vector<RegionColor> regionColors(const Scene& scene, const ImageRegion& region, const std::array<int, 2>& size,
                                      const JobControl& job) {
    const PictureInput picture = plainPictureInput(scene, size[0], size[1]);
    return regionColors(makeCpuRenderer(picture.volume)->render(picture.camera, picture.tf, picture.settings, job),
                        region);
}

RefinePriority huePriority(const Scene& scene, const TransferFunction& tf, double hue) {
    const TransferFunction drawn = withDrawnColors(tf, *scene.volume, scene.colors.get());
    RefinePriority priority;
    if (scene.session.measure->profile != Profile::Published) {
        priority.intensity = intensityOfHue(drawn, hue);
        return priority;
    }
    if (std::ranges::none_of(drawn.points, [](const ControlPoint& p) { return hsvFromRgb(p.color).saturation > 0; }))
        throw Error("no colour has a hue", "transfer function", "prioritize an intensity, or give it colours");
    priority.region = {{rgbFromHsv(hue, 1, 1), 1}};
    return priority;
}

RefinePriority refinePriority(const Scene& scene, const JobControl& job) {
    const RefineSettings& settings = *scene.session.refine;
    if (settings.hue) return huePriority(scene, scene.tf, *settings.hue);
    RefinePriority priority;
    priority.intensity = settings.intensity;
    if (!settings.intensity && settings.region)
        priority.region = regionColors(scene, *settings.region, regionPictureSize(settings), job);
    return priority;
}

} // namespace pellucid
