#include "session/view_workspace.h"

#include <optional>

#include <glm/common.hpp>

#include "base/error.h"
#include "engines/divided_work.h"
#include "optimize/objective.h"
#include "render/cpu/cpu_engine.h"
#include "volume/excerpt.h"

namespace pellucid {

namespace {

constexpr std::size_t kFullTries = 2;  ///< views whose opacities are optimized on the full volume, at most
constexpr double kWellReached = 0.002; ///< F that makes no difference

} // namespace

int coarseningForViews(const Int3& dims) {
    int factor = 1;
    while (voxelCount((dims - 1) / glm::min(Int3(factor), dims) + 1) > kMostViewVoxels) ++factor;
    return factor;
}

ViewSubject viewSubject(const MeasureInput& input) {
    if (input.settings.profile == Profile::Published)
        throw UsageError("the published profile looks along the grid alone, from no other view", "views",
                         "take the default profile");
    return {input.view, input.tf, input.settings.vws};
}

void ViewWorkspace::release() {
    const std::lock_guard lock(m_mutex);
    forget();
}

void ViewWorkspace::forget() {
    m_engine.reset();
    m_volume.reset();
    m_seen.reset();
    m_weightsOf = {};
    m_weights = {};
}

ViewLevel ViewWorkspace::level(const MeasureInput& input, const JobControl& job) {
    if (m_volume != input.volume || !m_engine) {
        forget();
        const int factor = coarseningForViews(input.volume->dims());
        // The copy of a volume in blocks is a whole, for each process that has one of them.
        const bool isSeen = factor == 1 && input.volume->elsewhere() == nullptr;
        m_seen = isSeen ? input.volume : std::make_shared<const Volume>(coarserCopy(*input.volume, factor));
        job.throwIfStopped();
        m_engine = makeDraftEngine(m_seen);
        m_volume = input.volume;
    }
    if (const WeightsOf wanted(input); m_weightsOf != wanted) {
        m_weightsOf = {};
        const Volume& volume = *m_seen;
        std::optional<VoxelColors> coarse;
        if (input.colors && volume.dims() != input.volume->dims())
            coarse = coarserColors(*input.colors, coarseningForViews(input.volume->dims()));
        updateSaliencyFields(m_weights, volume, input.tf, input.settings.saliency, {job.stop, {}},
                             coarse ? &*coarse : input.colors.get());
        m_weightsOf = wanted;
    }
    return {*m_engine, m_weights, dividedWork()};
}

ViewSearch ViewWorkspace::search(const MeasureInput& input, const ViewMetric& metric, int count, const JobControl& job,
                                 const std::function<void(const ViewMap&)>& watch) {
    const ViewSubject subject = viewSubject(input);
    const std::lock_guard lock(m_mutex);
    return searchViews(level(input, job), subject, metric, count, job, watch);
}

std::vector<ReachableView> ViewWorkspace::reach(const MeasureInput& input, const ViewSearch& search,
                                                const std::vector<OpacityLimits>& limits,
                                                const OptimizeOptions& options, const JobControl& job) {
    const std::lock_guard lock(m_mutex);
    return reachableViews(level(input, job), viewSubject(input), search, limits, options, job);
}

BestView ViewWorkspace::best(Workspace& workspace, const MeasureInput& input, const ViewSearch& search,
                             const JobControl& job) {
    const ViewSubject subject = viewSubject(input);
    VisibilityEngine& engine = workspace.engine(input);
    const WeightFields& weights = workspace.weights(input, {job.stop, {}});
    const std::lock_guard lock(m_mutex);
    return bestView(level(input, job), ViewLevel{engine, weights}, subject, search, job);
}

ViewAndOpacities optimizeViewAndOpacities(Workspace& workspace, ViewWorkspace& views, const MeasureInput& input,
                                          const std::vector<double>& targets, const std::vector<OpacityLimits>& limits,
                                          const OptimizeOptions& options, const JobControl& job,
                                          const std::function<void(const MeasureInput&, const OptimizeState&)>& watch) {
    ViewMetric metric;
    metric.targets = normalizedTargets(targets, input.tf.features.size());
    const ViewSearch search = views.search(input, metric, kSphereViews, job.part(0, 2));
    const std::vector<ReachableView> reached = views.reach(input, search, limits, options, job.part(1, 2));

    const auto optimizeFrom = [&](const Camera& camera, const std::vector<double>* opacity) {
        MeasureInput from = input;
        from.view.camera = camera;
        if (opacity != nullptr) from.tf = withFeatureOpacities(from.tf, *opacity);
        OptimizeResult result =
            workspace.optimize(from, targets, limits, options, {job.stop, {}}, [&](const OptimizeState& state) {
                if (watch) watch(from, state);
            });
        if (result.reason == StopReason::Cancelled) throw Cancelled{};
        return ViewAndOpacities{from, std::move(result), static_cast<int>(search.map.values.size() + reached.size())};
    };
    const auto objectiveAt = [](const ViewAndOpacities& v) { return v.result.history[v.result.best].objective; };

    // From the present opacities, as everywhere; where that leads elsewhere, from those that the search has found.
    std::optional<ViewAndOpacities> best;
    const auto take = [&](ViewAndOpacities next) {
        if (!best || objectiveAt(next) < objectiveAt(*best)) best = std::move(next);
    };
    const auto reachedIt = [&](double objective) { return objective < options.tolerance || objective <= kWellReached; };
    for (std::size_t i = 0; i < reached.size() && i < kFullTries; ++i) {
        take(optimizeFrom(reached[i].camera, nullptr));
        if (objectiveAt(*best) > reached[i].objective + kWellReached && !reachedIt(objectiveAt(*best)))
            take(optimizeFrom(reached[i].camera, &reached[i].opacity));
        if (reachedIt(objectiveAt(*best))) return std::move(*best);
    }
    take(optimizeFrom(input.view.camera, nullptr));
    return std::move(*best);
}

} // namespace pellucid
