#include "volume/formats/block_codec.h"

#include <algorithm>
#include <new>
#include <vector>

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

namespace pellucid {

namespace {

/// A zlib stream, which ends with a checksum.
class ZlibCodec final : public BlockCodec {
public:
    ZlibCodec() {
        if (inflateInit(&m_stream) != Z_OK) throw std::bad_alloc(); // it fails for nothing else
    }
    ~ZlibCodec() override { inflateEnd(&m_stream); }
    ZlibCodec(const ZlibCodec&) = delete;
    ZlibCodec& operator=(const ZlibCodec&) = delete;

    bool begin(const PackedBlock&) override { return inflateReset(&m_stream) == Z_OK; }
    State decode(Input& in, Output& out) override {
        constexpr std::size_t kMost = std::size_t{1} << 30;
        const std::size_t input = std::min(in.left, kMost), output = std::min(out.left, kMost);
        m_stream.next_in = const_cast<Bytef*>(in.next); // zlib leaves it alone
        m_stream.avail_in = static_cast<uInt>(input);
        m_stream.next_out = out.next;
        m_stream.avail_out = static_cast<uInt>(output);
        const int status = inflate(&m_stream, Z_NO_FLUSH);
        if (status == Z_MEM_ERROR) throw std::bad_alloc(); // its window is made when it is needed
        in = {m_stream.next_in, in.left - (input - m_stream.avail_in)};
        out = {m_stream.next_out, out.left - (output - m_stream.avail_out)};
        if (status == Z_STREAM_END) return State::Ended;
        return status == Z_OK || status == Z_BUF_ERROR ? State::More : State::Damaged;
    }

private:
    z_stream m_stream{};
};

/// An LZ4 block, without a frame and without a checksum.
class Lz4Codec final : public BlockCodec {
public:
    bool begin(const PackedBlock& block) override {
        m_block = block;
        m_packed.clear();
        m_unpacked.clear();
        m_at = 0;
        // The caller holds the sizes against the file; what is packed is never much longer than what it unpacks to.
        return block.unpacked <= kMostLz4Block && block.packed <= kMostLz4Block + kMostLz4Block / 128;
    }
    State decode(Input& in, Output& out) override {
        const auto taken = static_cast<std::size_t>(std::min<std::uint64_t>(in.left, m_block.packed - m_packed.size()));
        m_packed.insert(m_packed.end(), in.next, in.next + taken);
        in = {in.next + taken, in.left - taken};
        if (m_packed.size() < m_block.packed) return State::More;
        if (m_unpacked.empty() && m_block.unpacked > 0 && !unpack()) return State::Damaged;
        const std::size_t given = std::min(out.left, m_unpacked.size() - m_at);
        std::copy_n(m_unpacked.begin() + static_cast<std::ptrdiff_t>(m_at), given, out.next);
        out = {out.next + given, out.left - given};
        m_at += given;
        return m_at == m_unpacked.size() ? State::Ended : State::More;
    }

private:
    bool unpack() {
        m_unpacked.resize(static_cast<std::size_t>(m_block.unpacked));
        const int bytes = LZ4_decompress_safe(reinterpret_cast<const char*>(m_packed.data()),
                                              reinterpret_cast<char*>(m_unpacked.data()),
                                              static_cast<int>(m_packed.size()), static_cast<int>(m_unpacked.size()));
        return bytes >= 0 && static_cast<std::uint64_t>(bytes) == m_block.unpacked;
    }

    PackedBlock m_block{0, 0};
    std::vector<unsigned char> m_packed, m_unpacked;
    std::size_t m_at = 0; // of m_unpacked, the next byte
};

/// An .xz stream, which ends with a checksum.
class LzmaCodec final : public BlockCodec {
public:
    LzmaCodec() = default;
    ~LzmaCodec() override { lzma_end(&m_stream); }
    LzmaCodec(const LzmaCodec&) = delete;
    LzmaCodec& operator=(const LzmaCodec&) = delete;

    bool begin(const PackedBlock&) override {
        constexpr std::uint64_t kMostMemory = 256u << 20; // its highest level needs a quarter
        const lzma_ret status = lzma_stream_decoder(&m_stream, kMostMemory, 0);
        if (status == LZMA_MEM_ERROR) throw std::bad_alloc();
        return status == LZMA_OK;
    }
    State decode(Input& in, Output& out) override {
        m_stream.next_in = in.next;
        m_stream.avail_in = in.left;
        m_stream.next_out = out.next;
        m_stream.avail_out = out.left;
        const lzma_ret status = lzma_code(&m_stream, LZMA_RUN);
        if (status == LZMA_MEM_ERROR) throw std::bad_alloc();
        in = {m_stream.next_in, m_stream.avail_in};
        out = {m_stream.next_out, m_stream.avail_out};
        if (status == LZMA_STREAM_END) return State::Ended;
        return status == LZMA_OK || status == LZMA_BUF_ERROR ? State::More : State::Damaged;
    }

private:
    lzma_stream m_stream = LZMA_STREAM_INIT;
};

} // namespace

std::unique_ptr<BlockCodec> BlockCodec::of(VtkPacking packing) {
    if (packing == VtkPacking::Lz4) return std::make_unique<Lz4Codec>();
    if (packing == VtkPacking::Lzma) return std::make_unique<LzmaCodec>();
    return std::make_unique<ZlibCodec>();
}

std::uint64_t BlockCodec::mostPerByte(VtkPacking packing) {
    // Deflate: a match of 258 bytes takes two bits. LZ4: each byte of a length stands for 255. LZMA: a match of 273
    // bytes takes a third of a bit, where all bits that tell of it are as probable as they can be.
    constexpr std::uint64_t kMostDeflate = 1040, kMostLz4 = 256, kMostLzma = 10'000;
    return packing == VtkPacking::Lz4 ? kMostLz4 : packing == VtkPacking::Lzma ? kMostLzma : kMostDeflate;
}

} // namespace pellucid
