// A part of a picture that someone has drawn round: a rectangle or a lasso.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace pellucid {

/// A closed outline in fractions of the picture's width (to the right) and height (down), [0,1], the last corner joined
/// to the first; a rectangle has four. What lies inside is told by the even-odd rule.
struct ImageRegion {
    std::vector<glm::dvec2> outline;

    bool operator==(const ImageRegion&) const = default;

    /// Whether the place lies inside; never with fewer than three corners.
    bool contains(double x, double y) const {
        bool inside = false;
        for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
            const glm::dvec2 &a = outline[i], &b = outline[j];
            if ((a.y > y) != (b.y > y) && x < a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)) inside = !inside;
        }
        return inside;
    }
};

} // namespace pellucid
