// Where a command writes: checked before any work is done.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "resolve.h"

namespace pellucid::cli {

/// The files that a command reads, those of its session too. Throws as inputsOf() does.
std::vector<std::string> inputFiles(const SceneOptions& options);

void requireFileName(const std::string& path, const std::string& option); ///< throws UsageError where it is empty

/// A file to be written: throws where that cannot work, and UsageError where it is one of the inputs by whatever name.
void checkOutputFile(const std::string& path, const std::string& option, std::span<const std::string> inputs = {});

/// The same for files in a folder, which is made where it is missing.
void checkOutputFolder(const std::string& path, const std::string& option, std::span<const std::string> fileNames,
                       std::span<const std::string> inputs);

/// *.camera.json. Throws FileError.
void writeCamera(const Camera& camera, const std::string& path);

} // namespace pellucid::cli
