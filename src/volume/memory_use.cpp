#include "volume/memory_use.h"

#include "base/memory.h"
#include "volume/intensity_grid.h"

namespace pellucid {

bool isLean(const Int3& dims, SampleType type) { return voxelCount(dims) >= kLeanVoxels && bytesPerSample(type) == 1; }

std::uint64_t bytesOf(const MemoryUse& use, const Int3& dims, SampleType type) {
    return static_cast<std::uint64_t>((isLean(dims, type) ? use.leanBytesPerVoxel : use.bytesPerVoxel) *
                                      static_cast<double>(voxelCount(dims)));
}

MemoryUse ofPartHere(MemoryUse use, const Volume& volume) {
    if (volume.elsewhere() == nullptr || !isLean(volume.dims(), volume.sampleType())) return use;
    if (volume.here() && samplesAreNarrowCodes(*volume.here())) use.leanBytesPerVoxel -= 1;
    use.bytesPerVoxel = use.leanBytesPerVoxel;
    return use;
}

void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, SampleType type) {
    requireMemory(use.doing + " " + dimsText(dims) + " voxels", where, bytesOf(use, dims, type));
}

void requireMemory(const MemoryUse& use, const std::string& where, const Int3& dims, SampleType type,
                   std::uint64_t reading, std::uint64_t kept) {
    const std::uint64_t later = kept + bytesOf(use, dims, type);
    const bool alsoDoing = later > reading && !use.doing.empty();
    requireMemory((alsoDoing ? "reading and " + use.doing : "reading") + " " + dimsText(dims) + " voxels", where,
                  std::max(later, reading));
}

} // namespace pellucid
