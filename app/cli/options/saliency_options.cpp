#include "options/saliency_options.h"

#include <cmath>

#include "parse.h"

namespace pellucid::cli {

void SaliencyInput::add(CLI::App& app) {
    const char* const group = "Saliency";
    addValue(
        app, "--sigma", "S",
        [this](const std::string& text, const std::string& option) { sigma = parseRealAbove(text, option, 0, 8); },
        "radius of the centre in reference lengths, at most 8 (default 2)", group);
    addValue(
        app, "--kernel", "thesis|narrow",
        [this](const std::string& text, const std::string& option) {
            if (text != "thesis" && text != "narrow")
                throw UsageError("unknown kernel '" + text + "'", option, "give thesis or narrow");
            kernel = text == "thesis" ? SaliencyKernel::Thesis : SaliencyKernel::Narrow;
        },
        "weights within the radius (default thesis)", group);
    const auto number = [&](const char* name, const char* value, std::optional<double>& target, double most,
                            const char* help) {
        addValue(
            app, name, value,
            [&target, most](const std::string& text, const std::string& option) {
                target = parseReal(text, option, 0, most);
            },
            help, group);
    };
    number("--w1", "W", w1, 1e6, "weight of the centre (default 1)");
    number("--w2", "W", w2, 1e6, "weight of the surround (default 1)");
    number("--u1", "U", u1, 1, "share of brightness in the saliency (default 0.5)");
    number("--u2", "U", u2, 1, "share of saturation; both shares sum to 1, one alone determines the other");
    addValue(
        app, "--saliency-background", "R,G,B",
        [this](const std::string& text, const std::string& option) { background = parseColor(text, option); },
        "colour of voxels in no feature, components from 0 to 1 or #rrggbb (default black)", group);
}

void SaliencyInput::applyTo(SceneInputs& inputs) const {
    if (u1 && u2 && std::abs(*u1 + *u2 - 1) > 1e-9)
        throw UsageError("the shares of brightness and saturation do not sum to 1", "--u1 and --u2",
                         "give two numbers that do, or one of them");
    inputs.session.measure.edit([this](MeasureSettings& m) {
        m.saliency.sigma = sigma.value_or(m.saliency.sigma);
        m.saliency.kernel = kernel.value_or(m.saliency.kernel);
        m.saliency.w1 = w1.value_or(m.saliency.w1);
        m.saliency.w2 = w2.value_or(m.saliency.w2);
        m.saliency.background = background.value_or(m.saliency.background);
        if (u1)
            m.vws = {*u1, u2.value_or(1 - *u1)};
        else if (u2)
            m.vws = {1 - *u2, *u2};
    });
}

} // namespace pellucid::cli
