#include "render/gl/slice_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "base/error.h"

namespace pellucid::gl {

namespace {

constexpr int kMaxSlabs = 1'000'000;

struct Box {
    Vec3 lo, hi;
    Vec3 corner(int i) const {
        return {(i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y, (i & 4) != 0 ? hi.z : lo.z};
    }
};

Box clippedBox(const Geometry& g, const RenderSettings& settings) {
    const Vec3 size = g.boundsMax() - g.boundsMin();
    return {g.boundsMin() + size * settings.clipping.lo, g.boundsMin() + size * settings.clipping.hi};
}

/// Andrew's monotone chain, counter-clockwise; fewer than three corners where the points lie on a line.
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
    const auto less = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
    std::sort(points.begin(), points.end(), less);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return {};
    const auto turn = [](const glm::dvec2& o, const glm::dvec2& a, const glm::dvec2& b) {
        return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    };
    std::vector<glm::dvec2> hull;
    const auto chain = [&](auto first, auto last) {
        const std::size_t start = hull.size();
        for (auto p = first; p != last; ++p) {
            while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
            hull.push_back(*p);
        }
        hull.pop_back(); // the next chain begins with it
    };
    chain(points.begin(), points.end());
    chain(points.rbegin(), points.rend());
    return hull.size() < 3 ? std::vector<glm::dvec2>{} : hull;
}

constexpr std::array<std::array<int, 2>, 12> kEdges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Largest length of a ray per unit of depth, over the rays that meet box and picture.
double largestStretch(const SliceView& view, const Box& box, double nearDepth) {
    if (!view.perspective) return 1;
    const double picture = std::sqrt(1 + glm::dot(view.halfExtent, view.halfExtent));
    if (view.depthOf(box.corner(0)) <= view.eyeDepth) return picture;
    double corners = 1;
    for (int i = 0; i < 8; ++i) {
        const double ahead = view.depthOf(box.corner(i)) - view.eyeDepth;
        if (ahead <= 0 || nearDepth <= view.eyeDepth) return picture;
        corners = std::max(corners, glm::length(box.corner(i) - view.camera.eye) / ahead);
    }
    return std::min(picture, corners);
}

} // namespace

SliceView::SliceView(const Camera& c, const Geometry& geometry, const RenderSettings& settings)
    : perspective(c.projection == Projection::Perspective), camera(c) {
    const Box box = clippedBox(geometry, settings);
    middle = 0.5 * (box.lo + box.hi);
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const double half = perspective ? std::tan(c.fovY * std::acos(-1.0) / 360) : 0.5 * c.height;
    halfExtent = {half * aspect, half};
    eyeDepth = depthOf(c.eye);
}

double SliceView::depthOf(const Vec3& world) const { return glm::dot(world - middle, camera.forward()); }

glm::dvec2 SliceView::pictureFromWorld(const Vec3& world) const {
    const Vec3 d = world - camera.eye;
    const glm::dvec2 across(glm::dot(d, camera.right()), glm::dot(d, camera.trueUp()));
    return across / halfExtent / (perspective ? glm::dot(d, camera.forward()) : 1.0);
}

glm::dmat3 SliceView::rayOrigin(const Geometry& g) const {
    const double scale = perspective ? -eyeDepth : 1.0; // depth 0 is that far from the eye
    const Vec3 size = g.boundsMax() - g.boundsMin();
    // The view's axis pierces the plane of depth 0 here.
    const Vec3 axis = camera.eye - eyeDepth * camera.forward();
    return {camera.right() * (halfExtent.x * scale) / size, camera.trueUp() * (halfExtent.y * scale) / size,
            (axis - g.boundsMin()) / size};
}

glm::dmat3 SliceView::rayDirection(const Geometry& g) const {
    const Vec3 size = g.boundsMax() - g.boundsMin();
    const double spread = perspective ? 1.0 : 0.0;
    return {camera.right() * (halfExtent.x * spread) / size, camera.trueUp() * (halfExtent.y * spread) / size,
            camera.forward() / size};
}

std::vector<SlabVertex> slabTriangles(const SliceView& view, const Geometry& geometry, const RenderSettings& settings,
                                      const Vec3& partLo, const Vec3& partHi) {
    Box box = clippedBox(geometry, settings);
    const auto depthsOf = [&](const Box& b) {
        std::array<double, 8> depths{};
        for (int i = 0; i < 8; ++i) depths[static_cast<std::size_t>(i)] = view.depthOf(b.corner(i));
        return depths;
    };
    std::array<double, 8> depth = depthsOf(box);
    double nearest = *std::min_element(depth.begin(), depth.end());
    const double farthest = *std::max_element(depth.begin(), depth.end());
    // A wide box may reach behind the eye; what is nearer than this is thinner than any sample.
    if (view.perspective) nearest = std::max(nearest, view.eyeDepth + 1e-3 * geometry.d0());
    if (!(farthest > nearest)) return {};

    const double step = settings.stepInD0 * geometry.d0() / largestStretch(view, box, nearest);
    const double slabs = std::ceil((farthest - nearest) / step - 1e-9);
    if (!(slabs <= kMaxSlabs)) throw Error("the picture needs over a million slices", "step", "make the step longer");
    const int count = std::max(1, static_cast<int>(slabs));
    const double thickness = (farthest - nearest) / count;

    const Vec3 origin = geometry.boundsMin(), size = geometry.boundsMax() - origin;
    box = {glm::max(box.lo, origin + size * partLo), glm::min(box.hi, origin + size * partHi)};
    if (!glm::all(glm::lessThan(box.lo, box.hi))) return {};
    depth = depthsOf(box);
    const auto [partNear, partFar] = std::minmax_element(depth.begin(), depth.end());
    const auto slabOf = [&](double d) {
        return static_cast<int>(std::clamp((d - nearest) / thickness, 0.0, count - 1.0));
    };
    const int firstSlab = slabOf(*partNear), lastSlab = slabOf(*partFar);

    std::vector<SlabVertex> vertices;
    std::vector<glm::dvec2> points;
    for (int slab = firstSlab; slab <= lastSlab; ++slab) {
        const double from = nearest + slab * thickness, to = slab + 1 == count ? farthest : from + thickness;
        points.clear();
        for (std::size_t i = 0; i < 8; ++i)
            if (depth[i] >= from && depth[i] <= to)
                points.push_back(view.pictureFromWorld(box.corner(static_cast<int>(i))));
        for (const auto& [p, q] : kEdges) {
            const double dp = depth[static_cast<std::size_t>(p)], dq = depth[static_cast<std::size_t>(q)];
            for (const double plane : {from, to})
                if ((dp - plane) * (dq - plane) < 0) {
                    const double w = (plane - dp) / (dq - dp);
                    points.push_back(view.pictureFromWorld(glm::mix(box.corner(p), box.corner(q), w)));
                }
        }
        const auto hull = convexHull(points);
        const auto vertex = [&](const glm::dvec2& p) {
            return SlabVertex{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(from),
                              static_cast<float>(to)};
        };
        for (std::size_t i = 2; i < hull.size(); ++i) {
            vertices.push_back(vertex(hull[0]));
            vertices.push_back(vertex(hull[i - 1]));
            vertices.push_back(vertex(hull[i]));
        }
    }
    return vertices;
}

} // namespace pellucid::gl
