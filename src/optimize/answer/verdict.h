// Why a target is out of reach, and what would help (docs/method.md, "Why a target is out of reach").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/enum_names.h"
#include "optimize/answer/occlusion.h"
#include "optimize/optimizer.h"
#include "render/camera_motion.h"

namespace pellucid {

/// What an optimization starts from besides its targets.
struct ReachProblem {
    View view;
    TransferFunction tf;               ///< with features; hidden ones have opacity 0 and are locked
    std::vector<OpacityLimits> limits; ///< one per feature
};

/// Why a feature holds a target back.
enum class LimitReason {
    Locked,     ///< its opacity is locked
    Lowest,     ///< it may not become fainter
    Highest,    ///< it may not become more opaque
    OutOfSight, ///< nothing of it is in sight, whatever the opacities are
    NoContrast  ///< it is in sight, but its colour is that of its surroundings: no saliency
};

template <>
inline constexpr auto kNamesOf<LimitReason> = enumNames("reason", "locked", "lowest", "highest", "out-of-sight",
                                                        "no-contrast");

struct ReachLimit {
    std::size_t feature = 0;
    LimitReason reason = LimitReason::Locked;
    /// F that is reached where the limits of this feature alone are lifted; where there is nothing to lift, that of the
    /// verdict.
    double objective = 0;
};

/// A change that was tried, and brings the target nearer.
struct ReachHelp {
    enum class Kind { Release, View, Color, Clipping } kind = Kind::Release;
    std::size_t feature = 0;             ///< of Release and Color
    std::optional<ViewAngles> view = {}; ///< of View: degrees
    std::optional<Rgb> color = {};       ///< of Color
    double objective = 0;                ///< F that is reached with it
};

template <>
inline constexpr auto kNamesOf<ReachHelp::Kind> = enumNames("help", "release", "view", "color", "clipping");

struct Verdict {
    double objective = 0;               ///< F of the nearest shares that can be reached
    std::vector<double> vws;            ///< these shares
    std::vector<double> opacity;        ///< the opacities that have them
    std::vector<ReachLimit> limits;     ///< what holds the target back, the most limiting first
    OcclusionMatrix occlusion;          ///< at these opacities
    std::vector<ReachHelp> helps;       ///< the best first
    std::vector<std::string> sentences; ///< all of it in words, one sentence each
};

/// What a verdict needs of those who can measure. Calls throw Cancelled.
class VerdictTools {
public:
    virtual ~VerdictTools() = default;
    virtual const Geometry& geometry() const = 0;
    /// The search to the targets that the verdict is about; `rough`: an estimate will do.
    virtual OptimizeResult solve(const ReachProblem& problem, bool rough, const JobControl& job) = 0;
    /// Sums, weighted by saliency, of candidates: opacities of the features.
    virtual std::vector<FeatureSums>
    sums(const ReachProblem& problem, const std::vector<std::vector<double>>& candidates, const JobControl& job) = 0;
};

struct VerdictOptions {
    double tolerance = 0.03; ///< on F: what counts as reached
    bool otherViews = true;  ///< whether views around are tried, a search each
};

/// `found` is the answer of a global search of `problem`; where that is below the tolerance the verdict is that, and no
/// more. Nothing is said that was not tried: every F is one that a search of the whole volume has reached. Throws
/// Cancelled.
Verdict explain(VerdictTools& tools, const ReachProblem& problem, const std::vector<double>& targets,
                const OptimizeResult& found, const VerdictOptions& options = {}, const JobControl& job = {});

} // namespace pellucid
