#include "foreign/zarr/zarr_codecs.h"

#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <memory>

#include <blosc.h>
#include <bzlib.h>
#include <lz4.h>
#include <zlib.h>
#include <zstd.h>

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path) {
    throw FileError(what, path, "copy the data again");
}
[[noreturn]] void failDamaged(const std::string& path) { fail("this chunk is damaged: it cannot be unpacked", path); }

/// What chunks of a file are grown by while they are unpacked: a few bytes must not claim much memory.
constexpr std::size_t kStep = 1u << 20;

/// Grows `to` by a step, of at most `most` bytes. False where it has them already.
bool grow(std::vector<char>& to, std::size_t used, std::size_t most) {
    if (used < to.size()) return true;
    if (to.size() >= most) return false;
    to.resize(std::min(most, std::max(kStep, 2 * to.size())));
    return true;
}

/// Of gzip, with one member or several, or of zlib.
std::vector<char> inflated(const std::vector<char>& packed, std::size_t bytes, const std::string& path) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 32) != Z_OK) fail("there is no memory to unpack this chunk", path);
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
    std::vector<char> out;
    std::size_t used = 0;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    for (;;) {
        char none = 0;
        const bool hasRoom = grow(out, used, bytes);
        stream.next_out = reinterpret_cast<Bytef*>(hasRoom ? out.data() + used : &none);
        const std::size_t room = hasRoom ? out.size() - used : 1;
        stream.avail_out = static_cast<uInt>(std::min<std::size_t>(room, std::numeric_limits<uInt>::max()));
        const uInt before = stream.avail_out;
        const int state = inflate(&stream, Z_NO_FLUSH);
        const std::size_t came = before - stream.avail_out;
        if (!hasRoom && came > 0) fail("this chunk unpacks to more than the array has", path);
        used += came;
        if (state == Z_STREAM_END) {
            if (stream.avail_in == 0) break;
            if (inflateReset(&stream) != Z_OK) failDamaged(path);
        } else if (state != Z_OK || (came == 0 && stream.avail_in == 0)) {
            failDamaged(path);
        }
    }
    out.resize(used);
    return out;
}

std::vector<char> unpackedZstd(const std::vector<char>& packed, std::size_t bytes, const std::string& path) {
    const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
    if (!stream) fail("there is no memory to unpack this chunk", path);
    std::vector<char> out;
    std::size_t used = 0, state = 1;
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    while (state != 0 || in.pos < in.size) {
        char none = 0;
        const bool hasRoom = grow(out, used, bytes);
        ZSTD_outBuffer to{hasRoom ? out.data() + used : &none, hasRoom ? out.size() - used : 1, 0};
        const std::size_t before = in.pos;
        state = ZSTD_decompressStream(stream.get(), &to, &in);
        if (ZSTD_isError(state) != 0) failDamaged(path);
        if (!hasRoom && to.pos > 0) fail("this chunk unpacks to more than the array has", path);
        used += to.pos;
        if (to.pos == 0 && in.pos == before && state != 0) failDamaged(path); // cut off
    }
    out.resize(used);
    return out;
}

std::vector<char> unpackedBlosc(const std::vector<char>& packed, std::size_t bytes, const std::string& path) {
    std::size_t size = 0;
    if (packed.size() < BLOSC_MIN_HEADER_LENGTH || blosc_cbuffer_validate(packed.data(), packed.size(), &size) != 0)
        failDamaged(path);
    if (size > bytes) fail("this chunk unpacks to more than the array has", path);
    std::vector<char> out(size);
    if (size > 0 && blosc_decompress_ctx(packed.data(), out.data(), size, 1) != static_cast<int>(size))
        failDamaged(path);
    return out;
}

/// The number of bytes that it unpacks to stands before it (numcodecs).
std::vector<char> unpackedLz4(const std::vector<char>& packed, std::size_t bytes, const std::string& path) {
    if (packed.size() < 4) failDamaged(path);
    std::uint32_t size = 0;
    for (std::size_t i = 4; i > 0; --i) size = size << 8 | static_cast<unsigned char>(packed[i - 1]);
    if (size > bytes) fail("this chunk unpacks to more than the array has", path);
    std::vector<char> out(size);
    const int came =
        LZ4_decompress_safe(packed.data() + 4, out.data(), static_cast<int>(packed.size() - 4), static_cast<int>(size));
    if (came != static_cast<int>(size)) failDamaged(path);
    return out;
}

