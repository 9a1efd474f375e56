// Where the volume's box lies in the image.
#pragma once

#include "render/camera.h"

namespace pellucid {

/// Part of the image that the box covers, pixels from the top left corner, and how deep the box is along the view.
struct BoxInImage {
    int x = 0, y = 0, width = 0, height = 0; ///< width 0: the box is outside the image
    double depthInD0 = 0;
};
BoxInImage boxInImage(const Camera& camera, const Geometry& geometry, int width, int height);

} // namespace pellucid
