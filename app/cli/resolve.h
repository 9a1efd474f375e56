// From the words on the command line to what commands work on: the one way for all of them.
#pragma once

#include <string>
#include <vector>

#include "options/camera_options.h"
#include "options/clip_options.h"
#include "options/engine_options.h"
#include "options/ground_options.h"
#include "options/overlay_options.h"
#include "options/picture_options.h"
#include "options/saliency_options.h"
#include "options/tf_options.h"
#include "options/variable_options.h"
#include "options/volume_options.h"
#include "progress.h"

namespace pellucid::cli {

/// What is worked on, and how. A command adds the groups that it takes; those that it does not add change nothing.
struct SceneOptions {
    std::optional<std::string> sessionFile; ///< --session: all that is not said otherwise is as saved there
    VolumeOptions volume;
    VariableOptions variables;
    TfOptions tf;
    CameraOptions camera;
    ClipOptions clip;
    EngineOptions engine;
    SaliencyInput saliency;
    PictureOptions picture;
    GroundOptions ground;
    OverlayOptions overlay;
    SettingOptions<CoordinateSettings> coordinates; ///< --coordinates
    SettingOptions<FieldView> field; ///< --field and the options of its look: a field in the place of the data

    bool drawsField() const { return field.values().kind.has_value(); }

    void addSession(CLI::App& app); ///< --session
    /// The groups that commands share: those of the data, of what is looked at and from where, and of all that figures
    /// of a view depend on. Each begins with the one before.
    void addForData(CLI::App& app, VolumeOptions::SizeIs size = VolumeOptions::SizeIs::Sample);
    void addForView(CLI::App& app, VolumeOptions::SizeIs size = VolumeOptions::SizeIs::Sample);
    void addForFigures(CLI::App& app, VolumeOptions::SizeIs size = VolumeOptions::SizeIs::Sample);
};

/// What a command does with the volume, and the memory that it takes beside it.
struct Work {
    MemoryUse use;
    bool byEngine = false; ///< figures are computed: the reference engine takes more
    bool needsTf = true;   ///< false: an automatic start would be for nothing
};

/// Everything that can be told before a transfer function or volume is read. Throws UsageError for options that do not
/// go together, Error for files. `notices` gets remarks about the session.
SceneInputs inputsOf(const SceneOptions& options, const Work& work, std::vector<std::string>& notices);

struct Opened {
    Scene scene;
    std::vector<std::string> sessionNotices;
    /// Those of the session, then those of the data.
    std::vector<std::string> notices() const;
};

/// Opens what the options say. Throws as inputsOf() and openScene() do.
Opened resolve(const SceneOptions& options, Progress& progress, const Work& work = {});

} // namespace pellucid::cli
