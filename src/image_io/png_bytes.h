// PNG files, written by our own code: it takes zlib alone, so that pictures need neither OpenImageIO nor the quarter of
// a second that its libraries take to load.
#pragma once

#include <vector>

#include "base/image.h"
#include "base/plane.h"

namespace pellucid {

/// 8 bits, with straight alpha, marked as sRGB. Values beyond [0,1] are cut, those that are no numbers are 0; the
/// others are rounded.
std::vector<unsigned char> pngBytes(const Image& image);
/// Grey, 16 bits of value · 65535, likewise; no statement of its colours.
std::vector<unsigned char> pngBytes(const Plane& plane);

} // namespace pellucid
