// Where points of the world lie in a picture: pixelRay() the other way round.
#pragma once

#include <glm/geometric.hpp>

#include "render/camera.h"
#include "render/stroke_font.h"

namespace pellucid {

/// The world in a picture of width × height pixels.
class Projected {
public:
    Projected(const Camera& camera, double width, double height)
        : m_camera(camera), m_forward(camera.forward()), m_right(camera.right()), m_up(camera.trueUp()), m_width(width),
          m_height(height), m_halfHeight(camera.halfHeight()) {}

    bool isPerspective() const { return m_camera.projection == Projection::Perspective; }
    /// Along the view, from the plane through the eye; world units.
    double depth(const Vec3& p) const { return glm::dot(p - m_camera.eye, m_forward); }
    /// World units per pixel at a depth.
    double unitsPerPixel(double depth) const {
        return (isPerspective() ? 2 * depth * m_halfHeight : m_camera.height) / m_height;
    }
    /// Pixels from the top left corner, y down; depth(p) > 0 where perspective.
    Vec2 operator()(const Vec3& p) const {
        const Vec3 way = p - m_camera.eye;
        const double scale = 1 / unitsPerPixel(depth(p));
        return {m_width / 2 + glm::dot(way, m_right) * scale, m_height / 2 - glm::dot(way, m_up) * scale};
    }
    /// Whether a plane through `p` is seen from the side that its normal points to.
    bool faces(const Vec3& normal, const Vec3& p) const {
        const Vec3 towardEye = isPerspective() ? m_camera.eye - p : -m_forward;
        return glm::dot(normal, towardEye) > 1e-9 * glm::length(towardEye);
    }
    /// A direction, seen from far away: right and up in the picture, and toward the viewer.
    Vec3 turned(const Vec3& d) const { return {glm::dot(d, m_right), glm::dot(d, m_up), -glm::dot(d, m_forward)}; }
    const Vec3& right() const { return m_right; }
    const Vec3& up() const { return m_up; }

private:
    Camera m_camera;
    Vec3 m_forward, m_right, m_up;
    double m_width, m_height, m_halfHeight;
};

} // namespace pellucid
