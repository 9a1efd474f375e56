#include "volume/formats/vtk_bytes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/base64.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

constexpr std::size_t kPiece = 1u << 18;

/// What the header says.
struct Header {
    std::uint64_t bytes = 0;         ///< of the data, unpacked
    std::vector<PackedBlock> blocks; ///< of packed data
};

/// Reads it from `from`, whose next byte is then the first of the data. `stored`: bytes of the file from there on.
Header readHeader(ByteSource& from, const VtkData& data, std::uint64_t stored) {
    const auto fail = [&](const std::string& what) {
        return FileError(what, data.path, "copy or write the file again");
    };
    const auto number = [&] {
        std::array<unsigned char, 8> bytes{};
        const auto count = static_cast<std::size_t>(data.headerBytes);
        if (from.read(reinterpret_cast<char*>(bytes.data()), count) < count)
            throw fail("the data of the array end within their header");
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[data.bigEndian ? i : count - 1 - i];
        return value;
    };
    Header header;
    if (data.packing == VtkPacking::None) {
        header.bytes = number();
        return header;
    }
    constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
    const std::uint64_t count = number(), size = number(), last = number();
    // Each block but the last has a size, and all together are no more than is wanted: no table is longer than that.
    if (count > stored / static_cast<std::uint64_t>(data.headerBytes) || (count > 0 && size > kMost / count) ||
        last > size || (count > 1 && (size == 0 || count - 1 > data.bytes / size)))
        throw fail("the header of the compressed array makes no sense");
    std::uint64_t packed = 0;
    header.blocks.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) {
        header.blocks.push_back({number(), i + 1 == count && last > 0 ? last : size});
        if (header.blocks.back().packed > stored || (packed += header.blocks.back().packed) > stored)
            throw fail("the compressed blocks of the array are longer than the file");
        header.bytes += header.blocks.back().unpacked;
    }
    return header;
}

std::unique_ptr<ByteSource> encodedBytes(const VtkData& data, const JobControl& job) {
    if (data.base64) return std::make_unique<Base64Bytes>(data.path, data.start, job);
    return std::make_unique<FileBytes>(data.path, data.start, job);
}

std::uint64_t storedFrom(const VtkData& data) {
    const std::uint64_t file = readableFileBytes(data.path);
    return file - std::min(file, data.start);
}

} // namespace

bool Base64Bytes::decodeFour() {
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
        const int c = m_digits.peek();
        if (const int digit = base64Digit(c); digit >= 0 && padding == 0) {
            bits = bits << 6 | static_cast<std::uint32_t>(digit);
            ++digits;
        } else if (c == '=' && digits >= 2) {
            bits <<= 6;
            ++padding;
        } else if (std::isspace(c) == 0) {
            return false; // at the end, too
        }
        m_digits.pass();
    }
    for (int i = 0; i < 3 - padding; ++i) m_ready += static_cast<char>(bits >> (16 - 8 * i) & 0xff);
    return true;
}

std::size_t Base64Bytes::read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
        if (m_readyAt == m_ready.size()) {
            m_ready.clear();
            m_readyAt = 0;
            while (m_ready.size() < 4096 && decodeFour()) continue;
            if (m_ready.empty()) break;
        }
        const std::size_t piece = std::min(count - done, m_ready.size() - m_readyAt);
        std::copy_n(m_ready.data() + m_readyAt, piece, to + done);
        m_readyAt += piece;
        done += piece;
    }
    return done;
}

PackedBlocks::PackedBlocks(std::unique_ptr<ByteSource> from, VtkPacking packing, std::vector<PackedBlock> blocks)
    : m_from(std::move(from)), m_codec(BlockCodec::of(packing)), m_blocks(std::move(blocks)), m_packed(kPiece) {
    m_failed = !m_blocks.empty() && !beginBlock();
}

/// More of the packed block; false where there is none.
bool PackedBlocks::fill() {
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(m_packedLeft, m_packed.size()));
    const std::size_t read = m_from->read(reinterpret_cast<char*>(m_packed.data()), piece);
    m_packedLeft -= read;
    m_in = {m_packed.data(), read};
    return read > 0;
}

/// False where there is none, or it is not to be unpacked.
bool PackedBlocks::beginBlock() {
    if (m_block == m_blocks.size()) return false;
    m_packedLeft = m_blocks[m_block].packed;
    m_unpackedLeft = m_blocks[m_block].unpacked;
    m_in = {};
    m_ended = false;
    return m_codec->begin(m_blocks[m_block]);
}

/// Goes on with the block, by more of the file where that is needed; false where it is damaged or there is no more.
bool PackedBlocks::step(BlockCodec::Output& out) {
    const std::size_t input = m_in.left, output = out.left;
    const BlockCodec::State state = m_codec->decode(m_in, out);
    m_ended = state == BlockCodec::State::Ended;
    if (state == BlockCodec::State::Damaged) return false;
    const bool hasMoved = m_in.left < input || out.left < output;
    return m_ended || hasMoved || (m_in.left == 0 && fill());
}

