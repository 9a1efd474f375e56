#include "session/keyframes.h"

#include <cmath>

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "render/camera_motion.h"
#include "support/film_scene.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

double apart(const Vec3& a, const Vec3& b) { return glm::length(a - b); }

Keyframe keyAt(double time, const Scene& scene, double azimuth, Easing easing = Easing::Linear) {
    Keyframe key{time, {}, easing};
    key.state = keyStateOf(scene);
    key.state.camera = cameraFromView(scene.volume->geometry(), azimuth, 0, 1, Projection::Perspective);
    return key;
}

/// Degrees a second, by a difference over a thousandth of a second.
double turningAt(const Keyframes& keys, double time, const Geometry& geometry) {
    const auto azimuth = [&](double at) { return viewAngles(cameraAt(keys, at, geometry), geometry).azimuth; };
    return (azimuth(time + 5e-4) - azimuth(time - 5e-4)) / 1e-3;
}

} // namespace

TEST_CASE("at the time of a key the film shows exactly the key", "[film]") {
    const Scene scene = filmScene();
    Keyframes keys = twoKeys(scene, 2);
    keys.push_back(keyAt(3.1, scene, 200));
    for (const Keyframe& key : keys) CHECK(stateAt(keys, key.time, scene.volume->geometry()) == key.state);
    CHECK(stateAt(keys, -1, scene.volume->geometry()) == keys.front().state);
    CHECK(stateAt(keys, 99, scene.volume->geometry()) == keys.back().state);
    // Just beside a key it is nearly there.
    const KeyState near = stateAt(keys, 2 - 1e-6, scene.volume->geometry());
    CHECK(apart(near.camera.eye, keys[1].state.camera.eye) < 1e-4 * glm::length(near.camera.eye));
    CHECK(near.tf.opacity(keys[1].state.tf.points[1].x) == Approx(0.05).margin(1e-5));
    CHECK(near.clipping.hi.x == Approx(0.6).margin(1e-6));
}

TEST_CASE("halfway between two keys all is halfway", "[film]") {
    const Scene scene = filmScene();
    for (const Easing easing : {Easing::Linear, Easing::Smooth}) {
        const Keyframes keys = twoKeys(scene, 2, easing);
        const KeyState half = stateAt(keys, 1, scene.volume->geometry());
        CHECK(half.clipping.hi.x == Approx(0.8));
        // tents:3 has peaks of 0.5.
        CHECK(half.tf.points[1].opacity == Approx((0.5 + 0.05) / 2));
        // From unlit, which is light from everywhere, to the usual light.
        CHECK(half.light.on);
        CHECK(half.light.ambient == Approx((1 + Light{}.ambient) / 2));
        CHECK(half.light.diffuse == Approx(Light{}.diffuse / 2));
        const auto off = [](const Camera& c) { return glm::length(c.eye - c.center); };
        CHECK(off(half.camera) ==
              Approx(std::sqrt(off(keys[0].state.camera) * off(keys[1].state.camera))).epsilon(1e-6));
    }
}

TEST_CASE("easing goes from 0 to 1, and rests or goes on as its name says", "[film]") {
    const double h = 1e-6;
    for (const Easing easing : allOf<Easing>()) {
        CHECK(easedTime(easing, 0) == 0);
        if (easing == Easing::Hold) continue;
        CHECK(easedTime(easing, 1) == Approx(1));
        const double first = easedTime(easing, h) / h, last = (1 - easedTime(easing, 1 - h)) / h;
        const bool begins = easing == Easing::Smooth || easing == Easing::EaseIn;
        const bool ends = easing == Easing::Smooth || easing == Easing::EaseOut;
        CHECK(first == Approx(begins ? 0 : 1).margin(1e-4));
        CHECK(last == Approx(ends ? 0 : 1).margin(1e-4));
    }
    CHECK(easedTime(Easing::Hold, 0.99) == 0);
}

TEST_CASE("a film that holds stays at its key and jumps to the next", "[film]") {
    const Scene scene = filmScene();
    const Keyframes keys = twoKeys(scene, 1, Easing::Hold);
    CHECK(stateAt(keys, 0.999, scene.volume->geometry()) == keys[0].state);
    CHECK(stateAt(keys, 1, scene.volume->geometry()) == keys[1].state);
}

TEST_CASE("the camera passes a key at an even speed, and stops where that is asked for", "[film]") {
    const Scene scene = filmScene();
    const Geometry& g = scene.volume->geometry();
    // 30° in the first second, 90° in the next: at the key neither 30 nor 90 degrees a second, and no jump.
    Keyframes keys{keyAt(0, scene, 0), keyAt(1, scene, 30), keyAt(2, scene, 120), keyAt(3, scene, 150)};
    const double before = turningAt(keys, 1 - 1e-3, g), after = turningAt(keys, 1 + 1e-3, g);
    CHECK(before == Approx(60).margin(1));
    CHECK(after == Approx(before).margin(1));
    // With nothing to pass, a way between two keys is even from its beginning on.
    const Keyframes two{keyAt(0, scene, 0), keyAt(1, scene, 50)};
    CHECK(turningAt(two, 0.01, g) == Approx(50).margin(0.1));
    CHECK(turningAt(two, 0.9, g) == Approx(50).margin(0.1));
    keys[0].easing = keys[1].easing = Easing::Smooth;
    CHECK(turningAt(keys, 1 - 1e-3, g) == Approx(0).margin(1));
    CHECK(turningAt(keys, 1 + 1e-3, g) == Approx(0).margin(1));
    // A camera that rests between two keys does not sway.
    const Keyframes rests{keyAt(0, scene, 0), keyAt(1, scene, 30), keyAt(2, scene, 30), keyAt(3, scene, 60)};
    for (double t = 1; t <= 2; t += 0.1) CHECK(viewAngles(cameraAt(rests, t, g), g).azimuth == Approx(30).margin(1e-6));
}

