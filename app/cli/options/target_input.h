// --target: shares that features are wanted to have, as numbers or as a word.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/scene.h"
#include "session/target_presets.h"

namespace pellucid::cli {

/// "0.1,0.3,0.6", "equal", "diagonal", "inside-out", "only:NAME".
struct TargetInput {
    std::vector<double> numbers; ///< of those who give some
    std::optional<TargetPreset> preset;
    std::optional<std::string> only; ///< name of the feature that gets all

    static TargetInput parse(const std::string& text, const std::string& option); ///< throws UsageError
    /// One number for each feature, not scaled; words respect what the session has locked and hidden. Throws
    /// UsageError.
    std::vector<double> of(const Scene& scene) const;
};

/// What the visible features of a scene are wanted to show: shownShares() of what was given, else of the scene's own
/// targets; only in proportion. Throws UsageError where these are not one number for each feature.
std::vector<double> targetsOf(const std::optional<TargetInput>& given, const Scene& scene);

inline constexpr const char* kTargetForms = "T1,T2,...|equal|diagonal|inside-out|only:NAME";

} // namespace pellucid::cli
