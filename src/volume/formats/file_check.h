// What a header claims, held against what is really there, before anything is allocated.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/job.h"
#include "base/text.h"
#include "volume/formats/byte_source.h"

namespace pellucid {

bool isFolder(const std::string& path);

/// Size of a file that can be read. Throws FileError: no such file, a folder, not permitted.
std::uint64_t readableFileBytes(const std::string& path);

/// The first `limit` bytes, fewer where the file is shorter. Throws FileError.
std::string fileHead(const std::string& path, std::size_t limit);

/// Size of the file `data`, which holds the samples and is named in the file `header`, or is that file. Throws
/// FileError as readableFileBytes() does; where `data` is missing, it names both.
std::uint64_t dataFileBytes(const std::string& data, const std::string& header);

/// Throws UsageError unless `index` is that of one of the `count` things called `what` ("time step") in a file.
void requireIndex(const std::string& what, int index, std::uint64_t count, const std::string& path);

/// What is wrong with a file that is not `expected` ("an NRRD file"), by its first 1024 bytes.
FileError notOfFormat(const std::string& expected, const std::string& path, std::string_view head);

/// Number of values, product of `sizes`. Throws FileError unless each is in [1, 2^31) and the product times
/// bytesPerValue stays below 2^63.
std::uint64_t valueCount(const std::string& path, std::span<const std::int64_t> sizes, std::uint64_t bytesPerValue);

enum class Encoding { Raw, Deflate, Bzip2, Text, Hex };

/// Throws FileError where `stored` bytes cannot hold `values` values of `bytesPerValue` in this encoding. `where` is
/// the file that holds the data; `toDo` advises what to check.
void requireStored(const std::string& where, Encoding encoding, std::uint64_t values, std::uint64_t bytesPerValue,
                   std::uint64_t stored, const std::string& toDo);

/// Throws FileError where `stored` bytes, each of which unpacks to `most` at most, cannot hold `bytes`.
void requirePacked(const std::string& where, std::uint64_t bytes, std::uint64_t stored, std::uint64_t most,
                   const std::string& toDo);

/// Unpacks a stream of the file `path` without keeping it. Throws FileError unless it yields `wanted` bytes or more in
/// members with the right checksum and length. Throws Cancelled.
void requireSound(UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path);

/// The same to the end of the file, where only zeros may follow the stream. Returns how many bytes it yields.
std::uint64_t requireSoundToEnd(UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path);

/// Throws FileError, which says why, unless a stream that was read as far as it goes has ended with the file, or with
/// zeros behind it, and holds `wanted` sound bytes.
void requireWhole(const UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path);

/// Throws a FileError that says why a stream, read as far as it goes, does not hold `wanted` sound bytes.
[[noreturn]] void failToUnpack(const UnpackedBytes& bytes, std::uint64_t wanted, const std::string& path);

/// Throws FileError unless the text at byte `start` of a file holds `wanted` numbers, separated by blanks or commas.
void requireNumbers(const std::string& path, std::uint64_t start, std::uint64_t wanted, const JobControl& job);

} // namespace pellucid
