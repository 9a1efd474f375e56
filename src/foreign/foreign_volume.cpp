#include "foreign/foreign_volume.h"

#include <algorithm>
#include <filesystem>

#include "volume/formats/file_check.h"

namespace pellucid {

namespace fs = std::filesystem;

std::string folderToRead(const std::string& path) {
    if (isFolder(path)) return path;
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

std::span<std::byte> copyFromSlice(std::span<const std::byte> slice, const glm::ivec2& size, std::size_t bytesPerVoxel,
                                   const VoxelRegion& region, std::span<std::byte> to) {
    const std::size_t row = static_cast<std::size_t>(size.x) * bytesPerVoxel,
                      first = static_cast<std::size_t>(region.lo.x) * bytesPerVoxel,
                      count = static_cast<std::size_t>(region.hi.x - region.lo.x) * bytesPerVoxel;
    for (int y = region.lo.y; y < region.hi.y; ++y, to = to.subspan(count))
        std::ranges::copy(slice.subspan(static_cast<std::size_t>(y) * row + first, count), to.begin());
    return to;
}

void swapBytes(std::span<std::byte> bytes, std::size_t width) {
    for (; bytes.size() >= width; bytes = bytes.subspan(width)) std::ranges::reverse(bytes.first(width));
}

std::uint64_t bytesOfFile(const std::string& path) {
    std::error_code ec;
    const auto bytes = fs::file_size(path, ec);
    return ec ? 0 : bytes;
}

} // namespace pellucid
