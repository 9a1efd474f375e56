#include "volume/formats/dds_bytes.h"

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

constexpr std::size_t kPiece = 1u << 16;
constexpr std::string_view kWhole = "DDS v3d\n", kInBlocks = "DDS v3e\n"; // how planes are laid out
constexpr std::uint64_t kBlock = 1u << 24;                                // bytes of each plane in a block

bool isInBlocks(const std::string& path) { return fileHead(path, kDdsStart) == kInBlocks; }

} // namespace

bool isDds(std::string_view head) { return head.starts_with(kWhole) || head.starts_with(kInBlocks); }

// A stream: 2 bits, planes − 1; 16 bits, strip − 1; then runs: 7 bits, how many bytes (0: the end); 3 bits, how wide
// their differences are (n > 0: n + 1 bits); the differences, each plus half of its range. A difference is to the byte
// before; behind the first strip, to the byte before plus what it changed by one strip earlier.

DdsStream::DdsStream(const std::string& path, const JobControl& job) : m_file(path, kDdsStart, job), m_packed(kPiece) {
    m_packedAt = m_packed.size();
    m_planes = bits(2) + 1;
    m_strip = bits(16) + 1;
    m_past.resize(static_cast<std::size_t>(m_strip) + 1);
}

unsigned char DdsStream::refill() {
    if (m_packedAt == m_packed.size()) {
        m_packed.resize(kPiece);
        m_packed.resize(m_file.read(reinterpret_cast<char*>(m_packed.data()), m_packed.size()));
        m_packedAt = 0;
        m_isAtEnd = m_packed.empty();
        if (m_isAtEnd) return 0;
    }
    return m_packed[m_packedAt++];
}

unsigned DdsStream::bits(int count) {
    while (m_buffered < count) {
        m_buffer = m_buffer << 8 | refill();
        m_buffered += 8;
    }
    m_buffered -= count;
    return m_buffer >> m_buffered & ((1u << count) - 1);
}

bool DdsStream::beginRun() {
    m_left = bits(7);
    if (m_left == 0 || m_isAtEnd) {
        m_hasEnded = m_left == 0; // some writers leave the zeros of the mark out
        m_left = 0;
        return false;
    }
    const int code = static_cast<int>(bits(3));
    m_width = code == 0 ? 0 : code + 1;
    return true;
}

std::size_t DdsStream::read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count && !m_hasEnded && !m_isAtEnd) {
        if (m_left == 0 && !beginRun()) break;
        const auto at = static_cast<std::size_t>(m_count % m_past.size());
        unsigned value = m_last + bits(m_width) - ((1u << m_width) >> 1);
        if (m_isAtEnd) break;
        // One strip back is the next place of the ring but one; a strip of 1 means none.
        if (m_strip > 1 && m_count > m_strip)
            value += static_cast<unsigned>(m_past[(at + 1) % m_past.size()]) - m_past[at];
        m_last = static_cast<unsigned char>(value);
        m_past[at] = m_last;
        ++m_count;
        --m_left;
        to[done++] = static_cast<char>(m_last);
    }
    return done;
}

std::uint64_t ddsLength(const std::string& path, const JobControl& job) {
    DdsStream stream(path, job);
    std::vector<char> piece(kPiece);
    std::uint64_t length = 0;
    while (const std::size_t read = stream.read(piece.data(), piece.size())) length += read;
    if (!stream.hasEnded())
        throw FileError("the compressed data ends after " + std::to_string(length) + " bytes, within a run of them",
                        path, "copy the file again");
    return length;
}

DdsBytes::DdsBytes(const std::string& path, std::uint64_t length, const JobControl& job) : m_length(length) {
    m_planes.push_back({std::make_unique<DdsStream>(path, job), 0, 0});
    m_planeCount = m_planes[0].stream->planes();
    m_block = isInBlocks(path) && m_planeCount > 1 ? kBlock * m_planeCount : length;
    while (m_planes.size() < m_planeCount) m_planes.push_back({std::make_unique<DdsStream>(path, job), 0, 0});
}

/// Brings each plane's stream to where the plane begins in the next block; false where there is none.
bool DdsBytes::beginBlock() {
    if (m_blockStart >= m_length) return false;
    m_blockLeft = std::min(m_block, m_length - m_blockStart);
    std::uint64_t begin = m_blockStart;
    std::vector<char> dropped(kPiece);
    for (std::uint64_t n = 0; n < m_planeCount; ++n) {
        Plane& plane = m_planes[static_cast<std::size_t>(n)];
        plane.left = (m_blockLeft + m_planeCount - 1 - n) / m_planeCount;
        while (plane.at < begin) {
            const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(dropped.size(), begin - plane.at));
            const std::size_t read = plane.stream->read(dropped.data(), piece);
            if (read == 0) return false;
            plane.at += read;
        }
        begin += plane.left;
    }
    m_blockStart += m_blockLeft;
    return true;
}

/// Some bytes more in m_ready: as many of each plane, but at the end of a block.
bool DdsBytes::fill() {
    if (m_blockLeft == 0 && !beginBlock()) return false;
    const std::uint64_t bytes = std::min<std::uint64_t>(m_blockLeft, kPiece * m_planeCount);
    m_ready.resize(static_cast<std::size_t>(bytes));
    m_readyAt = 0;
    std::vector<char> values(kPiece);
    for (std::size_t n = 0; n < m_planes.size(); ++n) {
        Plane& plane = m_planes[n];
        const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(plane.left, kPiece));
        if (plane.stream->read(values.data(), wanted) < wanted) return false;
        plane.at += wanted;
        plane.left -= wanted;
        for (std::size_t i = 0, to = n; to < m_ready.size(); ++i, to += m_planes.size()) m_ready[to] = values[i];
    }
    m_blockLeft -= bytes;
    return true;
}

std::size_t DdsBytes::read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
        if (m_readyAt == m_ready.size() && !fill()) break;
        const std::size_t piece = std::min(count - done, m_ready.size() - m_readyAt);
        std::copy_n(m_ready.data() + m_readyAt, piece, to + done);
        m_readyAt += piece;
        done += piece;
    }
    return done;
}

} // namespace pellucid
