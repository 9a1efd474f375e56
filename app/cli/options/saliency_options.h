// --sigma, --kernel, --w1, --w2, --u1, --u2, --saliency-background: what catches the eye.
#pragma once

#include "options/setting_options.h"
#include "session/scene.h"

namespace pellucid::cli {

struct SaliencyInput {
    SettingOptions<SaliencyOptions> options;
    SettingOptions<VwsOptions> shares;

    void add(CLI::App& app);
    /// Throws UsageError unless u1 and u2 sum to 1; one alone determines the other.
    void applyTo(SceneInputs& inputs) const;
};

} // namespace pellucid::cli
