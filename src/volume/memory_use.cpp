#include "volume/memory_use.h"

#include "base/memory.h"

namespace pellucid {

namespace {

std::string voxels(const Int3& dims) {
    return std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " + std::to_string(dims.z) + " voxels";
}

std::uint64_t bytesOf(const MemoryUse& use, const Int3& dims) {
    return static_cast<std::uint64_t>(use.bytesPerVoxel * static_cast<double>(voxelCount(dims)));
}

} // namespace

void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims) {
    requireMemory(use.doing + " " + voxels(dims), where, bytesOf(use, dims));
}

void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, std::uint64_t reading,
                   std::uint64_t kept) {
    const std::uint64_t later = kept + bytesOf(use, dims);
    if (later > reading)
        requireMemory((use.doing.empty() ? "reading" : "reading and " + use.doing) + " " + voxels(dims), where, later);
    else
        requireMemory("reading " + voxels(dims), where, reading);
}

} // namespace pellucid
