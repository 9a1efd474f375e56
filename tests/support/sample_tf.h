// Transfer functions made by hand for built-in samples: known shapes for what measures engines.
#pragma once

#include "tf/tf_range.h"
#include "volume/volume.h"

namespace pellucid {

/// Tents of opacity 0.6 in light green, magenta and dark green, fig. 4.1.
inline TransferFunction disksTf() {
    TransferFunction tf = tents(3, 0.6);
    const std::vector<Rgb> colors{{0.56, 0.93, 0.56}, {1.0, 0.0, 1.0}, {0.0, 0.39, 0.0}};
    for (std::size_t f = 0; f < 3; ++f) {
        tf.features[f].color = colors[f];
        for (std::size_t p = 3 * f; p < 3 * f + 3; ++p) tf.points[p].color = colors[f];
    }
    return tf;
}

/// A tent for each tissue, in Hounsfield units, written for the window of `knee`.
inline TransferFunction kneeTf(const Volume& knee) {
    struct Tissue {
        const char* name;
        double lo, peak, hi, opacity;
        Rgb color;
    };
    TransferFunction tf;
    tf.range = ValueRange{-1000, 1400};
    const auto x = [](double value) { return (value + 1000) / 2400; };
    for (const Tissue& t : {Tissue{"skin and fat", -220, -100, -30, 0.05, {0.93, 0.74, 0.60}},
                            Tissue{"muscle", -20, 50, 130, 0.08, {0.80, 0.22, 0.20}},
                            Tissue{"bone", 180, 700, 1400, 0.30, {0.98, 0.96, 0.86}}}) {
        tf.points.push_back({x(t.lo), 0.0, t.color, true, {}});
        tf.points.push_back({x(t.peak), t.opacity, t.color, false, {}});
        tf.points.push_back({x(t.hi), 0.0, t.color, true, {}});
        tf.features.push_back({t.name, x(t.lo), x(t.hi), t.color, {}});
    }
    return inRange(tf, knee.range());
}

} // namespace pellucid
