// Writes OME-Zarr 0.4: a folder with the volume in chunks packed by zlib, and with coarser copies of it.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <new>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/parallel.h"
#include "volume/excerpt.h"
#include "volume/formats/writer.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

using nlohmann::json;

constexpr int kChunk = 64;         ///< voxels along each axis
constexpr int kSmallestLevel = 64; ///< no coarser copy of what has no more along any axis
constexpr int kPacking = 3;        ///< noise does not get smaller at higher levels, only slower

json arrayMetadata(const Volume& volume) {
    constexpr const char* kTypes[] = {"|u1", "|i1", "<u2", "<i2", "<u4", "<i4", "<f4", "<f8"};
    std::string type = kTypes[static_cast<std::size_t>(volume.sampleType())];
    if (std::endian::native == std::endian::big && type.front() == '<') type.front() = '>';
    const Int3 d = volume.dims(), chunk = glm::min(d, Int3(kChunk));
    return {{"zarr_format", 2},
            {"shape", {d.z, d.y, d.x}},
            {"chunks", {chunk.z, chunk.y, chunk.x}},
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

void writeArray(OutputFolder& folder, const std::string& name, const Volume& volume, const JobControl& job) {
    folder.write(name + "/.zarray", arrayMetadata(volume).dump(2));
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

json transformationsOf(const Geometry& g) {
    return {{{"type", "scale"}, {"scale", {g.spacing.z, g.spacing.y, g.spacing.x}}},
            {{"type", "translation"}, {"translation", {g.origin.z, g.origin.y, g.origin.x}}}};
}

void write(const Volume& volume, const std::string& path, const JobControl& job) {
    const Geometry& g = volume.geometry();
    writeFolderAtomically(path, [&](OutputFolder& folder) {
        json datasets = json::array();
        const int longest = std::max({g.dims.x, g.dims.y, g.dims.z});
        for (int factor = 1, level = 0; factor == 1 || longest / factor >= kSmallestLevel; factor *= 2, ++level) {
            const std::string name = std::to_string(level);
            if (factor == 1) {
                writeArray(folder, name, volume, job.part(0, 2));
                datasets.push_back({{"path", name}, {"coordinateTransformations", transformationsOf(g)}});
            } else {
                const Volume coarser = coarserCopy(volume, factor);
                writeArray(folder, name, coarser, {job.stop, {}});
                datasets.push_back(
                    {{"path", name}, {"coordinateTransformations", transformationsOf(coarser.geometry())}});
            }
        }
        json axes = json::array();
        for (const char* axis : {"z", "y", "x"}) {
            axes.push_back({{"name", axis}, {"type", "space"}});
            if (g.worldAxes == WorldAxes::Patient) axes.back()["unit"] = "millimeter";
        }
        const json image{{"version", "0.4"}, {"axes", axes}, {"datasets", datasets}, {"type", "mean"}};
        folder.write(".zattrs", json{{"multiscales", json::array({image})}}.dump(2));
        folder.write(".zgroup", json{{"zarr_format", 2}}.dump(2));
    });
}

std::vector<std::string> losses(const Geometry& g) {
    std::vector<std::string> lost;
    if (g.directions != Mat3(1)) lost.emplace_back("OME-Zarr has no rotations: the volume will lie along the axes");
    if (g.worldAxes == WorldAxes::Patient) lost.emplace_back("OME-Zarr does not say that places are a patient's");
    return lost;
}

} // namespace

VolumeWriter omeZarrWriter() { return {"OME-Zarr", {".zarr"}, write, losses}; }

} // namespace pellucid
