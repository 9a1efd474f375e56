#include "tf/presets.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"
#include "tf/formats/tf_json.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr const char* kPrefix = "preset:";
constexpr const char* kSuffix = ".tf.json";

std::string textOf(const json& document, const char* key, const std::string& otherwise) {
    const auto found = document.find(key);
    return found != document.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

/// What a file of that name is called.
std::string stemOf(std::string name) {
    if (name.ends_with(kSuffix)) name.resize(name.size() - std::string(kSuffix).size());
    return name;
}

TfPreset presetOf(const json& document, const std::string& name, const std::string& place) {
    return {name, textOf(document, "title", name), textOf(document, "group", ""), textOf(document, "about", ""),
            tfFromJson({document, place})};
}

} // namespace

const std::vector<TfPreset>& tfPresets() {
    static const std::vector<TfPreset> presets = [] {
        std::vector<TfPreset> all;
        for (const EmbeddedPreset& preset : embeddedPresets()) {
            const std::string name = stemOf(preset.name);
            all.push_back(presetOf(json::parse(preset.text), name, kPrefix + name));
        }
        std::ranges::stable_sort(all, {}, &TfPreset::group);
        return all;
    }();
    return presets;
}

std::optional<TransferFunction> tfFromPresetSpec(const std::string& text) {
    if (!text.starts_with(kPrefix)) return {};
    const std::string name = text.substr(std::string(kPrefix).size());
    const std::vector<TfPreset>& presets = tfPresets();
    if (const auto preset = std::ranges::find(presets, name, &TfPreset::name); preset != presets.end())
        return preset->tf;
    throw UsageError("there is no preset '" + name + "'", "transfer function '" + text + "'",
                     "choose one of " + joined(presets, ", ", &TfPreset::name));
}

TfPreset readPreset(const std::string& path) {
    const std::string name = stemOf(std::filesystem::path(path).filename().string());
    return presetOf(readJson(path), name, path);
}

void writePreset(const TransferFunction& tf, const std::string& title, const std::string& path) {
    TransferFunction titled = tf;
    json extra = tf.extraJson.empty() ? json::object() : json::parse(tf.extraJson);
    for (const char* ofAnother : {"group", "about"}) extra.erase(ofAnother);
    extra["title"] = title;
    titled.extraJson = extra.dump();
    writeTf(titled, path);
}

TransferFunction taken(const TransferFunction& present, const TransferFunction& other, Take what) {
    if (what == Take::All) return other;
    TransferFunction result = what == Take::Colors ? present : other;
    const TfSampler colors(what == Take::Colors ? other : present);
    for (ControlPoint& p : result.points) p.color = colors.color(p.x);
    for (Feature& f : result.features) {
        double peak = f.a;
        for (const ControlPoint& p : result.points)
            if (f.contains(p.x) && p.opacity >= result.opacity(peak)) peak = p.x;
        f.color = colors.color(peak);
    }
    return result;
}

} // namespace pellucid
