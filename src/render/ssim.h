// How alike two pictures are to the eye.
#pragma once

#include "base/image.h"

namespace pellucid {

/// The mean structural similarity of two pictures of one size: Wang, Bovik, Sheikh and Simoncelli, "Image quality
/// assessment: from error visibility to structural similarity", IEEE Transactions on Image Processing 13(4), 2004,
/// eq. 13 and 17, of the luminance 0.2126 R + 0.7152 G + 0.0722 B over black, [0,1]. As there: a Gaussian window of
/// 11×11 pixels with a standard deviation of 1.5, of sum 1; K1 = 0.01, K2 = 0.03, L = 1; the mean is over all pixels
/// around which the whole window lies in the picture. Pictures of less than 11 pixels in a direction have a window as
/// wide as fits.
///   range   [−1, 1]; 1 of equal pictures only
/// Throws UsageError where the sizes differ or are 0.
double ssim(const Image& a, const Image& b);

} // namespace pellucid
