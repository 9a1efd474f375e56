#include "render/ruler_marks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/mark_maker.h"

namespace pellucid {

namespace {

constexpr Rgb kInk{1.0, 0.85, 0.30}, kSelectedInk{0.80, 0.91, 1.0}; ///< with a dark halo seen on any ground
constexpr double kPlateAlpha = 0.6;                                 ///< of the plate behind a label
constexpr double kFaint = 0.4;                                      ///< alpha of what lies beside a slice
constexpr double kRing = 3.5;    ///< radius of the ring at an end, lengths of the screen
constexpr double kArc = 0.3;     ///< radius of an angle's arc, of the shorter leg
constexpr int kCircle = 64;      ///< corners of a circle
constexpr double kInSlice = 0.5; ///< voxels from a slice within which a point lies in it
constexpr double kAcross = 0.5;  ///< cosine to a slice's normal from which on a face is not seen from the side

using Line = std::vector<Vec3>; ///< world

/// What is drawn of a ruler, in the world.
struct Shape {
    std::vector<Line> lines, faint;
    std::vector<Vec3> ends;
    bool isEmpty() const { return lines.empty(); }
};

Line circle(const Vec3& center, const Vec3& u, const Vec3& v) {
    Line line;
    for (int n = 0; n <= kCircle; ++n) {
        const double angle = 2 * std::numbers::pi * n / kCircle;
        line.push_back(center + u * std::cos(angle) + v * std::sin(angle));
    }
    return line;
}

/// Between the legs of an angle.
Line arcOf(const Ruler& ruler) {
    const Vec3 corner = ruler.points[1], a = ruler.points[0] - corner, b = ruler.points[2] - corner;
    const double radius = kArc * std::min(glm::length(a), glm::length(b));
    const Vec3 from = glm::normalize(a), to = glm::normalize(b);
    const double whole = std::acos(std::clamp(glm::dot(from, to), -1.0, 1.0));
    Vec3 side = to - from * glm::dot(from, to);
    if (glm::length(side) < 1e-6) return {}; // straight: there is no one side that the arc lies on
    side = glm::normalize(side);
    Line arc;
    for (int n = 0; n <= kCircle / 2; ++n) {
        const double angle = whole * n / (kCircle / 2);
        arc.push_back(corner + (from * std::cos(angle) + side * std::sin(angle)) * radius);
    }
    return arc;
}

/// The legs of an angle, or the one line of a distance.
std::vector<Line> straightLines(const Ruler& ruler) {
    std::vector<Line> lines;
    for (std::size_t n = 0; n + 1 < ruler.points.size(); ++n) lines.push_back({ruler.points[n], ruler.points[n + 1]});
    return lines;
}

Vec3 boxCorner(const Ruler& box, int n) {
    const Vec3 &lo = box.points[0], &hi = box.points[1];
    return {n & 1 ? hi.x : lo.x, n & 2 ? hi.y : lo.y, n & 4 ? hi.z : lo.z};
}

std::vector<Line> boxEdges(const Ruler& box) {
    std::vector<Line> edges;
    for (int axis = 0; axis < 3; ++axis)
        for (int n = 0; n < 8; ++n)
            if ((n >> axis & 1) == 0) edges.push_back({boxCorner(box, n), boxCorner(box, n | 1 << axis)});
    return edges;
}

/// The outline that is seen of a sphere.
Line outlineOf(const Ruler& sphere, const Camera& camera) {
    Vec3 center = sphere.points[0];
    double radius = sphere.radius;
    Vec3 toEye = camera.towardEye(center);
    if (camera.projection == Projection::Perspective) {
        // Where rays from the eye touch it: nearer than the centre, and on a smaller circle.
        const double distance = glm::length(camera.eye - center);
        if (distance <= radius) return {};
        const double sine = radius / distance;
        center += toEye * (radius * sine);
        radius *= std::sqrt(1 - sine * sine);
    }
    const Vec3 u = glm::normalize(glm::cross(camera.trueUp(), toEye)), v = glm::cross(toEye, u);
    return circle(center, u * radius, v * radius);
}

Shape shapeIn(const Ruler& ruler, const Camera& camera) {
    Shape shape;
    switch (ruler.kind) {
    case RulerKind::Distance:
    case RulerKind::Angle:
        shape.lines = straightLines(ruler);
        shape.ends = ruler.points;
        if (ruler.kind == RulerKind::Angle) shape.lines.push_back(arcOf(ruler));
        break;
    case RulerKind::Sphere:
        shape.lines = {outlineOf(ruler, camera)};
        shape.ends = ruler.points;
        break;
    case RulerKind::Box:
        shape.lines = boxEdges(ruler);
        break;
    }
    return shape;
}

/// The plane of a slice in the world.
struct Cut {
    Cut(const Geometry& g, const SlicePlane& slice) : geometry(g), axis(slice.axis), position(slice.position) {
        const Mat3 rows = glm::transpose(g.indexFromWorld());
        normal = glm::normalize(rows[axis]);
        voxelsPerUnit = glm::length(rows[axis]);
        const SliceView view = sliceView(g, axis);
        const Vec3 right = g.directions[view.right] * (view.flipRight ? -1.0 : 1.0);
        u = glm::normalize(right - normal * glm::dot(right, normal));
        v = glm::cross(normal, u);
    }
    double voxelsBefore(const Vec3& world) const { return geometry.voxelFromWorld(world)[axis] - position; }
    bool holds(const Vec3& world) const { return std::abs(voxelsBefore(world)) <= kInSlice; }
    Vec3 onPlane(const Vec3& world) const { return world - normal * (voxelsBefore(world) / voxelsPerUnit); }

