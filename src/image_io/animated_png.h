// Pictures that follow one another in one PNG file (APNG), which browsers play: lossless, and without another program.
#pragma once

#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace pellucid {

/// Whether these are the bytes of a whole PNG file of this size: each piece with its checksum, and an end.
bool isWholePng(std::span<const unsigned char> bytes, int width, int height);
bool isWholePngFile(const std::string& path, int width, int height); ///< likewise; false where it cannot be read

/// The pictures of PNG files of pngBytes(), all of one size, `framesPerSecond` of them a second (above 0; a picture
/// stays for 655 s at most), again and again. The file is whole or absent. Throws FileError, also where a picture is
/// none or of another size, Cancelled.
void writeAnimatedPng(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                      const std::stop_token& stop = {});

} // namespace pellucid
