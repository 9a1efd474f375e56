// A part of a picture that someone has drawn around.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace pellucid {

/// The inside of a closed outline, whatever the picture's size: fractions of width (to the right) and height (down), in
/// [0,1]. A rectangle has four corners; fewer than three points hold nothing. Where the outline crosses itself a place
/// is inside if a line from it to infinity meets the outline an odd number of times.
struct ImageRegion {
    std::vector<glm::dvec2> outline;

    bool contains(double x, double y) const {
        bool inside = false;
        for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
            const glm::dvec2 &a = outline[i], &b = outline[j];
            // Half-open in y, so that a corner between two edges counts once.
            if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
        }
        return inside;
    }
    bool operator==(const ImageRegion&) const = default;
};

} // namespace pellucid