    const Geometry& geometry;
    int axis;
    double position;
    Vec3 normal{0}, u{0}, v{0}; ///< unit vectors at right angles; u runs to the right of the picture
    double voxelsPerUnit = 1;   ///< along the normal
};

/// The part of a straight line within half a voxel of the slice; empty: none.
Line partInSlice(const Line& line, const Cut& cut) {
    const double a = cut.voxelsBefore(line[0]), b = cut.voxelsBefore(line[1]);
    double t0 = 0, t1 = 1;
    if (a == b) {
        if (std::abs(a) > kInSlice) return {};
    } else {
        const double first = (-kInSlice - a) / (b - a), second = (kInSlice - a) / (b - a);
        t0 = std::max(0.0, std::min(first, second));
        t1 = std::min(1.0, std::max(first, second));
        if (t0 > t1) return {};
    }
    return {glm::mix(line[0], line[1], t0), glm::mix(line[0], line[1], t1)};
}

struct CutSphere {
    Vec3 center{0};
    double radius = 0; ///< of the circle; < 0: the slice misses it
};
CutSphere cutOf(const Ruler& sphere, const Cut& cut) {
    const Vec3 center = cut.onPlane(sphere.points[0]);
    const Vec3 off = center - sphere.points[0];
    const double rest = sphere.radius * sphere.radius - glm::dot(off, off);
    return {center, rest >= 0 ? std::sqrt(rest) : -1};
}

/// The corners of a box's cut, in order; fewer than three: there is none.
std::vector<Vec3> cutBox(const Ruler& box, const Cut& cut) {
    std::vector<Vec3> corners;
    Vec3 middle(0);
    for (const Line& edge : boxEdges(box)) {
        const double a = cut.voxelsBefore(edge[0]), b = cut.voxelsBefore(edge[1]);
        if (a == b || a * b > 0) continue;
        corners.push_back(glm::mix(edge[0], edge[1], a / (a - b)));
        middle += corners.back();
    }
    if (corners.size() < 3) return {};
    middle /= static_cast<double>(corners.size());
    const auto turn = [&](const Vec3& p) {
        return std::atan2(glm::dot(p - middle, cut.v), glm::dot(p - middle, cut.u));
    };
    std::sort(corners.begin(), corners.end(), [&](const Vec3& a, const Vec3& b) { return turn(a) < turn(b); });
    return corners;
}

Shape shapeIn(const Ruler& ruler, const Cut& cut) {
    Shape shape;
    if (ruler.kind == RulerKind::Sphere) {
        const CutSphere at = cutOf(ruler, cut);
        if (at.radius < 0) return {};
        shape.lines = {circle(at.center, cut.u * at.radius, cut.v * at.radius)};
    } else if (ruler.kind == RulerKind::Box) {
        Line outline = cutBox(ruler, cut);
        if (outline.empty()) return {};
        outline.push_back(outline.front());
        shape.lines = {std::move(outline)};
        return shape;
    } else {
        const std::vector<Line> lines = straightLines(ruler);
        for (const Line& line : lines)
            if (Line part = partInSlice(line, cut); !part.empty()) shape.lines.push_back(std::move(part));
        if (shape.isEmpty()) return {};
        shape.faint = lines;
    }
    for (const Vec3& p : ruler.points)
        if (cut.holds(p)) shape.ends.push_back(p);
    if (ruler.kind == RulerKind::Angle && shape.ends.size() == ruler.points.size()) shape.lines.push_back(arcOf(ruler));
    return shape;
}

using Projection2 = std::function<std::optional<Vec2>(const Vec3&)>;

/// Draws shapes into a picture.
class Drawing {
public:
    Drawing(double width, double height, const RulerLook& look, Projection2 project)
        : m_maker(width, height, look.density, Rgb{}), m_look(look), m_sheet{0, 0, width, height},
          m_project(std::move(project)) {}

