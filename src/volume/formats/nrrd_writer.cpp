// Writes NRRD0004: gzip-compressed in the volume's own type, or unpacked where several processes write together.
#include <bit>
#include <new>

#include <zlib.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/joint_file.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/formats/writer.h"
#include "volume/loader.h"
#include "volume/volume_part.h"
#include "volume/volume_writer.h"
#include "volume/voxel_loops.h"
#include "volume/write_field.h"

namespace pellucid {

namespace {

const char* nrrdType(SampleType type) {
    constexpr const char* kTypes[] = {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float", "double"};
    return kTypes[static_cast<std::size_t>(type)];
}

/// Whether a unit can stand in quotes: short, on one line, and without what would end them.
bool canBeQuoted(const std::string& unit) {
    constexpr std::size_t kMostUnit = 40; // bytes, of which a reader keeps no more
    return unit.size() <= kMostUnit && unit == trimmed(printable(unit)) && unit.find('\\') == std::string::npos;
}

/// A unit of time in quotes, in which \" is a quote; none where it cannot be said.
std::string quoted(const std::string& unit) {
    std::string text = "\"";
    if (canBeQuoted(unit))
        for (const char c : unit) text += c == '"' ? std::string("\\\"") : std::string(1, c);
    return text + "\"";
}

std::string headerText(const Geometry& g, SampleType type, const std::string& encoding, int frames = 1,
                       const std::optional<StepTimes>& times = {}) {
    const auto vector = [](const Vec3& v) {
        return "(" + exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z) + ")";
    };
    // Without a patient the world has a dimension and no name.
    const Mat3 axes = g.worldFromIndex();
    const bool several = frames > 1;
    std::string text = "NRRD0004\ntype: " + std::string(nrrdType(type)) + "\ndimension: " + (several ? "4" : "3") +
                       "\n" +
                       (g.worldAxes == WorldAxes::Patient ? "space: left-posterior-superior" : "space dimension: 3") +
                       "\nsizes: " + std::to_string(g.dims.x) + " " + std::to_string(g.dims.y) + " " +
                       std::to_string(g.dims.z) + (several ? " " + std::to_string(frames) : "") +
                       "\nspace directions: " + vector(axes[0]) + " " + vector(axes[1]) + " " + vector(axes[2]) +
                       (several ? " none" : "") + "\nkinds: domain domain domain" + (several ? " time" : "");
    if (several && times) // what is said of axes in space is said by their directions
        text += "\nspacings: nan nan nan " + exactText(times->width) + "\naxis mins: nan nan nan " +
                exactText(times->first) + "\nunits: \"\" \"\" \"\" " + quoted(times->unit);
    const LengthUnit unit = g.lengthUnit;
    if (unit != LengthUnit::Unknown) {
        const std::string name = '"' + std::string(plainSign(unit)) + '"';
        text += "\nspace units: " + name + " " + name + " " + name;
    }
    return text + "\nendian: " + (std::endian::native == std::endian::big ? "big" : "little") +
           "\nencoding: " + encoding + "\nspace origin: " + vector(g.origin) + "\n\n";
}

void write(const FramesToWrite& frames, const std::string& path, const JobControl& job) {
    writeAtomically(path, [&](OutputFile& out) {
        out.write(headerText(frames.geometry, frames.type, "gzip", frames.count, frames.times));
        deflateFrames(out, {}, frames, job);
    });
}

std::vector<std::string> losses(const FramesToWrite& frames, const std::string&) {
    if (!frames.times || canBeQuoted(frames.times->unit)) return {};
    return {"NRRD cannot write the unit of time " + inQuotes(frames.times->unit)};
}

} // namespace

VolumeWriter nrrdWriter() { return {"NRRD", {".nrrd"}, write, losses}; }

struct GzipOutput::Stream {
    z_stream zlib{};
    std::vector<char> packed = std::vector<char>(1u << 18);
    void put(std::span<const std::byte> bytes, int flush, OutputFile& out) {
        // zlib does not write there.
        zlib.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
        zlib.avail_in = static_cast<uInt>(bytes.size());
        do {
            zlib.next_out = reinterpret_cast<Bytef*>(packed.data());
            zlib.avail_out = static_cast<uInt>(packed.size());
            deflate(&zlib, flush);
            out.write(packed.data(), packed.size() - zlib.avail_out);
        } while (zlib.avail_out == 0);
    }
};

GzipOutput::GzipOutput(OutputFile& out) : m_out(out), m_stream(std::make_unique<Stream>()) {
    constexpr int kGzipFrame = 16;
    constexpr int kLevel = 3; // noise does not get smaller at higher levels, only slower
    if (deflateInit2(&m_stream->zlib, kLevel, Z_DEFLATED, MAX_WBITS + kGzipFrame, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
}

GzipOutput::~GzipOutput() { deflateEnd(&m_stream->zlib); }

void GzipOutput::write(std::span<const std::byte> bytes, const JobControl& job) {
    constexpr std::size_t kPiece = 1u << 24;
    for (std::size_t done = 0; done < bytes.size();) {
        job.throwIfStopped();
        const auto piece = bytes.subspan(done, std::min(kPiece, bytes.size() - done));
        m_stream->put(piece, Z_NO_FLUSH, m_out);
        done += piece.size();
        job.report(static_cast<double>(done) / static_cast<double>(bytes.size()));
    }
}

void GzipOutput::finish() { m_stream->put({}, Z_FINISH, m_out); }

void deflateFrames(OutputFile& out, std::span<const std::byte> head, const FramesToWrite& frames,
                   const JobControl& job) {
    GzipOutput gzip(out);
    gzip.write(head, {job.stop, {}});
    for (int n = 0; n < frames.count; ++n) {
        const JobControl part = frames.part(n, job);
        gzip.write(sampleBytes(frames.frame(n, part)), part);
    }
    gzip.finish();
}

void writeNrrd(const Volume& volume, const std::string& path) {
    FramesToWrite one{volume.geometry(), volume.sampleType()};
    one.frame = [&](int, const JobControl&) -> const Volume& { return volume; };
    write(one, path, {});
}

void writeNrrd(const Geometry& geometry, const Grid<float>& values, const std::string& path) {
    PELLUCID_CHECK(values.dims() == geometry.dims);
    writeAtomically(path, [&](OutputFile& out) { // as they lie there: a volume of them would be a copy
        out.write(headerText(geometry, SampleType::F32, "gzip"));
        GzipOutput gzip(out);
        gzip.write(std::as_bytes(std::span(values.data(), voxelCount(geometry.dims))), {});
        gzip.finish();
    });
}

std::vector<std::string> writeField(const Volume& volume, const Grid<float>& values, const std::string& path) {
    const bool isNrrd = lowerCase(path).ends_with(".nrrd");
    if (volume.elsewhere() == nullptr && isNrrd) {
        writeNrrd(volume.geometry(), values, path);
        return {};
    }
    if (volume.elsewhere() == nullptr)
        return writeVolume(
            Volume(volume.geometry(), SampleArray<float>(std::vector<float>(values.begin(), values.end()))), path);
    if (!isNrrd) throw UsageError("several processes write fields as NRRD only", path, "leave the format out");
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
    return {};
}

} // namespace pellucid
