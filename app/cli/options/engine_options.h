// --engine, --quality: what computes, and how carefully; --profile, --along: by which definitions.
#pragma once

#include "options/setting_options.h"
#include "output.h"
#include "session/scene.h"

namespace pellucid::cli {

struct CameraOptions;
struct SaliencyInput;

struct EngineOptions {
    SettingOptions<MeasureSettings> given;

    void add(CLI::App& app);
    /// Beside the above; for commands that measure.
    void addProfile(CLI::App& app);
    /// --profile alone; for commands that look from nowhere.
    void addDefinitions(CLI::App& app);
    /// Throws UsageError for --along without the published profile.
    void applyTo(SceneInputs& inputs) const;
    /// The published profile has its own definition of engine, quality and saliency: throws UsageError naming the
    /// option that was given with it.
    void requireProfile(const SceneInputs& inputs, const SaliencyInput& saliency) const;
};

/// The published profile refines by steps of its own: throws UsageError naming the option that was given with it.
void requireOwnSteps(Profile profile, const SettingOptions<RefineSteps>& steps);
/// What one should know of figures that are not of the camera: empty, or that they are of the profile's own view.
std::optional<std::string> profileNotice(const MeasureSettings& settings, const CameraOptions& camera);
/// "profile" and "along", where figures are of the published profile.
void addProfile(Json& json, const MeasureSettings& settings);
/// " (published profile, front)", likewise; else empty.
std::string profileText(const MeasureSettings& settings);

} // namespace pellucid::cli
