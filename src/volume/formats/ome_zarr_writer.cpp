// Writes OME-Zarr 0.4: a folder with the volume in chunks packed by zlib, and with coarser copies of it.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <new>
#include <optional>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/error.h"
#include "base/parallel.h"
#include "volume/excerpt.h"
#include "volume/formats/writer.h"
#include "volume/orientation.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

using nlohmann::json;

constexpr int kChunk = 64;         ///< voxels along each axis
constexpr int kSmallestLevel = 64; ///< no coarser copy of what has no more along any axis
constexpr int kPacking = 3;        ///< noise does not get smaller at higher levels, only slower

/// Of one level of all frames.
json arrayMetadata(const Int3& d, const FramesToWrite& frames) {
    constexpr const char* kTypes[] = {"|u1", "|i1", "<u2", "<i2", "<u4", "<i4", "<f4", "<f8"};
    std::string type = kTypes[static_cast<std::size_t>(frames.type)];
    if (std::endian::native == std::endian::big && type.front() == '<') type.front() = '>';
    const Int3 chunk = glm::min(d, Int3(kChunk));
    json shape{d.z, d.y, d.x}, chunks{chunk.z, chunk.y, chunk.x};
    if (frames.count > 1) {
        shape.insert(shape.begin(), frames.count);
        chunks.insert(chunks.begin(), 1);
    }
    return {{"zarr_format", 2},
            {"shape", shape},
            {"chunks", chunks},
            {"dtype", type},
            {"compressor", {{"id", "zlib"}, {"level", kPacking}}},
            {"fill_value", 0},
            {"order", "C"},
            {"filters", nullptr},
            {"dimension_separator", "/"}};
}

/// The values of a chunk; beyond the volume they are zero.
std::vector<std::byte> chunkOf(const Volume& volume, const Int3& first, const Int3& size) {
    const std::size_t bytesPer = bytesPerSample(volume.sampleType());
    std::vector<std::byte> chunk(voxelCount(size) * bytesPer);
    const auto values = sampleBytes(volume);
    const Int3 d = volume.dims(), there = glm::min(size, d - first);
    for (int z = 0; z < there.z; ++z)
        for (int y = 0; y < there.y; ++y)
            std::memcpy(chunk.data() + voxelIndex(size, 0, y, z) * bytesPer,
                        values.data() + voxelIndex(d, first.x, first.y + y, first.z + z) * bytesPer,
                        static_cast<std::size_t>(there.x) * bytesPer);
    return chunk;
}

std::vector<Bytef> packed(const std::vector<std::byte>& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<Bytef> packed(size);
    if (compress2(packed.data(), &size, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                  kPacking) != Z_OK) // there is room for all that it can make of them
        throw std::bad_alloc();
    packed.resize(size);
    return packed;
}

