#include "render/camera.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDefaultFov = 30.0;

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Vec3 vec3FromJson(const JsonValue& value) {
    if (!value.json().is_array() || value.json().size() != 3) value.fail("three numbers [x,y,z] are expected");
    const std::vector<double> v = value.numbers();
    return {v[0], v[1], v[2]};
}

json jsonFromVec3(const Vec3& v) { return {v.x, v.y, v.z}; }

} // namespace

Vec3 Camera::forward() const { return glm::normalize(center - eye); }
Vec3 Camera::right() const { return glm::normalize(glm::cross(forward(), up)); }
Vec3 Camera::trueUp() const { return glm::cross(right(), forward()); }

double Camera::halfHeight() const {
    return projection == Projection::Perspective ? std::tan(fovY * std::numbers::pi / 360) : height / 2;
}

Vec3 Camera::towardEye(const Vec3& point) const {
    return projection == Projection::Orthographic ? -forward() : glm::normalize(eye - point);
}

void Camera::validate(const std::string& where) const {
    const char* correct = "correct the camera";
    if (!finite(eye) || !finite(center) || !finite(up))
        throw Error("the camera has a number that is not finite", where, correct);
    if (!(glm::length(center - eye) > 0)) throw Error("eye and center are the same point", where, correct);
    if (!(glm::length(glm::cross(forward(), up)) > 1e-9 * glm::length(up)))
        throw Error("up is zero or parallel to the view direction", where, correct);
    if (projection == Projection::Orthographic) {
        if (!(height > 0) || !std::isfinite(height)) throw Error("height must be positive", where, correct);
        return;
    }
    if (!(fovY > 0 && fovY < 180)) throw Error("fov_y must lie between 0 and 180 degrees", where, correct);
}

void Camera::validate(const Geometry& geometry, const std::string& where) const {
    validate(where);
    if (projection == Projection::Orthographic) return;
    if (geometry.contains(eye))
        throw Error("the eye is inside the volume's box", where, "move it outside, or use an orthographic camera");
}

Ray pixelRay(const Camera& camera, double x, double y, int width, int height) {
    const double halfHeight =
        camera.projection == Projection::Perspective ? std::tan(camera.fovY * kRadians / 2) : camera.height / 2;
    const double sx = (2 * x / width - 1) * halfHeight * width / height;
    const double sy = (1 - 2 * y / height) * halfHeight;
    const Vec3 offset = sx * camera.right() + sy * camera.trueUp();
    if (camera.projection == Projection::Perspective) return {camera.eye, glm::normalize(camera.forward() + offset)};
    return {camera.eye + offset, camera.forward()};
}

Camera cameraFromView(const Geometry& geometry, double azimuth, double elevation, double zoom, Projection projection) {
    if (!std::isfinite(azimuth) || !std::isfinite(elevation))
        throw UsageError("azimuth and elevation must be finite numbers of degrees", "view", "correct them");
    if (!(zoom > 0) || !std::isfinite(zoom)) throw UsageError("zoom must be a positive factor", "view", "correct it");
    const double az = azimuth * kRadians, el = elevation * kRadians;
    const Vec3 toEye{std::sin(az) * std::cos(el), -std::cos(az) * std::cos(el), std::sin(el)};
    const double radius = geometry.radius();

    Camera camera;
    camera.projection = projection;
    camera.center = geometry.boxCenter();
    // The derivative of toEye by elevation: perpendicular to the view and defined at the poles too.
    camera.up = {-std::sin(az) * std::sin(el), std::cos(az) * std::sin(el), std::cos(el)};
    // Zooming narrows the image instead of moving the eye, so that no zoom leads into the box.
    camera.eye = camera.center + toEye * (radius / std::sin(kDefaultFov * kRadians / 2));
    camera.fovY = 2 * std::atan(std::tan(kDefaultFov * kRadians / 2) / zoom) / kRadians;
    camera.height = 2 * radius / zoom;
    return camera;
}

Camera cameraFromJson(const JsonValue& j) {
    j.requireObject();
    const json& projection = j["projection"].json();
    const bool perspective = projection == "perspective";
    if (!perspective && projection != "orthographic")
        j["projection"].fail("the projection is neither \"perspective\" nor \"orthographic\"");
    Camera camera;
    camera.eye = vec3FromJson(j["eye"]);
    camera.center = vec3FromJson(j["center"]);
    camera.up = vec3FromJson(j["up"]);
    camera.projection = perspective ? Projection::Perspective : Projection::Orthographic;
    if (perspective || j.has("fov_y")) camera.fovY = j["fov_y"].number();
    if (!perspective || j.has("height")) camera.height = j["height"].number();
    camera.validate(j.place());
    return camera;
}

json jsonFromCamera(const Camera& camera) {
    json j = {
        {"eye", jsonFromVec3(camera.eye)}, {"center", jsonFromVec3(camera.center)}, {"up", jsonFromVec3(camera.up)}};
    const bool perspective = camera.projection == Projection::Perspective;
    j["projection"] = perspective ? "perspective" : "orthographic";
    if (perspective)
        j["fov_y"] = camera.fovY;
    else
        j["height"] = camera.height;
    return j;
}

Camera readCamera(const std::string& path) {
    const json document = readJson(path);
    return cameraFromJson(document, path);
}

} // namespace pellucid
