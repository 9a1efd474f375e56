// How much two pictures differ, in all and pixel by pixel.
#pragma once

#include <string>

#include "base/image.h"
#include "base/plane.h"

namespace pellucid {

inline constexpr double kNoticedDeltaE = 2.3; ///< ΔE that is just noticed

struct PictureDifference {
    Plane map;          ///< ΔE of each pixel, see deltaEOf()
    double ssim = 1;    ///< see ssim()
    double mean = 0;    ///< ΔE over all pixels
    double largest = 0; ///< ΔE of one pixel
    double noticed = 0; ///< share of the pixels above kNoticedDeltaE, [0,1]
};
/// Throws Error where the sizes differ. `where` names both in its message.
PictureDifference differenceOf(const Image& a, const Image& b, const std::string& where);

/// `a` to the left, `b` to the right; both have one height.
Image sideBySide(const Image& a, const Image& b);

/// The map as a file of one channel has it: floats tell ΔE itself; 16 bits are white at the 100 from black to white.
Plane storedDifference(Plane map, bool asFloats);

} // namespace pellucid