std::vector<char> unpackedBz2(const std::vector<char>& packed, std::size_t bytes, const std::string& path) {
    std::vector<char> out(bytes);
    auto size = static_cast<unsigned>(bytes);
    const int state = BZ2_bzBuffToBuffDecompress(out.data(), &size, const_cast<char*>(packed.data()),
                                                 static_cast<unsigned>(packed.size()), 0, 0);
    if (state == BZ_OUTBUFF_FULL) fail("this chunk unpacks to more than the array has", path);
    if (state != BZ_OK) failDamaged(path);
    out.resize(size);
    return out;
}

/// CRC-32C (Castagnoli), by the reversed polynomial.
std::uint32_t crc32cOf(const char* bytes, std::size_t count) {
    static const std::array<std::uint32_t, 256> kTable = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t n = 0; n < 256; ++n) {
            std::uint32_t value = n;
            for (int bit = 0; bit < 8; ++bit) value = (value & 1u) != 0 ? value >> 1 ^ 0x82f63b78u : value >> 1;
            table[n] = value;
        }
        return table;
    }();
    std::uint32_t sum = ~0u;
    for (std::size_t i = 0; i < count; ++i)
        sum = kTable[(sum ^ static_cast<unsigned char>(bytes[i])) & 255u] ^ sum >> 8;
    return ~sum;
}

/// The sum stands behind.
std::vector<char> checkedCrc32c(const std::vector<char>& packed, const std::string& path) {
    if (packed.size() < 4) failDamaged(path);
    const std::size_t count = packed.size() - 4;
    std::uint32_t stored = 0;
    for (std::size_t i = 4; i > 0; --i) stored = stored << 8 | static_cast<unsigned char>(packed[count + i - 1]);
    if (crc32cOf(packed.data(), count) != stored) fail("this chunk is damaged: its checksum is wrong", path);
    return {packed.begin(), packed.end() - 4};
}

} // namespace

ZarrCodec zarrCodecNamed(const std::string& name, const JsonValue& at) {
    static const std::map<std::string, ZarrCodec> kNames{
        {"gzip", ZarrCodec::Gzip},           {"zlib", ZarrCodec::Zlib},
        {"zstd", ZarrCodec::Zstd},           {"blosc", ZarrCodec::Blosc},
        {"numcodecs.zlib", ZarrCodec::Zlib}, {"lz4", ZarrCodec::Lz4},
        {"numcodecs.lz4", ZarrCodec::Lz4},   {"bz2", ZarrCodec::Bz2},
        {"numcodecs.bz2", ZarrCodec::Bz2},   {"crc32c", ZarrCodec::Crc32c}};
    if (const auto found = kNames.find(name); found != kNames.end()) return found->second;
    at.fail("chunks packed by " + inQuotes(name) + " cannot be unpacked",
            "write the array again, packed by gzip, zstd or blosc");
}

std::vector<char> unpacked(ZarrCodec codec, const std::vector<char>& packed, std::size_t bytes,
                           const std::string& path) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max(); // that these libraries can count
    if (packed.size() > kMost || bytes > kMost) fail("this chunk is too large", path);
    switch (codec) {
    case ZarrCodec::Gzip:
    case ZarrCodec::Zlib:
        return inflated(packed, bytes, path);
    case ZarrCodec::Zstd:
        return unpackedZstd(packed, bytes, path);
    case ZarrCodec::Blosc:
        return unpackedBlosc(packed, bytes, path);
    case ZarrCodec::Lz4:
        return unpackedLz4(packed, bytes, path);
    case ZarrCodec::Bz2:
        return unpackedBz2(packed, bytes, path);
    case ZarrCodec::Crc32c:
        break;
    }
    return checkedCrc32c(packed, path);
}

} // namespace pellucid
