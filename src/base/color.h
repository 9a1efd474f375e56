// Colours as people give them: sRGB, components in [0,1].
#pragma once

#include <string>

namespace pellucid {

struct Rgb {
    double r = 0, g = 0, b = 0; ///< sRGB (gamma-encoded), [0,1]
    bool operator==(const Rgb&) const = default;
};

/// hue in degrees (any real, wrapped), saturation and value in [0,1].
Rgb rgbFromHsv(double hueDegrees, double saturation, double value);

struct Hsv {
    double hueDegrees = 0; ///< [0, 360)
    double saturation = 0, value = 0;
};
Hsv hsvFromRgb(const Rgb& rgb);

/// "#rrggbb"; components are rounded to 8 bits.
std::string hexFromRgb(const Rgb& rgb);
/// Reads "#rrggbb" or "#rgb"; throws Error.
Rgb rgbFromHex(const std::string& text);
/// That, or "R,G,B" with components in [0,1]. Throws UsageError.
Rgb rgbFromText(const std::string& text);

} // namespace pellucid
