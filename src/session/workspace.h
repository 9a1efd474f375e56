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
    /// What coverage is computed from. Kept until volume, view or features are others.
    const RayBundle& rays(const MeasureInput& input, const JobControl& job = {});
    /// Its memory, and that of the volume it was made for, is wanted for something else.
    void releaseEngine();

    const Seconds& seconds() const { return m_seconds; } ///< of the latest computation

private:
    friend class WorkspaceTools;
    bool haveWeights(const MeasureInput& input) const;
    /// By rays of the input's view; weights() are its own. None for the published profile, whose slices are another
    /// problem.
    VwsEstimates estimates(const MeasureInput& input, const JobControl& job);
    /// Lets go of what other rays than the input's have met.
    void lookAlong(const MeasureInput& input);
    void releaseRays();

    std::shared_ptr<const Volume> m_engineVolume, m_weightsVolume;
    EngineChoice m_choice = EngineChoice::Auto;
    Quality m_quality = Quality::Normal;
    Profile m_engineProfile = Profile::Default, m_weightsProfile = Profile::Default;
    std::unique_ptr<VisibilityEngine> m_engine;
    TransferFunction m_weightsTf; // its colorsOf()
    std::shared_ptr<const VoxelColors> m_weightsColors;
    SaliencyOptions m_weightsOptions;
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
