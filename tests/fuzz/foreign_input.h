// A volume that a reader process reads, in this process: what it says is checked as the program that asks checks it.
#pragma once

#include <cstring>
#include <vector>

#include <nlohmann/json.hpp>

#include "foreign/foreign_volume.h"
#include "fuzz_input.h"
#include "volume/process/reader_messages.h"

namespace pellucid::fuzz {

/// Of voxels, and of what is unpacked at once; larger ones are described only.
inline constexpr std::uint64_t kMostBytes = 1u << 20, kMostUnpacked = 64u << 20;

inline std::vector<std::byte> readBox(const ForeignVolume& volume, const ReaderLayout& layout, const ReaderBox& box) {
    std::vector<std::byte> voxels(static_cast<std::size_t>(bytesOf(box, layout, "")));
    volume.read(
        0, box, voxels, [](std::uint64_t) {}, JobControl{});
    return voxels;
}

/// The last voxel of a box, read alone, is that of the box.
inline void requireSameVoxel(const ForeignVolume& volume, const ReaderLayout& layout, const ReaderBox& box,
                             const std::vector<std::byte>& whole) {
    ReaderBox last = box;
    last.region.lo = box.region.hi - 1;
    const std::vector<std::byte> voxel = readBox(volume, layout, last);
    require(voxel.size() <= whole.size() &&
                std::memcmp(voxel.data(), whole.data() + (whole.size() - voxel.size()), voxel.size()) == 0,
            "a voxel read alone is that of the whole");
}

inline void readLevel(const ForeignVolume& volume, const ReaderLayout& layout, int level) {
    const ReaderBox box{level, {Int3(0), dimsOf(layout, level)}, 0};
    if (bytesOf(box, layout, "") > kMostBytes || volume.largestImageBytes() > kMostUnpacked) return;
    requireSameVoxel(volume, layout, box, readBox(volume, layout, box));
}

/// Describes it, and reads each of its levels.
inline void readForeign(const ForeignVolume& volume) {
    bool isTold = false;
    const ReaderDescription description{volume.contents(), volume.files()};
    succeeds([&] { isTold = descriptionIn(jsonOf(description)).contents.steps >= 1; });
    require(!description.files.empty(), "a volume has a file");
    const ReaderLayout layout = volume.layout(0);
    ReaderLayout heard;
    succeeds([&] { heard = layoutIn(jsonOf(layout)); });
    if (heard.layout.axes.empty()) return; // the asker refuses it
    require(isTold, "what can be read can be told of");
    for (int level = 0; level <= static_cast<int>(heard.levels.size()); ++level)
        succeeds([&] { readLevel(volume, layout, level); });
}

} // namespace pellucid::fuzz
