#include "tf/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/round_numbers.h"
#include "tf/color_maps.h"
#include "tf/edit.h"
#include "tf/part_names.h"

namespace pellucid {

namespace {

constexpr double kSmallestGap = 1.0 / 64;

const Feature& at(const TransferFunction& tf, int feature) { return tf.features.at(static_cast<std::size_t>(feature)); }
Feature& at(TransferFunction& tf, int feature) { return tf.features.at(static_cast<std::size_t>(feature)); }

bool anyEndsAt(const TransferFunction& tf, double x) {
    return std::ranges::find(tf.features, x, &Feature::b) != tf.features.end();
}
bool anyStartsAt(const TransferFunction& tf, double x) {
    return std::ranges::find(tf.features, x, &Feature::a) != tf.features.end();
}

/// The points that share x, [first, last).
struct Group {
    std::size_t first = 0, last = 0;
    bool empty() const { return first == last; }
};
Group pointsAt(const std::vector<ControlPoint>& points, double x) {
    const auto first = std::ranges::lower_bound(points, x, {}, &ControlPoint::x);
    const auto last = std::ranges::upper_bound(points, x, {}, &ControlPoint::x);
    return {static_cast<std::size_t>(first - points.begin()), static_cast<std::size_t>(last - points.begin())};
}

/// A point on the curve.
ControlPoint curveAt(const TransferFunction& tf, double x) {
    const double opacity = tf.opacity(x);
    return {x, opacity, tf.color(x), opacity == 0, {}};
}

/// What the function is just below x: that of the first point at x, where there is one.
ControlPoint leftOf(const TransferFunction& tf, double x) {
    const Group group = pointsAt(tf.points, x);
    return group.empty() ? curveAt(tf, x) : tf.points[group.first];
}
ControlPoint rightOf(const TransferFunction& tf, double x) {
    const Group group = pointsAt(tf.points, x);
    return group.empty() ? curveAt(tf, x) : tf.points[group.last - 1];
}

ControlPoint bottomAt(const ControlPoint& point) { return {point.x, 0.0, point.color, true, {}}; }

/// `tf` with α = 0 over [a, b) ([a, 1] where b is 1); α outside stays, by steps where it has to.
TransferFunction cleared(const TransferFunction& tf, double a, double b) {
    TransferFunction result = tf;
    auto& points = result.points;
    points.clear();
    for (const ControlPoint& p : tf.points)
        if (p.x < a) points.push_back(p);
    if (a > 0) {
        const ControlPoint end = leftOf(tf, a);
        const bool descends = !points.empty() && points.back().opacity > 0;
        if (end.opacity > 0 || descends || anyEndsAt(tf, a)) points.push_back(end);
        if (end.opacity > 0) points.push_back(bottomAt(end));
    }
    if (b < 1) {
        const ControlPoint start = rightOf(tf, b);
        const std::size_t next = pointsAt(tf.points, b).last;
        const bool rises = next < tf.points.size() && tf.points[next].opacity > 0;
        if (start.opacity > 0) points.push_back(bottomAt(start));
        if (start.opacity > 0 || rises || anyStartsAt(tf, b)) points.push_back(start);
        points.insert(points.end(), tf.points.begin() + static_cast<std::ptrdiff_t>(next), tf.points.end());
    }
    return result;
}

/// The feature's own points, the first at a, the last at b.
std::vector<ControlPoint> lifted(const TransferFunction& tf, int feature) {
    const Feature& f = at(tf, feature);
    std::vector<ControlPoint> shape;
    std::vector<ControlPoint> start, end;
    for (const int i : pointsOfFeature(tf, feature)) {
        const ControlPoint& p = tf.points[static_cast<std::size_t>(i)];
        (p.x == f.a ? start : p.x == f.b ? end : shape).push_back(p);
    }
    // At an end two points say everything: the feature's own side, and a bottom at which it begins or ends by a step.
    if (start.empty()) start.push_back(rightOf(tf, f.a));
    if (start.size() > 1) start = {start.front(), start.back()};
    if (start.size() > 1 && start.front().opacity > 0) start.erase(start.begin());
    if (end.empty()) end.push_back(leftOf(tf, f.b));
    if (end.size() > 1) end = {end.front(), end.back()};
    if (end.size() > 1 && end.back().opacity > 0) end.pop_back();
    shape.insert(shape.begin(), start.begin(), start.end());
    shape.insert(shape.end(), end.begin(), end.end());
    return shape;
}

/// `tf` with `shape` over [a, b), where it has no feature.
TransferFunction withSetIn(const TransferFunction& tf, std::vector<ControlPoint> shape, double a, double b) {
    // Intensities 0 and 1 belong to the feature: there is nothing beyond, to which it would have to fall.
    if (a <= 0 && shape.size() > 2 && shape[1].x == a && shape[0].opacity == 0) shape.erase(shape.begin());
    if (b >= 1 && shape.size() > 2 && shape[shape.size() - 2].x == b && shape.back().opacity == 0) shape.pop_back();
    TransferFunction result = cleared(tf, a, b);
    auto& points = result.points;
    const auto insertAt = [&](std::size_t place, const ControlPoint& p) {
        points.insert(points.begin() + static_cast<std::ptrdiff_t>(place), p);
    };
    const auto eraseAt = [&](std::size_t place) { points.erase(points.begin() + static_cast<std::ptrdiff_t>(place)); };

    const Group before = pointsAt(points, a);
    std::size_t place = before.last;
    if (a > 0) {
        if (before.empty() && shape.front().opacity > 0) insertAt(place++, bottomAt(shape.front()));
        if (!before.empty() && shape.front().opacity == 0 && points[place - 1].opacity == 0 && !anyEndsAt(tf, a))
            eraseAt(--place);
    }
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(place), shape.begin(), shape.end());
    place += shape.size();
    if (b < 1) {
        const bool any = place < points.size() && points[place].x == b;
        if (!any && shape.back().opacity > 0) insertAt(place, bottomAt(shape.back()));
        if (any && shape.back().opacity == 0 && points[place].opacity == 0 && !anyStartsAt(tf, b)) eraseAt(place);
    }
    return result;
}

/// Takes the feature out: the rest, in which it is still listed but meets nothing.
TransferFunction withoutShape(const TransferFunction& tf, int feature) {
    const Feature& f = at(tf, feature);
    TransferFunction others = tf;
    others.features.erase(others.features.begin() + feature);
    return cleared(others, f.a, f.b);
}

/// The feature's own points, mapped affinely to [a, b].
std::vector<ControlPoint> liftedTo(const TransferFunction& tf, int feature, double a, double b) {
    const Feature& f = at(tf, feature);
    std::vector<ControlPoint> shape = lifted(tf, feature);
    for (ControlPoint& p : shape) p.x = p.x == f.b ? b : std::clamp(a + (p.x - f.a) * ((b - a) / (f.b - f.a)), a, b);
    return shape;
}

/// The feature with `shape` in place of its own, and the interval [a, b).
TransferFunction withFeatureReplaced(const TransferFunction& tf, int feature, std::vector<ControlPoint> shape, double a,
                                     double b) {
    TransferFunction result = withSetIn(withoutShape(tf, feature), std::move(shape), a, b);
    Feature placed = at(tf, feature);
    placed.a = a;
    placed.b = b;
    result.features.insert(result.features.begin() + feature, placed);
    result.validate();
    return result;
}

TransferFunction withFeaturePlaced(const TransferFunction& tf, int feature, double a, double b) {
    if (a == at(tf, feature).a && b == at(tf, feature).b) return tf;
    return withFeatureReplaced(tf, feature, liftedTo(tf, feature, a, b), a, b);
}

std::string freshName(const TransferFunction& tf, const std::string& base) {
    const auto taken = [&](const std::string& text) {
        return std::ranges::find(tf.features, text, &Feature::name) != tf.features.end();
    };
    if (!taken(base)) return base;
    for (int i = 2;; ++i)
        if (const std::string text = base + " " + std::to_string(i); !taken(text)) return text;
}

/// How many of `counts` (a histogram over [0,1]) lie in [a, b); within a bin they are spread evenly.
double countedIn(std::span<const std::uint64_t> counts, double a, double b) {
    const auto bins = static_cast<double>(counts.size());
    double sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double lo = static_cast<double>(i) / bins, hi = static_cast<double>(i + 1) / bins;
        const double part = (std::min(b, hi) - std::max(a, lo)) * bins;
        if (part > 0) sum += part * static_cast<double>(counts[i]);
    }
    return sum;
}

