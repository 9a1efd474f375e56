#include "session/keyframes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "render/ray_box.h"
#include "session/scene.h"
#include "tf/tf_morph.h"
#include "tf/tf_range.h"

namespace pellucid {

namespace {

constexpr double kSameTime = 1e-9; ///< s, of rounding
constexpr double kRadians = std::numbers::pi / 180;

double mix(double a, double b, double t) { return a + t * (b - a); }
Vec3 mix(const Vec3& a, const Vec3& b, double t) { return a + t * (b - a); }

/// A way from key `from` to the next one, at the part `u` of it; u is 0 at a key and beyond the ends.
struct Place {
    std::size_t from = 0;
    double u = 0;
};

Place placeAt(const Keyframes& keys, double time) {
    std::size_t n = 0;
    while (n + 1 < keys.size() && keys[n + 1].time <= time + kSameTime) ++n;
    if (n + 1 == keys.size() || time <= keys[n].time + kSameTime) return {n, 0};
    return {n, easedTime(keys[n].easing, (time - keys[n].time) / (keys[n + 1].time - keys[n].time))};
}

// ---- cameras

/// Lengths as logarithms: they grow by equal factors.
struct Pose {
    Vec3 center;
    glm::dquat turn;
    Vec3 sizes; ///< logarithms of distance, angle and height
};

Pose poseOf(const Camera& c) {
    const Mat3 axes{c.right(), c.trueUp(), -c.forward()};
    return {c.center,
            glm::normalize(glm::quat_cast(axes)),
            {std::log(glm::length(c.eye - c.center)), std::log(c.fovY), std::log(c.height)}};
}

Camera cameraOf(const Pose& pose, Projection projection) {
    const glm::dmat3 axes = glm::mat3_cast(pose.turn);
    Camera c;
    c.projection = projection;
    c.center = pose.center;
    c.eye = pose.center + axes[2] * std::exp(pose.sizes.x);
    c.up = axes[1];
    c.fovY = std::exp(pose.sizes.y);
    c.height = std::exp(pose.sizes.z);
    return c;
}

/// As the other projection shows the same in the plane of the center.
Camera inProjection(Camera c, Projection projection) {
    if (c.projection == projection) return c;
    const Vec3 way = c.eye - c.center;
    if (projection == Projection::Orthographic)
        c.height = 2 * glm::length(way) * std::tan(c.fovY * kRadians / 2);
    else
        c.eye = c.center + glm::normalize(way) * (c.height / 2 / std::tan(c.fovY * kRadians / 2));
    c.projection = projection;
    return c;
}

/// The shorter way to turn by `q`: an axis as long as half the angle.
Vec3 logOf(glm::dquat q) {
    if (q.w < 0) q = -q;
    const Vec3 v{q.x, q.y, q.z};
    const double length = glm::length(v);
    return length > 0 ? v * (std::atan2(length, q.w) / length) : Vec3(0);
}
glm::dquat expOf(const Vec3& v) {
    const double angle = glm::length(v);
    if (!(angle > 0)) return {1, 0, 0, 0};
    const Vec3 axis = v * (std::sin(angle) / angle);
    return {std::cos(angle), axis.x, axis.y, axis.z};
}

/// What changes from one pose to another.
struct Change {
    Vec3 center, turn, sizes;
};
Change operator*(double f, const Change& c) { return {f * c.center, f * c.turn, f * c.sizes}; }
Change between(const Pose& a, const Pose& b) {
    return {b.center - a.center, logOf(glm::inverse(a.turn) * b.turn), b.sizes - a.sizes};
}

/// The speed at a key between the speeds of the ways around it, which take h0 and h1: none where they turn back, and
/// never so fast that the curve runs beyond the key.
Vec3 speedBetween(const Vec3& before, const Vec3& after, double h0, double h1) {
    if (!(glm::dot(before, after) > 0)) return Vec3(0);
    const Vec3 mean = (h1 * before + h0 * after) / (h0 + h1);
    const double most = 3 * std::min(glm::length(before), glm::length(after)), length = glm::length(mean);
    return length > most ? mean * (most / length) : mean;
}

Vec3 hermite(const Vec3& way, const Vec3& begin, const Vec3& end, double u) {
    return (3 - 2 * u) * u * u * way + u * (1 - u) * (1 - u) * begin - u * u * (1 - u) * end;
}

/// From `a` on by `way`, with the speeds `begin` and `end` in units of the whole way's time. Turns as a curve of Bézier
/// whose sums are products: Kim, Kim and Shin, "A general construction scheme for unit quaternion curves with simple
/// high order derivatives", SIGGRAPH 1995.
Pose moved(const Pose& a, const Change& way, const Change& begin, const Change& end, double u) {
    Pose pose = a;
    pose.center += hermite(way.center, begin.center, end.center, u);
    pose.sizes += hermite(way.sizes, begin.sizes, end.sizes, u);
    const Vec3 first = begin.turn / 3.0, last = end.turn / 3.0;
    const Vec3 middle = logOf(expOf(-first) * expOf(way.turn) * expOf(-last));
    const double rest = 1 - u;
    pose.turn = glm::normalize(a.turn * expOf((1 - rest * rest * rest) * first) * expOf((3 - 2 * u) * u * u * middle) *
                               expOf(u * u * u * last));
    return pose;
}

/// Whether the film goes on at key n without a stop.
bool isPassed(const Keyframes& keys, std::size_t n) {
    if (n == 0 || n + 1 >= keys.size()) return false;
    const Easing before = keys[n - 1].easing, after = keys[n].easing;
    return (before == Easing::Linear || before == Easing::EaseIn) &&
           (after == Easing::Linear || after == Easing::EaseOut);
}

Camera outsideBox(Camera camera, const Geometry& geometry) {
    if (camera.projection == Projection::Orthographic || !geometry.contains(camera.eye)) return camera;
    const Ray back = inVoxels({camera.eye, -camera.forward()}, geometry);
    const double distance = glm::length(camera.eye - camera.center);
    camera.eye -= camera.forward() * (intersectBox(back, geometry).exit + 1e-3 * distance);
    return camera;
}

Camera cameraBetweenKeys(const Keyframes& keys, const Place& at, const Geometry& geometry) {
    const Projection projection = keys[at.from].state.camera.projection;
    const auto pose = [&](std::size_t n) { return poseOf(inProjection(keys[n].state.camera, projection)); };
    const auto span = [&](std::size_t n) { return keys[n + 1].time - keys[n].time; }; // of the way from key n on
    const Pose a = pose(at.from), b = pose(at.from + 1);
    const Change way = between(a, b);
    Change begin = way, end = way;
    const double h = span(at.from);
    const auto speeds = [&](const Change& before, const Change& after, double h0, double h1) -> Change {
        const Change p = 1 / h0 * before, q = 1 / h1 * after;
        return {speedBetween(p.center, q.center, h0, h1), speedBetween(p.turn, q.turn, h0, h1),
                speedBetween(p.sizes, q.sizes, h0, h1)};
    };
    if (isPassed(keys, at.from)) begin = h * speeds(between(pose(at.from - 1), a), way, span(at.from - 1), h);
    if (isPassed(keys, at.from + 1)) end = h * speeds(way, between(b, pose(at.from + 2)), h, span(at.from + 1));
    return outsideBox(cameraOf(moved(a, way, begin, end, at.u), projection), geometry);
}

// ---- the rest

/// Where a plane cuts nothing of the volume.
double idleOffset(const Vec3& normal, const Geometry& geometry) {
    double most = glm::dot(normal, geometry.corner(0));
    for (int n = 1; n < 8; ++n) most = std::max(most, glm::dot(normal, geometry.corner(n)));
    return most;
}

ClipPlane withUnitNormal(const ClipPlane& plane) {
    const double length = glm::length(plane.normal);
    return {plane.normal / length, plane.offset / length};
}

std::vector<ClipPlane> planesBetween(const std::vector<ClipPlane>& a, const std::vector<ClipPlane>& b, double t,
                                     const Geometry& geometry) {
    const auto idle = [&](const ClipPlane& p) { return ClipPlane{p.normal, idleOffset(p.normal, geometry)}; };
    std::vector<ClipPlane> planes;
    for (std::size_t n = 0; n < std::max(a.size(), b.size()); ++n) {
        ClipPlane p = withUnitNormal(n < a.size() ? a[n] : b[n]), q = withUnitNormal(n < b.size() ? b[n] : a[n]);
        if (n >= a.size()) p = idle(q);
        if (n >= b.size()) q = idle(p);
        const Vec3 normal = mix(p.normal, q.normal, t);
        const double length = glm::length(normal);
        if (length > 1e-6) // opposite ones have no way between them
            planes.push_back({normal / length, mix(p.offset, q.offset, t)});
        else
            planes.push_back(t < 0.5 ? p : q);
    }
    return planes;
}

Clipping clippingBetween(const Clipping& a, const Clipping& b, double t, const Geometry& geometry) {
    const auto part = [&](const BoxPart& p, const BoxPart& q) {
        return BoxPart{mix(p.lo, q.lo, t), mix(p.hi, q.hi, t), planesBetween(p.planes, q.planes, t, geometry)};
    };
    Clipping c;
    c.setPart(part(a.part(), b.part()));
    // Where nothing is faint all is as dense as it is.
    c.rest.within = a.rest.isNone()   ? b.rest.within
                    : b.rest.isNone() ? a.rest.within
                                      : part(a.rest.within, b.rest.within);
    if (!c.rest.isNone()) {
        const double full = 0.999;
        c.rest.density = mix(a.rest.isNone() ? full : a.rest.density, b.rest.isNone() ? full : b.rest.density, t);
    }
    return c;
}

/// Light that changes nothing.
Light asLit(Light l) {
    if (l.on) return l;
    l.on = true;
    l.ambient = 1;
    l.diffuse = l.specular = 0;
    return l;
}

Light lightBetween(const Light& a, const Light& b, double t) {
    const bool on = a.on || b.on;
    const Light p = on ? asLit(a) : a, q = on ? asLit(b) : b;
    Light l = t < 0.5 ? p : q;
    for (double Light::*part : {&Light::ambient, &Light::diffuse, &Light::specular, &Light::gradientOpacity,
                                &Light::occlusion, &Light::depthCue, &Light::silhouettes})
        l.*part = mix(p.*part, q.*part, t);
    l.shininess = p.shininess * std::pow(q.shininess / p.shininess, t);
    const Vec3 from = a.on || !b.on ? p.direction : q.direction, to = b.on || !a.on ? q.direction : p.direction;
    const Vec3 direction = mix(glm::normalize(from), glm::normalize(to), t);
    if (glm::length(direction) > 1e-6) l.direction = glm::normalize(direction);
    return l;
}

int frameBetween(int a, int b, double t) { return static_cast<int>(std::lround(mix(a, b, t))); }

} // namespace

double easedTime(Easing easing, double t) {
    switch (easing) {
    case Easing::Smooth:
        return t * t * (3 - 2 * t);
    case Easing::EaseIn:
        return t * t * (2 - t);
    case Easing::EaseOut:
        return t * (1 + t - t * t);
    case Easing::Hold:
        return 0;
    case Easing::Linear:
        break;
    }
    return t;
}

KeyState keyStateOf(const Scene& scene) {
    KeyState state{scene.camera, scene.tf, *scene.session.clipping, scene.session.display->light, scene.session.frame};
    if (!state.tf.range) state.tf.range = scene.volume->range();
    return state;
}

Scene withKeyState(const Scene& scene, const KeyState& state) {
    Scene changed = scene;
    changed.camera = state.camera;
    changed.tf = inRange(state.tf, scene.volume->range());
    changed.session.clipping = state.clipping;
    changed.session.display.edit([&](DisplaySettings& d) { d.light = state.light; });
    return changed;
}

Scene sceneAtKey(const Scene& scene, const KeyState& state, const JobControl& job) {
    if (state.frame == scene.session.frame) return withKeyState(scene, state);
    Session session = scene.session;
    session.frame = state.frame;
    return withKeyState(resolve(std::move(session), scene, {}, job), state);
}

std::size_t putKey(Keyframes& keys, Keyframe key) {
    const auto at = std::ranges::lower_bound(keys, key.time - kSameKeyTime, {}, &Keyframe::time);
    const auto place = static_cast<std::size_t>(at - keys.begin());
    if (at != keys.end() && at->time <= key.time + kSameKeyTime)
        *at = std::move(key);
    else
        keys.insert(at, std::move(key));
    return place;
}

std::size_t moveKey(Keyframes& keys, std::size_t n, double time, double step) {
    Keyframe key = std::move(keys.at(n));
    keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(n));
    const auto isTaken = [&](double at) {
        return std::ranges::any_of(keys, [&](const Keyframe& k) { return std::abs(k.time - at) < step / 2; });
    };
    key.time = std::clamp(time, 0.0, kMostFilmSeconds);
    while (isTaken(key.time) && key.time + step <= kMostFilmSeconds) key.time += step;
    while (isTaken(key.time)) key.time -= step; // at the very end
    return putKey(keys, std::move(key));
}

KeyState stateAt(const Keyframes& keys, double time, const Geometry& geometry) {
    const Place at = placeAt(keys, time);
    const KeyState& a = keys[at.from].state;
    if (at.u <= 0) return a;
    const KeyState& b = keys[at.from + 1].state;
    return {cameraBetweenKeys(keys, at, geometry), tfMorph(a.tf, b.tf, at.u),
            clippingBetween(a.clipping, b.clipping, at.u, geometry), lightBetween(a.light, b.light, at.u),
            frameBetween(a.frame, b.frame, at.u)};
}

int frameAt(const Keyframes& keys, double time) {
    const Place at = placeAt(keys, time);
    const int from = keys[at.from].state.frame;
    return at.u > 0 ? frameBetween(from, keys[at.from + 1].state.frame, at.u) : from;
}

Camera cameraAt(const Keyframes& keys, double time, const Geometry& geometry) {
    const Place at = placeAt(keys, time);
    return at.u > 0 ? cameraBetweenKeys(keys, at, geometry) : keys[at.from].state.camera;
}

} // namespace pellucid