/// All of the block has come out: what is left of it is its checksum, which has to be right. Begins the next one.
bool PackedBlocks::endBlock() {
    while (!m_ended) {
        unsigned char more = 0;
        BlockCodec::Output out{&more, 1};
        if (!step(out) || out.left == 0) return false;
    }
    if (!m_from->skip(m_packedLeft)) return false;
    ++m_block;
    return beginBlock();
}

std::size_t PackedBlocks::read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count && !m_failed && m_block < m_blocks.size()) {
        if (m_unpackedLeft == 0) {
            m_failed = !endBlock();
            continue;
        }
        const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(count - done, m_unpackedLeft));
        BlockCodec::Output out{reinterpret_cast<unsigned char*>(to + done), piece};
        m_failed = m_ended || !step(out);
        done += piece - out.left;
        m_unpackedLeft -= piece - out.left;
    }
    // The last block's checksum is looked at with its last byte.
    if (!m_failed && m_unpackedLeft == 0 && m_block + 1 == m_blocks.size())
        m_failed = !endBlock() && m_block < m_blocks.size();
    // A block may turn out to be damaged when all that was asked for has come out of it.
    return m_failed && done == count && count > 0 ? count - 1 : done;
}

bool PackedBlocks::skip(std::uint64_t count) {
    while (count > 0 && !m_failed && m_block < m_blocks.size()) {
        const bool isAtBegin = m_unpackedLeft == m_blocks[m_block].unpacked;
        if (isAtBegin && count >= m_unpackedLeft) {
            count -= m_unpackedLeft;
            m_failed = !m_from->skip(m_packedLeft);
            if (++m_block < m_blocks.size()) m_failed = !beginBlock() || m_failed;
        } else if (m_unpackedLeft == 0) {
            m_failed = !endBlock();
        } else {
            const std::uint64_t piece = std::min(count, m_unpackedLeft);
            if (!ByteSource::skip(piece)) return false;
            count -= piece;
        }
    }
    return count == 0;
}

namespace {

void requireBlocks(const VtkData& data, const std::vector<PackedBlock>& blocks) {
    if (data.packing != VtkPacking::Lz4) return;
    for (const PackedBlock& block : blocks)
        if (block.unpacked > kMostLz4Block)
            throw FileError("a compressed block of the array has " + describeBytes(block.unpacked), data.path,
                            "write the file with blocks of " + describeBytes(kMostLz4Block) + " at most");
}

} // namespace

std::uint64_t requireVtkBytes(const VtkData& data, const JobControl& job) {
    const std::uint64_t bytes = data.bytes, stored = storedFrom(data);
    auto from = encodedBytes(data, job);
    const Header header = readHeader(*from, data, stored);
    if (header.bytes != bytes)
        throw FileError("the array has " + std::to_string(header.bytes) + " bytes, but its extent and type need " +
                            std::to_string(bytes),
                        data.path, kCheckArray);
    const bool isPacked = data.packing != VtkPacking::None;
    if (!data.base64 && !isPacked) {
        const auto before = static_cast<std::uint64_t>(data.headerBytes);
        requireStored(data.path, Encoding::Raw, bytes, 1, stored - before, kCheckArray);
        return data.start + before;
    }
    if (isPacked)
        requirePacked(data.path, bytes, stored, BlockCodec::mostPerByte(data.packing), kCheckArray);
    else
        requireStored(data.path, Encoding::Raw, bytes, 1, stored / 4 * 3 + 3, kCheckArray);
    requireBlocks(data, header.blocks);
    // Unpacked once without keeping it: nothing is allocated for what is not there.
    const auto unpacked = openVtkData(data, job);
    std::vector<char> piece(1u << 18);
    std::uint64_t yield = 0;
    while (yield < bytes) {
        const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), bytes - yield));
        const std::size_t read = unpacked->read(piece.data(), wanted);
        yield += read;
        if (read < wanted) break;
    }
    if (yield < bytes)
        throw FileError("the data of the array end or are damaged after " + std::to_string(yield) + " of " +
                            std::to_string(bytes) + " bytes",
                        data.path, "copy or write the file again");
    return data.start;
}

std::unique_ptr<ByteSource> openVtkData(const VtkData& data, const JobControl& job) {
    auto from = encodedBytes(data, job);
    Header header = readHeader(*from, data, storedFrom(data));
    if (data.packing == VtkPacking::None) return from;
    return std::make_unique<PackedBlocks>(std::move(from), data.packing, std::move(header.blocks));
}

} // namespace pellucid