/// `tf`, which has the feature's shape, with the feature in its place among the others.
AddedFeature withFeatureListed(const TransferFunction& tf, const Feature& feature) {
    AddedFeature added{tf, 0};
    std::vector<Feature>& features = added.tf.features;
    const auto place = std::ranges::find_if(features, [&](const Feature& other) { return other.a > feature.a; });
    added.index = static_cast<int>(place - features.begin());
    features.insert(place, feature);
    added.tf.validate();
    return added;
}

/// The intervals that no feature has, ascending.
std::vector<ValueRange> gaps(const TransferFunction& tf) {
    std::vector<ValueRange> taken;
    for (const Feature& f : tf.features) taken.push_back({f.a, f.b});
    std::ranges::sort(taken, {}, &ValueRange::lo);
    std::vector<ValueRange> free;
    double from = 0;
    for (const ValueRange& t : taken) {
        if (t.lo > from) free.push_back({from, t.lo});
        from = t.hi;
    }
    if (from < 1) free.push_back({from, 1});
    return free;
}

double gaussian(double z) {
    static const double kEnd = std::exp(-4.5);
    return std::max(0.0, (std::exp(-z * z / 2) - kEnd) / (1 - kEnd));
}

/// Appends where the chords of the Gaussian end, within (u, v]; z = 3u.
void halve(double u, double v, std::vector<double>& ends) {
    double error = 0;
    for (int i = 1; i < 16; ++i) {
        const double t = i / 16.0;
        const double chord = gaussian(3 * u) * (1 - t) + gaussian(3 * v) * t;
        error = std::max(error, std::abs(gaussian(3 * (u + (v - u) * t)) - chord));
    }
    if (error > 0.9 * kGaussianTolerance) { // the samples may miss the very largest
        halve(u, (u + v) / 2, ends);
        halve((u + v) / 2, v, ends);
    } else {
        ends.push_back(v);
    }
}

} // namespace

