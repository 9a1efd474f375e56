#include "session/keyframes_file.h"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"
#include "base/text.h"
#include "render/camera_motion.h"
#include "session/scene_data.h"
#include "session/session_json.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"

namespace pellucid {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kFormat = "pellucid-film";
constexpr int kVersion = 1;

/// What a session file has of a key; the rest stays.
void takeSession(KeyState& state, const std::string& path, const Scene& scene) {
    const Session session = readSession(path).session;
    state.camera = session.camera.value_or(homeCamera(scene.volume->geometry(), Projection::Perspective));
    if (const auto tf = session.tf()) {
        state.tf = *tf;
        if (!state.tf.range) state.tf.range = session.variable().window.value_or(scene.volume->range());
    }
    state.clipping = *session.clipping;
    state.light = session.display->light;
    state.frame = session.frame;
}

/// A frame that there is, a camera that can draw.
void check(const KeyState& state, const Scene& scene, const std::string& where) {
    if (state.frame >= scene.series->size())
        throw Error("there is no frame " + std::to_string(state.frame), where,
                    "write 0 to " + std::to_string(scene.series->size() - 1));
    state.camera.validate(scene.volume->geometry(), where);
}

std::string pathIn(const std::string& folder, const std::string& name) {
    return fs::path(name).is_absolute() ? name : (fs::path(folder) / name).string();
}

/// A file, or "preset:NAME" and its kind.
TransferFunction namedTf(const std::string& name, const std::string& folder, const Scene& scene) {
    const auto begins = [&](const char* with) { return name.starts_with(with); };
    const bool isFile = !begins("preset:") && !begins("tents:") && !begins("ramp:");
    return forScene(readTfNamed(isFile ? pathIn(folder, name) : name), scene);
}

void takeState(KeyState& state, const JsonValue& j, const std::string& folder, const Scene& scene) {
    if (j.has("session")) takeSession(state, pathIn(folder, j["session"].text()), scene);
    if (j.has("camera")) {
        const JsonValue camera = j["camera"];
        state.camera = camera.json().is_string() ? readCamera(pathIn(folder, camera.text())) : cameraFromJson(camera);
    }
    if (j.has("tf")) {
        const JsonValue tf = j["tf"];
        state.tf = tf.json().is_string() ? namedTf(tf.text(), folder, scene) : tfFromJson(tf, Identities::Keep);
        if (!state.tf.range) state.tf.range = scene.volume->range();
    }
    if (j.has("clip")) state.clipping = clippingFromJson(j["clip"]);
    if (j.has("light")) state.light = lightFromJson(j["light"]);
    if (j.has("frame")) state.frame = j["frame"].whole(0, 1'000'000'000);
    check(state, scene, j.place());
}

} // namespace

Keyframes keyframesFromJson(const JsonValue& document, const std::string& folder, const Scene& scene) {
    requireFormat(document, kFormat, kVersion, "give a film of keyframes");
    if (document["keys"].items().empty()) document["keys"].fail("a film needs a key at least", "add one");
    KeyState state = keyStateOf(scene);
    return keysFromJson(document["keys"], [&](const JsonValue& key) {
        takeState(state, key, folder, scene);
        return state;
    });
}

Keyframes readKeyframes(const std::string& path, const Scene& scene) {
    const json document = readJson(path);
    return keyframesFromJson({document, path}, fs::path(path).parent_path().string(), scene);
}

json jsonFromKeyframes(const Keyframes& keys) {
    return {{"format", kFormat}, {"version", kVersion}, {"keys", jsonFromKeys(keys)}};
}

void writeKeyframes(const Keyframes& keys, const std::string& path) {
    writeTextAtomically(path, jsonFromKeyframes(keys).dump(1) + "\n");
}

void checkKeyframes(const Keyframes& keys, const Scene& scene) {
    for (std::size_t n = 0; n < keys.size(); ++n) check(keys[n].state, scene, "key " + std::to_string(n + 1));
}

bool isFilmFile(const std::string& text) {
    return text.find(';') == std::string::npos && lowerCase(trimmed(text)).ends_with(kFilmSuffix);
}

Keyframes keyframesOfText(const std::string& text, double seconds, const Scene& scene) {
    if (isFilmFile(text)) return readKeyframes(trimmed(text), scene);
    std::vector<std::string> paths;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(';', at), text.size());
        if (std::string path = trimmed(text.substr(at, end - at)); !path.empty()) paths.push_back(std::move(path));
        at = end + 1;
    }
    if (paths.size() < 2 || paths.size() > kMostKeyframes)
        throw UsageError("keyframes need a film, or two sessions at least", "",
                         "name one *.film.json, or sessions with semicolons between, such as a.pellucid.json; "
                         "b.pellucid.json");
    Keyframes keys;
    KeyState state = keyStateOf(scene);
    const std::size_t last = paths.size() - 1;
    for (std::size_t n = 0; n <= last; ++n) {
        takeSession(state, paths[n], scene);
        check(state, scene, paths[n]);
        Keyframe key{seconds * static_cast<double>(n) / static_cast<double>(last),
                     fs::path(paths[n]).stem().stem().string()};
        if (n == 0) key.easing = last == 1 ? Easing::Smooth : Easing::EaseIn;
        if (n > 0 && n + 1 == last) key.easing = Easing::EaseOut;
        key.state = state;
        keys.push_back(std::move(key));
    }
    return keys;
}

} // namespace pellucid
