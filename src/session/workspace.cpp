#include "session/workspace.h"

#include "base/stopwatch.h"
#include "engines/engines.h"
#include "optimize/ray_vws.h"
#include "render/memory_needs.h"
#include "render/published_engine.h"
#include "saliency/published_saliency.h"

namespace pellucid {

namespace {

/// What measuring takes under these settings.
MemoryUse useUnder(const MeasureSettings& settings) {
    const MemoryUse use = toMeasure("measuring");
    if (settings.profile == Profile::Published) return byPublished(use);
    return settings.engine == EngineChoice::Reference ? byReference(use) : use;
}

} // namespace

VisibilityEngine& Workspace::engine(const MeasureInput& input) {
    const MeasureSettings& settings = input.settings;
    const EngineOf wanted{input.volume, settings.engine, settings.quality, settings.profile};
    if (!m_engine || m_engineOf != wanted) {
        m_engine.reset();
        if (m_weightsOf.volume != input.volume) { // what was measured before needs no room any more
            m_weightsOf.volume.reset();
            m_weights = {};
        }
        if (m_raysOf.volume != input.volume) releaseRays();
        try {
            requireMemory(ofPartHere(useUnder(settings), *input.volume), input.volume->title, input.volume->dimsHere(),
                          input.volume->sampleType());
        } catch (const FileError& e) { // the file is sound: a frame of a series is not to be passed over
            throw Error(e);
        }
        m_engine = settings.profile == Profile::Published ? makePublishedEngine(input.volume)
                                                          : makeEngine(settings.engine, input.volume, settings.quality);
        m_engineOf = wanted;
    }
    return *m_engine;
}

void Workspace::releaseEngine() {
    m_engine.reset();
    m_engineOf.volume.reset();
    releaseRays();
}

void Workspace::releaseRays() {
    m_rays.reset();
    m_raySamples.reset();
    m_raysOf = {};
}

const WeightFields& Workspace::weights(const MeasureInput& input, const JobControl& job) {
    m_seconds.saliency = 0;
    if (!haveWeights(input)) {
        const Stopwatch watch;
        m_weightsOf.volume.reset();
        m_raySamples.reset();
        const bool published = input.settings.profile == Profile::Published;
        if (published || m_weightsOf.profile != input.settings.profile) m_weights = {}; // of another form
        m_weightsOf.profile = input.settings.profile;
        if (published)
            m_weights = publishedSaliencyFields(*input.volume, input.tf, job);
        else
            updateSaliencyFields(m_weights, *input.volume, input.tf, input.settings.saliency, job, input.colors.get());
        m_weightsOf = WeightsOf(input);
        m_seconds.saliency = watch.seconds();
    }
    return m_weights;
}

void Workspace::lookAlong(const MeasureInput& input) {
    RaysOf now{input.volume, input.view, withFullPeaks(input.tf)};
    if (now == m_raysOf) return;
    releaseRays();
    m_raysOf = std::move(now);
}

const RayBundle& Workspace::rays(const MeasureInput& input, const JobControl& job) {
    lookAlong(input);
    if (!m_rays) m_rays.emplace(*input.volume, input.tf, input.view, kCoverageRays, job);
    return *m_rays;
}

EngineVws Workspace::vws(const MeasureInput& input, const JobControl& job) {
    VisibilityEngine& e = engine(input);
    return {e, input.view, input.tf, weights(input, job), input.settings.vws};
}

Measures Workspace::measure(const MeasureInput& input, const JobControl& job) {
    return guarded([&] {
        VisibilityEngine& e = engine(input);
        const bool all = !haveWeights(input); // half of the work, or none
        const WeightFields& w = weights(input, all ? job.part(0, 2) : job);
        Measures measures =
            pellucid::measure(e, input.view, input.tf, w, input.settings.vws, all ? job.part(1, 2) : job);
        if (input.settings.profile == Profile::Published) // closed intervals, where bins of a histogram are not
            measures.features = featureMeasures(e.sums(input.view, {&input.tf, 1}, &w)[0], input.settings.vws);
        m_seconds.visibility = measures.visibilitySeconds;
        return measures;
    });
}

Coverage Workspace::coverage(const MeasureInput& input, const JobControl& job) {
    return coverageOf(rays(input, job), input.tf);
}

std::vector<std::vector<double>> Workspace::jacobian(const MeasureInput& input, const JobControl& job) {
    return guarded([&] {
        VisibilityEngine& e = engine(input);
        const bool all = !haveWeights(input);
        const WeightFields& w = weights(input, all ? job.part(0, 2) : job);
        const Stopwatch watch;
        auto matrix = vwsJacobian(e.jacobian(input.view, input.tf, &w, all ? job.part(1, 2) : job), input.settings.vws);
        m_seconds.visibility = watch.seconds();
        return matrix;
    });
}

OcclusionMatrix Workspace::occlusion(const MeasureInput& input, const JobControl& job) {
    return guarded([&] { return pellucid::occlusion(engine(input), input.view, input.tf, job); });
}

VwsEstimates Workspace::estimates(const MeasureInput& input, const JobControl& job) {
    if (input.settings.profile != Profile::Default) return {};
    lookAlong(input);
    if (!m_raySamples)
        m_raySamples =
            std::make_shared<RaySamples>(*input.volume, input.tf, input.view, m_weights, JobControl{job.stop, {}});
    return rayEstimates(m_raySamples, input.tf, input.settings.vws);
}

Field Workspace::field(const MeasureInput& input, FieldKind kind, int feature, const JobControl& job) {
    return guarded([&] {
        const Volume& volume = *input.volume;
        const bool swept = dependsOnView(kind), weighted = kind != FieldKind::Visibility;
        VisibilityEngine* const e = swept ? &engine(input) : nullptr;
        const bool all = weighted && !haveWeights(input);
        requireMemory(toDrawField(all), volume.title, volume.dimsHere(), volume.sampleType());
        // Saliency, sweep and what is made of them are about as long.
        std::size_t done = 0;
        const std::size_t parts = (all ? 1u : 0u) + (swept ? 1u : 0u) + 1u;
        const WeightFields* w = nullptr;
        if (weighted) {
            w = &weights(input, job.part(done, parts));
            done += all ? 1 : 0;
        }
        Grid<float> values;
        const Stopwatch watch;
        if (swept) {
            values = e->field(input.view, input.tf, job.part(done++, parts)).values;
            m_seconds.visibility = watch.seconds();
        }
        const JobControl rest = job.part(done, parts);
        if (kind == FieldKind::Vws)
            visibilityToVws(values, *w, input.settings.vws, rest);
        else if (!swept)
            values = saliencyGrid(*w, kind, input.settings.vws, rest);
        const double top = usualTop(values);
        keepFeature(values, volume, input.tf, feature, rest);
        rest.throwIfStopped();
        std::string title = pellucid::title(kind);
        if (feature >= 0) title += ", " + input.tf.features[static_cast<std::size_t>(feature)].name;
        return fieldVolume(volume.geometry(), values, top, std::move(title));
    });
}

OptimizeResult Workspace::optimize(const MeasureInput& input, const std::vector<double>& targets,
                                   const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                                   const JobControl& job, const std::function<void(const OptimizeState&)>& watch,
                                   const std::vector<std::vector<double>>& known) {
    return guarded([&] {
        const EngineVws function = vws(input, job);
        const Stopwatch searching;
        OptimizeOptions steps = options;
        steps.publishedSteps = input.settings.profile == Profile::Published;
        OptimizeProblem problem{function, targets, limits};
        problem.known = known;
        problem.makeEstimates = [&] { return estimates(input, job); };
        problem.rays = &rays(input, {job.stop, {}});
        OptimizeResult result = pellucid::optimize(problem, steps, job, watch);
        m_seconds.visibility = searching.seconds();
        return result;
    });
}

Workspace::Approach Workspace::approach(const MeasureInput& input, const std::vector<double>& targets,
                                        const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                                        bool rough, const JobControl& job) {
    constexpr std::size_t kQuick = 64 * 64 * 64; // voxels whose sweeps follow the hand
    return guarded([&] {
        const EngineVws full = vws(input, job);
        const Stopwatch watch;
        const VwsFunction& base = full;
        const VwsEstimates along = rough && input.volume->size() > kQuick ? estimates(input, job) : VwsEstimates{};
        OptimizeOptions steps = options;
        steps.publishedSteps = input.settings.profile == Profile::Published;
        OptimizeProblem problem{along.empty() ? base : *along.front(), targets, limits};
        problem.rays = &rays(input, {job.stop, {}});
        problem.nearby = true;
        Approach reached{pellucid::optimize(problem, steps, job), !along.empty()};
        m_seconds.visibility = watch.seconds();
        return reached;
    });
}

DensityCurve Workspace::densityCurve(const MeasureInput& input, const std::vector<OpacityLimits>& limits,
                                     const JobControl& job) {
    return guarded([&] {
        const EngineVws function = vws(input, {job.stop, {}});
        const VwsEstimates along = estimates(input, job);
        const DensityProblem problem{function, along.empty() ? nullptr : along.front().get(),
                                     rays(input, {job.stop, {}}), limits};
        return pellucid::densityCurve(problem, featureOpacities(input.tf), {}, job);
    });
}

} // namespace pellucid