std::vector<ControlPoint> pointsOfShape(const Shape& shape) {
    const double mode = shape.a + std::clamp(shape.top, 0.0, 1.0) * (shape.b - shape.a);
    std::vector<ControlPoint> points;
    const auto add = [&](double x, double opacity, bool fixed) {
        points.push_back({std::clamp(x, shape.a, shape.b), opacity, shape.color, fixed, {}});
    };
    add(shape.a, 0, true);
    switch (shape.kind) {
    case ShapeKind::Tent:
        add(mode, shape.peak, false);
        break;
    case ShapeKind::Trapezoid:
        add((shape.a + mode) / 2, shape.peak, false);
        add((mode + shape.b) / 2, shape.peak, false);
        break;
    case ShapeKind::Gaussian: {
        std::vector<double> ends; // of one half, from the peak outwards
        halve(0, 1, ends);
        ends.pop_back();
        for (auto u = ends.rbegin(); u != ends.rend(); ++u)
            add(mode - *u * (mode - shape.a), shape.peak * gaussian(3 * *u), false);
        add(mode, shape.peak, false);
        for (const double u : ends) add(mode + u * (shape.b - mode), shape.peak * gaussian(3 * u), false);
        break;
    }
    case ShapeKind::Ramp:
        add(shape.b, shape.peak, false);
        break;
    case ShapeKind::Step:
        add(shape.a, shape.peak, false);
        add(shape.b, shape.peak, false);
        break;
    }
    add(shape.b, 0, true);
    return points;
}

AddedFeature withShapeAdded(const TransferFunction& tf, const Shape& shape) {
    if (!(shape.a >= 0) || !(shape.b <= 1) || !(shape.b - shape.a >= kSmallestFeature))
        throw Error("a shape needs 0 <= a < b <= 1", "", "widen it");
    if (!(shape.peak >= 0) || !(shape.peak <= 1)) throw Error("a peak lies in [0,1]", "", "correct it");
    for (const Feature& f : tf.features)
        if (std::max(f.a, shape.a) < std::min(f.b, shape.b))
            throw Error("the shape would overlap the feature '" + f.name + "'", "", "narrow one of them");
    Feature feature;
    feature.name = shape.name.empty() ? freshName(tf, name(shape.kind)) : shape.name;
    feature.a = shape.a;
    feature.b = shape.b;
    feature.color = shape.color;
    return withFeatureListed(withSetIn(tf, pointsOfShape(shape), shape.a, shape.b), feature);
}

