// A second volume over the first: a t-map on its anatomy, a dose on its CT (docs/method.md, "The overlay").
#pragma once

#include <memory>

#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid {

/// What is drawn over a volume, in one pass with it. No figure depends on it.
struct Overlay {
    std::shared_ptr<const Volume> volume; ///< through the range of its values
    /// Where its voxels lie in the world of the first volume; with the reference length of that, so that opacities of
    /// both are those of the same path.
    Geometry geometry;
    TransferFunction tf; ///< of intensities of `volume`

    /// Data units, trilinear over the valid voxels around; empty outside its box, and where invalid voxels have more
    /// than half of the weight.
    std::optional<double> valueAt(const Vec3& world) const;
};

/// Where an overlay lies in the world of the first volume.
struct OverlayPlace {
    Geometry geometry;      ///< as Overlay::geometry
    bool byCentres = false; ///< nothing tells where both lie in one world: the centres of their boxes are one
};

/// By what both files say of the world. Where one of them is a patient's and the other is not, or neither says more
/// than its spacing, by the centres of their boxes.
OverlayPlace overlayPlace(const Geometry& first, const Geometry& second);

/// How far two boxes are apart at least, world units; 0 where they meet. It is the widest gap that a plane across which
/// they lie can have, of the planes along two of their edges: exact unless corner is nearest to corner.
double boxGap(const Geometry& a, const Geometry& b);

} // namespace pellucid
