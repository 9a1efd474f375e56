// Bytes as text.
#pragma once

#include <span>
#include <string>

namespace pellucid {

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// What a letter of it stands for, 0 … 63; −1: it is none.
constexpr int base64Digit(int c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    if (c == '/') return 63;
    return -1;
}

} // namespace pellucid
