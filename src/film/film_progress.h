// Which film the pictures in a folder are of while it is drawn: a small file beside them, by which the rest can be
// drawn later.
#pragma once

#include <optional>
#include <string>

#include "film/film.h"

namespace pellucid {

inline constexpr const char* kFilmProgressFile = "film.progress.json";

/// Of all that the pictures depend on: program, data, what is decided in the session, size, way.
std::string filmDigest(const FilmTask& task);

/// That of the film which is drawn in a folder. Empty where the folder holds no such file or none that can be
/// understood.
std::optional<std::string> readFilmProgress(const std::string& folder);
void writeFilmProgress(const std::string& digest, const std::string& folder); ///< whole or not at all
void removeFilmProgress(const std::string& folder);

} // namespace pellucid
