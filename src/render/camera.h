// Where the volume is looked at from.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/json_value.h"
#include "volume/volume.h"

namespace pellucid {

enum class Projection { Perspective, Orthographic };

/// World units (docs/method.md, "Volume and intensity"). Orthographic rays run along center − eye.
struct Camera {
    Projection projection = Projection::Perspective;
    Vec3 eye{0, -3, 0};
    Vec3 center{0, 0, 0};
    Vec3 up{0, 0, 1};
    double fovY = 30;  ///< degrees, perspective: full vertical angle of the image, (0, 180)
    double height = 1; ///< world units, orthographic: full height of the image, > 0

    bool operator==(const Camera&) const = default;

    Vec3 forward() const; ///< unit vector, center − eye
    Vec3 right() const;   ///< unit vector
    Vec3 trueUp() const;  ///< unit vector, perpendicular to forward and right
    /// Half of the image's height, world units; perspective: at depth 1.
    double halfHeight() const;
    /// Unit direction from `point` toward the eye: the way light of a voxel goes.
    Vec3 towardEye(const Vec3& point) const;

    /// Throws Error: not finite, eye = center, up parallel to the view, fov or height out of range. `where` names the
    /// camera's origin (a file, an option) in the message.
    void validate(const std::string& where) const;
    /// The same and, for perspective, the eye inside the box.
    void validate(const Geometry& geometry, const std::string& where) const;
};

/// A ray of the image plane: p(t) = origin + t·direction, direction of unit length, world units.
struct Ray {
    Vec3 origin, direction;
};
/// x, y in pixels from the top left corner, centres at +0.5; perspective rays start at the eye, orthographic
/// ones in the plane through the eye.
Ray pixelRay(const Camera& camera, double x, double y, int width, int height);

/// Azimuth and elevation in degrees: (0,0) looks along +y from the front, z up; positive azimuth moves the eye toward
/// +x, positive elevation toward +z. zoom 1 fits the box's bounding sphere into the image, 2 is twice as large.
Camera cameraFromView(const Geometry& geometry, double azimuth, double elevation, double zoom, Projection projection);

/// *.camera.json (docs/guide.md). Throw Error with place and reason. A perspective camera may say its "height" too, a
/// parallel one its "fov_y": what the other projection would take up again.
Camera cameraFromJson(const JsonValue& json);
inline Camera cameraFromJson(const nlohmann::json& json, const std::string& where) {
    return cameraFromJson(JsonValue(json, where));
}
nlohmann::json jsonFromCamera(const Camera& camera);
Camera readCamera(const std::string& path);

} // namespace pellucid
