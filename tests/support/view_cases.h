// Cameras that sweeps differ for: perspective, orthographic, along an axis, and close up.
#pragma once

#include <vector>

#include "render/camera.h"

namespace pellucid::test {

/// `close`: how far the eye of the last one is from the centre, of the distance that shows all.
inline std::vector<Camera> viewCases(const Geometry& g, double close) {
    Camera near = cameraFromView(g, 120, 5, 1, Projection::Perspective);
    near.eye = near.center + close * (near.eye - near.center);
    return {cameraFromView(g, 30, 20, 1, Projection::Perspective),
            cameraFromView(g, 200, -35, 1, Projection::Orthographic),
            cameraFromView(g, 0, 0, 1, Projection::Orthographic), near};
}

} // namespace pellucid::test
