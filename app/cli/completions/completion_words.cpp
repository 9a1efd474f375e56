#include "completions/completion_words.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "base/text.h"
#include "bench/bench.h"
#include "completions/completion_scripts.h"
#include "optimize/optimizer.h"
#include "parse.h"
#include "render/annotation.h"
#include "render/standard_view.h"
#include "reproduce/item.h"
#include "session/target_presets.h"
#include "tf/color_maps.h"
#include "tf/presets.h"
#include "tf/terrain.h"
#include "volume/procedural.h"

namespace pellucid::cli {

namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

template <NamedEnum E>
Words namesOf() {
    return Words(kNamesOf<E>.names.begin(), kNamesOf<E>.names.end());
}

Words sampleNames(const std::string& prefix) {
    Words names;
    for (const SampleInfo& sample : samples()) names.push_back(prefix + sample.name);
    return names;
}

Words presetNames() {
    Words names;
    for (const TfPreset& preset : tfPresets()) names.push_back("preset:" + preset.name);
    return names;
}

/// `steps`: those too that give each feature a colour of its own.
Words colorMapNames(bool steps) {
    Words names;
    for (const ColorMap& map : colorMaps())
        if (steps || map.kind != ColorMap::Kind::Categorical) names.push_back(map.name);
    return names;
}

Words viewNames() {
    Words names;
    for (const WorldAxes axes : {WorldAxes::Patient, WorldAxes::File})
        for (const StandardView view : kStandardViews)
            if (std::ranges::find(names, name(view, axes)) == names.end()) names.emplace_back(name(view, axes));
    return names;
}

Words annotationNames() {
    Words names{"all"};
    for (const AnnotationPartInfo& part : kAnnotationParts) names.emplace_back(part.name);
    return names;
}

Words itemNames() {
    Words names;
    for (const Item& item : items()) names = std::move(names) + item.shows;
    return names;
}

/// Values whose names stand in other tables than that of the options.
const std::map<std::string, Words>& wordsOfOptions() {
    static const std::map<std::string, Words> kWords{
        {"--annotate", annotationNames()},
        {"--colormap", colorMapNames(true)},
        {"--features-of", {"gradient", "volatility:", "difference:", "gradient:", "x"}},
        {"--field-colormap", Words{"feature"} + colorMapNames(false)},
        {"--ground", sampleNames("sample:") + Words{"none"}},
        {"--ground-map", Words{kTerrainMap} + colorMapNames(false)},
        {"--hsb", {"saturation=", "brightness=", "hue=", "alpha=", "off"}},
        {"--paths", namesOf<SearchMethod>() + Words{"runs"}},
        {"--scale", {"linear", "log", "log:"}},
        {"--show", {"F"}},
        {"--slice", {"x:", "y:", "z:"}},
        {"--target", namesOf<TargetPreset>() + Words{"only:"}},
        {"--tf", Words{"auto", "tents:", "ramp:"} + presetNames()},
        {"--view", viewNames()},
    };
    return kWords;
}

bool isWord(const std::string& text) {
    const auto isOfWord = [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; };
    return !text.empty() && text.front() != '-' && std::ranges::all_of(text, isOfWord);
}

/// "auto|gl|cpu" has three, "AZIMUTH,ELEVATION|best" one.
Words wordsInForm(const std::string& form) {
    Words words;
    for (const std::string& part : split(form, '|'))
        if (isWord(part)) words.push_back(part);
    return words;
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

CompletionValues valuesOf(const std::string& command, const CLI::Option& option) {
    const std::string form = option.get_type_name();
    CompletionValues values{form, {}, has(form, "FILE"), has(form, "DIR")};
    const std::string first = "--" + (option.get_lnames().empty() ? std::string() : option.get_lnames().front());
    if (first == "--only" && command == "bench") {
        values.words = namesOf<BenchRow>();
    } else if (const auto known = wordsOfOptions().find(first); known != wordsOfOptions().end()) {
        values.words = known->second;
        for (const std::string& word : wordsInForm(form))
            if (std::ranges::find(values.words, word) == values.words.end() && first == "--view")
                values.words.push_back(word);
    } else {
        values.words = wordsInForm(form);
    }
    return values;
}

CompletionValues valuesOfArgument(const std::string& command, const std::string& name) {
    CompletionValues values{name, {}, false, false};
    if (name == "NAME") {
        values.words = sampleNames("");
    } else if (name == "ITEM") {
        values.words = itemNames();
    } else if (name == "SHELL") {
        values.words = completionShells();
    } else if (name == "DIR") {
        values.folders = true;
    } else if (name != "X,Y") {
        values.files = true;
        if (!command.starts_with("study") && name != "IMAGE") values.words = sampleNames("sample:");
    }
    return values;
}

/// To the first ';', ':' or '(' that is followed by more: what fits into a line of proposals.
std::string firstWords(const std::string& help) {
    constexpr std::size_t kMost = 70;
    std::string text = help.substr(0, std::min({help.find("; "), help.find(": "), help.find(" (")}));
    if (text.size() > kMost) {
        const std::size_t end = text.rfind(' ', kMost);
        text = text.substr(0, end == std::string::npos ? kMost : end) + " …";
    }
    return text;
}

CompletionOption optionOf(const std::string& command, const CLI::Option& option) {
    CompletionOption made;
    for (const std::string& name : option.get_lnames()) made.names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) made.names.push_back("-" + name);
    made.about = firstWords(option.get_description());
    made.takesValue = option.get_items_expected_max() > 0 && option.get_type_size() > 0;
    if (made.takesValue) made.values = valuesOf(command, option);
    return made;
}

CompletionCommand commandOf(const CLI::App& app, const std::string& name) {
    CompletionCommand command{name, app.get_description(), {}, {}, {}};
    for (const CLI::Option* option : app.get_options()) {
        if (option->nonpositional())
            command.options.push_back(optionOf(name, *option));
        else
            command.arguments.push_back(valuesOfArgument(name, option->get_name(true)));
    }
    for (const CLI::App* own : app.get_subcommands([](const CLI::App*) { return true; }))
        command.commands.push_back(commandOf(*own, name.empty() ? own->get_name() : name + " " + own->get_name()));
    return command;
}

} // namespace

CompletionCommand completionWords(const CLI::App& program) { return commandOf(program, ""); }

} // namespace pellucid::cli
