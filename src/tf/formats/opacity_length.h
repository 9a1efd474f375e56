// How long a path is that the opacities of another program hold for, and opacities written for a path of another length
// (docs/method.md, "Transfer functions of other programs").
#pragma once

#include "tf/transfer_function.h"

namespace pellucid {

struct OpacityLength {
    enum class Kind {
        Reference, ///< d0, as here
        World,     ///< `value` world units
        ParaView,  ///< the diagonal of the outer voxels' centres over the cube root of the number of cells
        Texture    ///< `value` times the edge of a volume that is a cube; of others the mean edge
    };
    Kind kind = Kind::Reference;
    double value = 1; ///< > 0, finite
    bool operator==(const OpacityLength&) const = default;

    /// In world units, for a volume that lies like this.
    double inWorld(const Geometry& geometry) const;
    bool needsVolume() const { return kind != Kind::World; }
};

/// The volume that a length is told for where none is known: 256³ voxels, 1 apart.
Geometry unknownVolume();

/// α of a path `ratio` (> 0) times as long: 1 − (1 − α)^ratio; 1 stays 1.
double opacityPer(double alpha, double ratio);

/// `points` with the opacities of paths `ratio` times as long; between two points the line is bent then, and points are
/// added where it would miss by more than 0.002. What is added is fixed where both its neighbours are.
std::vector<ControlPoint> pointsPer(const std::vector<ControlPoint>& points, double ratio);

/// The same of a whole transfer function; features stay.
TransferFunction withOpacitiesPer(const TransferFunction& tf, double ratio);

} // namespace pellucid
