// Places in a deflate stream where reading can resume, so that its parts can be read in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "volume/formats/byte_source.h"

namespace pellucid {

/// The index of one stream. The stream is unpacked once, up to the end of the member that holds the wanted bytes, to
/// compare checksums. Then any byte can be reached from one of at most 64 places (40 kB each): reading a step of a
/// series costs that step and at most 1/32 of the stream. Thread-safe; one thread at a time unpacks.
class InflateIndex {
public:
    /// The index of the stream at byte `start` of a file; the same one as long as the file keeps its size and time. The
    /// latest 16 are kept.
    static std::shared_ptr<InflateIndex> of(const std::string& path, std::uint64_t start, bool zlib);

    InflateIndex(std::string path, std::uint64_t start, bool zlib);
    /// As requireSound(). Throws FileError, Cancelled.
    void require(std::uint64_t wanted, const JobControl& job);
    /// All of the stream, which only zeros may follow in the file: how many bytes it unpacks to. Throws FileError,
    /// Cancelled.
    std::uint64_t requireWhole(const JobControl& job);
    /// The stream from its beginning; skip() goes by the places. It must not outlive this, nor `job`.
    std::unique_ptr<ByteSource> bytes(const JobControl& job) const;
    /// The last place at or before a byte of the unpacked stream.
    std::unique_ptr<InflatedBytes> from(std::uint64_t decoded, const JobControl& job) const;

private:
    // m_mutex is held:
    void keep(const InflatedBytes& bytes);
    std::unique_ptr<InflatedBytes> unpackUpTo(std::uint64_t wanted, const JobControl& job);

    const std::string m_path;
    const std::uint64_t m_start;
    const bool m_zlib;
    mutable std::mutex m_mutex;
    std::vector<InflatedBytes::Place> m_places; // ascending
    std::uint64_t m_sound = 0;                  // bytes, from the first one on
    std::optional<std::uint64_t> m_whole;       // bytes of all, where they are sound
    std::uint64_t m_between;                    // bytes from place to place
};

} // namespace pellucid
