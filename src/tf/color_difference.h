// How different the colours of two pictures look: ΔE of CIELAB.
#pragma once

#include <vector>

#include "base/image.h"
#include "base/plane.h"

namespace pellucid {

/// The mean over all pixels of CIE76's ΔE, the distance of two sRGB colours in CIELAB (white point D65), between two
/// pictures of one size, of what is seen over black where they are transparent. 0: the same; about 2.3: just noticed;
/// 100: black to white. Components are rounded to 8 bits, as screens show them. The same bits for any thread count.
/// Throws Error for pictures of different sizes.
double meanDeltaE(const Image& a, const Image& b);

/// The same of each pixel. Throws likewise.
Plane deltaEOf(const Image& a, const Image& b);

/// CIELAB of what is seen of each pixel over black: L*, a*, b* one after the other, not rounded.
std::vector<double> labPixels(const Image& image);

} // namespace pellucid
