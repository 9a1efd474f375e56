// What an object lies on in a scanner: a board, a holder, a head rest (docs/method.md, "The opening view").
#pragma once

#include <optional>

#include "base/job.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid {

/// Something thin that runs through the data from border to border beside an object: with the same cross-section, where
/// a box parts them; or apart from it, where a few planes do.
struct Holder {
    int along = 2;      ///< axis of the grid that it runs along
    int axis = 1;       ///< axis of the grid along which it lies beyond the object
    bool isHigh = true; ///< toward high coordinates of that axis; else toward low ones
    Vec3 toward{0};     ///< unit vector of the world, from the object to the holder
    BoxPart without;    ///< the box, or half-spaces, that leave it out
    double lost = 0;    ///< part of the rest of what is drawn that they leave out, too, [0, 0.05]
};

/// The holder among what `tf` draws; empty where there is none, or nothing parts it from the rest. The same for any
/// number of threads. Throws Cancelled.
std::optional<Holder> findHolder(const Volume& volume, const TransferFunction& tf, const JobControl& job = {});

/// The holder, as faint as makes a look through it along Holder::axis meet an opacity of kFaintHolder under `tf`, on
/// average. Throws Cancelled.
FaintRest faintRest(const Holder& holder, const Volume& volume, const TransferFunction& tf, const JobControl& job = {});
inline constexpr double kFaintHolder = 0.15;

} // namespace pellucid
