// --profile, --along: by which definitions figures are computed.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "output.h"
#include "session/scene.h"

namespace pellucid::cli {

struct EngineOptions;
struct SaliencyInput;
struct CameraOptions;

struct ProfileOptions {
    std::optional<Profile> profile;
    std::optional<Along> along;

    void add(CLI::App& app);
    /// Throws UsageError for --along without the published profile.
    void applyTo(SceneInputs& inputs) const;
    /// The published profile leaves nothing to these: throws UsageError naming the option that was given with it.
    void requireNone(const SceneInputs& inputs, const EngineOptions& engine, const SaliencyInput& saliency) const;
};

/// What one should know of figures that are not of the camera: empty, or that they are of the profile's own view.
std::optional<std::string> profileNotice(const MeasureSettings& settings, const CameraOptions& camera);

/// "profile" and "along", where figures are of the published profile.
void addProfile(Json& json, const MeasureSettings& settings);
/// " (published profile, front)", likewise; else empty.
std::string profileText(const MeasureSettings& settings);

} // namespace pellucid::cli
