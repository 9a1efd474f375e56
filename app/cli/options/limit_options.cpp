#include "options/limit_options.h"

#include "parse.h"
#include "session/session.h"

namespace pellucid::cli {

LimitOptions::NamedLimits LimitOptions::parse(const std::string& text, const std::string& option) {
    const auto high = text.rfind(':'), low = high == std::string::npos || high == 0 ? high : text.rfind(':', high - 1);
    if (high == std::string::npos || low == std::string::npos || low == 0)
        throw UsageError("'" + text + "' is not of the form NAME:LO:HI", option, "write it as in bone:0.1:0.5");
    OpacityLimits limits;
    limits.lowest = parseReal(text.substr(low + 1, high - low - 1), option);
    limits.highest = parseReal(text.substr(high + 1), option);
    if (!(limits.lowest >= 0 && limits.lowest <= limits.highest && limits.highest <= 1))
        throw UsageError("'" + text + "' needs 0 <= LO <= HI <= 1", option, "correct the limits");
    return {text.substr(0, low), limits};
}

void LimitOptions::add(CLI::App& app) {
    addRepeated(app, "--limits", "NAME:LO:HI", m_limits, parse, "keep the opacity of this feature within LO and HI");
    addRepeated(app, "--lock", "NAME", m_locked, anyText, "keep the opacity of this feature as it is");
}

std::vector<OpacityLimits> LimitOptions::of(const Scene& scene) const {
    std::vector<OpacityLimits> limits = limitsOf(scene.tf, *scene.session.goals);
    for (const NamedLimits& given : m_limits) {
        OpacityLimits& l = limits[parseFeature(given.name, "--limits", scene.tf)];
        l.lowest = given.limits.lowest;
        l.highest = given.limits.highest;
    }
    for (const std::string& name : m_locked) limits[parseFeature(name, "--lock", scene.tf)].locked = true;
    return limits;
}

} // namespace pellucid::cli
