#include "volume/formats/voreen_format.h"

#include <algorithm>
#include <array>
#include <map>

#include <glm/geometric.hpp>

#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

std::optional<ValueType> typeNamed(const std::string& name) {
    static const std::map<std::string, ValueType> kTypes{
        {"uchar", ValueType::U8},      {"char", ValueType::I8},    {"ushort", ValueType::U16},
        {"ushort_12", ValueType::U16}, {"short", ValueType::I16},  {"uint", ValueType::U32},
        {"int", ValueType::I32},       {"float", ValueType::F32},  {"double", ValueType::F64},
        {"uint8", ValueType::U8},      {"int8", ValueType::I8},    {"uint16", ValueType::U16},
        {"uint12", ValueType::U16},    {"int16", ValueType::I16},  {"uint32", ValueType::U32},
        {"int32", ValueType::I32},     {"uint64", ValueType::U64}, {"int64", ValueType::I64},
        {"float32", ValueType::F32},   {"float64", ValueType::F64}};
    const auto it = kTypes.find(name);
    return it == kTypes.end() ? std::nullopt : std::optional(it->second);
}

} // namespace

std::optional<VoxelFormat> voxelFormatNamed(const std::string& name) {
    const std::string lower = lowerCase(name);
    std::string type = lower;
    VoxelFormat format;
    for (int n = 2; n <= 4; ++n) {
        const std::string digit = std::to_string(n), inviwo = "vec" + digit, voreen = "vector" + digit + "(";
        const bool isVoreen = lower.starts_with(voreen) && lower.ends_with(')');
        if (!isVoreen && !lower.starts_with(inviwo)) continue;
        type = isVoreen ? lower.substr(voreen.size(), lower.size() - voreen.size() - 1) : lower.substr(inviwo.size());
        format.components = n;
    }
    const std::optional<ValueType> found = typeNamed(type);
    if (!found) return {};
    format.type = *found;
    return format;
}

void transformGrid(FileLayout& layout, const std::array<double, 16>& rows, const std::string& path) {
    if (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1)
        throw FileError("the transformation in the header is one of perspective", path,
                        "give it 0 0 0 1 as its last row");
    const auto mapped = [&](const Vec3& v) {
        return Vec3(rows[0] * v.x + rows[1] * v.y + rows[2] * v.z, rows[4] * v.x + rows[5] * v.y + rows[6] * v.z,
                    rows[8] * v.x + rows[9] * v.y + rows[10] * v.z);
    };
    layout.origin = mapped(layout.origin) + Vec3(rows[3], rows[7], rows[11]);
    for (int a = 0; a < 3; ++a) {
        const Vec3 axis = mapped(layout.directions[a] * layout.spacing[a]);
        layout.spacing[a] = glm::length(axis);
        layout.directions[a] = cleanDirection(axis);
    }
}

void placeRawData(FileLayout& layout, const std::string& header, int step, const JobControl& job) {
    const std::uint64_t bytes = dataFileBytes(layout.dataPath, header);
    requireData(layout, bytes - std::min(layout.start, bytes), valuesUpTo(layout, step),
                "check sizes and format in the header, or copy the file again", job);
}

} // namespace pellucid
