// Transfer functions as the tables that shaders/include/ray_depth.glsl reads. No GL.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/visibility.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::gl {

/// Entry i stands for the intensity i / cells; cell i lies between the entries i and i + 1. Per entry one number for
/// each candidate, the candidates beyond the last transfer function repeating it.
struct DepthTables {
    int candidates = 1;
    int cells = 0;
    std::vector<float> tau;                  ///< [entry][candidate], optical depth of d0
    std::vector<std::uint32_t> integral;     ///< [entry][candidate], of τ over the cells before, exact, in `unit`
    double unit = 1;                         ///< optical depths times cells; no integral reaches 2³¹ of it
    std::vector<std::uint32_t> opaqueBefore; ///< [entry], how many cells before it any candidate has an opacity in
};

/// A number of cells such that the intensities of integer data in a window of up to 16 384 values (high: 65 536) are
/// entries: steps of a transfer function are smeared over a cell, and should not touch what lies on neither side.
int tableCells(const Volume& volume, Quality quality);
DepthTables makeDepthTables(std::span<const TransferFunction> tfs, int candidates, int cells);

} // namespace pellucid::gl
