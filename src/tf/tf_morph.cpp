#include "tf/tf_morph.h"

#include <algorithm>
#include <cmath>

#include "tf/color_spaces.h"
#include "tf/shown_tf.h"
#include "tf/tf_between.h"
#include "tf/tf_range.h"

namespace pellucid {

namespace {

constexpr double kSame = 1e-12; ///< intensities that are no more apart are one

double mix(double a, double b, double t) { return a + t * (b - a); }
Rgb mixed(const Rgb& a, const Rgb& b, double t) { return ColorWay(a, b, ColorSpace::Lab).at(t); }

/// Places that belong together: x in the first transfer function, y in the second.
struct Pair {
    double x, y;
};

const Feature* counterpartOf(const Feature& f, const std::vector<Feature>& others) {
    const auto find = [&](const auto& isIt) {
        const auto found = std::find_if(others.begin(), others.end(), isIt);
        return found == others.end() ? nullptr : &*found;
    };
    if (f.id != 0)
        if (const Feature* same = find([&](const Feature& g) { return g.id == f.id; })) return same;
    return find([&](const Feature& g) { return g.name == f.name && (f.id == 0 || g.id == 0 || g.id != f.id); });
}

/// How the axis of the one is stretched to that of the other: rising in both, from (0, 0) to (1, 1).
class Stretch {
public:
    Stretch(const TransferFunction& from, const TransferFunction& to) {
        std::vector<Feature> features = from.features;
        std::ranges::sort(features, {}, &Feature::a);
        for (const Feature& f : features)
            if (const Feature* const g = counterpartOf(f, to.features)) {
                add({f.a, g->a});
                add({f.b, g->b});
            }
        m_pairs.push_back({1, 1});
    }
    const std::vector<Pair>& pairs() const { return m_pairs; }
    double there(double x) const { return stretched(x, &Pair::x, &Pair::y); }
    double back(double y) const { return stretched(y, &Pair::y, &Pair::x); }

private:
    /// Features that have changed places cannot both be followed.
    void add(const Pair& pair) {
        const Pair& last = m_pairs.back();
        if (pair.x > last.x + kSame && pair.y > last.y + kSame && pair.x < 1 - kSame && pair.y < 1 - kSame)
            m_pairs.push_back(pair);
    }
    double stretched(double at, double Pair::*in, double Pair::*out) const {
        std::size_t n = 1;
        while (n + 1 < m_pairs.size() && m_pairs[n].*in < at) ++n;
        const Pair &a = m_pairs[n - 1], &b = m_pairs[n];
        return std::clamp(mix(a.*out, b.*out, (at - a.*in) / (b.*in - a.*in)), 0.0, 1.0);
    }
    std::vector<Pair> m_pairs{{0, 0}};
};

struct Sample {
    double opacity = 0;
    Rgb color;
    bool operator==(const Sample&) const = default;
};

/// What a curve has just below a place, and from there on.
struct Sides {
    Sample below, from;
};

Sides sidesAt(const std::vector<ControlPoint>& points, double x) {
    const auto first = std::lower_bound(points.begin(), points.end(), x - kSame, [](const ControlPoint& p, double at) {
        return p.x < at;
    }); // there is one: the last is at 1
    if (first == points.end()) return {{points.back().opacity, points.back().color}, {}};
    if (first->x <= x + kSame) {
        auto last = first;
        while (std::next(last) != points.end() && std::next(last)->x <= x + kSame) ++last;
        return {{first->opacity, first->color}, {last->opacity, last->color}};
    }
    const ControlPoint &p = *std::prev(first), &q = *first;
    const double t = (x - p.x) / (q.x - p.x);
    const auto straight = [t](double a, double b) { return mix(a, b, t); };
    const Sample sample{
        straight(p.opacity, q.opacity),
        {straight(p.color.r, q.color.r), straight(p.color.g, q.color.g), straight(p.color.b, q.color.b)}};
    return {sample, sample};
}

Sample mixed(const Sample& a, const Sample& b, double t) {
    return {mix(a.opacity, b.opacity, t), mixed(a.color, b.color, t)};
}

/// A feature between those of the two; both intervals are on their own axes.
Feature between(const Feature& f, const Feature& g, double t) {
    Feature m = t < 0.5 ? f : g;
    m.a = mix(f.a, g.a, t);
    m.b = mix(f.b, g.b, t);
    m.color = mixed(f.color, g.color, t);
    return m;
}

/// Those of the nearer one, and of the other those that are in no one's way.
std::vector<Feature> featuresBetween(const TransferFunction& from, const TransferFunction& to, const Stretch& stretch,
                                     double t) {
    std::vector<Feature> features;
    const auto add = [&](const Feature& f) {
        const bool isFree = std::ranges::none_of(
            features, [&](const Feature& g) { return (f.a < g.b && g.a < f.b) || (f.id != 0 && f.id == g.id); });
        if (isFree && f.a < f.b) features.push_back(f);
    };
    const auto addAll = [&](const TransferFunction& own, const TransferFunction& other, bool isFrom) {
        for (const Feature& f : own.features) {
            Feature twin = f;
            if (const Feature* const g = counterpartOf(f, other.features)) {
                twin = *g;
            } else {
                twin.a = isFrom ? stretch.there(f.a) : stretch.back(f.a);
                twin.b = isFrom ? stretch.there(f.b) : stretch.back(f.b);
            }
            add(isFrom ? between(f, twin, t) : between(twin, f, t));
        }
    };
    if (t < 0.5) {
        addAll(from, to, true);
        addAll(to, from, false);
    } else {
        addAll(to, from, false);
        addAll(from, to, true);
    }
    std::ranges::sort(features, {}, &Feature::a);
    return features;
}

TransferFunction stretchedBetween(const TransferFunction& from, const TransferFunction& to, double t) {
    const Stretch stretch(from, to);
    const std::vector<ControlPoint> first = from.pointsWithEnds(), second = to.pointsWithEnds();
    std::vector<Pair> places = stretch.pairs();
    for (const ControlPoint& p : first) places.push_back({p.x, stretch.there(p.x)});
    for (const ControlPoint& p : second) places.push_back({stretch.back(p.x), p.x});
    std::ranges::sort(places, {}, [](const Pair& p) { return p.x + p.y; });
    TransferFunction tf;
    double last = -1; // x + y of the place before
    for (const Pair& place : places) {
        if (place.x + place.y <= last + 2 * kSame) continue;
        last = place.x + place.y;
        const Sides a = sidesAt(first, place.x), b = sidesAt(second, place.y);
        const Sample below = mixed(a.below, b.below, t), onward = mixed(a.from, b.from, t);
        const double x = std::max(mix(place.x, place.y, t), tf.points.empty() ? 0 : tf.points.back().x);
        tf.points.push_back({x, below.opacity, below.color, false, {}});
        if (!(onward == below)) tf.points.push_back({x, onward.opacity, onward.color, false, {}});
    }
    tf.features = featuresBetween(from, to, stretch, t);
    tf.range = from.range;
    return tf;
}

/// Without what eyes hide, as pictures have it.
TransferFunction seen(const TransferFunction& tf) {
    TransferFunction shown = shownTf(tf);
    for (Feature& f : shown.features) f.hidden = false;
    return shown;
}

} // namespace

TransferFunction tfMorph(const TransferFunction& from, const TransferFunction& to, double t) {
    if (t <= 0) return from;
    if (t >= 1) return to;
    TransferFunction a = seen(from), b = seen(to);
    if (!a.range) a.range = b.range;
    if (!b.range) b.range = a.range;
    if (a.range && *a.range != *b.range) {
        const ValueRange both{std::min(a.range->lo, b.range->lo), std::max(a.range->hi, b.range->hi)};
        a = inRange(a, both);
        b = inRange(b, both);
    }
    TransferFunction twin = b; // matched features are the same, whoever has numbered them
    if (a.features.size() == twin.features.size())
        for (std::size_t n = 0; n < a.features.size(); ++n)
            if (a.features[n].name == twin.features[n].name) twin.features[n].id = a.features[n].id;
    std::optional<TransferFunction> straight = tfBetween(a, twin, t);
    if (!straight) return stretchedBetween(a, b, t);
    for (std::size_t i = 0; i < straight->points.size(); ++i)
        straight->points[i].color = mixed(a.points[i].color, twin.points[i].color, t);
    for (std::size_t i = 0; i < straight->features.size(); ++i)
        straight->features[i].color = mixed(a.features[i].color, twin.features[i].color, t);
    return *straight;
}

} // namespace pellucid
