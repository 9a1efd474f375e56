// The bytes that a DDS stream unpacks to ("differential data stream" of the program V^3), in which .pvm files are
// packed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "volume/formats/byte_source.h"

namespace pellucid {

/// How a file begins that is packed, and where the stream in it starts.
bool isDds(std::string_view head);
inline constexpr std::uint64_t kDdsStart = 8;

/// A byte of a stream stands for so many unpacked ones at most: a run of 127 equal differences takes 10 bits.
inline constexpr std::uint64_t kMostDds = 127 * 8 / 10 + 1;

/// The bytes in the order of the stream: the bytes of interleaved data plane by plane.
class DdsStream {
public:
    DdsStream(const std::string& path, const JobControl& job);
    /// The next `count` bytes, fewer at the end.
    std::size_t read(char* to, std::size_t count);
    /// Whether the stream has come to its end; else it was cut off within a run.
    bool hasEnded() const { return m_hasEnded; }
    /// Bytes of a voxel: data of more than one are stored in planes.
    std::uint64_t planes() const { return m_planes; }

private:
    unsigned char refill();
    /// Up to 16 bits, the highest first; zeros behind the end.
    unsigned bits(int count);
    bool beginRun();

    FileBytes m_file;
    std::vector<unsigned char> m_packed;
    std::size_t m_packedAt = 0;
    bool m_isAtEnd = false;     // of the file
    std::uint32_t m_buffer = 0; // bits that were read, the next one highest of m_buffered
    int m_buffered = 0;
    std::uint64_t m_planes = 1, m_strip = 1;
    unsigned m_left = 0;               // bytes of the run
    int m_width = 0;                   // bits of each
    std::vector<unsigned char> m_past; // the last m_strip + 1 bytes, in a ring
    std::uint64_t m_count = 0;
    unsigned char m_last = 0;
    bool m_hasEnded = false;
};

/// Length of the whole, by going through it once. Throws FileError where the stream does not end. `job` may stop it.
std::uint64_t ddsLength(const std::string& path, const JobControl& job);

/// The unpacked bytes in their own order. Keeps a few hundred KB, however long they are: each plane is read by a
/// stream of its own.
class DdsBytes final : public ByteSource {
public:
    /// `length`: ddsLength(). `job` must outlive them.
    DdsBytes(const std::string& path, std::uint64_t length, const JobControl& job);
    std::size_t read(char* to, std::size_t count) override;

private:
    bool beginBlock();
    bool fill();

    std::uint64_t m_length, m_planeCount, m_block;
    struct Plane {
        std::unique_ptr<DdsStream> stream;
        std::uint64_t at = 0;   // bytes of the stream that have been read
        std::uint64_t left = 0; // of the plane in this block
    };
    std::vector<Plane> m_planes;
    std::uint64_t m_blockStart = 0, m_blockLeft = 0; // bytes
    std::string m_ready;
    std::size_t m_readyAt = 0;
};

} // namespace pellucid
