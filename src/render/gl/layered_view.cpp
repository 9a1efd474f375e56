#include "render/gl/layered_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/gl/kept_region.h"

namespace pellucid::gl {

namespace {

constexpr double kWidest = 1.5; ///< tangent of the angle between the axis of a picture that is alone and its corners
constexpr double kFarEye = 1e8; ///< in d0: the rays of eyes farther off are parallel
constexpr double kBeside = 2;   ///< pixels around what is seen, between which voxels at its outline interpolate

/// Right, up and forward, unit vectors of the world, as the rows of local coordinates.
struct Axes {
    Vec3 right, up, forward;
};

/// A picture may be turned at will: along the grid, so that pixels stand on voxels where the view is along an axis.
Axes axesAlong(const Vec3& forward, const Geometry& geometry) {
    Vec3 best(0);
    for (int a = 0; a < 3; ++a) {
        const Vec3 across = geometry.directions[a] - glm::dot(geometry.directions[a], forward) * forward;
        if (glm::length(across) > glm::length(best) + 1e-9) best = across;
    }
    const Vec3 right = glm::normalize(best);
    return {right, glm::cross(forward, right), forward};
}

class Pictures {
public:
    Pictures(const View& view, const Geometry& geometry, Quality quality, int mostPixels)
        : m_geometry(geometry), m_d0(geometry.d0()), m_clipping(clippingInVoxels(view.clipping, geometry)),
          m_planes(m_clipping.cut), m_corners(keptCorners(geometry, m_planes)),
          m_perD0(quality == Quality::High ? 2 : 1), m_mostPixels(mostPixels) {
        if (const auto kept = keptVoxels(geometry, m_planes))
            m_anchor = geometry.worldFromVoxel(Vec3(kept->first));
        else
            m_corners.clear();
        const Mat3 indexFromWorld = geometry.indexFromWorld();
        for (int a = 0; a < 3; ++a) {
            const Vec3 gradient{indexFromWorld[0][a], indexFromWorld[1][a], indexFromWorld[2][a]};
            Vec3 normal(0);
            normal[a] = 1 / (glm::length(gradient) * m_d0);
            m_sides.push_back({-normal, 0.5 * normal[a]});
            m_sides.push_back({normal, (geometry.dims[a] - 0.5) * normal[a]});
        }
        m_sides.insert(m_sides.end(), m_planes.begin(), m_planes.end());
    }

    bool nothing() const { return m_corners.empty(); }
    Vec3 middle() const {
        Vec3 lo = m_corners.front(), hi = lo;
        for (const Vec3& p : m_corners) {
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
        }
        return m_geometry.worldFromVoxel(0.5 * (lo + hi));
    }

    LayeredView parallel(const Vec3& forward) const {
        return *layOut(axesAlong(forward, m_geometry), middle(), {}, m_planes, m_corners);
    }

    /// Empty where the kept part reaches beside the eye, or looks too wide for one picture.
    std::optional<LayeredView> perspective(const Vec3& eye) const {
        const Axes axes = axesAlong(glm::normalize(middle() - eye), m_geometry);
        for (const Vec3& corner : m_corners) {
            const Vec3 p = m_geometry.worldFromVoxel(corner) - eye;
            const double depth = glm::dot(p, axes.forward);
            const double aside = std::max(std::abs(glm::dot(p, axes.right)), std::abs(glm::dot(p, axes.up)));
            if (!(aside < kWidest * depth)) return {};
        }
        return layOut(axes, eye, eye, m_planes, m_corners);
    }