    void add(const ShownRuler& shown, const Shape& shape) {
        if (shape.isEmpty()) return;
        m_color = shown.isSelected ? kSelectedInk : kInk;
        const double width = 1.6 * m_look.density;
        for (const Line& line : shape.faint) addLine(line, width, kFaint);
        for (const Line& line : shape.lines) addLine(line, width, 1);
        for (const Vec3& end : shape.ends) addRing(end);
        if (!shown.label.empty()) addLabel(shown, shape);
    }
    std::vector<Mark> marks() { return std::move(m_marks); }

private:
    void addLine(const Line& line, double width, double alpha) {
        for (std::size_t n = 0; n + 1 < line.size(); ++n) {
            const auto a = m_project(line[n]), b = m_project(line[n + 1]);
            if (!a || !b) continue;
            const auto part = partWithin(*a, *b, m_sheet.widened(m_look.capHeight));
            if (!part) continue;
            // One mark for what hangs together, so that its joints are not drawn twice.
            if (!m_marks.empty() && n > 0 && m_marks.back().points.back() == (*part)[0]) {
                m_marks.back().points.push_back((*part)[1]);
                continue;
            }
            addStroke({(*part)[0], (*part)[1]}, width, alpha);
        }
    }

    void addStroke(std::vector<Vec2> points, double width, double alpha) {
        Mark mark = m_maker.lineMark(AnnotationPart::Measures, std::move(points), width);
        mark.color = m_color;
        mark.halo = 1.2 * m_look.density;
        mark.alpha = alpha;
        m_marks.push_back(std::move(mark));
    }

    void addRing(const Vec3& end) {
        const auto at = m_project(end);
        if (!at || !m_sheet.widened(m_look.capHeight).meets({at->x, at->y, at->x + 1e-6, at->y + 1e-6})) return;
        constexpr int kCorners = 16;
        std::vector<Vec2> ring;
        for (int n = 0; n <= kCorners; ++n) {
            const double angle = 2 * std::numbers::pi * n / kCorners;
            ring.push_back(*at + Vec2(std::cos(angle), std::sin(angle)) * (kRing * m_look.density));
        }
        addStroke(std::move(ring), 1.4 * m_look.density, 1);
    }

