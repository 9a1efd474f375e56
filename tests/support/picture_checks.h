// How far pictures lie apart.
#pragma once

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "render/image_renderer.h"

namespace pellucid::test {

/// Largest difference of premultiplied components.
inline double distance(const Image& a, const Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double alphaA = i % 4 == 3 ? 1 : a.rgba[i / 4 * 4 + 3], alphaB = i % 4 == 3 ? 1 : b.rgba[i / 4 * 4 + 3];
        worst = std::max(worst,
                         std::abs(alphaA * static_cast<double>(a.rgba[i]) - alphaB * static_cast<double>(b.rgba[i])));
    }
    return worst;
}

} // namespace pellucid::test
