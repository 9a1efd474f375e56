// Characters of UTF-8 texts that may be damaged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pellucid {

/// The character that a text begins with.
struct Character {
    std::size_t bytes = 1;
    std::uint32_t code = 0;
    bool isValid = false; ///< else a byte that is no UTF-8
};

/// Of a text that is not empty. Shorter or longer forms than the format has, surrogates and what lies beyond U+10FFFF
/// are no characters.
inline Character firstCharacter(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::uint32_t head = byte(0);
    if (head < 0x80) return {1, head, true};
    const std::size_t bytes = head >= 0xf0 ? 4 : head >= 0xe0 ? 3 : 2;
    if (head < 0xc2 || head > 0xf4 || text.size() < bytes) return {};
    std::uint32_t code = head & (0x7fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000}; // shorter forms say the same
    const bool isSurrogate = code >= 0xd800 && code < 0xe000;
    if (code < kLeast[bytes] || code > 0x10ffff || isSurrogate) return {};
    return {bytes, code, true};
}

/// At most `most` bytes from the beginning, and no part of a character.
inline std::string cutAtCharacter(std::string text, std::size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
    text.resize(most);
    return text;
}

} // namespace pellucid
