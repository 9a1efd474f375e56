// A head rest: what bends around an object, so that no box leaves it out (docs/method.md, "The opening view").
#pragma once

#include "render/drawn_cells.h"
#include "render/holder.h"

namespace pellucid {

/// The head rest among the drawn cells of a volume: something thin that runs from border to border beside an object
/// that is not, and that a few planes around the object part from it. Holder::lost is 0. Throws Cancelled.
std::optional<Holder> findCradle(const Geometry& geometry, const CellGrid& grid, const Grid<std::uint8_t>& drawn,
                                 const JobControl& job = {});

} // namespace pellucid
