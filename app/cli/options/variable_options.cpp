#include "options/variable_options.h"

#include <algorithm>

#include "base/text.h"
#include "parse.h"
#include "session/variable_edits.h"
#include "volume/formats/file_check.h"
#include "volume/series.h"

namespace pellucid::cli {

namespace {

constexpr const char* kVariableGroup = "Variables";
constexpr const char* kHsb = "--hsb";
constexpr const char* kFeatures = "--features-of";
constexpr const char* kHsbForm = "give alpha=, saturation=, brightness=, hue=, hue-from=, hue-to=, a=, b= with commas "
                                 "between; auto; or off";

VariableOptions::Named parseNamed(const std::string& text, const std::string& option) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw UsageError("'" + text + "' names no variable", option,
                         "give NAME=FILE, NAME=sample:NAME or NAME=gradient:OTHER and the like");
    VariableOptions::Named named{text.substr(0, equals), text.substr(equals + 1)};
    if (named.name.find_first_of(":,") != std::string::npos)
        throw UsageError("the name '" + named.name + "' has a colon or comma", option, "give a plain name");
    return named;
}

Variable variableOf(const VariableOptions::Named& named, const VolumeSource& first) {
    Variable variable;
    variable.name = named.name;
    variable.derivation = atOption("--variable", [&] { return parseDerivation(named.spec); });
    if (variable.derivation) return variable;
    VolumeSource& source = variable.source;
    source.path = named.spec;
    source.frames = first.frames;
    if (source.isSample()) {
        source.sampleSize = first.sampleSize;
        source.seed = first.seed;
    } else {
        source.raw = first.raw;
        source.missing = first.missing;
    }
    source.downsample = first.downsample;
    source.region = first.region;
    // A name that leads nowhere is told, whether the variable is used or not.
    const SeriesListing listing = listSeries(source);
    const VolumeSource& frame = listing.frames.front().source;
    if (!frame.isSample()) readableFileBytes(frame.path);
    return variable;
}

void set(Session& session, const std::string& key, const std::string& value) {
    const auto channel = [&](Channel which) {
        atOption(kHsb, [&] { requireVariable(session, value); });
        setChannel(session, which, value);
    };
    HsbMapping hsb = *session.hsb;
    const auto take = [&](std::string_view number) {
        atOption(kHsb, [&] { setText(settingOf(settingsOf<HsbMapping>(), number), &hsb, value); });
    };
    if (key == "alpha") return channel(Channel::Opacity);
    if (key == "saturation" || key == "brightness" || key == "hue") {
        const Channel which = key == "saturation"   ? Channel::Saturation
                              : key == "brightness" ? Channel::Brightness
                                                    : Channel::Hue;
        double constant = 0;
        if (which == Channel::Hue && parseNumber(value, constant)) {
            hsb.hue.clear();
            take("hue_from");
        } else if (value == "none") {
            return setChannel(session, which, "");
        } else {
            return channel(which);
        }
    } else if (key == "hue-from") {
        take("hue_from");
    } else if (key == "hue-to") {
        take("hue_to");
    } else if (key == "a" || key == "b") {
        take(key);
    } else {
        throw UsageError("there is no channel '" + key + "'", kHsb, kHsbForm);
    }
    session.hsb.set(std::move(hsb));
}

} // namespace

void VariableOptions::add(CLI::App& app) {
    addRepeated(app, "--variable", "NAME=SPEC", variables, parseNamed,
                "another variable beside VOLUME, which is x: a file or series like VOLUME (--raw, --spacing, --axes "
                "and --missing are of all), or made of another one: gradient:NAME, volatility:NAME:FRAMES, "
                "difference:NAME:FRAME; repeatable",
                kVariableGroup);
    addValue(
        app, kHsb, "CHANNELS", hsb, anyText,
        "colours by variables in place of the transfer function's: alpha=, saturation=, brightness=, hue= (a variable, "
        "of hue degrees too), hue-from=, hue-to= (degrees), a=, b= (scales of saturation and darkness, default auto) "
        "with commas between; auto: volatility of 10 frames and the second variable; off",
        kVariableGroup);
    addValue(
        app, kFeatures, "VARIABLE", features, anyText,
        "the variable whose intensities the transfer function and its features are of, and that drives opacity: a "
        "name, "
        "or gradient, volatility:FRAMES, difference:FRAME of VOLUME (gradient:NAME and so on of another one); figures, "
        "targets and searches, --tf and --range are of it (default: VOLUME, or the session's)",
        kVariableGroup);
}

