// Keyframes of a film: what is seen from where at certain times, and the way from one to the next.
#pragma once

#include <string>
#include <vector>

#include "base/enum_names.h"
#include "render/camera.h"
#include "render/clipping.h"
#include "render/render_settings.h"
#include "tf/transfer_function.h"

namespace pellucid {

struct JobControl;
struct Scene;

/// How a film goes from a key to the next one.
enum class Easing {
    Linear,  ///< evenly; a key between two such ways is passed without a stop
    Smooth,  ///< from rest to rest
    EaseIn,  ///< from rest, and on at full speed
    EaseOut, ///< at full speed, and to rest
    Hold     ///< not at all: it stays as it is and jumps
};
template <>
inline constexpr auto kNamesOf<Easing> = enumNames("easing", "linear", "smooth", "ease-in", "ease-out", "hold");

/// How much of the way is done after the part t ∈ [0,1] of the time: from 0 to 1, with slope 0 where it rests and
/// slope 1 where it goes on.
double easedTime(Easing easing, double t);

/// What a key decides of a picture; the rest is as in the scene that the film is of.
struct KeyState {
    Camera camera;
    TransferFunction tf; ///< in data units: it has a range
    Clipping clipping;
    Light light;
    int frame = 0; ///< of the series
    bool operator==(const KeyState&) const = default;
};
/// That of a scene with a volume.
KeyState keyStateOf(const Scene& scene);
/// The scene with that of a key. `scene` is at the key's frame.
Scene withKeyState(const Scene& scene, const KeyState& state);
/// The same of a scene that may be at another frame, which is read then. Throws FileError, Cancelled.
Scene sceneAtKey(const Scene& scene, const KeyState& state, const JobControl& job);

struct Keyframe {
    double time = 0; ///< s, from 0 on
    std::string name = {};
    Easing easing = Easing::Linear; ///< toward the next key
    KeyState state = {};
    bool operator==(const Keyframe&) const = default;
};

/// By time, which rises from key to key.
using Keyframes = std::vector<Keyframe>;

inline constexpr double kMostFilmSeconds = 3600; ///< that a key may lie after the beginning
inline constexpr std::size_t kMostKeyframes = 1000;

/// Times that are nearer to each other than this are the same, s.
inline constexpr double kSameKeyTime = 1e-6;

/// Puts a key where its time says; one at the same time is replaced. Returns its place.
std::size_t putKey(Keyframes& keys, Keyframe key);
/// Gives key `n` another time, within 0 … kMostFilmSeconds; where another key is, it comes `step` seconds after it.
/// Returns its new place.
std::size_t moveKey(Keyframes& keys, std::size_t n, double time, double step = 0.01);

/// What is seen at `time`; there are keys. At a key's time and beyond the ends exactly what the key has. Between two
/// keys:
///   camera    the center goes straight, the eye around it, lengths and angles grow by equal factors; where a key is
///             passed without a stop, on a curve whose speed does not jump. The eye stays outside the volume's box.
///             Projections do not mix: it is the first key's until the next.
///   tf        as tfMorph()
///   clipping  evenly; a plane that one key alone has comes in from where it cuts nothing
///   light     evenly; without light is light from everywhere
///   frame     evenly, rounded to the nearest
KeyState stateAt(const Keyframes& keys, double time, const Geometry& geometry);
/// The frame of the same alone.
int frameAt(const Keyframes& keys, double time);
Camera cameraAt(const Keyframes& keys, double time, const Geometry& geometry); ///< likewise

} // namespace pellucid
