#include "tf/formats/opacity_length.h"

#include <algorithm>
#include <cmath>

#include "tf/formats/tf_curves.h"

namespace pellucid {

namespace {

constexpr int kDeepest = 8; ///< halvings between two points

/// Adds what the bent line from p to q needs, both with the opacities that the points had.
void bend(const ControlPoint& p, const ControlPoint& q, double ratio, int depth, std::vector<ControlPoint>& points) {
    const double a = opacityPer(p.opacity, ratio), b = opacityPer(q.opacity, ratio);
    double miss = 0;
    for (const double t : {0.25, 0.5, 0.75})
        miss = std::max(miss, std::abs(a + (b - a) * t - opacityPer(std::lerp(p.opacity, q.opacity, t), ratio)));
    if (depth == 0 || miss <= kOpacityTolerance) return;
    const auto half = [](double from, double to) { return std::lerp(from, to, 0.5); };
    ControlPoint middle{half(p.x, q.x),
                        half(p.opacity, q.opacity),
                        {half(p.color.r, q.color.r), half(p.color.g, q.color.g), half(p.color.b, q.color.b)},
                        p.fixed && q.fixed,
                        {}};
    if (middle.x <= p.x || middle.x >= q.x) return;
    bend(p, middle, ratio, depth - 1, points);
    points.push_back(middle);
    points.back().opacity = opacityPer(middle.opacity, ratio);
    bend(middle, q, ratio, depth - 1, points);
}

} // namespace

Geometry unknownVolume() {
    Geometry geometry;
    geometry.dims = Int3(256);
    return geometry;
}

double OpacityLength::inWorld(const Geometry& geometry) const {
    const Vec3 dims(geometry.dims);
    switch (kind) {
    case Kind::World:
        return value;
    case Kind::ParaView: {
        const Vec3 cells = glm::max(dims - 1.0, Vec3(0)), edges = cells * geometry.spacing;
        double count = 1; // an axis of one voxel has none
        for (int a = 0; a < 3; ++a) count *= std::max(cells[a], 1.0);
        const double diagonal = std::sqrt(edges.x * edges.x + edges.y * edges.y + edges.z * edges.z);
        return diagonal > 0 ? diagonal / std::cbrt(count) : geometry.d0();
    }
    case Kind::Texture: {
        const Vec3 edges = dims * geometry.spacing;
        return value * std::cbrt(edges.x * edges.y * edges.z);
    }
    case Kind::Reference:
        break;
    }
    return geometry.d0();
}

double opacityPer(double alpha, double ratio) {
    if (ratio == 1 || alpha >= 1) return alpha;
    return std::clamp(-std::expm1(ratio * std::log1p(-alpha)), 0.0, 1.0);
}

std::vector<ControlPoint> pointsPer(const std::vector<ControlPoint>& points, double ratio) {
    if (ratio == 1) return points;
    std::vector<ControlPoint> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0 && result.size() < kMostNodes) bend(points[i - 1], points[i], ratio, kDeepest, result);
        result.push_back(points[i]);
        result.back().opacity = opacityPer(points[i].opacity, ratio);
    }
    return result;
}

TransferFunction withOpacitiesPer(const TransferFunction& tf, double ratio) {
    TransferFunction result = tf;
    if (ratio == 1) return result;
    // Where no point lies at an end, the line from there is part of the curve.
    const std::vector<ControlPoint> all = tf.pointsWithEnds();
    result.points = pointsPer(all, ratio);
    if (tf.points.empty() || tf.points.front().x > 0) result.points.erase(result.points.begin());
    if (tf.points.empty() || tf.points.back().x < 1) result.points.pop_back();
    return result;
}

} // namespace pellucid
