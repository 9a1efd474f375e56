#include "options/tf_options.h"

#include "parse.h"
#include "session/scene_data.h"
#include "session/variable_edits.h"
#include "tf/edit.h"
#include "tf/formats/tf_file.h"
#include "tf/shapes.h"

namespace pellucid::cli {

namespace {

TfParts parseParts(const std::string& text, const std::string& option) {
    TfParts parts{false, false, false};
    for (const std::string& word : split(text, ',')) {
        if (word == "colors")
            parts.colors = true;
        else if (word == "opacities")
            parts.opacities = true;
        else if (word == "range")
            parts.range = true;
        else
            throw UsageError("'" + word + "' is no part of a transfer function", option,
                             "use colors, opacities or range, with commas between");
    }
    return parts;
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
        "transfer function: *.tf.json, or a file of ParaView, 3D Slicer, Voreen, Inviwo or others (see convert), "
        "FILE#NAME "
        "for one of several in it (default: the session's, else auto: what the data propose, see propose); auto and "
        "the \"range\" of a file set the window unless --range says otherwise; points stay at their "
        "data values whatever the window",
        "Volume");
}

void TfOptions::add(CLI::App& app) {
    addSource(app);
    addValue(app, "--tf-parts", "PART[,PART]", parts, parseParts,
             "take only these of the file of --tf: colors, opacities (with the features), range; the rest stays as in "
             "the session, or as the data propose",
             "Volume");
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
        "colours by intensity from a map: " + joined(colorMaps(), ", ", &ColorMap::name) +
            "; reverse: from its end to its start, invert: light for dark, features: one colour for each",
        group);
    addValue(app, "--density", "K", density, realFrom(1e-3, 1e3),
             "multiply the extinction: 2 makes everything twice as dense, 0.5 half", group);
    addRepeated(app, "--hide", "NAME", hide, anyText, "close the eye of this feature: it is neither drawn nor measured",
                group);
    addRepeated(app, "--only", "NAME", only, anyText, "close the eyes of all other features", group);
}

void TfOptions::applyTo(SceneInputs& inputs) const {
    if (!parts) {
        inputs.tf = spec;
        return;
    }
    if (!spec || *spec == kAutomaticTf)
        throw UsageError("there is no file to take parts of", "--tf-parts", "name one by --tf");
    static_cast<void>(readTfNamed(*spec)); // an error in it should not wait for a large volume
}

void TfOptions::takePartsInto(Scene& scene, const MemoryUse& then, const JobControl& job) const {
    if (!parts) return;
    const TransferFunction other = forScene(readTfNamed(*spec), scene);
    Session session = scene.session;
    takeTfParts(session, other, *parts, scene.volume->range());
    const Camera camera = scene.camera;
    scene = resolve(std::move(session), scene, then, job);
    scene.camera = camera;
}

void TfOptions::applyTo(Scene& scene) const {
    TransferFunction tf = scene.tf;
    const auto setHidden = [&tf](const std::vector<std::string>& names, const char* option, bool hidden) {
        for (const std::string& name : names)
            for (const std::size_t i : parseFeatures(name, option, tf))
                tf = withFeatureHidden(tf, static_cast<int>(i), hidden);
    };
    if (!only.empty())
        for (Feature& f : tf.features) f.hidden = true;
    setHidden(only, "--only", false);
    setHidden(hide, "--hide", true);
    if (colorMap != nullptr) tf = withColorMap(tf, *colorMap, colorMapOptions);
    tf = withDensity(tf, density);
    if (tf == scene.tf) return;
    scene.session.setTf(std::move(tf));
    scene.tf = *scene.session.tf();
}

} // namespace pellucid::cli
