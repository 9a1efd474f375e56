// What the headers of Voreen and Inviwo have in common: .dat and .vvd.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "volume/formats/samples.h"

namespace pellucid {

/// The values of a voxel.
struct VoxelFormat {
    ValueType type = ValueType::U8;
    std::int64_t components = 1;
};

/// By the name that one of the two programs gives it: "USHORT_12", "UINT16", "Vec3FLOAT32", "Vector3(uint8)"; none
/// where it is none that we read.
std::optional<VoxelFormat> voxelFormatNamed(const std::string& name);

/// Maps the axes of `layout`, which have spacing, origin and directions already, by row-major `rows` of 4 x 4 numbers.
/// Throws FileError at `path` unless that keeps straight lines parallel.
void transformGrid(FileLayout& layout, const std::array<double, 16>& rows, const std::string& path);

/// Checks the data file of `layout` up to `step`; its data begin at layout.start.
void placeRawData(FileLayout& layout, const std::string& header, int step, const JobControl& job);

} // namespace pellucid
