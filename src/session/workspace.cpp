#include "session/workspace.h"

#include <chrono>

#include "engines/engines.h"
#include "render/memory_needs.h"
#include "render/published_engine.h"
#include "saliency/published_saliency.h"

namespace pellucid {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

} // namespace

/// What measuring takes under these settings.
MemoryUse useUnder(const MeasureSettings& settings) {
    const MemoryUse use = toMeasure("measuring");
    if (settings.profile == Profile::Published) return byPublished(use);
    return settings.engine == EngineChoice::Reference ? byReference(use) : use;
}

VisibilityEngine& Workspace::engine(const MeasureInput& input) {
    const MeasureSettings& settings = input.settings;
    if (m_engineVolume != input.volume || !m_engine || m_choice != settings.engine || m_quality != settings.quality ||
        m_engineProfile != settings.profile) {
        m_engine.reset();
        if (m_weightsVolume != input.volume) { // what was measured before needs no room any more
            m_weightsVolume.reset();
            m_weights = {};
        }
        requireMemory(useUnder(settings), input.volume->title, input.volume->dims(), input.volume->sampleType());
        m_engine = settings.profile == Profile::Published ? makePublishedEngine(input.volume)
                                                          : makeEngine(settings.engine, input.volume, settings.quality);
        m_engineVolume = input.volume;
        m_choice = settings.engine;
        m_quality = settings.quality;
        m_engineProfile = settings.profile;
    }
    return *m_engine;
}

void Workspace::releaseEngine() {
    m_engine.reset();
    m_engineVolume.reset();
}

bool Workspace::haveWeights(const MeasureInput& input) const {
    return m_weightsVolume == input.volume && m_weightsOptions == input.settings.saliency &&
           m_weightsProfile == input.settings.profile && m_weightsTf == colorsOf(input.tf);
}

const WeightFields& Workspace::weights(const MeasureInput& input, const JobControl& job) {
    m_seconds.saliency = 0;
    if (!haveWeights(input)) {
        const auto start = Clock::now();
        m_weightsVolume.reset();
        const bool published = input.settings.profile == Profile::Published;
        if (published || m_weightsProfile != input.settings.profile) m_weights = {}; // of another form
        m_weightsProfile = input.settings.profile;
        if (published)
            m_weights = publishedSaliencyFields(*input.volume, input.tf, job);
        else
            updateSaliencyFields(m_weights, *input.volume, input.tf, input.settings.saliency, job);
        m_weightsTf = colorsOf(input.tf);
        m_weightsOptions = input.settings.saliency;
        m_weightsVolume = input.volume;
        m_seconds.saliency = secondsSince(start);
    }
    return m_weights;
}

namespace {

/// Runs `work(engine)`. An engine that failed is not trusted again: `release` lets go of it.
template <class Work, class Release>
auto guarded(const Work& work, const Release& release) {
    try {
        return work();
    } catch (const Cancelled&) {
        throw;
    } catch (...) {
        release();
        throw;
    }
}

} // namespace

Measures Workspace::measure(const MeasureInput& input, const JobControl& job) {
    return guarded(
        [&] {
            VisibilityEngine& e = engine(input);
            const bool all = !haveWeights(input); // half of the work, or none
            const WeightFields& w = weights(input, all ? job.part(0, 2) : job);
            Measures measures =
                pellucid::measure(e, input.view, input.tf, w, input.settings.vws, all ? job.part(1, 2) : job);
            if (input.settings.profile == Profile::Published) // closed intervals, where bins of a histogram are not
                measures.features = featureMeasures(e.sums(input.view, {&input.tf, 1}, &w)[0], input.settings.vws);
            m_seconds.visibility = measures.visibilitySeconds;
            return measures;
        },
        [this] { releaseEngine(); });
}

std::vector<std::vector<double>> Workspace::jacobian(const MeasureInput& input, const JobControl& job) {
    return guarded(
        [&] {
            VisibilityEngine& e = engine(input);
            const bool all = !haveWeights(input);
            const WeightFields& w = weights(input, all ? job.part(0, 2) : job);
            const auto start = Clock::now();
            auto matrix =
                vwsJacobian(e.jacobian(input.view, input.tf, &w, all ? job.part(1, 2) : job), input.settings.vws);
            m_seconds.visibility = secondsSince(start);
            return matrix;
        },
        [this] { releaseEngine(); });
}

OcclusionMatrix Workspace::occlusion(const MeasureInput& input, const JobControl& job) {
    return guarded([&] { return pellucid::occlusion(engine(input), input.view, input.tf, job); },
                   [this] { releaseEngine(); });
}

OptimizeResult Workspace::optimize(const MeasureInput& input, const std::vector<double>& targets,
                                   const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                                   const JobControl& job, const std::function<void(const OptimizeState&)>& watch) {
    return guarded(
        [&] {
            VisibilityEngine& e = engine(input);
            const WeightFields& w = weights(input, job);
            const auto start = Clock::now();
            const EngineVws function(e, input.view, input.tf, w, input.settings.vws);
            OptimizeOptions steps = options;
            steps.publishedSteps = input.settings.profile == Profile::Published;
            OptimizeResult result = pellucid::optimize({function, targets, limits}, steps, job, watch);
            m_seconds.visibility = secondsSince(start);
            return result;
        },
        [this] { releaseEngine(); });
}

} // namespace pellucid