    /// A point of the picture, and the way from it to the label.
    struct Anchor {
        Vec2 at, outward;
    };
    std::optional<Anchor> anchorOf(const Ruler& ruler, const Shape& shape) const {
        if (ruler.kind == RulerKind::Distance) {
            const auto a = m_project(shape.lines[0].front()), b = m_project(shape.lines[0].back());
            if (!a || !b) return {};
            const Vec2 way = *b - *a;
            const double length = glm::length(way);
            Vec2 aside = length > 0 ? Vec2(way.y, -way.x) / length : Vec2(0, -1);
            if (aside.y > 0.2 || (aside.y > -0.2 && aside.x < 0)) aside = -aside; // above, or else to the right
            return Anchor{(*a + *b) / 2.0, aside};
        }
        if (ruler.kind == RulerKind::Angle) {
            const auto a = m_project(ruler.points[0]), corner = m_project(ruler.points[1]),
                       b = m_project(ruler.points[2]);
            if (!a || !b || !corner) return {};
            const Vec2 between = (*a + *b) / 2.0 - *corner;
            const double length = glm::length(between);
            return Anchor{*corner, length > 1e-6 ? -between / length : Vec2(0, -1)};
        }
        std::optional<Vec2> top;
        for (const Line& line : shape.lines)
            for (const Vec3& p : line)
                if (const auto at = m_project(p); at && (!top || at->y < top->y)) top = at;
        if (!top) return {};
        return Anchor{*top, {0, -1}};
    }

    void addLabel(const ShownRuler& shown, const Shape& shape) {
        const auto anchor = anchorOf(shown.ruler, shape);
        if (!anchor || !m_sheet.meets({anchor->at.x, anchor->at.y, anchor->at.x + 1e-6, anchor->at.y + 1e-6})) return;
        const double cap = m_look.capHeight, halfWidth = 0.5 * cap * textWidth(shown.label);
        const Vec2 way = anchor->outward;
        Vec2 middle = anchor->at + way * (cap + std::abs(way.x) * halfWidth + std::abs(way.y) * 0.5 * cap);
        const double edgeX = halfWidth + 0.5 * cap, edgeY = cap;
        if (m_sheet.right > 2 * edgeX) middle.x = std::clamp(middle.x, edgeX, m_sheet.right - edgeX);
        if (m_sheet.bottom > 2 * edgeY) middle.y = std::clamp(middle.y, edgeY, m_sheet.bottom - edgeY);
        Mark text = m_maker.textMark(AnnotationPart::Measures, shown.label, middle, Align::Middle, Align::Middle, cap);
        text.color = m_color;
        text.halo = 0; // a plate reads better than a rim, whatever lies below
        m_marks.push_back(
            m_maker.boxMark(AnnotationPart::Measures, extentOf(text).widened(0.45 * cap), kDarkInk, kPlateAlpha));
        m_marks.push_back(std::move(text));
    }

