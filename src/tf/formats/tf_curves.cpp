#include "tf/formats/tf_curves.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "tf/lch.h"

namespace pellucid {

namespace {

constexpr int kDeepest = 8; ///< halvings between two nodes

/// The first half of the way up to the midpoint, the second behind it.
double throughMidpoint(double t, double midpoint) {
    const double middle = std::clamp(midpoint, 1e-5, 1 - 1e-5);
    return t < middle ? 0.5 * t / middle : 0.5 + 0.5 * (t - middle) / (1 - middle);
}

double compressed(double t, double sharpness) {
    const double power = 1 + 10 * sharpness;
    return t < 0.5 ? 0.5 * std::pow(2 * t, power) : 1 - 0.5 * std::pow(2 * (1 - t), power);
}

/// Where the way is at t of the distance, as a part of itself; curves that are no Hermite ones need no more.
double partOfWay(double t, const CurveShape& shape) {
    const double s = throughMidpoint(t, shape.midpoint);
    if (shape.isStep()) return s < 0.5 ? 0 : 1;
    return shape.sharpness < 0.01 ? s : compressed(s, shape.sharpness);
}

/// From p to q at partOfWay() `s`.
double valueAt(double p, double q, double s, const CurveShape& shape) {
    if (s <= 0 || shape.isStep() || shape.sharpness < 0.01) return (1 - s) * p + s * q;
    const double s2 = s * s, s3 = s2 * s, slope = (1 - shape.sharpness) * (q - p);
    const double value =
        (2 * s3 - 3 * s2 + 1) * p + (3 * s2 - 2 * s3) * q + (s3 - 2 * s2 + s) * slope + (s3 - s2) * slope;
    return std::clamp(value, std::min(p, q), std::max(p, q));
}

double scaled(const TfCurves& curves, double x) { return curves.isLogarithmic ? std::log10(x) : x; }
double unscaled(const TfCurves& curves, double u) { return curves.isLogarithmic ? std::pow(10, u) : u; }

/// The way between two neighbours of a curve that holds at `u`; both are the same beyond the ends.
template <class Node>
struct Way {
    const Node *from, *to;
    double begin = 0, end = 0;
    double partAt(double u) const { return end > begin ? std::clamp((u - begin) / (end - begin), 0.0, 1.0) : 0; }
};

template <class Node>
Way<Node> wayAt(const TfCurves& curves, const std::vector<Node>& nodes, double u) {
    const auto next = std::ranges::upper_bound(nodes, u, {}, [&](const Node& n) { return scaled(curves, n.x); });
    const Node* to = next == nodes.end() ? &nodes.back() : &*next;
    const Node* from = next == nodes.begin() ? to : &*(next - 1);
    return {from, to, scaled(curves, from->x), scaled(curves, to->x)};
}

/// Both curves between two places without a node, step or midpoint between them.
class Piece {
public:
    Piece(const TfCurves& curves, double begin, double end) : m_curves(curves), m_middle((begin + end) / 2) {
        if (!curves.opacities.empty()) m_opacity = wayAt(curves, curves.opacities, m_middle);
        if (!curves.colors.empty()) {
            m_color = wayAt(curves, curves.colors, m_middle);
            m_colorWay = std::make_unique<ColorWay>(m_color.from->color, m_color.to->color, curves.space);
        }
    }

    /// Steps are at the ends of a piece: within, they have one value.
    double opacity(double u) const {
        if (m_opacity.from == nullptr) return 0;
        const CurveShape& shape = m_opacity.from->shape;
        const double t = m_opacity.partAt(shape.isStep() ? m_middle : u);
        return valueAt(m_opacity.from->opacity, m_opacity.to->opacity, partOfWay(t, shape), shape);
    }

    Rgb color(double u) const {
        if (m_color.from == nullptr) return {1, 1, 1};
        const CurveShape& shape = m_color.from->shape;
        const bool isStep = m_curves.space == ColorSpace::Step || shape.isStep();
        const double s = partOfWay(m_color.partAt(isStep ? m_middle : u), shape);
        if (m_curves.space == ColorSpace::Step) return m_color.to->color;
        if (m_curves.space != ColorSpace::Rgb || isStep) return m_colorWay->at(s);
        const Rgb &p = m_color.from->color, &q = m_color.to->color;
        return {valueAt(p.r, q.r, s, shape), valueAt(p.g, q.g, s, shape), valueAt(p.b, q.b, s, shape)};
    }

    bool isStraight() const {
        const auto straight = [](const auto& way) {
            return way.from == nullptr || way.from == way.to || way.from->shape.sharpness < 0.01 ||
                   way.from->shape.isStep();
        };
        const bool rgb =
            m_curves.space == ColorSpace::Rgb || m_curves.space == ColorSpace::Step || m_color.from == m_color.to;
        return straight(m_opacity) && straight(m_color) && rgb && !m_curves.isLogarithmic;
    }

