#include "tf/formats/preset_choice.h"

#include <algorithm>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"

namespace pellucid {

std::vector<std::string> distinctNames(std::vector<std::string> names) {
    std::set<std::string> taken;
    std::vector<bool> isOwn(names.size()); // the first of a name keeps it
    for (std::size_t i = 0; i < names.size(); ++i) isOwn[i] = !names[i].empty() && taken.insert(names[i]).second;
    std::map<std::string, int> again; // how often each has come up
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (isOwn[i]) continue;
        const std::string own = names[i].empty() ? "preset " + std::to_string(i + 1) : names[i];
        names[i] = own;
        while (!taken.insert(names[i]).second) names[i] = own + " (" + std::to_string(++again[own] + 1) + ")";
    }
    return names;
}

std::size_t presetNamed(const std::vector<std::string>& names, const ForeignFile& file,
                        std::vector<std::string>& notices) {
    if (file.part().empty()) {
        if (names.size() > 1)
            notices.push_back("the first of " + std::to_string(names.size()) + " presets, " + inQuotes(names.front()) +
                              ", is taken; FILE#NAME takes another");
        return 0;
    }
    const auto found = std::ranges::find(names, file.part());
    if (found == names.end()) {
        constexpr std::size_t kMost = 12;
        std::vector<std::string> some(names.begin(),
                                      names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMost)));
        throw FileError("there is no preset " + inQuotes(file.part()), file.path(),
                        "use one of " + joined(some) + (names.size() > kMost ? " …" : ""));
    }
    return static_cast<std::size_t>(found - names.begin());
}

namespace {

std::vector<JsonValue> presetsIn(const ForeignFile& file, bool (*isPreset)(const nlohmann::json&)) {
    const JsonValue document(file.json(), file.path());
    std::vector<JsonValue> presets;
    if (document.json().is_array()) {
        for (const JsonValue& item : document.items())
            if (isPreset(item.json())) presets.push_back(item);
    } else if (isPreset(document.json())) {
        presets.push_back(document);
    }
    if (presets.empty()) document.fail("there is no preset in it", "give a list of presets");
    return presets;
}

std::vector<std::string> namesOf(const std::vector<JsonValue>& presets) {
    std::vector<std::string> names;
    for (const JsonValue& preset : presets)
        names.push_back(preset.has("Name") && preset["Name"].json().is_string() ? preset["Name"].text() : "");
    return distinctNames(std::move(names));
}

} // namespace

std::vector<std::string> presetNames(const ForeignFile& file, bool (*isPreset)(const nlohmann::json&)) {
    return namesOf(presetsIn(file, isPreset));
}

PresetChoice presetOf(const ForeignFile& file, bool (*isPreset)(const nlohmann::json&)) {
    const std::vector<JsonValue> presets = presetsIn(file, isPreset);
    PresetChoice choice{presets.front(), {}};
    choice.preset = presets[presetNamed(namesOf(presets), file, choice.notices)];
    return choice;
}

} // namespace pellucid