/// All chunks of a volume, under `name`.
void writeChunks(OutputFolder& folder, const std::string& name, const Volume& volume, const JobControl& job) {
    const Int3 size = glm::min(volume.dims(), Int3(kChunk)), count = (volume.dims() - 1) / size + 1;
    std::atomic<std::size_t> done = 0;
    parallelFor(voxelCount(count), [&](std::size_t n) {
        job.throwIfStopped();
        const auto index = static_cast<int>(n);
        const Int3 at(index % count.x, index / count.x % count.y, index / count.x / count.y);
        const std::vector<Bytef> bytes = packed(chunkOf(volume, at * size, size));
        folder.write(name + "/" + std::to_string(at.z) + "/" + std::to_string(at.y) + "/" + std::to_string(at.x),
                     {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        if (n % 16 == 0) job.report(static_cast<double>(++done * 16) / static_cast<double>(voxelCount(count)));
    });
}

json transformationsOf(const Geometry& g, const FramesToWrite& frames) {
    json scale{g.spacing.z, g.spacing.y, g.spacing.x}, translation{g.origin.z, g.origin.y, g.origin.x};
    if (frames.count > 1) {
        const StepTimes times = frames.times.value_or(StepTimes{});
        scale.insert(scale.begin(), times.width);
        translation.insert(translation.begin(), times.first);
    }
    return {{{"type", "scale"}, {"scale", scale}}, {{"type", "translation"}, {"translation", translation}}};
}

/// How OME-Zarr writes a unit of time; empty: it is left out.
std::string timeUnit(const std::string& unit) {
    if (unit == "s") return "second";
    if (unit == "ms") return "millisecond";
    if (unit == "µs") return "microsecond";
    if (unit == "min") return "minute";
    return unit == "h" ? "hour" : unit == "d" ? "day" : "";
}

/// Of the units of length that OME-Zarr lists, all that are known here but thousandths of an inch.
bool isUnitOfZarr(LengthUnit unit) { return unit != LengthUnit::Unknown && unit != LengthUnit::Thou; }

json axesOf(const FramesToWrite& frames) {
    json axes = json::array();
    if (frames.count > 1) {
        axes.push_back({{"name", "t"}, {"type", "time"}});
        const std::string unit = frames.times ? timeUnit(frames.times->unit) : "";
        if (!unit.empty()) axes.back()["unit"] = unit;
    }
    for (const char* axis : {"z", "y", "x"}) {
        axes.push_back({{"name", axis}, {"type", "space"}});
        if (const LengthUnit unit = unitOf(frames.geometry); isUnitOfZarr(unit))
            axes.back()["unit"] = standardName(unit);
    }
    return axes;
}

/// A frame in all levels; their `datasets`, which are the same for each frame.
json writeLevels(OutputFolder& folder, int frame, const FramesToWrite& frames, const JobControl& job) {
    const Volume& volume = frames.frame(frame, job);
    const int longest = std::max({volume.dims().x, volume.dims().y, volume.dims().z});
    json datasets = json::array();
    for (int factor = 1, level = 0; factor == 1 || longest / factor >= kSmallestLevel; factor *= 2, ++level) {
        std::optional<Volume> coarser;
        if (factor > 1) coarser = coarserCopy(volume, factor);
        const Volume& copy = coarser ? *coarser : volume;
        const std::string name = std::to_string(level);
        if (frame == 0) folder.write(name + "/.zarray", arrayMetadata(copy.dims(), frames).dump(2));
        writeChunks(folder, frames.count > 1 ? name + "/" + std::to_string(frame) : name, copy,
                    factor == 1 ? job.part(0, 2) : JobControl{job.stop, {}});
        datasets.push_back({{"path", name}, {"coordinateTransformations", transformationsOf(copy.geometry(), frames)}});
    }
    return datasets;
}

/// Whether a folder is one image as it is written here, its levels and nothing else, which another one may replace.
bool isOneImage(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code ec;
    for (fs::directory_iterator it(path, ec), end; !ec && it != end; it.increment(ec)) {
        const std::string name = it->path().filename().string();
        const bool isLevel = it->is_directory(ec) && name.find_first_not_of("0123456789") == std::string::npos;
        if (!isLevel && name != ".zattrs" && name != ".zgroup") return false;
    }
    return !ec && fs::exists(path + "/.zgroup", ec) && fs::exists(path + "/.zattrs", ec);
}

void write(const FramesToWrite& frames, const std::string& path, const JobControl& job) {
    writeFolderAtomically(path, isOneImage, [&](OutputFolder& folder) {
        json datasets;
        for (int n = 0; n < frames.count; ++n) datasets = writeLevels(folder, n, frames, frames.part(n, job));
        const json image{{"version", "0.4"}, {"axes", axesOf(frames)}, {"datasets", datasets}, {"type", "mean"}};
        folder.write(".zattrs", json{{"multiscales", json::array({image})}}.dump(2));
        folder.write(".zgroup", json{{"zarr_format", 2}}.dump(2));
    });
}

std::vector<std::string> losses(const FramesToWrite& frames, const std::string&) {
    const Geometry& g = frames.geometry;
    std::vector<std::string> lost;
    if (g.directions != Mat3(1)) lost.emplace_back("OME-Zarr has no rotations: the volume will lie along the axes");
    if (g.worldAxes == WorldAxes::Patient) lost.emplace_back("OME-Zarr does not say that places are a patient's");
    if (g.lengthUnit == LengthUnit::Thou) lost.emplace_back("OME-Zarr has no unit for thousandths of an inch");
    if (frames.times && !frames.times->unit.empty() && timeUnit(frames.times->unit).empty())
        lost.push_back("OME-Zarr knows no unit of time called " + inQuotes(frames.times->unit));
    return lost;
}

} // namespace

VolumeWriter omeZarrWriter() { return {"OME-Zarr", {".zarr"}, write, losses}; }

} // namespace pellucid