TEST_CASE("the eye never goes through the volume", "[film]") {
    const Scene scene = filmScene();
    const Geometry& g = scene.volume->geometry();
    Keyframes keys{keyAt(0, scene, 0), keyAt(1, scene, 0)};
    // The second one looks away from the volume from its other side: straight ahead lies the box.
    Camera& far = keys[1].state.camera;
    far.eye.y = -far.eye.y + 2 * far.center.y;
    far.center.y = far.eye.y + (far.center.y - keys[0].state.camera.eye.y);
    int inside = 0;
    for (int n = 0; n <= 50; ++n) inside += g.contains(cameraAt(keys, n / 50.0, g).eye) ? 1 : 0;
    CHECK(inside == 0);
    // The straight way would have led through it.
    CHECK(g.contains((keys[0].state.camera.eye + far.eye) / 2.0));
}

TEST_CASE("a plane that one key alone has comes in from outside", "[film]") {
    const Scene scene = filmScene();
    Keyframes keys{keyAt(0, scene, 0), keyAt(1, scene, 0)};
    // Half of the box, along a normal of length 2: offsets are of that length, too.
    const Vec3 middle = scene.volume->geometry().boxCenter();
    keys[1].state.clipping.planes.push_back({{2, 0, 0}, 2 * middle.x});
    const double edge = scene.volume->geometry().boundsMax().x;
    const auto at = [&](double t) {
        const KeyState state = stateAt(keys, t, scene.volume->geometry());
        REQUIRE(state.clipping.planes.size() == 1);
        const ClipPlane& plane = state.clipping.planes[0];
        return plane.offset / glm::length(plane.normal);
    };
    CHECK(at(1e-6) == Approx(edge).epsilon(1e-4));
    CHECK(at(0.5) == Approx((edge + middle.x) / 2));
    CHECK(at(1) == Approx(middle.x));
}

TEST_CASE("frames are the nearest ones, and keys are put where their time says", "[film]") {
    const Scene scene = filmScene();
    Keyframes keys{keyAt(0, scene, 0), keyAt(1, scene, 0)};
    keys[1].state.frame = 3;
    for (const auto& [time, frame] : {std::pair(0.0, 0), {0.16, 0}, {0.17, 1}, {0.5, 2}, {0.84, 3}, {1.0, 3}}) {
        CHECK(frameAt(keys, time) == frame);
        CHECK(stateAt(keys, time, scene.volume->geometry()).frame == frame);
    }
    CHECK(putKey(keys, keyAt(0.5, scene, 7)) == 1);
    CHECK(keys.size() == 3);
    CHECK(putKey(keys, keyAt(0.5, scene, 9)) == 1); // in the place of that one
    CHECK(keys.size() == 3);
    CHECK(putKey(keys, keyAt(4, scene, 9)) == 3);
}

TEST_CASE("projections do not mix: the way is the first key's", "[film]") {
    const Scene scene = filmScene();
    const Geometry& g = scene.volume->geometry();
    Keyframes keys{keyAt(0, scene, 0), keyAt(1, scene, 90)};
    Camera& last = keys[1].state.camera;
    last = withProjection(last, g, Projection::Orthographic);
    const Camera near = cameraAt(keys, 1 - 1e-6, g);
    CHECK(near.projection == Projection::Perspective);
    // As large in the plane of the center as the key itself.
    CHECK(2 * glm::length(near.eye - near.center) * std::tan(near.fovY * M_PI / 360) ==
          Approx(last.height).epsilon(1e-3));
    CHECK(cameraAt(keys, 1, g) == last);
}

TEST_CASE("a key that is moved onto another one comes after it, and order follows time", "[film]") {
    const Scene scene = filmScene();
    Keyframes keys{keyAt(0, scene, 10), keyAt(1, scene, 20), keyAt(2, scene, 30)};
    const KeyState first = keys[0].state;
    CHECK(moveKey(keys, 0, 1.5) == 1);
    CHECK(keys[1].state == first);
    CHECK(keys[1].time == 1.5);
    CHECK(moveKey(keys, 1, 2) == 2); // another one is there
    CHECK(keys.size() == 3);
    CHECK(keys[2].state == first);
    CHECK(keys[2].time == Approx(2.01));
    CHECK(moveKey(keys, 2, -5) == 0);
    CHECK(keys[0].time == 0);
    // At the very end there is no later time.
    CHECK(moveKey(keys, 2, 1e9) == 2);
    CHECK(moveKey(keys, 0, 1e9) == 1);
    CHECK(keys[2].time == kMostFilmSeconds);
    CHECK(keys[1].time == Approx(kMostFilmSeconds - 0.01));
}
