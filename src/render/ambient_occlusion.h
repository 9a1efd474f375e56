// Ambient occlusion: how much of the light from all around reaches a place (docs/method.md, "Light").
#pragma once

#include "tf/transfer_function.h"
#include "volume/intensity_grid.h"

namespace pellucid {

/// One value per kCell³ voxels, 0 (closed in) to 255 (open). The centre of cell (a, b, c) lies at the voxel kCell·(a,
/// b, c) + (kCell − 1)/2; voxel v is at (v − (kCell − 1)/2)/kCell among the cells. Between centres trilinear, beyond
/// the outer ones that of the edge.
struct AmbientOcclusion {
    static constexpr int kCell = 4;
    Grid<std::uint8_t> open;
};

/// For the opacities of `tf`, inside `only` alone where it is not null. Every cell sends rays in 14 directions, as far
/// as 6 cells; what is left of them is averaged. The same bits for any number of threads.
AmbientOcclusion makeAmbientOcclusion(const IntensityGrid& grid, const Geometry& geometry, const TransferFunction& tf,
                                      const Feature* only);

} // namespace pellucid
