// Bytes packed as other programs pack them, by the libraries of the formats.
#pragma once

#include <cstdint>
#include <string>

#include <bzlib.h>
#include <lz4.h>
#include <lzma.h>

namespace pellucid::test {

/// `bytes` as one bzip2 stream, in blocks of 100 000 · `level`.
inline std::string bzipped(std::string bytes, int level = 9) {
    auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 100 + 600);
    std::string packed(size, '\0');
    BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), level, 0, 0);
    packed.resize(size);
    return packed;
}

/// `bytes` as one LZ4 block.
inline std::string lz4Packed(const std::string& bytes) {
    std::string packed(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))), '\0');
    const int size = LZ4_compress_default(bytes.data(), packed.data(), static_cast<int>(bytes.size()),
                                          static_cast<int>(packed.size()));
    packed.resize(static_cast<std::size_t>(size));
    return packed;
}

/// `bytes` as one .xz stream.
inline std::string lzmaPacked(const std::string& bytes) {
    std::string packed(lzma_stream_buffer_bound(bytes.size()), '\0');
    std::size_t size = 0;
    lzma_easy_buffer_encode(6, LZMA_CHECK_CRC32, nullptr, reinterpret_cast<const std::uint8_t*>(bytes.data()),
                            bytes.size(), reinterpret_cast<std::uint8_t*>(packed.data()), &size, packed.size());
    packed.resize(size);
    return packed;
}

} // namespace pellucid::test
