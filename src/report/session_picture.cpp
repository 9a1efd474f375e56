#include "report/session_picture.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file_watch.h"
#include "base/json_file.h"
#include "base/json_value.h"
#include "image_io/png_text.h"

namespace pellucid {

using nlohmann::json;

namespace {

std::string folderOf(const std::string& path) { return std::filesystem::path(path).parent_path().string(); }

std::optional<std::string> sessionIn(const std::string& path) {
    for (PngText& text : readPngTexts(path))
        if (text.keyword == kSessionKeyword) return std::move(text.text);
    return {};
}

} // namespace

std::string sessionText(const Scene& scene, const std::string& path) {
    Session session = scene.session;
    session.camera = scene.camera;
    try {
        return jsonFromSession(session, folderOf(path), DataPaths::Relative).dump();
    } catch (const json::type_error&) { // the other texts came from JSON themselves
        return {};
    }
}

bool carriesSession(const std::string& path) {
    try {
        return isPngFile(path) && sessionIn(path).has_value();
    } catch (const Error&) {
        return false;
    }
}

SessionFile readSessionOrPicture(const std::string& path) {
    if (!isPngFile(path)) return readSession(path);
    tellOfReading(path);
    const std::optional<std::string> text = sessionIn(path);
    if (!text)
        throw FileError("this picture carries no session", path,
                        "give a session file, or a PNG picture that was saved with its session");
    const json document = parseJson(*text, path);
    return sessionFromJson({document, path}, folderOf(path));
}

} // namespace pellucid
