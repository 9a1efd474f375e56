#include "engines/engines.h"

#include "base/error.h"
#include "engines/divided_work.h"
#include "engines/renderer_probe.h"
#include "ranks/block_balance.h"
#include "ranks/process_ranks.h"
#include "ranks/rank_engine.h"
#include "ranks/rank_renderer.h"
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

void requireEngine(EngineChoice choice) {
    if (ranksOfProcess() != nullptr && choice != EngineChoice::Auto && choice != EngineChoice::Cpu)
        throw UsageError("ranks work with the cpu engine", "--engine", "leave it out, or use pellucid-cli");
}

std::unique_ptr<VisibilityEngine> makeEngine(EngineChoice choice, std::shared_ptr<const Volume> volume,
                                             Quality quality) {
    requireEngine(choice);
    if (Communicator* ranks = ranksOfProcess()) return makeEngineOnRanks(*ranks, std::move(volume), quality);
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

namespace {

/// OpenGL, and the cpu renderer where there is an overlay, which OpenGL does not draw.
class GlElseCpu final : public ImageRenderer {
public:
    explicit GlElseCpu(std::shared_ptr<const Volume> volume)
        : m_volume(std::move(volume)), m_gl(makeGlRenderer(m_volume)) {}

    std::string name() const override { return m_last->name(); }
    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        if (settings.overlay && !m_cpu) m_cpu = makeCpuRenderer(m_volume);
        m_last = settings.overlay ? m_cpu.get() : m_gl.get();
        return m_last->render(camera, tf, settings, job);
    }

private:
    std::shared_ptr<const Volume> m_volume;
    std::unique_ptr<ImageRenderer> m_gl, m_cpu;
    ImageRenderer* m_last = m_gl.get();
};

} // namespace

std::unique_ptr<ImageRenderer> makeRenderer(EngineChoice choice, std::shared_ptr<const Volume> volume) {
    requireEngine(choice);
    if (Communicator* ranks = ranksOfProcess()) return makeRendererOnRanks(*ranks, std::move(volume));
    if (choice == EngineChoice::Auto && !gpuDrawsFaster()) return makeCpuRenderer(std::move(volume));
    if (choice == EngineChoice::Auto)
        return gpuElseCpu<ImageRenderer>([&] { return std::make_unique<GlElseCpu>(volume); },
                                         [&] { return makeCpuRenderer(volume); });
    if (choice == EngineChoice::Gl || choice == EngineChoice::Slices)
        return std::make_unique<GlElseCpu>(std::move(volume));
    return makeCpuRenderer(std::move(volume));
}

SharedWork dividedWork() { return workOfProcess(); }

bool cutBlocksByWork(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, const MemoryUse& then,
                     const JobControl& job) {
    return cutByWork(volume, tf, clipping, then, job);
}

} // namespace pellucid
