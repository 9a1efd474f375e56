#include "options/tf_options.h"

#include "parse.h"
#include "tf/edit.h"
#include "tf/shapes.h"

namespace pellucid::cli {

namespace {

std::string colorMapNames() {
    std::string names;
    for (const ColorMap& map : colorMaps()) names += (names.empty() ? "" : ", ") + map.name;
    return names;
}

/// All features of that name, ascending. Throws UsageError where there is none.
std::vector<int> featuresNamed(const TransferFunction& tf, const std::string& name, const char* option) {
    std::vector<int> found;
    std::string known;
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        if (tf.features[i].name == name) found.push_back(static_cast<int>(i));
        known += (known.empty() ? "'" : ", '") + tf.features[i].name + "'";
    }
    if (found.empty())
        throw UsageError("no feature is named '" + name + "'", option,
                         known.empty() ? "leave it out: this transfer function has none" : "known: " + known);
    return found;
}

} // namespace

void TfOptions::addSource(CLI::App& app) {
    addValue(
        app, "--tf", "FILE|auto|tents:N[:PEAK]|ramp:N|preset:NAME",
        [this](const std::string& text, const std::string& option) {
            if (text.empty())
                throw UsageError("the name is empty", option,
                                 "give a file, auto, tents:N[:PEAK], ramp:N or preset:NAME");
            spec = text;
        },
        "transfer function, *.tf.json or Voreen's *.tfi (default: the session's, else auto: what the data propose, see "
        "propose); auto and the \"range\" of a file set the window unless --range says otherwise; points stay at their "
        "data values whatever the window",
        "Volume");
}

void TfOptions::addEdits(CLI::App& app) {
    const char* const group = "Transfer function";
    addValue(
        app, "--colormap", "NAME[,reverse][,invert][,features]",
        [this](const std::string& text, const std::string& option) {
            const std::vector<std::string> words = split(text, ',');
            colorMap = atOption(option, [&] { return &colorMapNamed(words.front()); });
            colorMapOptions = {};
            for (std::size_t i = 1; i < words.size(); ++i) {
                if (words[i] == "reverse")
                    colorMapOptions.reversed = true;
                else if (words[i] == "invert")
                    colorMapOptions.inverted = true;
                else if (words[i] == "features")
                    colorMapOptions.overFeatures = true;
                else
                    throw UsageError("'" + words[i] + "' says nothing about a colour map", option,
                                     "use reverse, invert or features");
            }
        },
        "colours by intensity from a map: " + colorMapNames() +
            "; reverse: from its end to its start, invert: light for dark, features: one colour for each",
        group);
    addValue(
        app, "--density", "K",
        [this](const std::string& text, const std::string& option) { density = parseReal(text, option, 1e-3, 1e3); },
        "multiply the extinction: 2 makes everything twice as dense, 0.5 half", group);
    addRepeated(
        app, "--hide", "NAME", [this](const std::string& text, const std::string&) { hide.push_back(text); },
        "close the eye of this feature: it is neither drawn nor measured", group);
    addRepeated(
        app, "--only", "NAME", [this](const std::string& text, const std::string&) { only.push_back(text); },
        "close the eyes of all other features", group);
}

void TfOptions::applyTo(Scene& scene) const {
    TransferFunction tf = scene.tf;
    if (!only.empty()) {
        for (Feature& f : tf.features) f.hidden = true;
        for (const std::string& name : only)
            for (const int i : featuresNamed(tf, name, "--only")) tf = withFeatureHidden(tf, i, false);
    }
    for (const std::string& name : hide)
        for (const int i : featuresNamed(tf, name, "--hide")) tf = withFeatureHidden(tf, i, true);
    if (colorMap != nullptr) tf = withColorMap(tf, *colorMap, colorMapOptions);
    tf = withDensity(tf, density);
    if (tf == scene.tf) return;
    scene.session.setTf(std::move(tf));
    scene.tf = *scene.session.tf();
}

} // namespace pellucid::cli
