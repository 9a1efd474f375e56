// What PNG files are made of, for those that write and read them: a signature, and chunks of a length, a name of four
// letters, data, and a checksum of name and data. Numbers have their highest byte first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace pellucid::png {

using Bytes = std::vector<unsigned char>;
using Span = std::span<const unsigned char>;

inline constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
/// Bytes of a chunk around its data.
inline constexpr std::size_t kFrame = 12;

inline Span bytesOf(std::string_view text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::uint32_t numberIn(Span bytes); ///< in the first four
/// The lowest `count` bytes of `value`, 1 to 4.
void addNumber(Bytes& bytes, std::uint32_t value, int count = 4);

std::uint32_t checksumOf(std::string_view name, Span data);
void addChunk(Bytes& file, std::string_view name, Span data);

} // namespace pellucid::png
