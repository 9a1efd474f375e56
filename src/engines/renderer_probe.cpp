#include "engines/renderer_probe.h"

#include <chrono>

#include "base/error.h"
#include "render/gl/gl_engines.h"
#include "render/image_renderer.h"
#include "volume/procedural.h"

namespace pellucid {

namespace {

constexpr int kVoxels = 64, kPixels = 320;

/// The better of two pictures of a turning volume; a first one, which prepares, does not count.
double secondsOf(ImageRenderer& renderer, const Volume& volume, const JobControl& job) {
    const TransferFunction tf = tents(3, 0.25);
    RenderSettings settings;
    settings.width = settings.height = kPixels;
    settings.stepInD0 = 1;
    settings.light.on = true;
    double best = 0;
    for (int i = 0; i < 3; ++i) {
        const Camera camera = cameraFromView(volume.geometry(), 20 + 30 * i, 20, 1.2, Projection::Perspective);
        const auto begin = std::chrono::steady_clock::now();
        renderer.render(camera, tf, settings, job);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (i == 1 || (i == 2 && seconds < best)) best = seconds;
    }
    return best;
}

} // namespace

RendererTimes timeRenderers(const JobControl& job) {
    const JobControl quiet{job.stop, {}};
    const auto volume = std::make_shared<const Volume>(makeSample("shells", kVoxels));
    RendererTimes times;
    times.cpu = secondsOf(*makeCpuRenderer(volume), *volume, quiet);
    try {
        times.gl = secondsOf(*makeGlRenderer(volume), *volume, quiet);
    } catch (const Error&) { // whoever asks for gl hears of it
    }
    return times;
}

} // namespace pellucid
