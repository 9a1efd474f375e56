#include "foreign/foreign_volume.h"

#include <filesystem>

#include "volume/formats/file_check.h"

namespace pellucid {

namespace fs = std::filesystem;

std::string folderToRead(const std::string& path) {
    if (isFolder(path)) return path;
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

std::uint64_t bytesOfFile(const std::string& path) {
    std::error_code ec;
    const auto bytes = fs::file_size(path, ec);
    return ec ? 0 : bytes;
}

} // namespace pellucid
