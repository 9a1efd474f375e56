// A volume file as input: it is opened as the program opens it, all of it is looked at, and its parts must be the same
// as in the whole.
#pragma once

#include <algorithm>
#include <bit>
#include <optional>
#include <variant>

#include "fuzz_input.h"
#include "volume/file_contents.h"
#include "volume/loader.h"

namespace pellucid::fuzz {

/// Voxels of volumes that are read more than once.
inline constexpr std::size_t kMostVoxels = 100'000;

/// Looks at every sample, so that the address sanitizer sees where they are.
inline void touch(const Volume& volume) {
    double sum = 0;
    std::visit(
        [&](const auto& samples) {
            for (std::size_t i = 0; i < volume.size(); ++i) sum += static_cast<double>(samples[i]);
        },
        volume.samples());
    static volatile double s_sink;
    s_sink = s_sink + sum;
}

inline bool sameBits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// The voxels that lie in the middle, read alone, are those of the whole.
inline void requireSamePart(VolumeSource source, const Volume& whole) {
    const Int3 dims = whole.dims();
    const VoxelRegion region{dims / 3, dims - dims / 4};
    source.region = region;
    const Volume part = loadVolume(source);
    for (int k = region.lo.z; k < region.hi.z; ++k)
        for (int j = region.lo.y; j < region.hi.y; ++j)
            for (int i = region.lo.x; i < region.hi.x; ++i) {
                const Int3 at = Int3(i, j, k) - region.lo;
                const double value = part.value(voxelIndex(part.dims(), at.x, at.y, at.z));
                require(sameBits(value, whole.value(voxelIndex(dims, i, j, k))), "a part has the values of the whole");
            }
}

/// The last step, the last component, and a coarser copy.
inline void touchOthers(const VolumeSource& source, const FileContents& contents) {
    VolumeSource other = source;
    other.step = contents.steps - 1;
    other.component = contents.components - 1;
    if (!contents.arrays.empty()) other.array = contents.arrays.back();
    succeeds([&] { touch(loadVolume(other)); }); // of other arrays and steps the data may be missing
    VolumeSource coarse = source;
    coarse.downsample = 2;
    touch(loadVolume(coarse));
}

inline void openVolume(const VolumeSource& source) {
    std::optional<Volume> volume;
    const bool isRead = succeeds([&] { volume.emplace(loadVolume(source)); });
    FileContents contents;
    const bool isTold = succeeds([&] { contents = contentsOf(source); }); // of a header alone: the data may be missing
    if (!isRead) return;
    touch(*volume);
    require(isTold, "what can be read can be told of");
    require(contents.dims == volume->dims() && contents.type == volume->sampleType(), "a header tells what is read");
    require(!filesOf(source).empty(), "a volume has a file");
    if (volume->size() > kMostVoxels) return;
    succeeds([&] { requireSamePart(source, *volume); });
    succeeds([&] { touchOthers(source, contents); });
}

/// Opens the input as a file of this suffix. No format of a library has it, so that no process is started.
inline void openVolume(const InputFolder& folder, const std::uint8_t* data, std::size_t size,
                       const std::string& suffix) {
    folder.with(data, size, suffix, [](const std::string& path) {
        VolumeSource source;
        source.path = path;
        openVolume(source);
    });
}

} // namespace pellucid::fuzz
