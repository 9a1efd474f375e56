// What a session's refinement brings out (docs/method.md, "Entropy refinement"): the intensity, hue or region that is
// favoured, as refine() takes it.
#pragma once

#include <vector>

#include "optimize/refine/refine.h"
#include "session/scene.h"

namespace pellucid {

/// How the session refines, by the definitions of its profile, without what it favours.
RefineOptions refineOptions(const Session& session);

/// Pixels of the picture that the colours of the session's region are of, width and height.
std::array<int, 2> regionPictureSize(const RefineSettings& settings);
/// The colours of a region in the scene's picture of that size, unlit; by the cpu renderer: the same on every machine.
/// Throws Error where the region shows nothing, Cancelled.
std::vector<RegionColor> regionColors(const Scene& scene, const ImageRegion& region, const std::array<int, 2>& size,
                                      const JobControl& job = {});

/// What a hue (degrees, any real) means under `tf` in the picture of the scene: the intensity whose drawn colour is
/// nearest (intensityOfHue()); by the published profile the pure colour of that hue. Throws Error where every colour is
/// grey.
RefinePriority huePriority(const Scene& scene, const TransferFunction& tf, double hue);

/// All of it, in the scene as it is: what the session favours. Throws as the two above.
RefinePriority refinePriority(const Scene& scene, const JobControl& job = {});

} // namespace pellucid
