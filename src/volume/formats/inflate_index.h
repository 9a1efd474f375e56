// Places in a deflate stream from which it can be read on, so that its parts can be read in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "volume/formats/byte_source.h"

namespace pellucid {

/// Of one stream. Whether it is sound is known once the checksum of each of its members has been compared, which is
/// done once, up to the end of the member that is asked for: the whole stream, where it is one member, as it mostly is.
/// After that any byte can be reached from one of at most 64 places (40 kB each): reading a step of a series costs that
/// step and at most 1/32 of the stream. Any thread may call anything; unpacking for the first time is done by one at a
/// time.
class InflateIndex {
public:
    /// Of the stream that begins at byte `start` of a file: the same as before, as long as size and time of the file
    /// are the same. Those of the latest 16 files are kept.
    static std::shared_ptr<InflateIndex> of(const std::string& path, std::uint64_t start, bool zlib);

    InflateIndex(std::string path, std::uint64_t start, bool zlib);
    /// As requireInflates(). Throws FileError, Cancelled.
    void require(std::uint64_t wanted, const JobControl& job);
    /// The stream from its beginning; skip() goes by the places. It must not outlive this, nor `job`.
    std::unique_ptr<ByteSource> bytes(const JobControl& job) const;
    /// The last place at or before a byte of the unpacked stream.
    std::unique_ptr<InflatedBytes> from(std::uint64_t decoded, const JobControl& job) const;

private:
    void keep(const InflatedBytes& bytes); // m_mutex is held

    const std::string m_path;
    const std::uint64_t m_start;
    const bool m_zlib;
    mutable std::mutex m_mutex;
    std::vector<InflatedBytes::Place> m_places; // ascending
    std::uint64_t m_sound = 0;                  // bytes, from the first one on
    std::uint64_t m_between;                    // bytes from place to place
};

} // namespace pellucid
