// A picture on disk.
#pragma once

#include <string>
#include <vector>

#include "render/image.h"

namespace pellucid {

/// PNG (8 bit), TIFF (16 bit), JPEG (8 bit, no alpha) or EXR (half float) by suffix, through OpenImageIO and a
/// temporary file that is renamed. Throws FileError.
void writeImage(const Image& image, const std::string& path);
/// The bytes of a PNG file, 8 bit, with alpha. Throws FileError.
std::vector<unsigned char> pngOf(const Image& image);
Image readImage(const std::string& path);
/// Throws UsageError where the suffix is none of these, before any work is done.
void checkImageSuffix(const std::string& path);

} // namespace pellucid