    ControlPoint point(double u) const {
        const double alpha = opacity(u);
        return {unscaled(m_curves, u), alpha, color(u), alpha == 0, {}};
    }

private:
    const TfCurves& m_curves;
    double m_middle;
    Way<OpacityNode> m_opacity{nullptr, nullptr};
    Way<ColorNode> m_color{nullptr, nullptr};
    std::unique_ptr<ColorWay> m_colorWay;
};

/// Whether the straight line from p to q stays close to the piece, which has `from` and `to` there.
bool isClose(const Piece& piece, double from, double to, const ControlPoint& p, const ControlPoint& q) {
    constexpr int kProbes = 8;
    for (int n = 1; n < kProbes; ++n) {
        const ControlPoint at = piece.point(from + (to - from) * n / kProbes);
        const double t = (at.x - p.x) / (q.x - p.x);
        const auto mix = [t](double a, double b) { return a + (b - a) * t; };
        if (std::abs(mix(p.opacity, q.opacity) - at.opacity) > kOpacityTolerance) return false;
        const Rgb color{mix(p.color.r, q.color.r), mix(p.color.g, q.color.g), mix(p.color.b, q.color.b)};
        if (deltaE(labFromSrgb(color), labFromSrgb(at.color)) > 0.8 * kCurveTolerance) return false;
    }
    return true;
}

void follow(const Piece& piece, double from, double to, int depth, std::vector<ControlPoint>& points) {
    const double middle = (from + to) / 2;
    if (depth == 0 || points.size() >= kMostNodes || isClose(piece, from, to, piece.point(from), piece.point(to)) ||
        middle <= from || middle >= to)
        return;
    follow(piece, from, middle, depth - 1, points);
    points.push_back(piece.point(middle));
    follow(piece, middle, to, depth - 1, points);
}

template <class Node>
void addBreaks(const TfCurves& curves, const std::vector<Node>& nodes, bool bendsAtMidpoint,
               std::vector<double>& breaks) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double u = scaled(curves, nodes[i].x);
        breaks.push_back(u);
        if (i + 1 == nodes.size() || (nodes[i].shape.isStraight() && !bendsAtMidpoint)) continue;
        breaks.push_back(u + nodes[i].shape.midpoint * (scaled(curves, nodes[i + 1].x) - u));
    }
}

/// Where the curves bend or jump, in the scale in which they are mixed.
std::vector<double> breaksOf(const TfCurves& curves, const ValueRange& range) {
    std::vector<double> breaks{scaled(curves, range.lo), scaled(curves, range.hi)};
    addBreaks(curves, curves.opacities, false, breaks);
    addBreaks(curves, curves.colors, curves.space == ColorSpace::Diverging, breaks);
    const double lo = breaks[0], hi = breaks[1];
    std::erase_if(breaks, [&](double u) { return u < lo || u > hi; });
    std::ranges::sort(breaks);
    // std::ranges::unique of GCC 12 is beyond clang 14, which builds the fuzz targets.
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    return breaks;
}

bool sameValues(const ControlPoint& p, const ControlPoint& q) { return p.opacity == q.opacity && p.color == q.color; }

template <class Node>
void keepLast(std::vector<Node>& nodes) {
    std::vector<Node> kept;
    for (const Node& n : nodes) {
        if (!kept.empty() && kept.back().x == n.x) kept.pop_back();
        kept.push_back(n);
    }
    nodes = std::move(kept);
}

/// The piece at a single place.
Piece pieceAt(const TfCurves& curves, double x) { return {curves, scaled(curves, x), scaled(curves, x)}; }

} // namespace

void TfCurves::sort() {
    std::ranges::stable_sort(colors, {}, &ColorNode::x);
    std::ranges::stable_sort(opacities, {}, &OpacityNode::x);
}

void TfCurves::keepLastOfEach() {
    keepLast(colors);
    keepLast(opacities);
}

ValueRange TfCurves::range() const {
    if (colors.empty() && opacities.empty()) return {0, 0};
    if (colors.empty()) return {opacities.front().x, opacities.back().x};
    if (opacities.empty()) return {colors.front().x, colors.back().x};
    return {std::min(colors.front().x, opacities.front().x), std::max(colors.back().x, opacities.back().x)};
}

double opacityAt(const TfCurves& curves, double x) { return pieceAt(curves, x).opacity(scaled(curves, x)); }
Rgb colorAt(const TfCurves& curves, double x) { return pieceAt(curves, x).color(scaled(curves, x)); }

CurvePoints pointsOf(const TfCurves& curves, const ValueRange& range) {
    CurvePoints result;
    std::vector<ControlPoint>& points = result.points;
    const auto add = [&](const ControlPoint& p) {
        if (points.empty() || points.back().x != p.x || !sameValues(points.back(), p)) points.push_back(p);
    };
    const std::vector<double> breaks = breaksOf(curves, range);
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Piece piece(curves, breaks[i], breaks[i + 1]);
        add(piece.point(breaks[i]));
        if (!piece.isStraight()) {
            const std::size_t before = points.size();
            follow(piece, breaks[i], breaks[i + 1], kDeepest, points);
            result.areResampled = result.areResampled || points.size() > before;
        }
        add(piece.point(breaks[i + 1]));
    }
    // A step at the very end: what holds there and beyond.
    if (!points.empty()) {
        const Piece end = pieceAt(curves, range.hi);
        add(end.point(scaled(curves, range.hi)));
    }
    for (ControlPoint& p : points) p.x = std::clamp((p.x - range.lo) / (range.hi - range.lo), 0.0, 1.0);
    return result;
}

} // namespace pellucid
