// Rays of a picture in the order in which voxels are stored: the factorization of a view into a shear of the volume's
// slices and a warp of one plane (docs/method.md, "The quick picture").
#pragma once

#include <array>
#include <optional>

#include <glm/vec2.hpp>

#include "render/view.h"

namespace pellucid {

using Vec2 = glm::dvec2;

/// How rays run through the slices along one axis of the grid. Coordinates (u, v, w) are those of voxels along the
/// axes `axis`, w counted from the slice next to the eye on. The ray that passes (U, V) in the slice w = base passes
///     u(w) = U·scale(w) + shift[0](w),   v(w) = V·scale(w) + shift[1](w)
/// in all others: each slice is the plane `base`, shifted and, in perspective, scaled. One ray runs through each point
/// of a grid in that plane.
struct ShearView {
    /// of one coordinate over w
    struct Line {
        double at0 = 0, per1 = 0;
        double operator()(double w) const { return at0 + per1 * w; }
    };

    std::array<int, 3> axis{0, 1, 2}; ///< of the volume: 0 x, 1 y, 2 z; u is x unless w is
    Int3 dims{0, 0, 0};               ///< voxels along u, v, w
    bool reversed = false;            ///< w runs against its axis
    double base = 0;                  ///< slice
    Line scale{1, 0};
    std::array<Line, 2> shift;

    std::array<double, 2> first{0, 0}, pitch{1, 1}; ///< of the grid in the plane `base`, voxels
    int width = 0, height = 0;                      ///< rays; 0 where the picture shows nothing of the volume

    /// Where the ray of a pixel passes the plane `base`: (a + b·x + c·y) / (that of [2]) are U and V.
    struct Fraction {
        double constant = 0, perX = 0, perY = 0;
        double operator()(double x, double y) const { return constant + perX * x + perY * y; }
    };
    std::array<Fraction, 3> ofPixel;

    Vec3 inVoxels(const Vec3& uvw) const;     ///< from (u, v, w) to voxels of the grid
    Vec3 fromVoxels(const Vec3& voxel) const; ///< and back
    /// (u, v) at w of the ray through (U, V) of the plane `base`.
    Vec2 at(const Vec2& inBase, double w) const {
        return {inBase.x * scale(w) + shift[0](w), inBase.y * scale(w) + shift[1](w)};
    }
    /// (U, V) of the ray of a pixel: x, y from the top left corner.
    Vec2 inBase(double x, double y) const {
        const double below = ofPixel[2](x, y);
        return {ofPixel[0](x, y) / below, ofPixel[1](x, y) / below};
    }
};

/// Rays per pixel of a picture that a ShearView has, about, along each axis; and how close they get at most.
struct ShearDensity {
    double raysPerPixel = 0.75;
    double closest = 1.18;  ///< voxels
    double farthest = 1.85; ///< voxels, along u in every slice: that many neighbours are read together; `closest` wins
};

/// The view in storage order; empty where it has none: in perspective, where the eye is beside or within the stack of
/// slices or so near to it that some lie more than kMostScale times as far off as others, or rays are inclined by more
/// than kMostShear voxels per slice; and where the volume is flat. `camera` has been validated.
inline constexpr double kMostScale = 4, kMostShear = 3;
std::optional<ShearView> shearOf(const Camera& camera, const Geometry& geometry, const Clipping& clipping, double width,
                                 double height, const ShearDensity& density = {});

} // namespace pellucid
