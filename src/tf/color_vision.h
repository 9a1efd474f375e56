// Colours as viewers with a colour-vision deficiency see them (docs/method.md, "Colour vision").
#pragma once

#include <array>

#include "base/color.h"
#include "base/enum_names.h"
#include "base/image.h"
#include "tf/lch.h"

namespace pellucid {

enum class VisionKind {
    Normal,
    Protanopia,   ///< no cones for long waves: reds are dark
    Deuteranopia, ///< none for middle ones, the most frequent kind
    Tritanopia,   ///< none for short ones, which is rare
    Grey          ///< no colours at all; and what a printer without colours makes of them
};
template <>
inline constexpr auto kNamesOf<VisionKind> = enumNames("kind of colour vision", "normal", "protanopia", "deuteranopia",
                                                       "tritanopia", "grey");

/// Linear light as seen from linear light as it is: three rows, each of sum 1, so that greys stay.
using LightMatrix = std::array<std::array<double, 3>, 3>;

/// `severity` in [0,1]: 0 is normal vision, 1 lacks the cones altogether; between tenths straight lines. Of Normal the
/// identity.
LightMatrix visionMatrix(VisionKind vision, double severity = 1);

/// What is left of linear light, in [0,1].
Rgb seenLight(const Rgb& linear, const LightMatrix& matrix);
/// Of a colour of sRGB, in sRGB.
Rgb seenColor(const Rgb& srgb, const LightMatrix& matrix);
/// Of every pixel; alpha stays. The same bits for any thread count.
void simulateVision(Image& image, const LightMatrix& matrix);

} // namespace pellucid
