#include "volume/memory_use.h"

#include "base/memory.h"

namespace pellucid {

namespace {

std::string voxels(const Int3& dims) {
    return std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " + std::to_string(dims.z) + " voxels";
}

} // namespace

bool isLean(const Int3& dims, SampleType type) { return voxelCount(dims) >= kLeanVoxels && bytesPerSample(type) == 1; }

std::uint64_t bytesOf(const MemoryUse& use, const Int3& dims, SampleType type) {
    return static_cast<std::uint64_t>((isLean(dims, type) ? use.leanBytesPerVoxel : use.bytesPerVoxel) *
                                      static_cast<double>(voxelCount(dims)));
}

void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, SampleType type) {
    requireMemory(use.doing + " " + voxels(dims), where, bytesOf(use, dims, type));
}

void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, SampleType type,
                   std::uint64_t reading, std::uint64_t kept) {
    const std::uint64_t later = kept + bytesOf(use, dims, type);
    if (later > reading)
        requireMemory((use.doing.empty() ? "reading" : "reading and " + use.doing) + " " + voxels(dims), where, later);
    else
        requireMemory("reading " + voxels(dims), where, reading);
}

} // namespace pellucid