std::vector<int> pointsOfFeature(const TransferFunction& tf, int feature) {
    const Feature& f = at(tf, feature);
    const Group starts = pointsAt(tf.points, f.a), ends = pointsAt(tf.points, f.b);
    const bool touchesBelow = anyEndsAt(tf, f.a), touchesAbove = anyStartsAt(tf, f.b);
    std::vector<int> own;
    for (std::size_t i = starts.first; i < ends.last; ++i) {
        const double x = tf.points[i].x;
        if (x == f.a && touchesBelow && starts.last - starts.first > 1 && i == starts.first) continue;
        if (x == f.b && touchesAbove && (ends.last - ends.first == 1 || i != ends.first)) continue;
        own.push_back(static_cast<int>(i));
    }
    return own;
}

int featureWithId(const TransferFunction& tf, FeatureId id) {
    const auto found = std::ranges::find(tf.features, id, &Feature::id);
    return id == 0 || found == tf.features.end() ? -1 : static_cast<int>(found - tf.features.begin());
}

int nextFeature(const TransferFunction& tf, int feature) {
    int next = -1;
    for (int i = 0; i < static_cast<int>(tf.features.size()); ++i)
        if (at(tf, i).a >= at(tf, feature).b && (next < 0 || at(tf, i).a < at(tf, next).a)) next = i;
    return next;
}

int previousFeature(const TransferFunction& tf, int feature) {
    int previous = -1;
    for (int i = 0; i < static_cast<int>(tf.features.size()); ++i)
        if (at(tf, i).b <= at(tf, feature).a && (previous < 0 || at(tf, i).b > at(tf, previous).b)) previous = i;
    return previous;
}

namespace {

/// What the feature may reach: up to its neighbours and the ends of the axis.
ValueRange reach(const TransferFunction& tf, int feature) {
    const int below = previousFeature(tf, feature), above = nextFeature(tf, feature);
    return {below < 0 ? 0.0 : at(tf, below).b, above < 0 ? 1.0 : at(tf, above).a};
}

} // namespace

TransferFunction withFeatureMoved(const TransferFunction& tf, int feature, double dx) {
    const Feature& f = at(tf, feature);
    const ValueRange limits = reach(tf, feature);
    if (dx <= limits.lo - f.a) return withFeaturePlaced(tf, feature, limits.lo, limits.lo + (f.b - f.a));
    if (dx >= limits.hi - f.b) return withFeaturePlaced(tf, feature, limits.hi - (f.b - f.a), limits.hi);
    return withFeaturePlaced(tf, feature, f.a + dx, f.b + dx);
}

TransferFunction withFeatureWidened(const TransferFunction& tf, int feature, double a, double b) {
    const Feature& f = at(tf, feature);
    const ValueRange limits = reach(tf, feature);
    if (a > b) std::swap(a, b);
    a = std::clamp(a, limits.lo, limits.hi);
    b = std::clamp(b, limits.lo, limits.hi);
    const double least = std::min(kSmallestFeature, f.b - f.a);
    if (b - a < least) {
        // The end that stays stays.
        if (b == f.b)
            a = std::max(limits.lo, b - least);
        else
            a = std::min(a, limits.hi - least);
        b = std::min(limits.hi, a + least);
    }
    return withFeaturePlaced(tf, feature, a, b);
}

TransferFunction withFeatureKind(const TransferFunction& tf, int feature, ShapeKind kind) {
    const Feature f = at(tf, feature);
    Shape shape{kind, f.a, f.b, featureOpacities(tf).at(static_cast<std::size_t>(feature)), f.color, f.name};
    // The middle of what is as high as it gets.
    double first = 2, last = -1;
    for (const ControlPoint& p : lifted(tf, feature)) {
        if (p.opacity < shape.peak * (1 - 1e-9)) continue;
        first = std::min(first, p.x);
        last = std::max(last, p.x);
    }
    if (last > f.a && first < f.b && first < 2) shape.top = ((first + last) / 2 - f.a) / (f.b - f.a);
    if (shape.top <= 0 || shape.top >= 1) shape.top = 0.5;
    return withFeatureReplaced(tf, feature, pointsOfShape(shape), f.a, f.b);
}

