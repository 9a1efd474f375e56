// What a header claims, held against what is really there, before anything is allocated.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/job.h"
#include "base/text.h"
#include "volume/formats/byte_source.h"

namespace pellucid {

/// Size of a file that can be read. Throws FileError: no such file, a folder, not permitted.
std::uint64_t readableFileBytes(const std::string& path);

/// The first `limit` bytes, fewer where the file is shorter. Throws FileError.
std::string fileHead(const std::string& path, std::size_t limit);

/// What a file seems to be, for error messages: "a PNG image", "text", "binary data", …
std::string describeContent(std::string_view head);

/// Number of values, product of `sizes`. Throws FileError unless each is in [1, 2^31) and the product times
/// bytesPerValue stays below 2^63.
std::uint64_t valueCount(const std::string& path, std::span<const std::int64_t> sizes, std::uint64_t bytesPerValue);

enum class Encoding { Raw, Deflate, Text, Hex };

/// Throws FileError where `stored` bytes cannot hold `values` values of `bytesPerValue` in this encoding. `where` is
/// the file that holds the data; `toDo` advises what to check.
void requireStored(const std::string& where, Encoding encoding, std::uint64_t values, std::uint64_t bytesPerValue,
                   std::uint64_t stored, const std::string& toDo);

/// Unpacks the deflate stream that begins at byte `start` of a file (gzip, several members too; one of zlib or gzip
/// where `zlib`) without keeping it. Throws FileError unless it yields at least `wanted` bytes undamaged.
/// Returns how many there are: all where `toTheEnd`, otherwise those it had to look at.
std::uint64_t requireInflates(const std::string& path, std::uint64_t start, bool zlib, std::uint64_t wanted,
                              const JobControl& job, bool toTheEnd = false);

/// Throws FileError unless a stream that was unpacked to its `end` has ended well, with `wanted` bytes or more.
void requireYield(const std::string& path, std::uint64_t yield, std::uint64_t wanted, InflatedBytes::End end);

/// Throws FileError unless the text that begins at byte `start` of a file holds `wanted` numbers, between blanks or
/// commas.
void requireNumbers(const std::string& path, std::uint64_t start, std::uint64_t wanted, const JobControl& job);

} // namespace pellucid
