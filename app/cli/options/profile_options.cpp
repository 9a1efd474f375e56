#include "options/profile_options.h"

#include "options/camera_options.h"
#include "options/engine_options.h"
#include "options/saliency_options.h"
#include "parse.h"

namespace pellucid::cli {

namespace {

bool isPublished(const MeasureSettings& settings) { return settings.profile == Profile::Published; }

} // namespace

void ProfileOptions::add(CLI::App& app) {
    const char* const group = "Engine";
    addValue(
        app, "--profile", "default|published",
        [this](const std::string& text, const std::string& option) {
            profile = atOption(option, [&] { return profileFromName(text); });
        },
        "definitions of the figures; published: those of the programs behind the thesis's printed numbers, which look "
        "along an axis of the grid and need no camera",
        group);
    addValue(
        app, "--along", "top|bottom|front|back|left|right",
        [this](const std::string& text, const std::string& option) {
            along = atOption(option, [&] { return alongFromName(text); });
        },
        "the face of the grid that the published profile looks at: front is that of the highest y, top that of the "
        "highest z, right that of the highest x (default front)",
        group);
}

void ProfileOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.measure.edit([this](MeasureSettings& m) {
        m.profile = profile.value_or(m.profile);
        m.along = along.value_or(m.along);
    });
    if (along && !isPublished(*inputs.session.measure))
        throw UsageError("only the published profile looks along an axis", "--along",
                         "add --profile published, or give --view");
}

void ProfileOptions::requireNone(const SceneInputs& inputs, const EngineOptions& engine,
                                 const SaliencyInput& saliency) const {
    if (!isPublished(*inputs.session.measure)) return;
    const std::pair<bool, const char*> given[] = {
        {engine.choice.has_value() && *engine.choice != EngineChoice::Auto, "--engine"},
        {engine.quality.has_value() && *engine.quality != Quality::Normal, "--quality"},
        {saliency.sigma.has_value(), "--sigma"},
        {saliency.kernel.has_value(), "--kernel"},
        {saliency.w1.has_value(), "--w1"},
        {saliency.w2.has_value(), "--w2"},
        {saliency.u1.has_value(), "--u1"},
        {saliency.u2.has_value(), "--u2"},
        {saliency.background.has_value(), "--saliency-background"}};
    for (const auto& [isGiven, option] : given)
        if (isGiven)
            throw UsageError("the published profile has its own definition of this", option,
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
