#include "options/target_input.h"

#include "optimize/objective.h"
#include "parse.h"
#include "tf/shown_tf.h"

namespace pellucid::cli {

namespace {

constexpr const char* kOnly = "only:";

} // namespace

TargetInput TargetInput::parse(const std::string& text, const std::string& option) {
    TargetInput input;
    if (text.rfind(kOnly, 0) == 0)
        input.only = text.substr(std::string(kOnly).size());
    else if (!text.empty() && (text[0] >= 'a' && text[0] <= 'z') && text.find(',') == std::string::npos &&
             text.rfind("inf", 0) != 0 && text.rfind("nan", 0) != 0)
        try {
            input.preset = fromName<TargetPreset>(text);
        } catch (const UsageError& e) {
            throw UsageError(e.problem(), option, "give numbers, equal, diagonal, inside-out or only:NAME");
        }
    else
        input.numbers = parseTargets(text, option);
    return input;
}

std::vector<double> TargetInput::of(const Scene& scene) const {
    const FeatureGoals& goals = *scene.session.goals;
    const TransferFunction tf = scene.wantedTf();
    if (preset) return presetTargets(*preset, tf, goals);
    if (!only) return numbers;
    const std::size_t feature = parseFeature(*only, "--target", scene.tf);
    if (scene.tf.features[feature].hidden)
        throw UsageError("the feature '" + *only + "' is hidden", "--target", "show it first");
    if (scene.isEmpty(feature))
        throw UsageError("the feature '" + *only + "' is empty: no voxel has its values", "--target",
                         "name another one, or move its borders");
    return targetsForOne(tf, goals, feature);
}

std::vector<double> targetsOf(const std::optional<TargetInput>& given, const Scene& scene,
                              std::vector<std::string>& notices) {
    const std::vector<double> named = given ? given->of(scene) : scene.targets();
    atOption("--target", [&] { return normalizedTargets(named, scene.tf.features.size()); });
    if (const std::string text = emptyTargetText(scene.tf, *scene.histogram, named); !text.empty())
        notices.push_back(text);
    return shownShares(scene.wantedTf(), named);
}

} // namespace pellucid::cli
