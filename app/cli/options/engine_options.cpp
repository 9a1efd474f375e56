#include "options/engine_options.h"

#include "parse.h"

namespace pellucid::cli {

void EngineOptions::add(CLI::App& app, const std::string& qualityHelp) {
    const char* const group = "Engine";
    addValue(
        app, "--engine", "auto|gl|cpu|slices|reference",
        [this](const std::string& text, const std::string& option) {
            choice = atOption(option, [&] { return engineChoiceFromName(text); });
        },
        "what computes; auto (default): gl on a real GPU, else cpu; slices is the thesis's own method, on OpenGL",
        group);
    addValue(
        app, "--quality", "normal|high",
        [this](const std::string& text, const std::string& option) {
            quality = atOption(option, [&] { return qualityFromName(text); });
        },
        qualityHelp, group);
}

void EngineOptions::applyTo(SceneInputs& inputs) const {
    inputs.session.measure.edit([this](MeasureSettings& m) {
        m.engine = choice.value_or(m.engine);
        m.quality = quality.value_or(m.quality);
    });
}

} // namespace pellucid::cli
