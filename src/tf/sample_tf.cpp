#include "tf/sample_tf.h"

namespace pellucid {

namespace {

TransferFunction recoloured(TransferFunction tf, const std::vector<Rgb>& colors,
                            const std::vector<std::string>& names) {
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        tf.features[f].color = colors[f];
        tf.features[f].name = names[f];
        for (std::size_t p = 3 * f; p < 3 * f + 3; ++p) tf.points[p].color = colors[f];
    }
    return tf;
}

/// One tent per tissue, given in the sample's data units.
struct Tissue {
    const char* name;
    double lo, peak, hi, opacity;
    Rgb color;
};

TransferFunction tissueTents(const Volume& volume, const std::vector<Tissue>& tissues) {
    TransferFunction tf;
    tf.range = volume.range();
    const auto x = [&](double value) {
        const double s = volume.intensityOfValue(value);
        return s == s ? s : 0.0;
    };
    for (const Tissue& t : tissues) {
        const double a = x(t.lo), b = x(t.hi);
        if (!(a < b)) continue; // outside the window: nothing to see of it
        tf.points.push_back({a, 0.0, t.color, true, {}});
        tf.points.push_back({x(t.peak), t.opacity, t.color, false, {}});
        tf.points.push_back({b, 0.0, t.color, true, {}});
        tf.features.push_back({t.name, a, b, t.color, {}});
    }
    return tf;
}

} // namespace

TransferFunction defaultTf(const Volume& volume) {
    if (volume.format == "sample") {
        if (volume.title == "disks") // fig. 4.1: light green, magenta, dark green, all nearly solid
            return recoloured(tents(3, 0.6), {{0.56, 0.93, 0.56}, {1.0, 0.0, 1.0}, {0.0, 0.39, 0.0}},
                              {"first disk", "middle disk", "last disk"});
        if (volume.title == "shells")
            return recoloured(tents(3, 0.25), {{0.36, 0.58, 0.96}, {0.95, 0.33, 0.29}, {1.0, 0.85, 0.31}},
                              {"outer shell", "middle shell", "core"});
        if (volume.title == "knee")
            return tissueTents(volume, {{"skin and fat", -220, -100, -30, 0.05, {0.93, 0.74, 0.60}},
                                        {"muscle", -20, 50, 130, 0.08, {0.80, 0.22, 0.20}},
                                        {"bone", 180, 700, 1400, 0.30, {0.98, 0.96, 0.86}}});
    }
    return tents(3);
}

} // namespace pellucid
