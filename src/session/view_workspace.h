// Where views are compared: a copy of the volume that is coarse enough for hundreds of them.
#pragma once

#include <mutex>

#include "optimize/views/view_search.h"
#include "session/scene.h"
#include "session/workspace.h"

namespace pellucid {

/// As fine as the sphere of views is looked at: more voxels are joined to blocks.
inline constexpr std::size_t kMostViewVoxels = 3'500'000;

/// The smallest factor by which the volume has no more than kMostViewVoxels.
int coarseningForViews(const Int3& dims);

/// What of `input` all views have in common.
ViewSubject viewSubject(const MeasureInput& input);

/// Keeps the coarse copy of a volume, an engine for it and its saliency from one search to the next. Threads take
/// turns. The same input gives the same map, whatever was searched before.
class ViewWorkspace {
public:
    /// By the draft engine, whichever `input` asks for. Throws UsageError for a profile that has no other views,
    /// Cancelled.
    ViewSearch search(const MeasureInput& input, const ViewMetric& metric, int count = kSphereViews,
                      const JobControl& job = {}, const std::function<void(const ViewMap&)>& watch = {});
    /// BestView after search() of the same input; the full volume by the session's engine.
    BestView best(Workspace& workspace, const MeasureInput& input, const ViewSearch& search,
                  const JobControl& job = {});
    /// reachableViews() of a search for targets, after search() of the same input.
    std::vector<ReachableView> reach(const MeasureInput& input, const ViewSearch& search,
                                     const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                                     const JobControl& job = {});
    void release(); ///< its memory, and that of the volume it was made for

private:
    ViewLevel level(const MeasureInput& input, const JobControl& job);
    void forget();

    std::mutex m_mutex;                     ///< whoever has stopped may still be at it while the next one begins
    std::shared_ptr<const Volume> m_volume; ///< the one that the copy was made of
    std::shared_ptr<const Volume> m_seen;   ///< the copy, or the volume itself where that is small
    std::unique_ptr<VisibilityEngine> m_engine;
    WeightsOf m_weightsOf; ///< the volume as it was before it was made coarse
    WeightFields m_weights;
};

/// What optimizing view and opacities together has found.
struct ViewAndOpacities {
    MeasureInput input; ///< that was optimized: `input` of the search from the view that was found
    OptimizeResult result;
    int views = 0; ///< that were looked at before
};
/// Opacities for the view among reachableViews() from which they come nearest to the targets, on the full volume; where
/// that is not on target, the present view is tried too. `watch` gets each move and what it is a move of. Throws
/// Cancelled.
ViewAndOpacities
optimizeViewAndOpacities(Workspace& workspace, ViewWorkspace& views, const MeasureInput& input,
                         const std::vector<double>& targets, const std::vector<OpacityLimits>& limits,
                         const OptimizeOptions& options, const JobControl& job = {},
                         const std::function<void(const MeasureInput&, const OptimizeState&)>& watch = {});

} // namespace pellucid
