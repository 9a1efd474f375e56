// Which engine does the work: the one place that knows all of them.
#pragma once

#include <memory>

#include "render/engine_choice.h"
#include "render/image_renderer.h"
#include "volume/memory_use.h"

namespace pellucid {

/// Whether OpenGL finds a real GPU here, not a software rasterizer. Asked once.
bool haveGpu();

/// Throws UsageError where this process is one of several ranks, which have the cpu engine alone.
void requireEngine(EngineChoice choice);

/// Auto: gl on a real GPU, cpu on a software rasterizer, without GL, or where the volume is too large for the GPU.
std::unique_ptr<VisibilityEngine> makeEngine(EngineChoice choice, std::shared_ptr<const Volume> volume,
                                             Quality quality = Quality::Normal);
/// Auto: on a real GPU whichever of gl and cpu is faster here (renderer_probe.h), measured once; else cpu. The
/// reference choice draws with the cpu renderer, since no other image is defined; slices are what gl draws. Pictures
/// with an overlay are the cpu renderer's, whatever is chosen: name() is that of the renderer that drew last.
std::unique_ptr<ImageRenderer> makeRenderer(EngineChoice choice, std::shared_ptr<const Volume> volume);

/// Where this process is one of several that have blocks of the volume: cutByWork(), so that it is to be read again if
/// this is true. Else false.
bool cutBlocksByWork(const Volume& volume, const TransferFunction& tf, const Clipping& clipping, const MemoryUse& then,
                     const JobControl& job = {});

} // namespace pellucid
