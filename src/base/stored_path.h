// Names of files inside files: relative to the folder of the file that names them, so that both can be moved together.
#pragma once

#include <filesystem>
#include <string>

namespace pellucid {

/// How a file in `folder` names `path`; where that lies on another drive, by its absolute path. An empty folder is the
/// present one.
std::string relativeTo(const std::string& folder, const std::string& path);

/// Where a stored path leads from `folder`.
std::string foundPath(const std::filesystem::path& stored, const std::string& folder);

} // namespace pellucid
