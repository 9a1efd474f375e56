// How the chunks of Zarr arrays are packed: gzip, zlib, zstd, blosc, lz4, bz2, and checksums. Runs in
// pellucid-array-reader only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/json_value.h"

namespace pellucid {

/// One step from what is stored to the values of a chunk.
enum class ZarrCodec { Gzip, Zlib, Zstd, Blosc, Lz4, Bz2, Crc32c };

/// The one that a compressor of version 2 ("id") or a codec of version 3 ("name") is. Throws FileError for one that is
/// not known here.
ZarrCodec zarrCodecNamed(const std::string& name, const JsonValue& at);

/// What `packed` unpacks to: `bytes` bytes, or fewer by what further steps take away. Throws FileError, with `path`,
/// where it is damaged or unpacks to more.
std::vector<char> unpacked(ZarrCodec codec, const std::vector<char>& packed, std::size_t bytes,
                           const std::string& path);

} // namespace pellucid
