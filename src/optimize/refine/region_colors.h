// The colours of a region of a picture, which refinement brings out (docs/method.md, "Entropy refinement", (3.10)).
#pragma once

#include <vector>

#include "base/image.h"
#include "optimize/refine/refine.h"
#include "render/image_region.h"

namespace pellucid {

/// The colours of the pixels whose centres lie in the region, each colour once, sorted; pixels of alpha 0 are skipped.
/// `picture` is unlit and has no background, see plainPictureInput() in session/scene.h. Throws Error where no pixel is
/// left.
std::vector<RegionColor> regionColors(const Image& picture, const ImageRegion& region);

} // namespace pellucid
