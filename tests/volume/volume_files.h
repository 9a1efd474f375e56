// Small files in each format, written by the tests themselves, byte by byte.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <zlib.h>

namespace pellucid::test {

/// The bytes of `values` in memory order.
template <class T>
std::string bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// `bytes` as one gzip stream.
inline std::string gzipped(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, bytes.size()), '\0');
    std::string input = bytes;
    stream.next_in = reinterpret_cast<Bytef*>(input.data());
    stream.avail_in = static_cast<uInt>(input.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

/// `bytes` as one zlib stream, as MetaImage has it.
inline std::string zlibbed(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    packed.resize(size);
    return packed;
}

/// A NIfTI-1 header of 352 bytes in the byte order of this machine.
struct Nifti {
    std::array<std::int16_t, 8> dim{3, 2, 3, 4, 1, 1, 1, 1};
    std::int16_t datatype = 2, bitpix = 8; ///< u8
    std::array<float, 8> pixdim{1, 1, 2, 3, 1, 1, 1, 1};
    float voxOffset = 352, slope = 0, intercept = 0;
    std::int32_t size = 348;
    std::string magic = "n+1";
    std::int16_t intent = 0, qformCode = 0, sformCode = 0;
    char units = 0;
    std::array<float, 6> qform{};  ///< quaternion b, c, d, then offsets
    std::array<float, 12> sform{}; ///< row by row

    /// The same as a NIfTI-2 header of 544 bytes; its numbers are those of the other, only wider.
    std::string header2(std::int64_t dataStart = 544, const std::string& mark = "n+2") const {
        std::string bytes(544, '\0');
        const auto put = [&](std::size_t offset, const auto& value) {
            std::memcpy(bytes.data() + offset, &value, sizeof value);
        };
        const auto putAll = [&](std::size_t offset, const auto& values, auto as) {
            for (std::size_t i = 0; i < values.size(); ++i)
                put(offset + i * sizeof as, static_cast<decltype(as)>(values[i]));
        };
        put(0, std::int32_t{540});
        std::memcpy(bytes.data() + 4, (mark + std::string("\0\r\n\032\n", 5)).data(), 8);
        put(12, datatype);
        put(14, bitpix);
        putAll(16, dim, std::int64_t{});
        putAll(104, pixdim, double{});
        put(168, dataStart);
        put(176, static_cast<double>(slope));
        put(184, static_cast<double>(intercept));
        put(344, static_cast<std::int32_t>(qformCode));
        put(348, static_cast<std::int32_t>(sformCode));
        putAll(352, qform, double{});
        putAll(400, sform, double{});
        put(500, static_cast<std::int32_t>(units));
        put(504, static_cast<std::int32_t>(intent));
        return bytes;
    }

    std::string header() const {
        std::string bytes(352, '\0');
        const auto put = [&](std::size_t offset, const void* data, std::size_t count) {
            std::memcpy(bytes.data() + offset, data, count);
        };
        put(0, &size, 4);
        put(40, dim.data(), 16);
        put(70, &datatype, 2);
        put(72, &bitpix, 2);
        put(76, pixdim.data(), 32);
        put(108, &voxOffset, 4);
        put(112, &slope, 4);
        put(116, &intercept, 4);
        put(68, &intent, 2);
        put(123, &units, 1);
        put(252, &qformCode, 2);
        put(254, &sformCode, 2);
        put(256, qform.data(), 24);
        put(280, sform.data(), 48);
        put(344, magic.data(), magic.size());
        return bytes;
    }
};

} // namespace pellucid::test
