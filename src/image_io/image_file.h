// A picture on disk.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "base/plane.h"

namespace pellucid {

/// PNG (8 bit), TIFF (16 bit), JPEG (8 bit, no alpha) or EXR (half float) by suffix, PNG by png_bytes.h, the others
/// through OpenImageIO; by a temporary file that is renamed. Throws FileError.
void writeImage(const Image& image, const std::string& path);
/// The bytes of a PNG file, 8 bit, with alpha.
std::vector<unsigned char> pngOf(const Image& image);
/// A picture of any kind that OpenImageIO reads; alpha 1 where it has none. Throws FileError.
Image readImage(const std::string& path);
/// One channel: .exr with 32-bit floats as they are, .png with 16 bits of value · 65535. Throws FileError.
void writePlane(const Plane& plane, const std::string& path);
/// Throws UsageError where the suffix is neither, before any work is done.
void checkPlaneSuffix(const std::string& path);
/// Throws UsageError where the suffix is none of these, before any work is done.
void checkImageSuffix(const std::string& path);

} // namespace pellucid
