// sRGB as an ICC profile, for files that say their colours no other way.
#pragma once

#include <vector>

namespace pellucid {

/// A display profile of ICC.1:2001-04 (version 2.4): three primaries, one curve. Always the same bytes.
std::vector<unsigned char> srgbIccProfile();

} // namespace pellucid
