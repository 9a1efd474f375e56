// A feature: the voxels of an intensity interval, under a name and a colour (docs/method.md, "Transfer function",
// eq. 4.1).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/color.h"

namespace pellucid {

/// Which feature it is, whatever becomes of its name, interval or colour: what belongs to a feature (its target, say)
/// is found by it. 0: not told apart yet. Unique within a session, never used again there.
using FeatureId = std::uint64_t;

struct Feature {
    std::string name;
    double a = 0, b = 1; ///< intensities; the voxels with a ≤ s < b, and s = 1 too where b = 1
    Rgb color;
    std::string extraJson; ///< unknown keys of the file it came from, as one JSON object; written back

    bool contains(double s) const { return s >= a && (s < b || (b >= 1.0 && s <= 1.0)); }
    bool hidden = false; ///< an eye: the feature is as good as transparent, see shown_tf.h
    FeatureId id = 0;    ///< no part of the value: two features may be equal and not the same

    bool operator==(const Feature& o) const {
        return name == o.name && a == o.a && b == o.b && color == o.color && extraJson == o.extraJson &&
               hidden == o.hidden;
    }
};

/// Index of the feature that holds intensity s, −1 where none does (or s is NaN).
int featureAt(std::span<const Feature> features, double s);

} // namespace pellucid
