// What a PNG file says of itself: the texts in it, read as untrusted input.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "image_io/png_bytes.h"

namespace pellucid {

inline constexpr std::size_t kMostPngText = std::size_t{1} << 26; ///< bytes of all texts of a file together

/// The texts of the chunks tEXt, zTXt and iTXt in their order, as UTF-8; the pixels are passed over. Throws FileError,
/// which names `path`, where the file is no PNG file, ends too early, has a text that is damaged, or more than
/// kMostPngText of them.
std::vector<PngText> readPngTexts(const std::string& path);
/// The same of a stream that can be sought in.
std::vector<PngText> readPngTexts(std::istream& in, const std::string& path);
/// Whether it begins as PNG files do; false also where there is no such file.
bool isPngFile(const std::string& path);

} // namespace pellucid
