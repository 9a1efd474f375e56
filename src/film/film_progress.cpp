#include "film/film_progress.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/json_file.h"
#include "base/json_value.h"
#include "session/keyframes_file.h"
#include "session/session_json.h"
#include "tf/formats/tf_json.h"

namespace pellucid {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kFormat = "pellucid-film-progress";
constexpr int kVersion = 1;

/// Features have identities only where they were edited or kept, and no picture depends on them.
json withoutIdentities(json j) {
    if (j.is_object()) j.erase("identity");
    for (json& part : j)
        if (part.is_structured()) part = withoutIdentities(std::move(part));
    return j;
}

/// Names of files need not be UTF-8.
void addTo(Digest& digest, const json& j) {
    digest.add(withoutIdentities(j).dump(-1, ' ', false, json::error_handler_t::replace));
}

/// What is decided of the pictures; what is kept beside it changes none, nor does what keys decide.
json picturePart(const FilmTask& task) {
    json j = jsonFromSession(task.scene.session, {}, DataPaths::Absolute);
    for (const char* other :
         {"runs", "comparison", "target_keys", "features", "optimize", "refine", "slices", "picture_saliency",
          "hold_targets", "density", "field", "camera", "reference", "keyframes"})
        j.erase(other);
    if (task.keys.empty()) return j;
    for (const char* decided : {"clip", "frame"}) j.erase(decided);
    j["display"].erase("light");
    for (const char* decided : {"transfer_functions", "adapted"}) j["variables"].front().erase(decided);
    return j;
}

} // namespace

std::string filmDigest(const FilmTask& task) {
    Digest digest;
    addTo(digest, {{"program", PELLUCID_VERSION},
                   {"size", {task.width, task.height}},
                   {"title", task.scene.volume->title},
                   {"tf", task.keys.empty() ? jsonFromTf(task.scene.tf) : json()},
                   {"around", task.around.any() ? task.around.on : false}});
    addTo(digest, picturePart(task));
    for (const AnnotationPartInfo& part : kAnnotationParts) addTo(digest, task.around.*part.shown);
    addTo(digest, jsonFromKeyframes(task.keys));
    for (const FilmShot& shot : task.shots)
        addTo(digest,
              shot.time ? json(*shot.time) : json{{"frame", shot.frame}, {"camera", jsonFromWholeCamera(shot.camera)}});
    return digest.text();
}

std::optional<std::string> readFilmProgress(const std::string& folder) {
    const std::string path = (fs::path(folder) / kFilmProgressFile).string();
    if (std::error_code none; !fs::is_regular_file(path, none)) return {};
    try {
        // Not as an input of the program: it is an output, too.
        std::ifstream in(path, std::ios::binary);
        const json document = parseJson({std::istreambuf_iterator<char>(in), {}}, path);
        const JsonValue j(document, path);
        requireFormat(j, kFormat, kVersion, "draw the film anew");
        return j["digest"].text();
    } catch (const Error&) {
        return {};
    }
}

void writeFilmProgress(const std::string& digest, const std::string& folder) {
    const json j{{"format", kFormat}, {"version", kVersion}, {"digest", digest}};
    writeTextAtomically((fs::path(folder) / kFilmProgressFile).string(), j.dump() + "\n");
}

void removeFilmProgress(const std::string& folder) {
    std::error_code none;
    fs::remove(fs::path(folder) / kFilmProgressFile, none);
}

} // namespace pellucid
