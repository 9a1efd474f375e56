// Deflate streams that are unpacked in one go, which takes about half as long as piece by piece.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "volume/formats/byte_source.h"

namespace pellucid {

/// Streams of more bytes than this are unpacked piece by piece, so that reading them can be watched and cancelled.
inline constexpr std::uint64_t kMostAtOnce = 512u << 20;

/// Writes the first to.size() bytes that the stream at byte `start` of a file unpacks to: gzip, also of several
/// members; with `zlib` it may be a zlib stream. All members that hold them are whole and have the right checksums and
/// lengths; with `toEnd` the last of them ends with the bytes, and only zeros follow it in the file. False where any of
/// this is not so (InflatedBytes tells what is wrong), and for none or more than kMostAtOnce. Throws Cancelled.
bool unpackAtOnce(const std::string& path, std::uint64_t start, bool zlib, bool toEnd, std::span<char> to,
                  const JobControl& job);

/// The same `bytes` in memory of their own; null, too, where there is not twice the memory that they take.
std::unique_ptr<UnpackedBytes> unpackedAtOnce(const std::string& path, std::uint64_t start, bool zlib,
                                              std::uint64_t bytes, bool toEnd, const JobControl& job);

/// The length, modulo 2^32, that the last gzip member of a file gives for what it unpacks to.
std::uint32_t lengthAtEnd(const std::string& path);

} // namespace pellucid
