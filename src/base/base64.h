// Bytes as text.
#pragma once

#include <span>
#include <string>

namespace pellucid {

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

} // namespace pellucid
