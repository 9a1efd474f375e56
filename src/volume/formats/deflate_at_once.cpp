#include "volume/formats/deflate_at_once.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <libdeflate.h>

#include "base/mapped_file.h"
#include "base/memory.h"
#include "volume/formats/samples.h"

namespace pellucid {

namespace {

/// Bytes that have been unpacked and found sound.
class SoundBytes final : public UnpackedBytes {
public:
    SoundBytes(std::unique_ptr<char[]> bytes, std::size_t count) : m_bytes(std::move(bytes)), m_count(count) {}
    std::size_t read(char* to, std::size_t count) override {
        const std::size_t piece = take(count);
        std::memcpy(to, m_bytes.get() + m_at - piece, piece);
        return piece;
    }
    bool skip(std::uint64_t count) override {
        return take(static_cast<std::size_t>(std::min<std::uint64_t>(count, m_count))) == count;
    }
    std::uint64_t decoded() const override { return m_at; }
    std::uint64_t soundBytes() const override { return m_count; }
    End end() const override { return m_end; }

private:
    std::size_t take(std::size_t count) {
        const std::size_t piece = std::min(count, m_count - m_at);
        if (piece < count) m_end = End::Whole;
        m_at += piece;
        return piece;
    }

    std::unique_ptr<char[]> m_bytes;
    std::size_t m_count, m_at = 0;
    End m_end = End::None;
};

/// The bytes of a file from `start` on; mapped where there are many of them.
class Packed {
public:
    Packed(const std::string& path, std::uint64_t start) {
        std::error_code ec;
        const std::uint64_t size = std::filesystem::file_size(path, ec);
        if (ec || size <= start) return;
        if (size - start >= kMapBytes) m_mapped = MappedFile::map(path, start, size - start);
        if (m_mapped) {
            m_bytes = {m_mapped->data(), m_mapped->size()};
            return;
        }
        std::ifstream in(path, std::ios::binary);
        in.seekg(static_cast<std::streamoff>(start));
        m_read.resize(static_cast<std::size_t>(size - start));
        in.read(reinterpret_cast<char*>(m_read.data()), static_cast<std::streamsize>(m_read.size()));
        m_bytes = {m_read.data(), static_cast<std::size_t>(in.gcount())};
    }
    std::span<const unsigned char> bytes() const { return m_bytes; }

private:
    std::shared_ptr<const MappedFile> m_mapped;
    std::vector<unsigned char> m_read;
    std::span<const unsigned char> m_bytes;
};

/// Goes past one member; the bytes that have come out, or empty where it is not sound or there is no room for it.
std::optional<std::size_t> unpackMember(libdeflate_decompressor* decompressor, bool zlib,
                                        std::span<const unsigned char>& packed, std::span<char> to) {
    constexpr std::array<unsigned char, 2> kGzip{0x1f, 0x8b};
    std::size_t taken = 0, made = 0;
    const bool isGzip = packed.size() >= kGzip.size() && std::equal(kGzip.begin(), kGzip.end(), packed.begin());
    if (!isGzip && !zlib) return {};
    const auto unpack = isGzip ? libdeflate_gzip_decompress_ex : libdeflate_zlib_decompress_ex;
    if (unpack(decompressor, packed.data(), packed.size(), to.data(), to.size(), &taken, &made) != LIBDEFLATE_SUCCESS)
        return {};
    packed = packed.subspan(taken);
    return made;
}

} // namespace

bool unpackAtOnce(const std::string& path, std::uint64_t start, bool zlib, bool toEnd, std::span<char> to,
                  const JobControl& job) {
    if (to.empty() || to.size() > kMostAtOnce) return false;
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (!decompressor) return false;
    const Packed file(path, start);
    std::span<const unsigned char> packed = file.bytes();
    for (std::size_t done = 0; done < to.size();) {
        job.throwIfStopped();
        const auto made = unpackMember(decompressor.get(), zlib && done == 0, packed, to.subspan(done));
        if (!made) return false;
        done += *made;
    }
    return !toEnd || std::ranges::all_of(packed, [](unsigned char byte) { return byte == 0; });
}

std::unique_ptr<UnpackedBytes> unpackedAtOnce(const std::string& path, std::uint64_t start, bool zlib,
                                              std::uint64_t bytes, bool toEnd, const JobControl& job) {
    if (bytes > kMostAtOnce || availableMemoryBytes() / 2 < bytes) return {};
    const auto count = static_cast<std::size_t>(bytes);
    auto unpacked = std::make_unique_for_overwrite<char[]>(count);
    if (!unpackAtOnce(path, start, zlib, toEnd, {unpacked.get(), count}, job)) return {};
    return std::make_unique<SoundBytes>(std::move(unpacked), count);
}

std::uint32_t lengthAtEnd(const std::string& path) {
    std::array<unsigned char, 4> bytes{};
    std::ifstream in(path, std::ios::binary);
    in.seekg(-static_cast<std::streamoff>(bytes.size()), std::ios::end);
    in.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    std::uint32_t length = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) length = length << 8 | bytes[i];
    return length;
}

} // namespace pellucid
