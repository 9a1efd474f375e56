#include "options/target_input.h"

#include <algorithm>

#include "output.h"
#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* kOnly = "only:";

/// What can be told about the numbers before their features are known.
std::vector<double> parseNumbers(const std::string& text, const std::string& option) {
    auto targets = parseReals(text, option);
    double sum = 0;
    for (const double t : targets) {
        if (t < 0) throw UsageError("the target " + plainText(t) + " is negative", option, "give numbers from 0 on");
        if (t > 1e9) throw UsageError("the target " + plainText(t) + " is too large", option, "only proportions count");
        sum += t;
    }
    if (sum == 0) throw UsageError("all targets are 0", option, "give at least one above 0");
    return targets;
}

} // namespace

TargetInput TargetInput::parse(const std::string& text, const std::string& option) {
    TargetInput input;
    if (text.rfind(kOnly, 0) == 0)
        input.only = text.substr(std::string(kOnly).size());
    else if (!text.empty() && (text[0] >= 'a' && text[0] <= 'z') && text.find(',') == std::string::npos &&
             text.rfind("inf", 0) != 0 && text.rfind("nan", 0) != 0)
        try {
            input.preset = targetPresetFromName(text);
        } catch (const UsageError& e) {
            throw UsageError(e.problem(), option, "give numbers, equal, diagonal, inside-out or only:NAME");
        }
    else
        input.numbers = parseNumbers(text, option);
    return input;
}

std::vector<double> TargetInput::of(const Scene& scene) const {
    const FeatureGoals& goals = *scene.session.goals;
    if (preset) return presetTargets(*preset, scene.tf, goals);
    if (!only) return numbers;
    const auto& features = scene.tf.features;
    const auto named =
        std::find_if(features.begin(), features.end(), [this](const Feature& f) { return f.name == *only; });
    if (named == features.end()) {
        std::string names;
        for (const Feature& f : features) names += (names.empty() ? "'" : ", '") + f.name + "'";
        throw UsageError("there is no feature '" + *only + "'", "--target",
                         features.empty() ? "give a transfer function with features" : "choose among " + names);
    }
    if (named->hidden) throw UsageError("the feature '" + *only + "' is hidden", "--target", "show it first");
    return targetsForOne(scene.tf, goals, static_cast<std::size_t>(named - features.begin()));
}

} // namespace pellucid::cli
