// A picture on disk.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/image.h"
#include "base/plane.h"
#include "image_io/picture_text.h"

namespace pellucid {

/// PNG (8 bit), TIFF (16 bit, with a profile of sRGB), JPEG (8 bit, no alpha) or EXR (linear light, premultiplied by
/// alpha, 32-bit floats) by suffix, PNG by png_bytes.h, the others through OpenImageIO; by a temporary file that is
/// renamed. `text` is what the file says of the picture: all of it in PNG and EXR, software and description in TIFF and
/// JPEG. Equal pictures with equal texts make equal bytes. Throws FileError.
void writeImage(const Image& image, const std::string& path, const PictureText& text = {});
/// The bytes of a PNG file, 8 bit, with alpha.
std::vector<unsigned char> pngOf(const Image& image);
/// A picture of any kind that OpenImageIO reads; alpha 1 where it has none. Colours of EXR files, which are linear
/// light, become sRGB; one channel alone is a map, whose numbers stay. Throws FileError.
Image readImage(const std::string& path);
/// One channel: .exr with 32-bit floats as they are, .png with 16 bits of value · 65535. Throws FileError.
void writePlane(const Plane& plane, const std::string& path);
/// The bytes of an EXR file of channels with names, 32-bit floats: `values` has them pixel by pixel, rows from the top.
/// `texts`: by name. Throws FileError, which names `path`.
std::vector<unsigned char> exrOf(int width, int height, const std::vector<std::string>& channels,
                                 const std::vector<float>& values,
                                 const std::vector<std::pair<std::string, std::string>>& texts,
                                 const std::string& path);
/// Throws UsageError where the suffix is neither, before any work is done.
void checkPlaneSuffix(const std::string& path);
/// Throws UsageError where the suffix is none of these, before any work is done.
void checkImageSuffix(const std::string& path);

} // namespace pellucid
