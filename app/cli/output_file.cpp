#include "output_file.h"

#include <filesystem>

#include <unistd.h>

#include "base/error.h"

namespace pellucid::cli {

void requireFileName(const std::string& path, const std::string& option) {
    if (path.empty()) throw UsageError("the file name is empty", option, "name the file to write");
}

void checkOutputFile(const std::string& path, const std::string& option) {
    namespace fs = std::filesystem;
    requireFileName(path, option);
    const fs::path target(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code ec;
    if (!fs::is_directory(folder, ec)) throw FileError("the folder does not exist", folder.string(), "create it first");
    if (fs::is_directory(target, ec)) throw FileError("a folder has this name", path, "choose another name");
    if (access(folder.c_str(), W_OK) != 0)
        throw FileError("the folder is not writable", folder.string(),
                        "choose another folder or change its permissions");
}

} // namespace pellucid::cli
