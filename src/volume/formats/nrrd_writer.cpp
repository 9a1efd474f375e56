// Writes NRRD0004: gzip-compressed in the volume's own type, or unpacked where several processes write together.
#include <bit>

#include <zlib.h>

#include "base/atomic_file.h"
#include "base/joint_file.h"
#include "base/round_numbers.h"
#include "volume/formats/text_header.h"
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

void deflateInto(OutputFile& out, const char* data, std::size_t bytes) {
    constexpr int kGzipFrame = 16;
    constexpr int kLevel = 3; // noise does not get smaller at higher levels, only slower
    z_stream stream{};
    PELLUCID_CHECK(deflateInit2(&stream, kLevel, Z_DEFLATED, MAX_WBITS + kGzipFrame, 8, Z_DEFAULT_STRATEGY) == Z_OK);
    const struct End {
        z_stream& stream;
        ~End() { deflateEnd(&stream); }
    } end{stream};
    std::vector<char> packed(1u << 18);
    constexpr std::size_t kPiece = 1u << 24;
    std::size_t done = 0;
    bool last = false;
    while (!last) {
        const std::size_t piece = std::min(kPiece, bytes - done);
        last = done + piece == bytes;
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data + done)); // zlib does not write there
        stream.avail_in = static_cast<uInt>(piece);
        do {
            stream.next_out = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_out = static_cast<uInt>(packed.size());
            deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);
            out.write(packed.data(), packed.size() - stream.avail_out);
        } while (stream.avail_out == 0);
        done += piece;
    }
}

void writeFile(const std::string& path, const Geometry& geometry, SampleType type, const void* data) {
    writeAtomically(path, [&](OutputFile& out) {
        out.write(headerText(geometry, type, "gzip"));
        deflateInto(out, static_cast<const char*>(data), voxelCount(geometry.dims) * bytesPerSample(type));
    });
}

} // namespace

void writeNrrd(const Volume& volume, const std::string& path) {
    withSamples(volume,
                [&](const auto& values) { writeFile(path, volume.geometry(), volume.sampleType(), values.data()); });
}

void writeNrrd(const Geometry& geometry, const Grid<float>& values, const std::string& path) {
    PELLUCID_CHECK(values.dims() == geometry.dims);
    writeFile(path, geometry, SampleType::F32, values.data());
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