ValueRange roomFor(const TransferFunction& tf, double width, double near) {
    std::optional<ValueRange> best;
    double distance = std::numeric_limits<double>::infinity();
    const std::vector<ValueRange> free = gaps(tf);
    for (const ValueRange& gap : free) {
        if (gap.hi - gap.lo < width) continue;
        const double a = std::clamp(near - width / 2, gap.lo, gap.hi - width);
        const double away = std::abs(a + width / 2 - near);
        if (away >= distance) continue;
        distance = away;
        best = ValueRange{a, std::min(a + width, gap.hi)};
    }
    if (best) return *best;
    for (const ValueRange& gap : free)
        if (!best || gap.hi - gap.lo > best->hi - best->lo) best = gap;
    if (!best || best->hi - best->lo < kSmallestGap)
        throw Error("there is no room between the features", "", "narrow, merge or remove one");
    return *best;
}

AddedFeature withFeatureDuplicated(const TransferFunction& tf, int feature) {
    const Feature f = at(tf, feature);
    const double width = f.b - f.a;
    const ValueRange room = roomFor(tf, width, f.b + width / 2); // beside it, rather above
    std::vector<ControlPoint> shape = liftedTo(tf, feature, room.lo, room.hi);
    for (ControlPoint& p : shape) p.extraJson.clear();
    Feature copy = f;
    copy.id = 0;
    copy.hidden = false; // one wants to see what one has made
    copy.extraJson.clear();
    copy.name = freshName(tf, f.name);
    copy.a = room.lo;
    copy.b = room.hi;
    return withFeatureListed(withSetIn(tf, std::move(shape), room.lo, room.hi), copy);
}

TransferFunction withFeatureSplit(const TransferFunction& tf, int feature, double place,
                                  std::span<const std::uint64_t> counts) {
    const Feature f = at(tf, feature);
    const ValueRange values = tf.range.value_or(ValueRange{0, 1});
    const std::string border = numberText(values.lo + place * (values.hi - values.lo), values.hi - values.lo);
    if (!(place - f.a >= kSmallestFeature) || !(f.b - place >= kSmallestFeature))
        throw Error("the feature '" + f.name + "' cannot be split at " + border, "", "choose a value well inside it");
    const double below = countedIn(counts, f.a, place), above = countedIn(counts, place, f.b);
    if (!counts.empty() && !(std::min(below, above) >= kSmallestPart * (below + above)))
        throw Error("almost no voxel of '" + f.name + "' would lie " + (below < above ? "below " : "above ") + border,
                    "", "choose another value");
    TransferFunction result = tf;
    const Group group = pointsAt(result.points, place);
    ControlPoint left = leftOf(tf, place), right = rightOf(tf, place);
    if (group.last - group.first < 2) {
        right.extraJson.clear();
        auto& points = result.points;
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(group.first),
                     points.begin() + static_cast<std::ptrdiff_t>(group.last));
        points.insert(points.begin() + static_cast<std::ptrdiff_t>(group.first), {left, right});
    }
    const bool ofOneColor = std::ranges::all_of(
        pointsOfFeature(tf, feature), [&](int i) { return tf.points[static_cast<std::size_t>(i)].color == f.color; });
    const auto [lowerName, upperName] = namesOfParts(f.name, border);
    at(result, feature).b = place;
    at(result, feature).name = freshName(tf, lowerName);
    Feature upper = f;
    upper.id = 0;
    upper.extraJson.clear();
    upper.name = freshName(tf, upperName);
    upper.a = place;
    result.features.insert(result.features.begin() + feature + 1, upper);
    if (ofOneColor) {
        std::vector<Rgb> present;
        for (const Feature& other : tf.features) present.push_back(other.color);
        result = withFeatureColor(result, feature + 1, colorApartFrom(present));
    }
    result.validate();
    return result;
}

