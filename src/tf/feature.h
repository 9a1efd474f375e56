// A feature: the voxels of an intensity interval, under a name and a colour (MEASURES §2, eq. 4.1).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tf/color.h"

namespace pellucid {

struct Feature {
    std::string name;
    double a = 0, b = 1; ///< intensities; the voxels with a ≤ s < b, and s = 1 too where b = 1
    Rgb color;
    std::string extraJson; ///< unknown keys of the file it came from, as one JSON object; written back

    bool contains(double s) const { return s >= a && (s < b || (b >= 1.0 && s <= 1.0)); }
    bool operator==(const Feature&) const = default;
};

/// Index of the feature that holds intensity s, −1 where none does (or s is NaN).
int featureAt(std::span<const Feature> features, double s);

} // namespace pellucid