void VariableOptions::applyTo(SceneInputs& inputs) const {
    Session& session = inputs.session;
    for (const Named& named : variables) {
        const Variable variable = variableOf(named, dataVariable(session).source);
        session.variables.edit([&](std::vector<Variable>& all) {
            const auto same =
                std::find_if(all.begin(), all.end(), [&](const Variable& v) { return v.name == named.name; });
            if (same != all.end() && same->name == dataVariable(session).name)
                throw UsageError("the variable " + named.name + " is VOLUME's", "--variable", "give another name");
            if (same == all.end())
                all.push_back(variable);
            else
                *same = variable;
        });
    }
    for (const Named& named : variables)
        if (const auto derivation = parseDerivation(named.spec))
            atOption("--variable", [&] { requireVariable(session, derivation->of); });
    applyHsb(session);
    if (features) // last: channels are told of VOLUME
        atOption(kFeatures, [&] { setFeaturesOf(session, featuresOf(session, *features)); });
}

void VariableOptions::applyHsb(Session& session) const {
    if (!hsb) return;
    if (*hsb == "off") return session.hsb.edit([](HsbMapping& h) { h.on = false; });
    if (*hsb == "auto") {
        const Variable& x = session.variable();
        startMapping(session, x.derivation || listSeries(x.source).frames.size() > 1);
    } else {
        for (const std::string& part : split(*hsb, ',')) {
            const std::size_t equals = part.find('=');
            if (equals == std::string::npos) throw UsageError("'" + part + "' sets nothing", kHsb, kHsbForm);
            const std::string key = part.substr(0, equals);
            refuse({{features && key == "alpha", "opacity is driven by the variable that the features are of",
                     kFeatures, "leave out this option, or alpha= of --hsb"}});
            set(session, key, part.substr(equals + 1));
        }
    }
    session.hsb.edit([](HsbMapping& h) { h.on = true; });
}

void addMapping(Json& result, const Scene& scene) {
    const Variable& first = scene.session.variable();
    if (first.derivation) result["features_of"] = first.derivation->text();
    if (!scene.colors) return;
    const HsbMapping& hsb = *scene.session.hsb;
    Json& json = result["hsb"] = {{"alpha", first.name}};
    if (!hsb.saturation.empty()) {
        json["saturation"] = hsb.saturation;
        json["a"] = scene.hsbA;
    }
    if (!hsb.brightness.empty()) {
        json["brightness"] = hsb.brightness;
        json["b"] = scene.hsbB;
    }
    if (hsb.hue.empty()) {
        json["hue"] = hsb.hueFrom;
    } else {
        json["hue"] = hsb.hue;
        json["hue_from"] = hsb.hueFrom;
        json["hue_to"] = hsb.hueTo;
    }
    if (Json definitions = definitionsOf(scene.session); !definitions.empty())
        json["definitions"] = std::move(definitions);
}

Json definitionsOf(const Session& session) {
    Json definitions = Json::object();
    for (const Variable& v : *session.variables)
        if (v.derivation) definitions[v.name] = definitionOf(session, *v.derivation);
    if (!session.hsb->on) return definitions;
    for (const std::string& driver : {session.hsb->saturation, session.hsb->brightness, session.hsb->hue})
        if (session.variableNamed(driver) == nullptr)
            if (const auto derivation = parseDerivation(driver))
                definitions[driver] = definitionOf(session, *derivation);
    return definitions;
}

} // namespace pellucid::cli
