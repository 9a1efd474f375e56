// Draws marks into a picture.
#pragma once

#include <vector>

#include "base/image.h"
#include "render/annotation.h"

namespace pellucid {

/// Over the picture, in their order, with smooth edges. Pixels that no mark reaches keep their bits.
void drawMarks(Image& image, const std::vector<Mark>& marks);

} // namespace pellucid
