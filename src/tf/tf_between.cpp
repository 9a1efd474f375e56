#include "tf/tf_between.h"

namespace pellucid {

std::optional<TransferFunction> tfBetween(const TransferFunction& from, const TransferFunction& to, double t) {
    if (from.range != to.range || from.points.size() != to.points.size() || from.features.size() != to.features.size())
        return {};
    const auto mix = [t](double a, double b) { return a + t * (b - a); };
    const auto mixed = [&](const Rgb& a, const Rgb& b) { return Rgb{mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)}; };
    TransferFunction tf = from;
    for (std::size_t i = 0; i < tf.points.size(); ++i) {
        ControlPoint& p = tf.points[i];
        const ControlPoint& q = to.points[i];
        if (p.fixed != q.fixed) return {};
        p.x = mix(p.x, q.x);
        p.opacity = mix(p.opacity, q.opacity);
        p.color = mixed(p.color, q.color);
    }
    for (std::size_t i = 0; i < tf.features.size(); ++i) {
        Feature& f = tf.features[i];
        const Feature& g = to.features[i];
        if (f.id != g.id || f.name != g.name) return {};
        f.a = mix(f.a, g.a);
        f.b = mix(f.b, g.b);
        f.color = mixed(f.color, g.color);
    }
    return tf;
}

} // namespace pellucid
