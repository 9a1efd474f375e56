#include "options/engine_options.h"

#include "engines/engines.h"
#include "options/camera_options.h"
#include "options/saliency_options.h"

namespace pellucid::cli {

namespace {

constexpr const char* kEngineGroup = "Engine";

bool isPublished(const MeasureSettings& settings) { return settings.profile == Profile::Published; }

} // namespace

void EngineOptions::add(CLI::App& app) { given.add(app, kEngineGroup, {"engine", "quality"}); }

void EngineOptions::addProfile(CLI::App& app) { given.add(app, kEngineGroup, {"profile", "along"}); }

void EngineOptions::addDefinitions(CLI::App& app) { given.add(app, kEngineGroup, {"profile"}); }

void EngineOptions::applyTo(SceneInputs& inputs) const {
    if (given.has("engine")) requireEngine(given.values().engine); // before anything is read
    inputs.session.measure.edit([this](MeasureSettings& m) { given.applyTo(m); });
    if (given.has("along") && !isPublished(*inputs.session.measure))
        throw UsageError("only the published profile looks along an axis", "--along",
                         "add --profile published, or give --view");
}

void EngineOptions::requireProfile(const SceneInputs& inputs, const SaliencyInput& saliency) const {
    if (!isPublished(*inputs.session.measure)) return;
    std::vector<const Setting*> settings = saliency.options.given();
    settings.insert(settings.end(), saliency.shares.given().begin(), saliency.shares.given().end());
    if (given.values().engine != EngineChoice::Auto)
        settings.push_back(&settingOf(settingsOf<MeasureSettings>(), "engine"));
    if (given.values().quality != Quality::Normal)
        settings.push_back(&settingOf(settingsOf<MeasureSettings>(), "quality"));
    if (!settings.empty())
        throw UsageError("the published profile has its own definition of this", settings.front()->optionName(),
                         "leave it out, or give --profile default");
}

void requireOwnSteps(Profile profile, const SettingOptions<RefineSteps>& steps) {
    if (profile != Profile::Published) return;
    for (const Setting* step : steps.given())
        for (const char* own : {"step_down", "step_up"})
            if (std::string_view(step->key) == own)
                throw UsageError("the published profile has its own definition of this", step->optionName(),
                                 "leave it out, or give --profile default");
}

std::optional<std::string> profileNotice(const MeasureSettings& settings, const CameraOptions& camera) {
    if (!isPublished(settings) || !(camera.file || camera.view || camera.namedView)) return {};
    return std::string("figures are of the view \"") + name(settings.along) +
           "\" of the published profile, not of the camera";
}

void addProfile(Json& json, const MeasureSettings& settings) {
    if (!isPublished(settings)) return;
    json["profile"] = name(settings.profile);
    json["along"] = name(settings.along);
}

std::string profileText(const MeasureSettings& settings) {
    return isPublished(settings) ? std::string(" (published profile, ") + name(settings.along) + ")" : std::string();
}

} // namespace pellucid::cli
