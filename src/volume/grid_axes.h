// How the axes of a grid run where its file does not say it, or says it wrong: told by the user.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "volume/grid_spacing.h"

namespace pellucid {

/// Where the axes i, j, k of a grid point: each along an axis of the world of its own, forwards or backwards.
struct GridAxes {
    std::array<int, 3> along{1, 2, 3}; ///< of i, j, k: ±1, ±2, ±3 for the world's x, y, z; no two of one axis
    bool patient = false;              ///< the world is the patient's: +x, +y, +z are left, posterior, superior
    bool operator==(const GridAxes&) const = default;
};

/// "LPS", three letters of L R A P S I, or "+x-y+z": where i, j and k point. Throws UsageError.
GridAxes parseGridAxes(const std::string& text);
/// The same text back.
std::string gridAxesText(const GridAxes& axes);

/// Whether no two lie along one axis of the world.
bool isComplete(const GridAxes& axes);
/// Whether they are left-handed.
bool isMirrored(const GridAxes& axes);

/// The nearest to how a grid lies.
GridAxes nearestAxes(const Geometry& geometry);

/// The data after a quarter turn around world axis 0, 1 or 2, from the next axis to the one after it (around z: what
/// pointed to +x points to +y).
GridAxes turned(GridAxes axes, int around);
/// The data mirrored along world axis 0, 1 or 2.
GridAxes mirrored(GridAxes axes, int along);

/// The same samples with these axes and distances; empty: as the file has them. Axes turn around the middle of all
/// data, whatever part of them `volume` is: parts and coarser copies lie where they lay in the whole. Throws UsageError
/// as withSpacing() does.
Volume withPlacement(const Volume& volume, const std::optional<GridAxes>& axes,
                     const std::optional<GridSpacing>& spacing);

} // namespace pellucid
