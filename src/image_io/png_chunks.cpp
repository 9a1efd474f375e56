#include "image_io/png_chunks.h"

#include <zlib.h>

namespace pellucid::png {

std::uint32_t numberIn(Span bytes) {
    std::uint32_t value = 0;
    for (const unsigned char byte : bytes.first(4)) value = value << 8 | byte;
    return value;
}

void addNumber(Bytes& bytes, std::uint32_t value, int count) {
    for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
        bytes.push_back(static_cast<unsigned char>(value >> shift));
}

std::uint32_t checksumOf(std::string_view name, Span data) {
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(name.data()), static_cast<uInt>(name.size()));
    if (data.empty()) return static_cast<std::uint32_t>(sum); // zlib begins anew where there are no bytes
    return static_cast<std::uint32_t>(crc32(sum, data.data(), static_cast<uInt>(data.size())));
}

void addChunk(Bytes& file, std::string_view name, Span data) {
    addNumber(file, static_cast<std::uint32_t>(data.size()));
    file.insert(file.end(), name.begin(), name.end());
    file.insert(file.end(), data.begin(), data.end());
    addNumber(file, checksumOf(name, data));
}

} // namespace pellucid::png
