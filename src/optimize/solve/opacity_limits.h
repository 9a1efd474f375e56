#pragma once

#include <algorithm>
#include <vector>

namespace pellucid {

/// What a search may do to the opacity of a feature.
struct OpacityLimits {
    double lowest = 0, highest = 1; ///< 0 ≤ lowest ≤ highest ≤ 1
    bool locked = false;            ///< it stays as it is
    bool operator==(const OpacityLimits&) const = default;
};

/// Opacities of all features, those that are not locked brought within their limits.
inline std::vector<double> within(const std::vector<OpacityLimits>& limits, std::vector<double> opacity) {
    for (std::size_t f = 0; f < opacity.size(); ++f)
        if (!limits[f].locked) opacity[f] = std::clamp(opacity[f], limits[f].lowest, limits[f].highest);
    return opacity;
}

} // namespace pellucid
