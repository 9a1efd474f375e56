// The sweeps of one volume on the device: visibility (docs/method.md, "The gl engine") and its sums per feature. Rays
// march through the volume and leave in a buffer how much light they bring to every voxel plane; a second pass gathers
// from it, per voxel, the light in front of it; a third one adds up. Lives in one OpenGL context.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "render/gl/measure_buffers.h"
#include "render/gl/resident_volume.h"
#include "render/gl/sweep_geometry.h"
#include "render/gl/visibility_gl.h"

namespace pellucid::gl {

struct SweepRequest {
    std::vector<Sweep> sweeps;
    Vec3 eyeInVoxels{0, 0, 0};
    DepthTables tables; ///< 1, 4 or 8 candidates
    // For sums:
    int features = 0;
    std::vector<std::uint16_t> slotOfCode; ///< index of the feature; `features` for "in none"
    const WeightFields* weights = nullptr; ///< null: no weighted sums
    std::uint64_t weightsKey = 0;          ///< tells weights apart
};

/// The visibilities of some planes of one sweep.
struct SweptPlanes {
    const Sweep& sweep;
    int first, end;                ///< c
    std::span<const float> values; ///< a fastest, then b, then c − first
};

class SweepDevice {
public:
    /// `grid` must outlive the device. Throws Error where the context is older than 4.3.
    SweepDevice(const IntensityGrid& grid, const VisibilityBudget& budget);
    ~SweepDevice();
    SweepDevice(const SweepDevice&) = delete;
    SweepDevice& operator=(const SweepDevice&) = delete;

    /// How many candidates one pass can carry within the device's limits: 1, 4 or 8. Throws Error where not even one.
    int candidatesAtOnce(const SweepRequest& request) const;
    /// [slot][item][candidate] for the slots 0 … features; items are Σv, Σv·brightness, Σv·saturation, the weights in
    /// units of their 16 bits. The same bits in every run. Throws Error, Cancelled.
    std::vector<double> sums(const SweepRequest& request, const JobControl& job);
    /// All planes that have voxels, in the order of the sweeps; one candidate. Throws Error, Cancelled.
    void field(const SweepRequest& request, const JobControl& job, const std::function<void(const SweptPlanes&)>& sink);

private:
    class Programs;
    using AfterPlanes = std::function<void(const Sweep&, int first, int end)>;

    /// Sweeps everything, some planes at a time; `after` is called when the shaders have been given their work.
    /// `slots` 0: the visibility per voxel goes to m_output; else the sums of the work groups.
    void runSweeps(const SweepRequest& request, int slots, const JobControl& job, const AfterPlanes& after);
    void runSweep(const SweepRequest& request, const Sweep& sweep, int slots, const JobControl& job,
                  const AfterPlanes& after);
    /// Makes room for the steps of a sweep, the volume included, and says how many planes one can take.
    int prepare(const Sweep& sweep, int candidates, int slots);
    const Programs& programsFor(int candidates, int slots, bool clipped);
    double bufferLimit() const;

    const IntensityGrid& m_grid;
    VisibilityBudget m_budget;
    ResidentVolume m_volume;
    std::map<std::vector<std::string>, std::unique_ptr<Programs>> m_programs;
    TableBuffers m_tables;
    FeatureTotals m_totals;
    Buffer m_light, m_output;
};

} // namespace pellucid::gl
