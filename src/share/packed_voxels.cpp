#include "share/packed_voxels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <zlib.h>

#include "base/check.h"
#include "base/parallel.h"

namespace pellucid {

namespace {

bool isInteger(SampleType type) { return type != SampleType::F32 && type != SampleType::F64; }

/// The voxels of layer k, into planes that hold `layers` of them, as the `at`-th.
void packLayer(const Volume& volume, const ShareCodes& codes, bool hasInvalid, int k, std::size_t at,
               std::size_t layers, unsigned char* planes) {
    const Int3& n = volume.dims();
    const std::size_t layer = static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y), plane = layer * layers;
    const std::size_t first = voxelIndex(n, 0, 0, k);
    unsigned char* const high = codes.bits == 16 ? planes + at * layer : nullptr;
    unsigned char* const low = planes + (codes.bits == 16 ? plane : 0) + at * layer;
    unsigned char* const valid =
        hasInvalid ? planes + plane * static_cast<std::size_t>(codes.bits / 8) + at * layer : nullptr;
    for (std::size_t i = 0; i < layer; ++i) {
        const double s = volume.intensity(first + i);
        const bool isValid = !std::isnan(s);
        const auto code = static_cast<unsigned>(isValid ? s * codes.maxCode + 0.5 : 0);
        if (high != nullptr) high[i] = static_cast<unsigned char>(code >> 8);
        low[i] = static_cast<unsigned char>(code & 255);
        if (valid != nullptr) valid[i] = isValid ? 1 : 0;
    }
}

std::size_t planeCount(const ShareCodes& codes, bool hasInvalid) {
    return static_cast<std::size_t>(codes.bits / 8) + (hasInvalid ? 1 : 0);
}

} // namespace

ShareCodes shareCodes(const Volume& volume, int bits) {
    const ValueRange& range = volume.range();
    const double span = range.hi - range.lo;
    const bool whole = isInteger(volume.sampleType()) && span == std::floor(span) && range.lo == std::floor(range.lo);
    const auto of = [&](int wanted) {
        const int most = (1 << wanted) - 1;
        if (whole && span >= 1 && span <= most) return ShareCodes{wanted, static_cast<int>(span), true};
        return ShareCodes{wanted, most, volume.isConstant()}; // a constant volume has no intensity but 0
    };
    if (bits != 0) return of(bits);
    const ShareCodes narrow = of(8);
    return narrow.exact ? narrow : of(16);
}

std::vector<unsigned char> voxelPlanes(const Volume& volume, const ShareCodes& codes, const JobControl& job) {
    const bool hasInvalid = volume.invalidCount() > 0;
    const auto layers = static_cast<std::size_t>(volume.dims().z);
    std::vector<unsigned char> planes(volume.size() * planeCount(codes, hasInvalid));
    parallelFor(layers, [&](std::size_t k) {
        job.throwIfStopped();
        packLayer(volume, codes, hasInvalid, static_cast<int>(k), k, layers, planes.data());
    });
    return planes;
}

std::vector<unsigned char> deflated(std::span<const unsigned char> bytes, const JobControl& job) {
    z_stream stream{};
    PELLUCID_CHECK(deflateInit(&stream, Z_DEFAULT_COMPRESSION) == Z_OK);
    struct End {
        z_stream& stream;
        ~End() { deflateEnd(&stream); }
    } const end{stream};
    std::vector<unsigned char> packed;
    std::vector<unsigned char> piece(std::size_t{1} << 18);
    constexpr std::size_t kAtOnce = std::size_t{1} << 20;
    for (std::size_t at = 0;; at += kAtOnce) {
        job.throwIfStopped();
        const std::size_t count = std::min(kAtOnce, bytes.size() - std::min(at, bytes.size()));
        const bool last = at + kAtOnce >= bytes.size();
        stream.next_in = const_cast<unsigned char*>(bytes.data() + (count > 0 ? at : 0)); // zlib only reads it
        stream.avail_in = static_cast<uInt>(count);
        do {
            stream.next_out = piece.data();
            stream.avail_out = static_cast<uInt>(piece.size());
            deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);
            packed.insert(packed.end(), piece.data(), stream.next_out);
        } while (stream.avail_out == 0);
        if (last) return packed;
        job.report(static_cast<double>(at + count) / static_cast<double>(bytes.size()));
    }
}

double packedBytesPerVoxel(const Volume& volume, const ShareCodes& codes) {
    constexpr int kLayers = 8;
    constexpr std::size_t kMostVoxels = std::size_t{1} << 22; // an estimate is waited for
    const Int3& n = volume.dims();
    const auto affordable = static_cast<int>(kMostVoxels / layerSize(n));
    const int count = std::clamp(affordable, 1, std::min(kLayers, n.z));
    const bool hasInvalid = volume.invalidCount() > 0;
    const std::size_t layer = static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y);
    std::vector<unsigned char> planes(layer * static_cast<std::size_t>(count) * planeCount(codes, hasInvalid));
    for (int i = 0; i < count; ++i)
        packLayer(volume, codes, hasInvalid, static_cast<int>((i + 0.5) * n.z / count), static_cast<std::size_t>(i),
                  static_cast<std::size_t>(count), planes.data());
    return static_cast<double>(deflated(planes).size()) / static_cast<double>(layer * static_cast<std::size_t>(count));
}

} // namespace pellucid
