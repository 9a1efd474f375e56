#include "render/gl/engines.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "render/gl/headless_context.h"

namespace pellucid {

bool isSoftwareRenderer(std::string renderer) {
    std::transform(renderer.begin(), renderer.end(), renderer.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "software", "swiftshader", "swr"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
}

EngineChoice engineChoiceFromName(const std::string& name) {
    if (name == "auto") return EngineChoice::Auto;
    if (name == "gl") return EngineChoice::Gl;
    if (name == "cpu") return EngineChoice::Cpu;
    if (name == "reference") return EngineChoice::Reference;
    throw UsageError("unknown engine \"" + name + "\"", "engine", "use auto, gl, cpu or reference");
}

std::optional<GlInfo> probeGl() {
    try {
        return gl::HeadlessContext().info();
    } catch (const Error&) {
        return {};
    }
}

namespace {

bool haveGpu() {
    // Asked once: drivers do not come and go, and a context takes a while.
    static const bool gpu = [] {
        const auto info = probeGl();
        return info && !info->software;
    }();
    return gpu;
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
    case EngineChoice::Reference:
        return makeReferenceEngine(std::move(volume));
    default:
        return makeCpuEngine(std::move(volume), quality);
    }
}

std::unique_ptr<ImageRenderer> makeRenderer(EngineChoice choice, std::shared_ptr<const Volume> volume) {
    if (choice == EngineChoice::Auto)
        return gpuElseCpu<ImageRenderer>([&] { return makeGlRenderer(volume); },
                                         [&] { return makeCpuRenderer(volume); });
    if (choice == EngineChoice::Gl) return makeGlRenderer(std::move(volume));
    return makeCpuRenderer(std::move(volume));
}

} // namespace pellucid