    MarkMaker m_maker;
    RulerLook m_look;
    PixelBox m_sheet;
    Projection2 m_project;
    Rgb m_color = kInk;
    std::vector<Mark> m_marks;
};

Vec3 middleOf(const Ruler& box) { return 0.5 * (box.points[0] + box.points[1]); }

} // namespace

std::vector<Mark> rulerMarks(const std::vector<ShownRuler>& rulers, const PictureView& view, const RulerLook& look) {
    Drawing drawing(view.width, view.height, look, [&](const Vec3& world) -> std::optional<Vec2> {
        const auto pixel = pixelOf(view, world);
        if (!pixel) return {};
        return Vec2(pixel->x, pixel->y);
    });
    for (const ShownRuler& shown : rulers) drawing.add(shown, shapeIn(shown.ruler, view.camera));
    return drawing.marks();
}

std::vector<Mark> rulerMarks(const std::vector<ShownRuler>& rulers, const Geometry& geometry, const SlicePlane& plane,
                             const RulerLook& look) {
    const Cut cut(geometry, plane);
    Drawing drawing(plane.width, plane.height, look, [&](const Vec3& world) {
        return std::optional(pixelOfVoxel(geometry, plane, geometry.voxelFromWorld(world)));
    });
    for (const ShownRuler& shown : rulers) drawing.add(shown, shapeIn(shown.ruler, cut));
    return drawing.marks();
}

std::vector<RulerHandle> rulerHandles(const std::vector<Ruler>& rulers, const PictureView& view) {
    std::vector<RulerHandle> handles;
    for (const Ruler& ruler : rulers) {
        if (!ruler.shown) continue;
        const auto add = [&](int part, const Vec3& world) {
            if (const auto at = pixelOf(view, world)) handles.push_back({ruler.number, part, world, *at});
        };
        if (ruler.kind == RulerKind::Box) {
            add(0, middleOf(ruler));
            for (int face = 0; face < 6; ++face) {
                Vec3 at = middleOf(ruler);
                at[face / 2] = ruler.points[static_cast<std::size_t>(face % 2)][face / 2];
                add(1 + face, at);
            }
            continue;
        }
        for (std::size_t n = 0; n < ruler.points.size(); ++n) add(static_cast<int>(n), ruler.points[n]);
        if (ruler.kind == RulerKind::Sphere) add(1, ruler.points[0] + view.camera.right() * ruler.radius);
    }
    return handles;
}

std::vector<RulerHandle> rulerHandles(const std::vector<Ruler>& rulers, const Geometry& geometry,
                                      const SlicePlane& plane) {
    const Cut cut(geometry, plane);
    std::vector<RulerHandle> handles;
    for (const Ruler& ruler : rulers) {
        if (!ruler.shown) continue;
        const auto add = [&](int part, const Vec3& world) {
            const Vec2 at = pixelOfVoxel(geometry, plane, geometry.voxelFromWorld(world));
            handles.push_back({ruler.number, part, world, {at.x, at.y}});
        };
        if (ruler.kind == RulerKind::Box) {
            const std::vector<Vec3> corners = cutBox(ruler, cut);
            if (corners.empty()) continue;
            Vec3 middle(0);
            for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
            add(0, middle);
            for (int face = 0; face < 6; ++face) {
                const int axis = face / 2;
                if (std::abs(cut.normal[axis]) > kAcross) continue;
                Vec3 at = middle;
                at[axis] = ruler.points[static_cast<std::size_t>(face % 2)][axis];
                add(1 + face, cut.onPlane(at));
            }
            continue;
        }
        for (std::size_t n = 0; n < ruler.points.size(); ++n)
            if (cut.holds(ruler.points[n])) add(static_cast<int>(n), ruler.points[n]);
        if (ruler.kind != RulerKind::Sphere) continue;
        if (const CutSphere at = cutOf(ruler, cut); at.radius >= 0) add(1, at.center + cut.u * at.radius);
    }
    return handles;
}

Ruler withHandleAt(const Ruler& ruler, const RulerHandle& handle, const Vec3& world) {
    Ruler moved = ruler;
    if (ruler.kind == RulerKind::Sphere && handle.part == 1) {
        moved.radius = glm::length(world - ruler.points[0]);
    } else if (ruler.kind == RulerKind::Box && handle.part == 0) {
        for (Vec3& corner : moved.points) corner += world - handle.world;
    } else if (ruler.kind == RulerKind::Box) {
        const int axis = (handle.part - 1) / 2;
        const bool upper = handle.part % 2 == 0;
        const double other = ruler.points[upper ? 0 : 1][axis];
        moved.points[upper ? 1 : 0][axis] = upper ? std::max(world[axis], other) : std::min(world[axis], other);
    } else {
        moved.points.at(static_cast<std::size_t>(handle.part)) = world;
    }
    return rulerProblem(moved).empty() ? moved : ruler;
}

Vec3 besideInView(const PictureView& view, const Vec3& world, const PixelPoint& pixel) {
    const auto at = pixelOf(view, world);
    if (!at) return world;
    return world + worldFromCamera(view.camera, {pixel.x - at->x, at->y - pixel.y, 0}) * worldPerPixel(view, world);
}

} // namespace pellucid