    /// The six sides of a cube around the eye, as far as there is anything on them.
    std::vector<LayeredView> cube(const Vec3& eye) const {
        const Axes front = axesAlong(glm::normalize(middle() - eye), m_geometry);
        const std::array<Vec3, 3> directions{front.right, front.up, front.forward};
        const Mat3 worldFromIndex = m_geometry.worldFromIndex();
        Mat3 faceFromVoxel;
        Vec3 faceOffset;
        for (int a = 0; a < 3; ++a) {
            const Vec3& direction = directions[static_cast<std::size_t>(a)];
            for (int column = 0; column < 3; ++column)
                faceFromVoxel[column][a] = glm::dot(direction, worldFromIndex[column]) / m_d0;
            faceOffset[a] = glm::dot(direction, m_geometry.origin - eye) / m_d0;
        }
        std::vector<LayeredView> faces;
        for (int a = 0; a < 3; ++a)
            for (const int sign : {1, -1}) {
                const auto direction = [&](int n) { return directions[static_cast<std::size_t>((a + n) % 3)]; };
                const Axes axes{direction(1), direction(2), direction(0) * static_cast<double>(sign)};
                Clipping pyramid; // all that is as far ahead as aside
                for (const Vec3& aside : {axes.right, -axes.right, axes.up, -axes.up}) {
                    const Vec3 normal = aside - axes.forward;
                    pyramid.planes.push_back({normal, glm::dot(normal, eye)});
                }
                std::vector<VoxelPlane> planes = planesInVoxels(pyramid, m_geometry);
                planes.insert(planes.end(), m_planes.begin(), m_planes.end());
                auto face = layOut(axes, eye, eye, planes, keptCorners(m_geometry, planes));
                if (!face) continue;
                face->faceAxis = a;
                face->faceSign = sign;
                face->faceFromVoxel = faceFromVoxel;
                face->faceOffset = faceOffset;
                faces.push_back(std::move(*face));
            }
        return faces;
    }

private:
    /// `onAxis`: a point on the picture's axis. `eye`: empty for parallel rays. `corners`: of what is seen, the part of
    /// the box within `planes`; empty result where that is nothing.
    std::optional<LayeredView> layOut(const Axes& axes, const Vec3& onAxis, const std::optional<Vec3>& eye,
                                      const std::vector<VoxelPlane>& planes, const std::vector<Vec3>& corners) const {
        double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest; // ahead of onAxis, in d0
        for (const Vec3& corner : corners) {
            const double ahead = glm::dot(m_geometry.worldFromVoxel(corner) - onAxis, axes.forward) / m_d0;
            nearest = std::min(nearest, ahead);
            farthest = std::max(farthest, ahead);
        }
        if (!(nearest <= farthest) || (eye && !(farthest > 0))) return {};

        LayeredView view;
        view.sides = m_sides;
        view.faint = m_clipping.faint;
        view.faintDensity = m_clipping.density;
        const Mat3 worldFromIndex = m_geometry.worldFromIndex();
        const Mat3 rows(axes.right, axes.up, axes.forward);
        view.localFromVoxel = glm::transpose(rows) * worldFromIndex / m_d0;
        view.voxelFromLocal = glm::inverse(view.localFromVoxel);
        view.origin = m_geometry.voxelFromWorld(onAxis + axes.forward * (farthest * m_d0));
        if (eye) view.inverseDistance = 1 / farthest;
        for (const Vec3& corner : corners) {
            const Vec3 along =
                glm::abs(eye ? corner - m_geometry.voxelFromWorld(*eye) : view.voxelFromLocal * Vec3(0, 0, 1));
            const double most = std::max(along.x, std::max(along.y, along.z));
            if (most > 0) view.crossed = std::max(view.crossed, (along.x + along.y + along.z) / most - 1);
        }

        // Slices on the voxel planes where the view is along an axis and voxels are cubes.
        view.step = 1.0 / m_perD0;
        view.front = nearest - farthest - 0.5 * view.step;
        if (eye) view.front = std::max(view.front, -farthest);
        view.slabs = static_cast<int>(std::ceil(-view.front / view.step));

        const auto onPicture = [&](const Vec3& voxel) { // local (x, y) of the ray through a point, at z = 0
            const Vec3 local = view.localFromVoxel * (voxel - view.origin);
            return glm::dvec2(local) / (1 + local.z * view.inverseDistance);
        };
        glm::dvec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
        const auto seen = [&](const Vec3& corner) { // not the eye itself, where it touches the box
            return !eye || glm::dot(m_geometry.worldFromVoxel(corner) - *eye, axes.forward) > 1e-6 * farthest * m_d0;
        };
        for (const Vec3& corner : corners) {
            if (!seen(corner)) continue;
            lo = glm::min(lo, onPicture(corner));
            hi = glm::max(hi, onPicture(corner));
        }
        if (!(lo.x <= hi.x)) return {};
        const glm::dvec2 anchor = glm::dvec2(view.localFromVoxel * (m_geometry.voxelFromWorld(m_anchor) - view.origin));
        for (int a = 0; a < 2; ++a) {
            view.pixelsPerD0[a] = std::min<double>(m_perD0, (m_mostPixels - 2 * kBeside - 2) / (hi[a] - lo[a]));
            // Some pixel lies on the first kept voxel's ray, if rays are parallel.
            const double scale = view.pixelsPerD0[a];
            view.firstPixel[a] = anchor[a] - std::ceil((anchor[a] - lo[a]) * scale + kBeside) / scale;
            view.size[a] = static_cast<int>(std::ceil((hi[a] - view.firstPixel[a]) * scale + kBeside)) + 1;
        }

        // Slab by slab, the corners of what lies in it.
        for (int slab = 0; slab < view.slabs; ++slab) {
            std::vector<VoxelPlane> within = planes;
            const glm::dmat3 toLocal = glm::transpose(view.localFromVoxel);
            const Vec3 ahead = toLocal[2]; // local z = dot(ahead, voxel − origin)
            const double from = view.front + slab * view.step, origin = glm::dot(ahead, view.origin);
            within.push_back({-ahead, -(from + origin)});
            within.push_back({ahead, from + view.step + origin});
            LayeredView::Rectangle rectangle{view.size, {0, 0}};
            for (const Vec3& corner : keptCorners(m_geometry, within)) {
                if (!seen(corner)) continue;
                const glm::dvec2 pixel = (onPicture(corner) - view.firstPixel) * view.pixelsPerD0;
                rectangle.first = glm::min(rectangle.first, glm::ivec2(glm::floor(pixel - kBeside)));
                rectangle.end = glm::max(rectangle.end, glm::ivec2(glm::ceil(pixel + kBeside)) + 1);
            }
            rectangle.first = glm::max(rectangle.first, glm::ivec2(0));
            rectangle.end = glm::min(rectangle.end, view.size);
            view.rectangles.push_back(rectangle);
        }
        return view;
    }

    const Geometry& m_geometry;
    double m_d0;
    VoxelClipping m_clipping;
    std::vector<VoxelPlane> m_planes, m_sides;
    std::vector<Vec3> m_corners; ///< voxel coordinates; empty: no voxel is kept
    Vec3 m_anchor{0, 0, 0};      ///< centre of the first kept voxel, world
    int m_perD0, m_mostPixels;
};

} // namespace

std::vector<LayeredView> makeLayeredViews(const View& view, const Geometry& geometry, Quality quality, int mostPixels) {
    const Pictures pictures(view, geometry, quality, mostPixels);
    if (pictures.nothing()) return {};
    const Camera& camera = view.camera;
    if (camera.projection == Projection::Orthographic) return {pictures.parallel(camera.forward())};
    const Vec3 toMiddle = pictures.middle() - camera.eye;
    if (glm::length(toMiddle) > kFarEye * geometry.d0()) return {pictures.parallel(glm::normalize(toMiddle))};
    if (auto alone = pictures.perspective(camera.eye)) return {std::move(*alone)};
    return pictures.cube(camera.eye);
}

} // namespace pellucid::gl
