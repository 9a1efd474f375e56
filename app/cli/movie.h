// Pictures as a film, by a program that people have installed: ffmpeg.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

namespace pellucid::cli {

void checkMovieSuffix(const std::string& path); ///< throws UsageError where it does not end in .mp4
void requireMovieWriter();                      ///< throws Error where there is no ffmpeg in PATH

/// H.264 in `path`, `framesPerSecond` pictures a second; a line is added to pictures of odd sizes. The film is whole or
/// absent. Throws Error with what ffmpeg says where it fails, Cancelled.
void writeMovie(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                const std::stop_token& stop);

} // namespace pellucid::cli
