// Pictures of a volume whose blocks lie on many ranks (docs/method.md, "Blocks of a volume").
#pragma once

#include <memory>

#include "ranks/communicator.h"
#include "render/image_renderer.h"

namespace pellucid {

/// The renderer of a volume with blocks on ranks (RankVoxels): each draws its block, and what they have drawn is laid
/// over each other from the eye on. Of one that is on every rank as a whole each draws a part of the picture. All calls
/// are collective, with equal arguments, and give all ranks the same picture. Throws UsageError for what blocks do not
/// draw by themselves: modes but composite, ambient occlusion, colours by voxel, a ground, an overlay.
std::unique_ptr<ImageRenderer> makeRendererOnRanks(Communicator& ranks, std::shared_ptr<const Volume> volume);

} // namespace pellucid
