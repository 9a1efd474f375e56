// Where figures are computed: an engine and the saliency of one volume, kept from one computation to the next.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "optimize/answer/density_curve.h"
#include "optimize/answer/occlusion.h"
#include "optimize/answer/verdict.h"
#include "optimize/fields.h"
#include "optimize/measure.h"
#include "session/scene.h"

namespace pellucid {

class RaySamples;

/// What weights were made of: other inputs with the same have the same weights.
struct WeightsOf {
    std::shared_ptr<const Volume> volume; ///< null: there are no weights
    TransferFunction colors;              ///< colorsOf() the transfer function
    std::shared_ptr<const VoxelColors> mapped;
    SaliencyOptions options;
    Profile profile = Profile::Default;

    WeightsOf() = default;
    explicit WeightsOf(const MeasureInput& input)
        : volume(input.volume), colors(colorsOf(input.tf)), mapped(input.colors), options(input.settings.saliency),
          profile(input.settings.profile) {}
    bool operator==(const WeightsOf&) const = default;
};

/// Used by one thread at a time. The same input gives the same figures, whatever was computed before. An engine that
/// has failed is not kept.
class Workspace {
public:
    struct Seconds {
        double saliency = 0;   ///< 0 where it was there already
        double visibility = 0; ///< the sweeps
    };

    /// The figures of one view, without its coverage. Throws FileError where memory does not suffice, Error, Cancelled.
    Measures measure(const MeasureInput& input, const JobControl& job = {});
    /// Rays of their own: of a new view it costs as much as several sweeps of a small volume.
    Coverage coverage(const MeasureInput& input, const JobControl& job = {});
    /// ∂W_i/∂x_j as [i][j], see vwsJacobian().
    std::vector<std::vector<double>> jacobian(const MeasureInput& input, const JobControl& job = {});
    /// What every voxel contributes, of one kind; where `feature` of the input's transfer function is not −1, of its
    /// voxels alone, 0 elsewhere. Saliency needs no engine. Throws as measure() does.
    Field field(const MeasureInput& input, FieldKind kind, int feature = -1, const JobControl& job = {});
    /// Who hides whom.
    OcclusionMatrix occlusion(const MeasureInput& input, const JobControl& job = {});
    /// `limits`: one per feature, or empty. `known`: opacities that other searches have come to.
    OptimizeResult optimize(const MeasureInput& input, const std::vector<double>& targets,
                            const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                            const JobControl& job = {}, const std::function<void(const OptimizeState&)>& watch = {},
                            const std::vector<std::vector<double>>& known = {});

    /// Why the answer of optimize() of this input is not on target, and what would help. Where another method, or more
    /// moves, could find a better one, that is looked for first, from `known` opacities too. Throws as measure() does.
    Verdict explain(const MeasureInput& input, const std::vector<double>& targets,
                    const std::vector<OpacityLimits>& limits, const OptimizeOptions& options,
                    const OptimizeResult& found, const JobControl& job = {},
                    const std::vector<std::vector<double>>& known = {});

    struct Approach {
        OptimizeResult result;
        bool estimated = false; ///< its figures are those of rays
    };
    /// The same from nearby, with the floors of the picture (OptimizeProblem::nearby). `rough`: by rays and nothing
    /// else, where this saves time and rays can tell.
    Approach approach(const MeasureInput& input, const std::vector<double>& targets,
                      const std::vector<OpacityLimits>& limits, const OptimizeOptions& options, bool rough,
                      const JobControl& job = {});

    /// Through the opacities of the input's transfer function, with the shares that it has.
    DensityCurve densityCurve(const MeasureInput& input, const std::vector<OpacityLimits>& limits,
                              const JobControl& job = {});

    VisibilityEngine& engine(const MeasureInput& input);
    /// The fields depend on colours and features alone, so that they outlive changes of opacity.
    const WeightFields& weights(const MeasureInput& input, const JobControl& job = {});
    /// W of the input's features over their opacities, by engine() and weights(), which it refers to.
    EngineVws vws(const MeasureInput& input, const JobControl& job = {});
    /// What coverage is computed from. Kept until volume, view or features are others.
    const RayBundle& rays(const MeasureInput& input, const JobControl& job = {});
    /// Its memory, and that of the volume it was made for, is wanted for something else.
    void releaseEngine();

    const Seconds& seconds() const { return m_seconds; } ///< of the latest computation

private:
    friend class WorkspaceTools;
    /// What `work()` returns. An engine that failed is not trusted again: it is let go of.
    template <class Work>
    auto guarded(const Work& work) {
        try {
            return work();
        } catch (const Cancelled&) {
            throw;
        } catch (...) {
            releaseEngine();
            throw;
        }
    }
    bool haveWeights(const MeasureInput& input) const { return m_weightsOf == WeightsOf(input); }
    /// By rays of the input's view; weights() are its own. None for the published profile, whose slices are another
    /// problem.
    VwsEstimates estimates(const MeasureInput& input, const JobControl& job);
    /// Lets go of what other rays than the input's have met.
    void lookAlong(const MeasureInput& input);
    void releaseRays();

    struct EngineOf {
        std::shared_ptr<const Volume> volume;
        EngineChoice choice = EngineChoice::Auto;
        Quality quality = Quality::Normal;
        Profile profile = Profile::Default;
        bool operator==(const EngineOf&) const = default;
    } m_engineOf;
    std::unique_ptr<VisibilityEngine> m_engine;
    WeightsOf m_weightsOf;
    WeightFields m_weights;
    struct RaysOf {
        std::shared_ptr<const Volume> volume;
        View view;
        TransferFunction shapes; ///< peaks are 1
        bool operator==(const RaysOf&) const = default;
    } m_raysOf;
    std::optional<RayBundle> m_rays;
    std::shared_ptr<const RaySamples> m_raySamples; ///< of m_weights, too
    Seconds m_seconds;
};

} // namespace pellucid
