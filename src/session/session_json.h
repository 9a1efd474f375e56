// *.pellucid.json: a session as a file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "session/session.h"

namespace pellucid {

/// How data files are named in a session file.
enum class DataPaths {
    Relative, ///< to the session file's folder, so that both can be moved together; a file on another drive: absolute
    Absolute  ///< for files that are kept elsewhere, such as recovery files
};

/// What readSession() found.
struct SessionFile {
    Session session;
    std::vector<std::string> notices; ///< remarks for the user: a data file that is not the one that was saved
};

/// Throws Error with place and reason: wrong JSON, another format, a newer version, a missing key, a number out of its
/// range. Unknown keys are kept. Data files need not be there; where they are, their size and checksum are compared.
SessionFile readSession(const std::string& path);
/// Through a temporary file beside `path` that is renamed. Reading it back gives an equal session, with the absolute
/// path of the data where it was relative to another folder. Throws FileError.
void writeSession(const Session& session, const std::string& path, DataPaths paths = DataPaths::Relative);

/// The document; `folder` is that of the file, which relative paths are relative to.
nlohmann::json jsonFromSession(const Session& session, const std::string& folder, DataPaths paths);
SessionFile sessionFromJson(const JsonValue& document, const std::string& folder);

/// Parts as sessions and films have them. Readers throw Error with the place. Cameras say what the other projection
/// would take up again, too.
nlohmann::json jsonFromWholeCamera(const Camera& camera);
nlohmann::json jsonFromClipping(const Clipping& clipping);
Clipping clippingFromJson(const JsonValue& json);
nlohmann::json jsonFromLight(const Light& light);
Light lightFromJson(const JsonValue& json);
/// An array of keys, each of which says all that it decides.
nlohmann::json jsonFromKeys(const Keyframes& keys);
/// Their times, which must rise, names and easings; `state` reads what each decides.
Keyframes keysFromJson(const JsonValue& array, const std::function<KeyState(const JsonValue& key)>& state);

} // namespace pellucid
