// What an object lies on in a scanner: a board, a holder, a head rest (docs/method.md, "The opening view").
#pragma once

#include <optional>

#include "base/job.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid {

/// Something thin that runs through the data from border to border with the same cross-section, beside an object that
/// does not reach those borders.
struct Holder {
    int along = 2;      ///< axis of the grid that it runs along
    int axis = 1;       ///< axis of the grid along which it lies beyond the object
    bool isHigh = true; ///< toward high coordinates of that axis; else toward low ones
    Clipping without;   ///< the box that leaves it out
    double lost = 0;    ///< part of the rest of what is drawn that the box leaves out, too, [0, 0.05]

    /// Unit vector of the world, from the object to the holder.
    Vec3 side(const Geometry& geometry) const { return geometry.directions[axis] * (isHigh ? 1.0 : -1.0); }
};

/// The holder among what `tf` draws; empty where there is none, or no box parts it from the rest. The same for any
/// number of threads. Throws Cancelled.
std::optional<Holder> findHolder(const Volume& volume, const TransferFunction& tf, const JobControl& job = {});

} // namespace pellucid