double splitPlace(const Feature& feature, std::span<const std::uint64_t> counts) {
    const double middle = (feature.a + feature.b) / 2;
    const auto bins = static_cast<double>(counts.size());
    if (counts.empty()) return middle;
    const auto first = static_cast<std::size_t>(std::ceil(feature.a * bins - 1e-9));
    const auto last = std::min(counts.size(), static_cast<std::size_t>(std::floor(feature.b * bins + 1e-9)));
    if (last < first + 3) return middle;
    const double all = countedIn(counts, feature.a, feature.b);
    const auto leavesBoth = [&](double place) {
        const double below = countedIn(counts, feature.a, place);
        return std::min(below, all - below) >= kSmallestPart * all;
    };
    // A valley is as deep as the lower one of the highest counts on its two sides is above it, in logarithms, so that
    // few voxels beside many count; three bins at a time against noise.
    std::vector<double> height;
    for (std::size_t i = first; i < last; ++i) {
        double sum = 0;
        int n = 0;
        for (std::size_t j = i > first ? i - 1 : i; j < std::min(last, i + 2); ++j, ++n)
            sum += static_cast<double>(counts[j]);
        height.push_back(std::log1p(sum / n));
    }
    std::vector<double> above(height.size());
    double most = 0;
    for (std::size_t i = height.size(); i-- > 0;) above[i] = most = std::max(most, height[i]);
    double depth = 0.05;                   // about 5 %: less is noise
    std::size_t bottom = 0, bottomEnd = 0; // the bins of the bottom
    most = 0;
    for (std::size_t i = 0; i < height.size(); ++i) {
        most = std::max(most, height[i]);
        const double here = std::min(most, above[i]) - height[i];
        if (here < depth || !leavesBoth((static_cast<double>(first + i) + 0.5) / bins)) continue;
        if (here > depth) {
            depth = here;
            bottom = bottomEnd = i;
        } else if (bottomEnd + 1 == i) {
            bottomEnd = i;
        }
    }
    double place = middle;
    if (bottom > 0) {
        place = (static_cast<double>(first) + static_cast<double>(bottom + bottomEnd + 1) / 2) / bins;
    } else if (!leavesBoth(middle)) {
        double below = 0, smaller = -1;
        for (std::size_t i = first; i + 1 < last; ++i) {
            below += static_cast<double>(counts[i]);
            if (std::min(below, all - below) > smaller) {
                smaller = std::min(below, all - below);
                place = static_cast<double>(i + 1) / bins;
            }
        }
    }
    return std::clamp(place, feature.a + kSmallestFeature, feature.b - kSmallestFeature);
}

AddedFeature withFeaturesMerged(const TransferFunction& tf, int feature) {
    const int next = nextFeature(tf, feature);
    if (next < 0)
        throw Error("there is no feature above '" + at(tf, feature).name + "'", "", "choose the lower one of two");
    const Feature &low = at(tf, feature), &high = at(tf, next);
    Feature merged = high.b - high.a > low.b - low.a ? high : low;
    merged.name = nameOfWhole(low.name, high.name);
    merged.a = low.a;
    merged.b = high.b;
    AddedFeature result{tf, feature};
    at(result.tf, feature) = merged;
    result.tf.features.erase(result.tf.features.begin() + next);
    if (next < feature) --result.index;
    result.tf.validate();
    return result;
}

TransferFunction withFeatureRemoved(const TransferFunction& tf, int feature) {
    TransferFunction result = withoutShape(tf, feature);
    result.validate();
    return result;
}

TransferFunction withFeatureHidden(const TransferFunction& tf, int feature, bool hidden) {
    TransferFunction result = tf;
    at(result, feature).hidden = hidden;
    return result;
}

TransferFunction withOthersHidden(const TransferFunction& tf, int feature) {
    TransferFunction result = tf;
    for (Feature& f : result.features) f.hidden = true;
    at(result, feature).hidden = false;
    return result;
}

TransferFunction withAllShown(const TransferFunction& tf) {
    TransferFunction result = tf;
    for (Feature& f : result.features) f.hidden = false;
    return result;
}

} // namespace pellucid
