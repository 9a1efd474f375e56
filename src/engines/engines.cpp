#include "engines/engines.h"

#include "base/error.h"
#include "engines/renderer_probe.h"
#include "render/cpu/cpu_engine.h"
#include "render/gl/gl_engines.h"

namespace pellucid {

bool haveGpu() {
    // Drivers do not come and go, and a context takes a while.
    static const bool gpu = [] {
        const auto info = probeGl();
        return info && !info->software;
    }();
    return gpu;
}

namespace {

/// Measured only where the answer is open: a software rasterizer is no faster than our own renderer.
bool gpuDrawsFaster() {
    static const bool faster = haveGpu() && timeRenderers().preferGl(true);
    return faster;
}

/// Who leaves the choice to us gets an answer even where the volume is too large for the GPU.
template <class T, class MakeGl, class MakeCpu>
std::unique_ptr<T> gpuElseCpu(MakeGl makeGl, MakeCpu makeCpu) {
    if (haveGpu()) {
        try {
            return makeGl();
        } catch (const Error&) { // said by the choice "gl"
        }
    }
    return makeCpu();
}

} // namespace

std::unique_ptr<VisibilityEngine> makeEngine(EngineChoice choice, std::shared_ptr<const Volume> volume,
                                             Quality quality) {
    if (choice == EngineChoice::Auto)
        return gpuElseCpu<VisibilityEngine>([&] { return makeGlEngine(volume, quality); },
                                            [&] { return makeCpuEngine(volume, quality); });
    switch (choice) {
    case EngineChoice::Gl:
        return makeGlEngine(std::move(volume), quality);
    case EngineChoice::Slices:
        return makeSlicesEngine(std::move(volume), quality);
    case EngineChoice::Reference:
        return makeReferenceEngine(std::move(volume));
    default:
        return makeCpuEngine(std::move(volume), quality);
    }
}

std::unique_ptr<ImageRenderer> makeRenderer(EngineChoice choice, std::shared_ptr<const Volume> volume) {
    if (choice == EngineChoice::Auto && !gpuDrawsFaster()) return makeCpuRenderer(std::move(volume));
    if (choice == EngineChoice::Auto)
        return gpuElseCpu<ImageRenderer>([&] { return makeGlRenderer(volume); },
                                         [&] { return makeCpuRenderer(volume); });
    if (choice == EngineChoice::Gl || choice == EngineChoice::Slices) return makeGlRenderer(std::move(volume));
    return makeCpuRenderer(std::move(volume));
}

} // namespace pellucid
