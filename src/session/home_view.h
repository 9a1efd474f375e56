// Views that show all of what a scene draws, as large as it fits.
#pragma once

#include "session/scene.h"

namespace pellucid {

/// What the scene draws now, seen from where its features show most (openingView()). The scene has a volume. Throws
/// Cancelled.
Camera homeView(const Scene& scene, Projection projection, const JobControl& job = {});

/// What the scene draws now, seen from the direction of `camera`.
Camera fittedView(const Scene& scene, const Camera& camera, const JobControl& job = {});

} // namespace pellucid
