// Marks in the ink of a picture: light on dark and dark on light, of a size that can be read.
#pragma once

#include <array>
#include <optional>

#include "render/annotation.h"

namespace pellucid {

enum class Align { Start, Middle, End };

struct MarkMaker {
    /// `density`: pixels in which lengths of the screen are one.
    MarkMaker(double width, double height, double density, const Rgb& background);

    double capHeight; ///< height of a capital, pixels
    double margin;    ///< distance from the picture's edges, pixels
    bool onDark;      ///< the background is
    Rgb ink, haloInk;

    Mark lineMark(AnnotationPart part, std::vector<Vec2> points, double width) const;
    Mark areaMark(AnnotationPart part, std::vector<Vec2> corners, const Rgb& color, double alpha = 1) const;
    Mark boxMark(AnnotationPart part, const PixelBox& b, const Rgb& color, double alpha = 1) const;
    /// `at`: the start, middle or end of its capitals' box in each direction; vertically Start is the top. `capital`:
    /// their height.
    Mark textMark(AnnotationPart part, const std::string& words, const Vec2& at, Align horizontal, Align vertical,
                  double capital) const;
};

/// The part of a line between two points that lies in a box, or none.
std::optional<std::array<Vec2, 2>> partWithin(const Vec2& from, const Vec2& to, const PixelBox& box);

/// `a` with so much of `b`, [0,1].
Rgb mixed(const Rgb& a, const Rgb& b, double share);

inline constexpr Rgb kLightInk{0.93, 0.94, 0.95}, kDarkInk{0.07, 0.08, 0.09};

} // namespace pellucid
