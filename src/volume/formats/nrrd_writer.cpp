// Writes NRRD0004: gzip-compressed in the volume's own type, or unpacked where several processes write together.
#include <bit>
#include <new>

#include <zlib.h>

#include "base/atomic_file.h"
#include "base/joint_file.h"
#include "base/round_numbers.h"
#include "volume/formats/writer.h"
#include "volume/loader.h"
#include "volume/volume_part.h"
#include "volume/voxel_loops.h"
#include "volume/write_field.h"

namespace pellucid {

namespace {

const char* nrrdType(SampleType type) {
    constexpr const char* kTypes[] = {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float", "double"};
    return kTypes[static_cast<std::size_t>(type)];
}

std::string headerText(const Geometry& g, SampleType type, const std::string& encoding) {
    const auto vector = [](const Vec3& v) {
        return "(" + exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z) + ")";
    };
    // Without a patient the world has a dimension and no name.
    const Mat3 axes = g.worldFromIndex();
    std::string text =
        "NRRD0004\ntype: " + std::string(nrrdType(type)) + "\ndimension: 3\n" +
        (g.worldAxes == WorldAxes::Patient ? "space: left-posterior-superior" : "space dimension: 3") +
        "\nsizes: " + std::to_string(g.dims.x) + " " + std::to_string(g.dims.y) + " " + std::to_string(g.dims.z) +
        "\nspace directions: " + vector(axes[0]) + " " + vector(axes[1]) + " " + vector(axes[2]) +
        "\nkinds: domain domain domain\nendian: " + (std::endian::native == std::endian::big ? "big" : "little") +
        "\nencoding: " + encoding + "\nspace origin: " + vector(g.origin) + "\n\n";
    return text;
}

void writeFile(const std::string& path, const Geometry& geometry, SampleType type, std::span<const std::byte> data,
               const JobControl& job) {
    writeAtomically(path, [&](OutputFile& out) {
        out.write(headerText(geometry, type, "gzip"));
        deflatePieces(out, {data}, job);
    });
}

void write(const Volume& volume, const std::string& path, const JobControl& job) {
    writeFile(path, volume.geometry(), volume.sampleType(), sampleBytes(volume), job);
}

} // namespace

VolumeWriter nrrdWriter() {
    return {"NRRD", {".nrrd"}, write, [](const Geometry&) { return std::vector<std::string>{}; }};
}

void deflatePieces(OutputFile& out, std::initializer_list<std::span<const std::byte>> parts, const JobControl& job) {
    constexpr int kGzipFrame = 16;
    constexpr int kLevel = 3; // noise does not get smaller at higher levels, only slower
    constexpr std::size_t kPiece = 1u << 24;
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, MAX_WBITS + kGzipFrame, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    const struct End {
        z_stream& stream;
        ~End() { deflateEnd(&stream); }
    } end{stream};
    std::vector<char> packed(1u << 18);
    const auto put = [&](std::span<const std::byte> piece, int flush) {
        // zlib does not write there.
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(piece.data()));
        stream.avail_in = static_cast<uInt>(piece.size());
        do {
            stream.next_out = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_out = static_cast<uInt>(packed.size());
            deflate(&stream, flush);
            out.write(packed.data(), packed.size() - stream.avail_out);
        } while (stream.avail_out == 0);
    };
    for (const std::span<const std::byte> part : parts)
        for (std::size_t done = 0; done < part.size();) {
            job.throwIfStopped();
            const auto piece = part.subspan(done, std::min(kPiece, part.size() - done));
            put(piece, Z_NO_FLUSH);
            done += piece.size();
            job.report(static_cast<double>(done) / static_cast<double>(part.size()));
        }
    put({}, Z_FINISH);
}

void writeNrrd(const Volume& volume, const std::string& path) { write(volume, path, {}); }

void writeNrrd(const Geometry& geometry, const Grid<float>& values, const std::string& path) {
    PELLUCID_CHECK(values.dims() == geometry.dims);
    writeFile(path, geometry, SampleType::F32, std::as_bytes(std::span(values.data(), voxelCount(geometry.dims))), {});
}

void writeField(const Volume& volume, const Grid<float>& values, const std::string& path) {
    if (volume.elsewhere() == nullptr) return writeNrrd(volume.geometry(), values, path);
    PELLUCID_CHECK(values.dims() == volume.dimsHere());
    const Int3 dims = volume.dims();
    const std::string header = headerText(volume.geometry(), SampleType::F32, "raw");
    const VolumePart part = partHere(volume);
    const auto place = [&](const Int3& v) { return header.size() + sizeof(float) * voxelIndex(dims, v.x, v.y, v.z); };
    writeJointly(
        path, place({0, 0, dims.z}),
        [&](std::span<const std::byte> bytes) { return volume.elsewhere()->gather(bytes); },
        [&](JointFile& file) {
            file.writeAt(0, header.data(), header.size()); // the same from all
            if (part.volume == nullptr) return;
            part.forOwnRows(0, part.ownLayers(), [&](const Int3& row, std::size_t index, int voxels) {
                file.writeAt(place(row), &values[index], sizeof(float) * static_cast<std::size_t>(voxels));
            });
        });
}

} // namespace pellucid
