#include "tf/terrain.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "tf/color_maps.h"

namespace pellucid {

namespace {

/// Up to here it is sea: the lowest height, and what rounding makes of it.
constexpr double kSea = 1e-3;

struct Stop {
    double t;
    Rgb color;
};
constexpr Rgb kWater{0.22, 0.40, 0.62};
constexpr std::array<Stop, 6> kLand{{{0, {0.36, 0.55, 0.34}},
                                     {0.15, {0.53, 0.66, 0.40}},
                                     {0.35, {0.80, 0.75, 0.52}},
                                     {0.6, {0.62, 0.47, 0.33}},
                                     {0.85, {0.72, 0.68, 0.66}},
                                     {1, {0.97, 0.97, 0.98}}}};

} // namespace

Rgb terrainColor(double t) {
    if (!(t > kSea)) return kWater;
    t = std::min(t, 1.0);
    std::size_t i = 1;
    while (t > kLand[i].t) ++i;
    const Stop &a = kLand[i - 1], &b = kLand[i];
    const double f = (t - a.t) / (b.t - a.t);
    return {a.color.r + f * (b.color.r - a.color.r), a.color.g + f * (b.color.g - a.color.g),
            a.color.b + f * (b.color.b - a.color.b)};
}

ColorAt groundColors(const std::string& name) {
    if (name == kTerrainMap) return terrainColor;
    for (const ColorMap& map : colorMaps())
        if (map.name == name && map.kind != ColorMap::Kind::Categorical) return map.colorAt;
    throw UsageError("'" + name + "' is not a colour map for a ground", "ground",
                     "give one of " + joined(groundColorNames()));
}

std::vector<std::string> groundColorNames() {
    std::vector<std::string> names{kTerrainMap};
    for (const ColorMap& map : colorMaps())
        if (map.kind != ColorMap::Kind::Categorical) names.push_back(map.name);
    return names;
}

} // namespace pellucid
