#include "render/cpu/shear_view.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace pellucid {

namespace {

constexpr int kBorder = 2; ///< rays around those that are wanted: what interpolation reads

/// Rays of pixels in voxels: point + t·direction, both affine in the pixel. Perspective ones start at the eye.
struct PixelRays {
    Vec3 point, pointByX, pointByY, direction, directionByX, directionByY;

    PixelRays(const Camera& camera, const Geometry& geometry, double width, double height) {
        const Mat3 indexFromWorld = geometry.indexFromWorld();
        const double perPixel = 2 * camera.halfHeight() / height;
        const Vec3 right = indexFromWorld * (perPixel * camera.right()),
                   down = indexFromWorld * (-perPixel * camera.trueUp()), ahead = indexFromWorld * camera.forward();
        const Vec3 corner = -0.5 * width * right - 0.5 * height * down; // the picture's top left
        const bool perspective = camera.projection == Projection::Perspective;
        point = geometry.voxelFromWorld(camera.eye) + (perspective ? Vec3(0) : corner);
        pointByX = perspective ? Vec3(0) : right;
        pointByY = perspective ? Vec3(0) : down;
        direction = ahead + (perspective ? corner : Vec3(0));
        directionByX = perspective ? right : Vec3(0);
        directionByY = perspective ? down : Vec3(0);
    }
};

int longestComponent(const Vec3& v) {
    const Vec3 a = glm::abs(v);
    return a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
}

/// The region of voxels that is drawn: the box, as far as it is not cut away along its axes.
struct Bounds {
    Vec3 lo, hi;
};
Bounds drawnBox(const Geometry& geometry, const Clipping& clipping) {
    const Vec3 n(geometry.dims);
    return {clipping.lo * n - 0.5, clipping.hi * n - 0.5};
}
Vec3 cornerOf(const Bounds& b, unsigned n) {
    return {n & 1u ? b.hi.x : b.lo.x, n & 2u ? b.hi.y : b.lo.y, n & 4u ? b.hi.z : b.lo.z};
}

/// Shift and scale of slices; false where the view has none.
bool setShear(ShearView& s, const Camera& camera, const Geometry& geometry, const Bounds& box) {
    s.base = 0.5 * (s.dims.z - 1);
    double steepest = 0;
    if (camera.projection == Projection::Orthographic) {
        const Vec3 ahead = s.fromVoxels(geometry.indexFromWorld() * camera.forward()) - s.fromVoxels(Vec3(0));
        for (int a = 0; a < 2; ++a) {
            const double perSlice = ahead[a] / ahead.z;
            s.shift[static_cast<std::size_t>(a)] = {-perSlice * s.base, perSlice};
            steepest = std::max(steepest, std::abs(perSlice));
        }
    } else {
        const Vec3 eye = s.fromVoxels(geometry.voxelFromWorld(camera.eye));
        const double nearest = -0.5 - eye.z, farthest = s.dims.z - 0.5 - eye.z;
        if (!(nearest > 0) || farthest > kMostScale * nearest) return false;
        const double toBase = s.base - eye.z;
        s.scale = {-eye.z / toBase, 1 / toBase};
        for (int a = 0; a < 2; ++a)
            s.shift[static_cast<std::size_t>(a)] = {eye[a] * (1 - s.scale.at0), -eye[a] * s.scale.per1};
        for (unsigned c = 0; c < 8; ++c) {
            const Vec3 way = s.fromVoxels(cornerOf(box, c)) - eye;
            steepest = std::max({steepest, std::abs(way.x / way.z), std::abs(way.y / way.z)});
        }
    }
    return steepest <= kMostShear;
}

void setPixels(ShearView& s, const PixelRays& rays) {
    const Vec3 zero = s.fromVoxels(Vec3(0));
    const auto turned = [&](const Vec3& v) { return s.fromVoxels(v) - zero; };
    const Vec3 point[3] = {s.fromVoxels(rays.point), turned(rays.pointByX), turned(rays.pointByY)},
               direction[3] = {turned(rays.direction), turned(rays.directionByX), turned(rays.directionByY)};
    // U = u + t·du with t = (base − w)/dw. Parallel rays: dw is the same of all; perspective ones: u and w are.
    const bool parallel = direction[1] == Vec3(0) && direction[2] == Vec3(0);
    double coefficient[3][3];
    for (int n = 0; n < 3; ++n) { // constant, by x, by y
        const double one = n == 0 ? 1 : 0;
        for (int a = 0; a < 2; ++a)
            coefficient[a][n] = parallel ? point[n][a] * direction[0].z + (one * s.base - point[n].z) * direction[0][a]
                                         : point[0][a] * direction[n].z + (s.base - point[0].z) * direction[n][a];
        coefficient[2][n] = parallel ? one * direction[0].z : direction[n].z;
    }
    for (std::size_t a = 0; a < 3; ++a) s.ofPixel[a] = {coefficient[a][0], coefficient[a][1], coefficient[a][2]};
}

/// The grid of rays: as close as pixels, over what the picture shows of the box.
void setGrid(ShearView& s, const Bounds& box, const Vec2& pixelOfMiddle, double width, double height,
             const ShearDensity& density) {
    Vec2 lo(1e30), hi(-1e30);
    for (unsigned c = 0; c < 8; ++c) {
        const Vec3 corner = s.fromVoxels(cornerOf(box, c));
        for (int a = 0; a < 2; ++a) {
            const double inBase = (corner[a] - s.shift[static_cast<std::size_t>(a)](corner.z)) / s.scale(corner.z);
            lo[a] = std::min(lo[a], inBase);
            hi[a] = std::max(hi[a], inBase);
        }
    }
    const Vec2 here = s.inBase(pixelOfMiddle.x, pixelOfMiddle.y),
               byX = s.inBase(pixelOfMiddle.x + 1, pixelOfMiddle.y) - here,
               byY = s.inBase(pixelOfMiddle.x, pixelOfMiddle.y + 1) - here;
    // What of the plane the picture shows, where all of its corners look that way.
    Vec2 shownLo(1e30), shownHi(-1e30);
    bool looks = true;
    for (unsigned c = 0; c < 4; ++c) {
        const double x = c & 1u ? width : 0, y = c & 2u ? height : 0;
        looks = looks && s.ofPixel[2](x, y) > 0;
        const Vec2 p = s.inBase(x, y);
        shownLo = glm::min(shownLo, p);
        shownHi = glm::max(shownHi, p);
    }
    const double widest = std::max(s.scale(-0.5), s.scale(s.dims.z - 0.5));
    const double farthest[2] = {density.farthest / widest, 1e30};
    const auto set = [&](std::size_t i, int a, int& count) {
        s.pitch[i] = std::clamp(std::hypot(byX[a], byY[a]) / density.raysPerPixel, density.closest,
                                std::max(density.closest, farthest[i]));
        const double from = looks ? std::max(lo[a], shownLo[a]) : lo[a],
                     to = looks ? std::min(hi[a], shownHi[a]) : hi[a];
        count = from < to ? static_cast<int>(std::ceil((to - from) / s.pitch[i])) + 1 + 2 * kBorder : 0;
        s.first[i] = from - kBorder * s.pitch[i];
    };
    set(0, 0, s.width);
    set(1, 1, s.height);
    if (s.width == 0 || s.height == 0) s.width = s.height = 0;
}

} // namespace

