// Bytes packed as other programs pack them, by the libraries of the formats.
#pragma once

#include <string>

#include <bzlib.h>

namespace pellucid::test {

/// `bytes` as one bzip2 stream, in blocks of 100 000 · `level`.
inline std::string bzipped(std::string bytes, int level = 9) {
    auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 100 + 600);
    std::string packed(size, '\0');
    BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), level, 0, 0);
    packed.resize(size);
    return packed;
}

} // namespace pellucid::test
