// A box drawn with axes and words of its own, not the world's.
#pragma once

#include "render/annotation.h"

namespace pellucid {

struct AxisTick {
    double at; ///< coordinate along its axis
    std::string text;
};
/// A box whose axes are not those of the world: what they are, in words.
struct NamedBox {
    Vec3 lo{0, 0, 0}, hi{1, 1, 1}; ///< world units
    std::array<std::string, 3> captions;
    std::array<std::vector<AxisTick>, 3> ticks;
};

/// annotationMarks() with `box` in place of the axes around the volume.
std::vector<Mark> annotationMarks(const AnnotationInput& input, const NamedBox& box);

} // namespace pellucid
