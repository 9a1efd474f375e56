// Built-in data that changes over time. Each frame is made on its own: the same bits in any order of frames, on any
// number of threads.
#pragma once

#include "base/job.h"
#include "volume/procedural.h"
#include "volume/volume.h"

namespace pellucid {

/// How many frames there are, and what values lie in.
inline constexpr int kVortexFrames = 100, kSmokeFrames = 120, kHurricaneFrames = 48;
inline constexpr ValueRange kVortexRange{0, 255}, kSmokeRange{0, 1};
inline constexpr ValueRange kCloudRange{0, 0.002}, kPrecipitationRange{0, 0.008}; ///< kg of water per kg of air
inline constexpr ValueRange kWindRange{0, 80};                                    ///< m/s
inline constexpr ValueRange kGroundRange{0, 1800};                                ///< m

/// The magnitude of a turbulent vorticity, u8: a divergence-free sum of waves that drift and are carried along by a
/// larger flow; small structures fade, and larger ones take their place.
Volume makeVortex(const Geometry& geometry, const SampleOrder& order, const JobControl& job);

/// The density of smoke that rises from a source at the bottom, f32: an incompressible flow on a coarse grid, step by
/// step. Frames that were computed are kept for the next call.
Volume makeSmoke(const Geometry& geometry, const SampleOrder& order, const JobControl& job);

/// A hurricane that crosses a coast, f32: cloud water, precipitation and wind speed over a box 20 km high and 2000 km
/// wide; missing (NaN) below the ground.
Volume makeCloud(const Geometry& geometry, const SampleOrder& order, const JobControl& job);
Volume makePrecipitation(const Geometry& geometry, const SampleOrder& order, const JobControl& job);
Volume makeWind(const Geometry& geometry, const SampleOrder& order, const JobControl& job);
/// Heights of the land under it, m, one layer, f32; 0 is the sea.
Volume makeHurricaneGround(const Geometry& geometry, const SampleOrder& order, const JobControl& job);

} // namespace pellucid