Vec3 ShearView::inVoxels(const Vec3& uvw) const {
    Vec3 voxel;
    for (int a = 0; a < 3; ++a) voxel[axis[static_cast<std::size_t>(a)]] = uvw[a];
    if (reversed) voxel[axis[2]] = dims.z - 1 - uvw.z;
    return voxel;
}

Vec3 ShearView::fromVoxels(const Vec3& voxel) const {
    Vec3 uvw;
    for (int a = 0; a < 3; ++a) uvw[a] = voxel[axis[static_cast<std::size_t>(a)]];
    if (reversed) uvw.z = dims.z - 1 - uvw.z;
    return uvw;
}

std::optional<ShearView> shearOf(const Camera& camera, const Geometry& geometry, const Clipping& clipping, double width,
                                 double height, const ShearDensity& density) {
    const Int3 n = geometry.dims;
    if (n.x < 2 || n.y < 2 || n.z < 2) return {};
    const bool perspective = camera.projection == Projection::Perspective;
    const Vec3 ahead = geometry.indexFromWorld() * (perspective ? geometry.boxCenter() - camera.eye : camera.forward());
    ShearView s;
    const int w = longestComponent(ahead);
    s.axis = w == 0 ? std::array{1, 2, 0} : (w == 1 ? std::array{0, 2, 1} : std::array{0, 1, 2});
    for (int a = 0; a < 3; ++a) s.dims[a] = n[s.axis[static_cast<std::size_t>(a)]];
    s.reversed = ahead[w] < 0;
    const Bounds box = drawnBox(geometry, clipping);
    if (!setShear(s, camera, geometry, box)) return {};
    setPixels(s, PixelRays(camera, geometry, width, height));
    // Pixels are as wide as at the middle of the box.
    const Vec3 toMiddle = geometry.boxCenter() - camera.eye;
    const double depth = glm::dot(toMiddle, camera.forward());
    if (perspective && !(depth > 0)) return {}; // it looks away
    const double perPixel = 2 * camera.halfHeight() * (perspective ? depth : 1) / height;
    const Vec2 middle{width / 2 + glm::dot(toMiddle, camera.right()) / perPixel,
                      height / 2 - glm::dot(toMiddle, camera.trueUp()) / perPixel};
    setGrid(s, box, middle, width, height, density);
    return s;
}

} // namespace pellucid
