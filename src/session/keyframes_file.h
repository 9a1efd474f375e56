// *.film.json: keyframes as a file (docs/guide.md, "Files").
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "session/keyframes.h"
#include "session/scene.h"

namespace pellucid {

inline constexpr const char* kFilmSuffix = ".film.json";

/// What a key does not say is as in the key before it, in the first as in `scene`, which has a volume. `folder`: what
/// names of files are relative to. Throws Error with the place: wrong JSON, another format, a newer version, no keys,
/// times that do not rise, a number out of its range, a frame that the series has not, a camera in the box.
Keyframes keyframesFromJson(const JsonValue& document, const std::string& folder, const Scene& scene);
Keyframes readKeyframes(const std::string& path, const Scene& scene);

nlohmann::json jsonFromKeyframes(const Keyframes& keys);
/// Through a temporary file. Reading it back for the same data gives equal keys. Throws FileError.
void writeKeyframes(const Keyframes& keys, const std::string& path);

/// That keys fit the data of a scene: throws Error for a frame that the series has not, and a camera in the box.
void checkKeyframes(const Keyframes& keys, const Scene& scene);

/// What a command line may name: a *.film.json, or session files with semicolons between, which become keys at equal
/// times over `seconds`, from rest to rest. Throws UsageError without a place, and as the others do.
Keyframes keyframesOfText(const std::string& text, double seconds, const Scene& scene);
/// Whether `text` names a film and not sessions: `seconds` does not count then.
bool isFilmFile(const std::string& text);

} // namespace pellucid
