// PNG files, written by our own code: it takes zlib alone, so that pictures need neither OpenImageIO nor the quarter of
// a second that its libraries take to load.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/plane.h"

namespace pellucid {

/// What a PNG file says of itself under a keyword.
struct PngText {
    std::string keyword; ///< 1 to 79 letters of ASCII, no blanks around it
    std::string text;    ///< UTF-8
    bool operator==(const PngText&) const = default;
};

/// 8 bits, with straight alpha, marked as sRGB. Values beyond [0,1] are cut, those that are no numbers are 0; the
/// others are rounded. Texts come before the pixels, in their order; long ones are packed.
std::vector<unsigned char> pngBytes(const Image& image, std::span<const PngText> texts = {});
/// The same with 16 bits. `areColors`: false makes no statement of their space.
std::vector<unsigned char> deepPngBytes(const Image& image, bool areColors = true);
/// Grey, 16 bits of value · 65535, likewise; no statement of its colours.
std::vector<unsigned char> pngBytes(const Plane& plane);

} // namespace pellucid
