// A comparison as files: its figures, the difference of its pictures, and both side by side.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "session/comparison.h"

namespace pellucid {

/// A line per figure: of features (vws, visibility, fs, opacity) a, b and b − a, empty where a side has none; then of
/// the pictures ssim, mean, largest ΔE and the share of pixels where it is noticed. Numbers with all their digits.
std::string csvOf(const Comparison& comparison);
/// Names, size, ssim, delta_e and, where there are figures, features: what `compare --json` prints.
nlohmann::ordered_json jsonOf(const Comparison& comparison);

/// ΔE of each pixel: .exr (floats) or .png (16 bits, white at 100). Throws FileError.
void writeDifference(const PictureDifference& difference, const std::string& path);
/// CSV or JSON by the suffix. Throws UsageError for another one, FileError.
void writeFigures(const Comparison& comparison, const std::string& path);
/// Throws UsageError where the suffix is neither, before any work is done.
void checkFiguresSuffix(const std::string& path);

} // namespace pellucid
